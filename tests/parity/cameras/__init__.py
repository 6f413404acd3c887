# SPDX-License-Identifier: GPL-3.0-or-later
"""Projections, lenses, eyes and motion while the shutter is open."""
