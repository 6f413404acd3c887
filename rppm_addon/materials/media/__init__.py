# SPDX-License-Identifier: GPL-3.0-or-later
"""Participating media: their tables on the device, and the grids of those that vary."""
