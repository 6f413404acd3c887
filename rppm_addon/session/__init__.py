# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders from their scene to their picture, in this process or in one of their own."""
