# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes and normals of meshes."""
