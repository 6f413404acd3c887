# SPDX-License-Identifier: GPL-3.0-or-later
"""The commands of the rppm program; those for .blend files import bpy when they run."""
