# SPDX-License-Identifier: GPL-3.0-or-later
"""Node graphs to GLSL, and the tables that they read."""
