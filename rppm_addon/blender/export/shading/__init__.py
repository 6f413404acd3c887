# SPDX-License-Identifier: GPL-3.0-or-later
"""Shading: node trees, materials, lights and the world."""
