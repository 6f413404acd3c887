# SPDX-License-Identifier: GPL-3.0-or-later
"""What objects belong to, as Cryptomatte's assets have it."""

import bpy

from ....scene import RenderSettings
from ....scene.cryptomatte import ASSETS


def export_asset_names(depsgraph: bpy.types.Depsgraph, settings: RenderSettings) -> dict[str, str]:
    """Of objects that have a parent, by name, the names of their topmost ones; none where no pass asks for them."""
    if not any(name.startswith(ASSETS) for name in settings.passes):
        return {}
    objects = (block for block in depsgraph.ids if isinstance(block, bpy.types.Object))
    return {source.name: _topmost(source).name for source in objects if source.parent is not None}


def _topmost(source: bpy.types.Object) -> bpy.types.Object:
    while source.parent is not None:
        source = source.parent
    return source
