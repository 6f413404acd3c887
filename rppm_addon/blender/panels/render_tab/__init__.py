# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels of the render tab of the Properties editor."""
