# SPDX-License-Identifier: GPL-3.0-or-later
"""Exported scenes of viewports that were switched to another shading, for when they are switched back."""

import bpy
import numpy as np

from ...scene import Mesh, Scene
from ..export import SceneSync

MOST_BYTES = 1 << 30
"""Most bytes that the meshes and images of a scene may have for it to be kept."""
_MOST = 2
_MOST_UPDATES = 1 << 10
"""Blocks that change at once: noting more, in each frame of an animation, would take longer than it saves."""

_Key = tuple[int, int, str]
_kept: dict[_Key, SceneSync] = {}
"""By their depsgraphs, the newest last."""


def key_of(depsgraph: bpy.types.Depsgraph) -> _Key:
    """Return the key that identifies a depsgraph: its address, scene and view layer."""
    return depsgraph.as_pointer(), depsgraph.scene.session_uid, depsgraph.view_layer.name


def keep(key: _Key, sync: SceneSync) -> None:
    """Keep the export of a viewport, and note all changes for it from now on."""
    scene = sync.scene
    if scene is not None and _bytes_of(scene) > MOST_BYTES:
        return
    _kept.pop(key, None)
    _kept[key] = sync
    while len(_kept) > _MOST:
        del _kept[next(iter(_kept))]


def take(depsgraph: bpy.types.Depsgraph) -> SceneSync | None:
    """Remove and return the kept export of a viewport of the same depsgraph; None where there is none."""
    return _kept.pop(key_of(depsgraph), None)


def note(depsgraph: bpy.types.Depsgraph) -> None:
    """A depsgraph was evaluated: remember what has changed in it."""
    key = key_of(depsgraph) if _kept else None
    if key not in _kept:
        return
    if len(depsgraph.updates) > _MOST_UPDATES:
        del _kept[key]
    else:
        _kept[key].note(depsgraph)


def forget() -> None:
    """Give all back."""
    _kept.clear()


def _bytes_of(scene: Scene) -> int:
    return sum(image.pixels.nbytes for image in scene.images) + sum(map(_bytes_of_mesh, scene.meshes))


def _bytes_of_mesh(mesh: Mesh) -> int:
    arrays = [*vars(mesh).values(), *(attribute.values for attribute in mesh.attributes.values())]
    return sum(array.nbytes for array in arrays if isinstance(array, np.ndarray))
