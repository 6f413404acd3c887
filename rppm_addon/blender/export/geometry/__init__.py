# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry: meshes, hair and points."""
