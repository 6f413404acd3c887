# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes: grids of voxels, with the boxes around them."""
