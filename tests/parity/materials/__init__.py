# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces in whole scenes."""
