# SPDX-License-Identifier: GPL-3.0-or-later
"""The connection between Blender and the renderer's process: messages, shared memory, client sessions."""
