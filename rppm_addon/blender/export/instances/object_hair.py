# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair that mesh objects have by their particle systems."""

import bpy
import numpy as np

from ..camera.culling import Selection
from ..common.report import Report
from ..geometry.strands.particle_hair import HAIRLESS_MODES, hair_modifiers, hair_systems
from ..view_layer.visibility import is_seen, visibility_of
from .instance_reader import InstanceReader
from .multiplied_objects import random_of
from .placements import Placements, identity_of, identity_of_hair


class ObjectHair:
    """Places the hair of objects, whether the objects themselves are seen or not."""

    def __init__(self, reader: InstanceReader, placements: Placements, report: Report, is_render: bool) -> None:
        """is_render: whether the hair is that of renders, not of viewports."""
        self._reader = reader
        self._placements = placements
        self._report = report
        self._is_render = is_render

    def export(
        self,
        entry: bpy.types.DepsgraphObjectInstance,
        source: bpy.types.Object,
        matrix: np.ndarray,
        selection: Selection,
    ) -> None:
        """Place the hair of an entry's mesh object at a matrix (4, 4). Raises Unfinished when the slice is over."""
        if len(source.particle_systems) == 0:
            return
        if entry.is_instance and entry.instance_object.data != source.data:
            return  # what its nodes of geometry multiply: as in Cycles, without hair
        parent = entry.parent if entry.is_instance else None
        original, owner = source.original, (parent or source).original
        if not selection.shows(owner) or selection.culling.leaves_out(source, matrix):
            return
        instancer = None if parent is None else self._reader.instancer(parent, owner.session_uid)
        visibility = visibility_of(source)
        if not is_seen(visibility if instancer is None else visibility & instancer.visibility):
            return
        systems = list(hair_systems(source, self._is_render))
        if source.mode in HAIRLESS_MODES and any(hair_modifiers(source, self._is_render)):
            self._report.warn(
                f'Object "{source.name}": as in Cycles its hair is not rendered in {HAIRLESS_MODES[source.mode]}; '
                "leave that mode"
            )
        if not systems:
            return
        self._placements.mark_multiple(original.session_uid)
        self._reader.faceless.brings_others(original.session_uid)
        description = self._reader.describe_hair(source, systems, None if instancer is None else entry)
        if description is None:
            return
        random = None
        if instancer is not None:
            description, random = description.multiplied_by(instancer), random_of(entry)
        identity = ()
        if self._placements.identify:
            identity = identity_of_hair(identity_of(entry, original, owner), original)
        self._placements.add(description.place(matrix, random), matrix, 0, identity)
