# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene that follows Blender's depsgraph from frame to frame: changes, motion and baking."""
