# SPDX-License-Identifier: GPL-3.0-or-later
"""Media that emit light: where photons leave them, and how bright they are."""

import math
from dataclasses import dataclass

import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...scene.meshes import Instance, Mesh
from ...scene.scene import Scene
from .emission_cells import EmissionCells
from .grids import PlacedMedium
from .places import mesh_box
from .voxel_evaluation import WORLD

EMISSIVE_MEDIUM = Record(
    "EmissiveMedium",
    instance="uint",
    medium="uint",
    first_cell="uint",
    cell_count="uint",
    cell_side="uint",
    unused0="uint",
    unused1="uint",
    unused2="uint",
    inner="vec3",
    boxes="uint",
)
"""A medium that emits light within an ``instance``, by their numbers; WORLD where it is around everything. In one with
a grid, photons leave from cells of ``cell_side`` voxels along each axis; without cells, from anywhere in one of so many
``boxes`` about one center, of which the innermost has the extents ``inner`` of the outermost, which is that of the
light."""
Constants("EmissionPlaces", AROUND_EVERYTHING=WORLD)
StorageBlock("EmissiveMedia", "EmissiveMedium emissive_media[];")

_FREE_PATHS, _SCENES = 12.0, 8.0
"""Margin around the scene from which photons of the world's medium leave: longest mean free paths, but not more than so
many times the scene's diagonal."""
_BOXES = 6
"""Boxes of the world's medium, from that around the scene to the largest: light from far away seldom comes to it."""
_FLATTEST = 0.01
"""Least extent of the innermost of these over its largest: the photons of a flat one would carry no light."""
_LEAST_FILL = 0.02
"""Least part of its box that a medium is taken to fill, where its mesh has holes or turns inside out."""


@dataclass(frozen=True)
class EmissiveMedium:
    """A medium that emits light within an instance, or around everything."""

    instance: int
    """Number of the instance among those with triangles, or WORLD."""
    frame: np.ndarray
    """(4, 3) origin and axes of the box that it lies in or, with a grid, of the grid's voxels, meters."""
    strength: np.ndarray
    """(3,) W that all of the box emits; with a grid, 4 pi times the volume of a voxel, m^3 sr."""
    power: np.ndarray
    """(3,) W that it emits, as far as the volume within its surface is known."""
    inner: np.ndarray | None = None
    """(3,) extents of the innermost of several boxes over those of the outermost; None where there is but one."""


