# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes divided by the size at which the camera sees them: Cycles' adaptive subdivision."""
