# SPDX-License-Identifier: GPL-3.0-or-later
"""Assets that objects belong to, as Cryptomatte defines them."""

import bpy

from ....scene import RenderSettings
from ....scene.cryptomatte import ASSETS


def export_asset_names(depsgraph: bpy.types.Depsgraph, settings: RenderSettings) -> dict[str, str]:
    """Return the name of the topmost parent of each object that has a parent, by the object's name.

    The result is empty where no pass asks for assets.
    """
    if not any(name.startswith(ASSETS) for name in settings.passes):
        return {}
    objects = (block for block in depsgraph.ids if isinstance(block, bpy.types.Object))
    return {source.name: _topmost(source).name for source in objects if source.parent is not None}


def _topmost(source: bpy.types.Object) -> bpy.types.Object:
    while source.parent is not None:
        source = source.parent
    return source
