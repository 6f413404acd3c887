# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that stand for themselves: nothing multiplies them."""

import bpy
import numpy as np

from ....scene import Instance
from ..camera.culling import Selection
from ..geometry.strands.round_meshes import ROUND_TYPES
from .converted_curves import ConvertedCurves
from .instance_reader import CONVERTED_TYPES, InstanceReader
from .placements import Placements, identity_of


class SingleObjects:
    """Places objects that stand for themselves, unchanged objects with the instances that they had."""

    def __init__(
        self,
        reader: InstanceReader,
        placements: Placements,
        curves: ConvertedCurves,
        unchanged: dict[int, Instance],
        moved: dict[int, Instance],
    ) -> None:
        """unchanged: by session_uid, the instances of objects that are as they were; moved: of objects that at most
        were moved."""
        self._reader = reader
        self._placements = placements
        self._curves = curves
        self._unchanged = unchanged
        self._moved = moved

    def export(
        self,
        entry: bpy.types.DepsgraphObjectInstance,
        source: bpy.types.Object,
        matrix: np.ndarray,
        selection: Selection,
    ) -> None:
        """Place the object of an entry of a depsgraph at a matrix (4, 4). Raises Unfinished when the slice is over."""
        original, reader, placements = source.original, self._reader, self._placements
        if not selection.shows(original) or selection.culling.leaves_out(source, matrix):
            return
        uid, kind = original.session_uid, source.type
        identity = identity_of(entry, original, original) if placements.identify else ()
        if kind == "LIGHT":
            light = reader.light(source, matrix)
            if light is not None:
                placements.add_light(light, uid, identity)
            return
        is_round = kind in ROUND_TYPES
        if is_round:  # an object may show several
            placements.mark_multiple(uid)
            reader.faceless.brings_others(uid)
        unchanged = self._unchanged.get(uid)
        if unchanged is not None and not is_round and reader.keep(unchanged):
            placements.add(unchanged, matrix, uid, identity)
            return
        description = reader.describe(source, before=None if is_round else self._moved.get(uid))
        if description is None:
            return
        if kind in CONVERTED_TYPES:
            self._curves.add(source, description, matrix, identity)
            return
        if original.type in CONVERTED_TYPES:
            self._curves.add_mesh(original.as_pointer(), matrix)
        placements.add(description.place(matrix), matrix, 0 if is_round else uid, identity)
