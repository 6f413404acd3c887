# SPDX-License-Identifier: GPL-3.0-or-later
"""Participating media of a scene on the device: the volumes inside surfaces, and the world's."""

import numpy as np

from ..gl.buffer_sets import BufferSet, StorageBuffer
from ..gl.context.context import Context
from ..gl.programs.programs import ProgramLibrary
from ..scene.scene import Scene
from .records import MAX_MEDIA, MEDIUM, PHASE_FUNCTION
from .traits.interiors import Evaluate, Interior


class MediaTables(BufferSet):
    """The buffers Media and PhaseFunctions. Medium 0 is the world's, which all paths are in; others fill materials."""

    remedy = "use fewer materials with volumes"
    _media = StorageBuffer("media", MEDIUM, block="Media")
    _phase_functions = StorageBuffer("phase functions", PHASE_FUNCTION, block="PhaseFunctions")

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

    def build(
        self, scene: Scene, records: np.ndarray, interiors: list[Interior], world: Interior, evaluate: Evaluate
    ) -> None:
        """Upload the coefficients of the media, and enter the media's numbers into the records of the materials.

        interiors: of the materials, (n,) as the MATERIAL ``records``; world: the world's volume.
        """
        media = [_medium(interior, evaluate) for interior in interiors]
        filled = [index for index, (record, _) in enumerate(media) if _has_effect(record)]
        if len(filled) > MAX_MEDIA:
            scene.warn(f"{len(filled)} materials have volumes; those of the first {MAX_MEDIA} are rendered")
            filled = filled[:MAX_MEDIA]
        records["medium"][filled] = 1 + np.arange(len(filled))
        records["medium_bits"] = max(len(filled).bit_length(), 1)
        listed = [_medium(world, evaluate), *(media[index] for index in filled)]
        first = 0
        for record, functions in listed:
            record["first_function"] = first
            first += len(functions)
        self._media.upload(np.array([record for record, _ in listed]))
        self._phase_functions.upload(np.concatenate([functions for _, functions in listed] + [PHASE_FUNCTION.zeros(1)]))
        self.materials = frozenset(filled)
        self.emit = any(record["emission"].any() for record, _ in listed)
        self.scatter = any(record["scattering"].any() for record, _ in listed)
        self.world_scatters = bool(listed[0][0]["scattering"].any())


def _medium(interior: Interior, evaluate: Evaluate) -> tuple[np.void, np.ndarray]:
    """The MEDIUM record of an interior, and its (n,) PHASE_FUNCTION records."""
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
