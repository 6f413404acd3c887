# SPDX-License-Identifier: GPL-3.0-or-later
"""The renderers that this Blender uses: their process, their thread and their device."""
