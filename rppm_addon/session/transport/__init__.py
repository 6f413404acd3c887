# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages and arrays between Blender and the renderer's process."""
