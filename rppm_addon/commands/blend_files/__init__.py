# SPDX-License-Identifier: GPL-3.0-or-later
""".blend files: opened with the bpy module, their settings, and what Blender brings along."""
