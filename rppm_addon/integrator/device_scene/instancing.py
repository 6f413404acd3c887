# SPDX-License-Identifier: GPL-3.0-or-later
"""Instancing: which instances are expanded to world triangles, and which the rays place in the world."""

import numpy as np

from ...materials.traits.emitted import Emits, emits
from ...materials.traits.node_rays import traces_rays
from ...scene.materials import Material
from ...scene.passes import DEEP_CUBEMAP, VECTOR
from ...scene.scene import Scene
from ...scene.settings import FirstCameraHits, Instancing

MANY_TRIANGLES = 1 << 22
"""Triangles of an expanded scene from which on AUTOMATIC instancing has two levels, where a tenth of them stays."""
_FRACTION_LEFT = 0.1


def instanced_members(scene: Scene, is_software: bool) -> np.ndarray | None:
    """(instances,) bool, the instances that are not expanded to world triangles; None for none.

    These are the instances of meshes that occur more than once, keep their shape while the shutter is open, and have
    materials that neither emit light nor fill their inside with a medium. is_software: whether the processor stands in
    for a GPU.
    """
    wanted = scene.settings.instancing
    if wanted is Instancing.EXPANDED or not _may_have_two_levels(scene, is_software):
        return None
    meshes = np.array([instance.mesh for instance in scene.instances], np.int64)
    lengths = np.array([mesh.triangle_count for mesh in scene.meshes], np.int64)
    if not len(meshes) or (wanted is Instancing.AUTOMATIC and lengths[meshes].sum() < MANY_TRIANGLES):
        return None
    excluded = {index for index, material in enumerate(scene.materials) if _must_be_expanded(material)}
    bending = {deformation.mesh for deformation in scene.shutter.meshes} if scene.shutter is not None else set()
    whole = np.array([index not in bending and mesh.volume is None for index, mesh in enumerate(scene.meshes)])
    plain = np.array([excluded.isdisjoint(instance.materials) for instance in scene.instances])
    chosen = whole[meshes] & plain
    counts = np.bincount(meshes[chosen], minlength=len(scene.meshes))
    chosen &= counts[meshes] > 1
    if not chosen.any():
        return None
    left = lengths[meshes[~chosen]].sum() + lengths[np.unique(meshes[chosen])].sum()
    if wanted is Instancing.AUTOMATIC and left > _FRACTION_LEFT * lengths[meshes].sum():
        return None
    return chosen


def _may_have_two_levels(scene: Scene, is_software: bool) -> bool:
    """Whether all that looks at the triangles of a scene does so by rays and what they hit."""
    settings = scene.settings
    first_hits = (FirstCameraHits.TRACED, *((FirstCameraHits.AUTOMATIC,) if is_software else ()))
    return (
        settings.first_camera_hits in first_hits
        and scene.camera.texels is None
        and not {VECTOR, DEEP_CUBEMAP.name} & set(settings.passes)
        and not any(traces_rays(material.graph) for material in scene.materials)
    )


def _must_be_expanded(material: Material) -> bool:
    return material.interior is not None or emits(material.graph) is not Emits.NOTHING
