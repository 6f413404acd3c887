# SPDX-License-Identifier: GPL-3.0-or-later
"""Which Open Image Denoise libraries there are for this Blender."""

from pathlib import Path

import bpy

from ...denoising.places import LibraryPlace, library_places


def denoising_libraries() -> list[LibraryPlace]:
    """In the order in which they are tried; of what the user names, those that are there. Main thread only."""
    program = bpy.app.binary_path  # empty in the bpy module
    found = library_places(Path(program).parent if program else None, _chosen_path())
    return [place for place in found if place.path.is_file()]


def root_package() -> str:
    """The name under which Blender knows the extension: bl_ext.REPOSITORY.rppm, or rppm_addon from source."""
    return __package__.rpartition(".rppm_addon")[0] or "rppm_addon"


def _chosen_path() -> str:
    addon = bpy.context.preferences.addons.get(root_package())
    return "" if addon is None or addon.preferences is None else bpy.path.abspath(addon.preferences.denoiser_path)
