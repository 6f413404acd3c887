# SPDX-License-Identifier: GPL-3.0-or-later
"""Places of media that vary: each instance has a material of its own for them."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ...scene.meshes import Instance, Mesh
from ...scene.scene import Scene
from ..records import MAX_MEDIA
from ..traits.interiors import Interior, Variation
from .grids import PlacedMedium
from .voxel_evaluation import WORLD

_WORLD_MARGIN = 0.5
"""Margin around the scene up to which the world's medium is rendered where it varies, as a part of its longest side."""


@dataclass
class MediumPlaces:
    """Media that vary, by where they are.

    The medium that a surface leads into is that of its material's record. As the grid of a medium lies within an
    instance, an instance with such a medium has a copy of the record, behind those of all materials.
    """

    interiors: Mapping[int, Interior]
    """Media by material."""
    world: Interior | None
    """Medium of the world, where it varies."""
    even_count: int
    """Number of media of materials that are the same everywhere, which are numbered from 1 on."""
    copies: list[tuple[int, int]] = field(default_factory=list)
    """Instance and material of each copy, by their indices in the scene."""
    slots: list[Sequence[int]] | None = None
    """Materials of the slots of each instance of the scene; None where these are those of the instances."""

    @property
    def any(self) -> bool:
        """Whether any medium varies."""
        return bool(self.interiors) or self.world is not None

    def place(self, scene: Scene, records: np.ndarray) -> np.ndarray:
        """The (n,) MATERIAL records of the materials and then of the copies, for the instances of a scene."""
        self.copies, self.slots = [], None
        if not self.interiors:
            return records
        self.slots = []
        for index, instance in enumerate(scene.instances):
            numbers = {}
            for material in instance.materials:
                if material in self.interiors and material not in numbers:
                    numbers[material] = len(records) + len(self.copies)
                    self.copies.append((index, material))
            known = {material: material for material in instance.materials if 0 <= material < len(scene.materials)}
            self.slots.append([(known | numbers).get(material, -1) for material in instance.materials])
        copied = records[[material for _, material in self.copies]]
        copied["medium"] = 1 + self.even_count + np.arange(len(copied))
        count = self.even_count + len(copied)
        if count > MAX_MEDIA:
            scene.warn(f"{count} objects and materials have volumes of their own; the first {MAX_MEDIA} are rendered")
            copied["medium"][copied["medium"] > MAX_MEDIA] = 0
        return np.concatenate([records, copied])

    def media(
        self, scene: Scene, placed: Sequence[Instance], bounds: tuple[np.ndarray, np.ndarray]
    ) -> Iterator[PlacedMedium]:
        """The media of the copies, in their order, and that of the world.

        placed: the instances of the scene that have triangles, in its order; bounds: of the scene, (3,) each, meters.
        """
        numbers: dict[int, int] = {}
        for index, instance in enumerate(scene.instances):
            if len(numbers) < len(placed) and placed[len(numbers)] is instance:
                numbers[index] = len(numbers)
        images = tuple(scene.images)
        for index, material in self.copies[: MAX_MEDIA - self.even_count]:
            instance, interior = scene.instances[index], self.interiors[material]
            mesh = scene.meshes[instance.mesh]
            is_shared = interior.variation is Variation.PLACE_IN_OBJECT and not instance.attributes
            source = (scene.materials[material], mesh, *(() if is_shared else (instance,)), *images)
            box = mesh_box(mesh) if index in numbers else None
            volume, number = mesh.volume, numbers.get(index, 0)
            yield PlacedMedium(
                interior,
                box,
                instance.matrix,
                number,
                None if volume is None else volume.spacing,
                _density_factor(instance.matrix) if volume is not None and volume.scales_density else 1.0,
                volume,
                instance.attributes,
                source,
            )
        if self.world is not None:
            yield self._world_medium(self.world, scene, bounds)

    def _world_medium(self, world: Interior, scene: Scene, bounds: tuple[np.ndarray, np.ndarray]) -> PlacedMedium:
        low, high = bounds
        margin = _WORLD_MARGIN * float(np.max(high - low))
        low, high, camera = low - margin, high + margin, np.asarray(scene.camera.matrix, np.float64)[:3, 3]
        source = (scene.world, *scene.instances, *scene.meshes, *scene.images)
        if (camera < low).any() or (camera > high).any():
            source = (*source, scene.camera)
        box = np.minimum(low, camera), np.maximum(high, camera)
        return PlacedMedium(world, box, np.eye(4), WORLD, None, 1.0, None, {}, source)


def mesh_box(mesh: Mesh) -> tuple[np.ndarray, np.ndarray] | None:
    """Return the lowest and highest finite coordinates of a mesh, each (3,) float64; None without any."""
    positions = mesh.positions[np.isfinite(mesh.positions).all(axis=1)]
    if not len(positions):
        return None
    return positions.min(axis=0).astype(np.float64), positions.max(axis=0).astype(np.float64)


def _density_factor(matrix: np.ndarray) -> float:
    """Factor of densities by length in the space of an object, as in Cycles: by the scale along the diagonal."""
    scale = float(np.linalg.norm(np.asarray(matrix, np.float64)[:3, :3] @ np.full(3, 1.0 / np.sqrt(3.0))))
    return 1.0 / scale if scale > 0.0 else 1.0