class EmissiveMedia(BufferSet):
    """The buffers EmissiveMedia and EmissionCells, and the media by number."""

    remedy = "use fewer objects with volumes that emit light"
    _table = StorageBuffer("emissive media", EMISSIVE_MEDIUM, block="EmissiveMedia")
    _cells = StorageBuffer("cells of emissive media", "uvec2", block="EmissionCells")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: object = None) -> None:
        super().__init__(context, library, sizes)
        self.listed: list[EmissiveMedium] = []
        self._records: list[np.void] = []
        self._parts: list[np.ndarray] = []
        self._fills: dict[int, tuple[Mesh, float]] = {}
        """Part of its box that a mesh fills, by the mesh's identity, of the meshes since ``clear``."""
        self._fills_before: dict[int, tuple[Mesh, float]] = {}

    def clear(self) -> None:
        """Forget all media."""
        self.listed, self._records, self._parts = [], [], []
        self._fills_before, self._fills = self._fills, {}

    def add_even(self, scene: Scene, instance: Instance, number: int, medium: int, emission: np.ndarray) -> None:
        """Add a medium that is the same everywhere in an instance; emission: (3,) W/(m^3 sr)."""
        mesh = scene.meshes[instance.mesh]
        box = mesh_box(mesh)
        if box is None:
            return
        low, high = box
        matrix = np.asarray(instance.matrix, np.float64)
        frame = np.stack([matrix[:3, :3] @ low + matrix[:3, 3], *(matrix[:3, :3] * (high - low)).T])
        self._add(_even_medium(number, frame, emission, self._fill(mesh)), medium)

    def add_world(self, scene: Scene, bounds: tuple[np.ndarray, np.ndarray], world: np.void) -> None:
        """Add the world's medium, a MEDIUM record, where it is the same everywhere. bounds: of the scene, (3,) each."""
        camera = np.asarray(scene.camera.matrix, np.float64)[:3, 3]
        low, high = np.minimum(bounds[0], camera), np.maximum(bounds[1], camera)
        missing = np.maximum(_FLATTEST * max(float((high - low).max()), 1e-3) - (high - low), 0.0)
        low, high = low - 0.5 * missing, high + 0.5 * missing
        extinction = float(np.min(world["absorption"] + world["scattering"]))
        margin = min(_FREE_PATHS / max(extinction, 1e-30), _SCENES * float(np.linalg.norm(high - low)))
        frame = np.stack([low - margin, *np.diag(high - low + 2.0 * margin)])
        inner = (high - low) / np.diag(frame[1:])
        self._add(_even_medium(WORLD, frame, world["emission"], 1.0, inner), 0)

    def add_grid(
        self, scene: Scene, placed: PlacedMedium, instance: Instance | None, medium: int, to_grid: np.ndarray,
        cells: EmissionCells,
    ) -> None:  # fmt: skip
        """Add a medium that varies, within an instance or around everything; to_grid: (4, 4) from the world."""
        from_grid = np.linalg.inv(to_grid)
        frame = np.stack([from_grid[:3, 3], *from_grid[:3, :3].T])
        voxel = 4.0 * math.pi * abs(np.linalg.det(frame[1:]))
        fill = 1.0 if instance is None else self._fill(scene.meshes[instance.mesh])
        power = fill * voxel * placed.factor * cells.total
        self._add(EmissiveMedium(placed.instance, frame, np.full(3, voxel), power), medium, cells)

    def _add(self, found: EmissiveMedium, medium: int, cells: EmissionCells | None = None) -> None:
        if not (np.isfinite(found.frame).all() and np.isfinite(found.power).all() and found.power.any()):
            return
        record = EMISSIVE_MEDIUM.zeros(1)[0]
        record["instance"], record["medium"] = found.instance, medium
        record["inner"], record["boxes"] = (1.0, 1) if found.inner is None else (found.inner, _BOXES)
        record["first_cell"] = sum(map(len, self._parts))
        if cells is not None:
            record["cell_count"], record["cell_side"] = len(cells.records), cells.side
            self._parts.append(cells.records)
        self.listed.append(found)
        self._records.append(record)

    def upload(self) -> None:
        """Upload the media that were added since ``clear``."""
        self._table.upload(np.array([*self._records, EMISSIVE_MEDIUM.zeros(1)[0]], EMISSIVE_MEDIUM.dtype))
        self._cells.upload(np.concatenate([*self._parts, np.zeros((1, 2), np.uint32)]))

    def _fill(self, mesh: Mesh) -> float:
        """Part of its box that a closed mesh fills."""
        if id(mesh) not in self._fills:
            self._fills[id(mesh)] = self._fills_before.get(id(mesh)) or (mesh, _filled_part(mesh))
        return self._fills[id(mesh)][1]


def _even_medium(
    instance: int, frame: np.ndarray, emission: np.ndarray, fill: float, inner: np.ndarray | None = None
) -> EmissiveMedium:
    strength = 4.0 * math.pi * abs(np.linalg.det(frame[1:])) * np.asarray(emission, np.float64)
    return EmissiveMedium(instance, frame, strength, fill * strength, inner)


def _filled_part(mesh: Mesh) -> float:
    positions = mesh.positions.astype(np.float64)
    corners = positions[mesh.corner_vertices[mesh.triangle_corners]].reshape(-1, 3, 3)
    corners = corners[np.isfinite(corners).all(axis=(1, 2))]
    if not len(corners):
        return 1.0
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    a, b, c = np.moveaxis(corners - low, 1, 0)
    volume = abs(float((a * np.cross(b, c)).sum())) / 6.0
    return float(np.clip(volume / max(float(np.prod(high - low)), 1e-300), _LEAST_FILL, 1.0))
