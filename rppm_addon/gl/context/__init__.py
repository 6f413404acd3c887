# SPDX-License-Identifier: GPL-3.0-or-later
"""The OpenGL context, its device and driver, and how work is paced."""
