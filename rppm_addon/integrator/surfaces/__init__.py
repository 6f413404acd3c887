# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces on the device: world-space triangles, their attributes, and hits resolved to closures."""
