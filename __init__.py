# SPDX-License-Identifier: GPL-3.0-or-later
"""RPPM, a render engine for Blender: the root that Blender's extension system loads."""

from .rppm_addon import register, unregister

__all__ = ["register", "unregister"]
