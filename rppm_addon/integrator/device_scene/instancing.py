# SPDX-License-Identifier: GPL-3.0-or-later
"""Instancing: which instances are expanded to world triangles, and which the rays place in the world."""

import numpy as np

from ...gl.context.context import Context
from ...materials.traits.emitted import glowing_materials
from ...scene.meshes import Instance, Mesh
from ...scene.scene import Scene
from ...scene.settings import FirstCameraHits, Instancing
from ...scene.storage.sharing import changed_members
from ..common.instance_columns import InstanceColumns, column
from ..common.records.triangles import TRIANGLE_VERTICES
from ..lights.emitters.candidates import STEPS

MANY_TRIANGLES = 1 << 18
"""Triangles of an expanded scene from which on AUTOMATIC instancing may have two levels: building a hierarchy of fewer
takes less time than compiling the programs that trace two."""
_FRACTION_LEFT = 0.1
"""Fraction of an expanded scene's triangles that AUTOMATIC instancing leaves at most, unless things move."""

_EXPANDED_BYTES = 306
"""Bytes of an expanded triangle with all that is made of it (docs/benchmarks/instances.md)."""
_FRACTION_OF_MEMORY = 0.75
"""Fraction of a device's memory that expanded triangles take at most under AUTOMATIC."""


class MovedInstances:
    """Instances that have moved or bent from scene to scene, or do so while the shutter is open."""

    def __init__(self) -> None:
        self._instances: list[Instance] = []
        self._meshes: list[Mesh] = []
        self._have_moved = np.zeros(0, bool)
        """(instances,) those that have moved or bent from scene to scene."""

    def follow(self, scene: Scene) -> np.ndarray:
        """Take a scene; returns (instances,) bool, those that moved or bend, as far as the scenes had the same
        instances."""
        before, self._instances = self._instances, list(scene.instances)
        meshes, self._meshes = self._meshes, list(scene.meshes)
        if len(before) != len(scene.instances):
            self._have_moved = np.zeros(len(scene.instances), bool)
        else:
            rows = changed_members(before, scene.instances).tolist()
            self._have_moved[[row for row in rows if _has_moved(before[row], scene.instances[row])]] = True
            if len(meshes) == len(scene.meshes):
                rows = changed_members(meshes, scene.meshes).tolist()
                bent = [row for row in rows if _has_bent(meshes[row], scene.meshes[row])]
                self._have_moved |= _instances_of(bent, scene)
        result = self._have_moved.copy()
        if scene.shutter is not None:
            result[[movement.member for movement in scene.shutter.instances]] = True
            result |= _instances_of([deformation.mesh for deformation in scene.shutter.meshes], scene)
        return result


def _has_moved(old: Instance, new: Instance) -> bool:
    return old.mesh == new.mesh and old.matrix.tobytes() != new.matrix.tobytes()


def _has_bent(old: Mesh, new: Mesh) -> bool:
    return old.positions is not new.positions and not np.array_equal(old.positions, new.positions)


def _instances_of(meshes: list[int], scene: Scene) -> np.ndarray:
    """(instances,) bool, those of meshes by number."""
    if not meshes:
        return np.zeros(len(scene.instances), bool)
    return np.isin(column(scene.instances, "mesh", np.int64), meshes)


def most_expanded_triangles(context: Context) -> int:
    """Number of expanded triangles that a device holds: in one buffer, and in its memory where that is known."""
    in_buffer = context.array_limit(16) // TRIANGLE_VERTICES.size
    memory = context.memory
    return in_buffer if memory is None else min(in_buffer, int(_FRACTION_OF_MEMORY * memory) // _EXPANDED_BYTES)


def fits_expanded(scene: Scene, most_triangles: int) -> bool:
    """Return True where all instances of a scene have no more than so many triangles, and no more of these may emit
    light than can be chosen from."""
    lengths = np.array([mesh.triangle_count for mesh in scene.meshes], np.int64)
    few = min(most_triangles, STEPS)
    if len(scene.instances) * int(lengths.max(initial=0)) <= few:  # without a look at a million instances
        return True
    counts = lengths[column(scene.instances, "mesh", np.int64)]
    if counts.sum() <= few or counts.sum() > most_triangles:
        return bool(counts.sum() <= most_triangles)
    glowing = glowing_materials(scene.materials)
    glows = np.array([not glowing.isdisjoint(instance.materials) for instance in scene.instances], bool)
    return bool(counts[glows].sum() <= STEPS)


def instanced_members(
    scene: Scene, columns: InstanceColumns, moved: np.ndarray, is_software: bool
) -> np.ndarray | None:
    """(instances,) bool, the instances that are not expanded to world triangles; None for none.

    These are instances of meshes that occur more than once, or that move or bend, but for one that is baked and for
    grids of volumes. Those that emit light are such of meshes that occur more than once, and keep their shape while the
    shutter is open. columns: of the scene's instances, at any moment; moved:
    MovedInstances.follow. is_software: whether the processor stands in for a GPU.
    """
    wanted = scene.settings.instancing
    if wanted is Instancing.EXPANDED or not _may_have_two_levels(scene, is_software):
        return None
    meshes = columns.meshes
    lengths = np.array([mesh.triangle_count for mesh in scene.meshes], np.int64)
    is_automatic, total = wanted is Instancing.AUTOMATIC, lengths[meshes].sum() if len(meshes) else 0
    if not total or (is_automatic and total < MANY_TRIANGLES):
        return None
    glowing = glowing_materials(scene.materials)
    glows = columns.have(glowing)
    may_be = _may_be_instanced(scene, columns)
    if glows.any() and scene.shutter is not None:
        may_be &= ~(glows & _instances_of([deformation.mesh for deformation in scene.shutter.meshes], scene))
    counts = np.bincount(meshes[may_be], minlength=len(scene.meshes))
    shared = may_be & (counts[meshes] > 1)
    if is_automatic:
        left = lengths[meshes[~shared]].sum() + lengths[counts > 1].sum()
        shared &= left <= _FRACTION_LEFT * total
    chosen = shared | (may_be & moved & ~glows)
    return chosen if chosen.any() else None


def _may_be_instanced(scene: Scene, columns: InstanceColumns) -> np.ndarray:
    """(instances,) bool, those that rays may place in the world."""
    whole = np.array([mesh.volume is None for mesh in scene.meshes], bool)
    result = whole[columns.meshes]
    if scene.camera.texels is not None:  # which know the triangles of what is baked by number
        result[scene.camera.texels.instance] = False
    return result


def _may_have_two_levels(scene: Scene, is_software: bool) -> bool:
    """Whether all that looks at the triangles of a scene does so by rays and what they hit."""
    settings = scene.settings
    is_traced = is_software or settings.instancing is Instancing.TWO_LEVELS
    first_hits = (FirstCameraHits.TRACED, *((FirstCameraHits.AUTOMATIC,) if is_traced else ()))
    return settings.first_camera_hits in first_hits
