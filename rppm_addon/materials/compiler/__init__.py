# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiler of node graphs to GLSL."""
