# SPDX-License-Identifier: GPL-3.0-or-later
"""Photons meet importons: radii, sums of splats, and the two routes to them."""
