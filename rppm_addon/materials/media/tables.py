# SPDX-License-Identifier: GPL-3.0-or-later
"""Participating media of a scene on the device: the volumes inside surfaces, and the world's."""

from collections.abc import Sequence

import numpy as np

from ...gl.buffer_sets import BufferSet, Part, StorageBuffer
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...scene.meshes import Instance
from ...scene.scene import Scene
from ..records import MATERIAL, MAX_MEDIA, MEDIUM, PHASE_FUNCTION
from ..traits.interiors import Evaluate, Interior, Variation
from .emission import EmissiveMedia
from .grids import EvaluateVoxels, MediumGrids, PlacedMedium
from .places import MediumPlaces
from .voxel_evaluation import WORLD

_Medium = tuple[np.void, np.ndarray]
"""A MEDIUM record, and its (n,) PHASE_FUNCTION records."""


class MediaTables(BufferSet):
    """The buffers Media and PhaseFunctions. Medium 0 is the world's, which all paths are in; others fill materials.

    Media that are the same everywhere are numbered first, one a material. Those that vary have a grid, one for each
    instance with the material, and ``bake`` makes them once the instances are known.
    """

    remedy = "use fewer materials with volumes"
    _media = StorageBuffer("media", MEDIUM, block="Media")
    _phase_functions = StorageBuffer("phase functions", PHASE_FUNCTION, texel_bytes=16, block="PhaseFunctions")
    _grids = Part(MediumGrids)
    emissive = Part(EmissiveMedia)

    def __init__(self, context: Context, library: ProgramLibrary, sizes: object = None) -> None:
        super().__init__(context, library, sizes)
        self.materials: frozenset[int] = frozenset()
        """Materials that fill the inside of what they are on, by index."""
        self.emit = False
        """Whether any medium emits light."""
        self.scatter = False
        """Whether any medium scatters light."""
        self.world_scatters = False
        """Whether the world's medium scatters light."""
        self.fills_world = False
        """True where the world has a medium that is the same everywhere, and weakens light."""
        self.world_transmittance = (1.0, 1.0, 1.0)
        """Fraction of the light from infinitely far away that the world's medium lets through, by channel: 0 or 1."""
        self.places = MediumPlaces({}, None, 0)
        """Media that vary."""
        self._records, self._material_count = MATERIAL.zeros(1), 1
        self._table = MEDIUM.zeros(1)
        self._varying: list[PlacedMedium] = []
        self._even: list[_Medium] = []
        """The world's medium, and those that are the same everywhere."""

    def build(
        self, scene: Scene, records: np.ndarray, interiors: list[Interior], world: Interior, evaluate: Evaluate
    ) -> None:
        """Upload the coefficients of the media, and enter the media's numbers into the records of the materials.

        interiors: of the materials, (n,) as the MATERIAL ``records``; world: the world's volume.
        """
        even = {index: _medium(interior, evaluate) for index, interior in enumerate(interiors) if not interior.varies}
        filled = [index for index, (record, _) in even.items() if _has_effect(record)]
        if len(filled) > MAX_MEDIA:
            scene.warn(f"{len(filled)} materials have volumes; those of the first {MAX_MEDIA} are rendered")
            filled = filled[:MAX_MEDIA]
        records["medium"][filled] = 1 + np.arange(len(filled))
        world_varies = world.variation >= Variation.PLACE_IN_OBJECT
        self._even = [_medium(Interior() if world_varies else world, evaluate), *(even[index] for index in filled)]
        varying = {index: interior for index, interior in enumerate(interiors) if interior.varies}
        self.places = MediumPlaces(varying, world if world_varies else None, len(filled))
        self.materials = frozenset(filled) | frozenset(varying)
        self._records, self._material_count, self._varying = records, len(records), []
        self._upload(self._even)

    def place(self, scene: Scene) -> np.ndarray:
        """Return the (n,) MATERIAL records for the instances of a scene; ``bake`` is to follow."""
        self._records = self.places.place(scene, self._records[: self._material_count])
        return self._records

    def bake(
        self, scene: Scene, media: Sequence[PlacedMedium], evaluate: EvaluateVoxels, evaluate_once: Evaluate
    ) -> None:
        """Bake and upload the media that vary: those of ``places``, the world's behind them."""
        self._varying = list(media)
        baked = self._grids.bake(scene, self._varying, evaluate, evaluate_once)
        world = self._even[0] if self.places.world is None else baked.pop()
        self._upload([world, *self._even[1:], *baked])

    def advect(self, time: float) -> None:
        """Move what velocities move in volumes to where it is at a time of the shutter, 0 to 1, after ``bake``."""
        self._grids.advect(time)

    def list_emissive(self, scene: Scene, placed: Sequence[Instance], bounds: tuple[np.ndarray, np.ndarray]) -> None:
        """List the media that emit light, after ``bake``, and their light groups.

        placed: the instances of the scene that have triangles; bounds: of the scene, (3,) each.
        """
        self.emissive.clear()
        if not self.emit:
            return
        groups = {name: number for number, name in enumerate(scene.settings.light_groups, 1)}
        self._table["light_group"][0] = groups.get(scene.world.light_group, 0)
        world = self._even[0][0]
        if world["emission"].any():
            self.emissive.add_world(scene, bounds, world)
        even = self._even_emitters()
        for number, instance in enumerate(placed):
            for medium in sorted({even[material] for material in instance.materials if material in even}):
                self._table["light_group"][medium] = groups.get(instance.light_group, 0)
                self.emissive.add_even(scene, instance, number, medium, self._even[medium][0]["emission"])
        for medium, varying in enumerate(self._varying, len(self._even)):
            baked, to_object = self._grids.baked(varying), varying.to_object
            if baked is None or baked.emission_cells is None or to_object is None:
                continue
            to_grid = baked.lattice.to_grid @ to_object
            if varying.instance == WORLD:
                self.emissive.add_grid(scene, varying, None, 0, to_grid, baked.emission_cells)
                continue
            instance = placed[varying.instance]
            self._table["light_group"][medium] = groups.get(instance.light_group, 0)
            self.emissive.add_grid(scene, varying, instance, medium, to_grid, baked.emission_cells)
        self.emissive.upload()
        if groups:
            self._media.upload(self._table)

    def _even_emitters(self) -> dict[int, int]:
        """Numbers of the media that emit light and are the same everywhere, by material."""
        media = self._records["medium"][: self._material_count].tolist()
        shining = {number for number, (record, _) in enumerate(self._even) if number > 0 and record["emission"].any()}
        return {material: medium for material, medium in enumerate(media) if medium in shining}

    def _upload(self, listed: list[_Medium]) -> None:
        first = 0
        for record, functions in listed:
            record["first_function"] = first
            first += len(functions)
        media = MEDIUM.zeros(max(len(listed), len(self._records)))
        media[: len(listed)] = [record for record, _ in listed]
        media["material_medium"][: len(self._records)] = self._records["medium"]
        media["bounds_volume"][: len(self._records)] = self._records["bounds_volume"]
        media["medium_bits"] = max(int(self._records["medium"].max()).bit_length(), 1)
        self._table = media
        self._media.upload(media)
        self._phase_functions.upload(np.concatenate([functions for _, functions in listed] + [PHASE_FUNCTION.zeros(1)]))
        self.emit = any(record["emission"].any() for record, _ in listed)
        self.scatter = any(record["scattering"].any() for record, _ in listed)
        world = listed[0][0]
        self.world_scatters = bool(world["scattering"].any())
        weakened = (world["absorption"] + world["scattering"] > 0.0) & (self.places.world is None)
        self.fills_world = bool(weakened.any())
        self.world_transmittance = tuple(np.where(weakened, 0.0, 1.0).tolist())


def _medium(interior: Interior, evaluate: Evaluate) -> _Medium:
    """The record of an interior that is the same everywhere, and its phase functions."""
    record = MEDIUM.zeros(1)[0]
    for name, graph in (("absorption", interior.absorption), ("emission", interior.emission)):
        if graph is not None:
            record[name] = np.maximum(evaluate(graph)[0, 0], 0.0)
    functions = PHASE_FUNCTION.zeros(len(interior.scattering))
    for function, part in zip(functions, interior.scattering, strict=True):
        function["scattering"] = np.maximum(evaluate(part.coefficient)[0, 0], 0.0)
        function["kind"] = part.kind
        function["parameters"] = part.parameters(evaluate)
    record["scattering"] = functions["scattering"].sum(axis=0)
    record["function_count"] = len(functions)
    return record, functions


def _has_effect(record: np.void) -> bool:
    return any(record[name].any() for name in ("absorption", "scattering", "emission"))
