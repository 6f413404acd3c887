# SPDX-License-Identifier: GPL-3.0-or-later
"""The search of a depsgraph for what RPPM does not render as Cycles does."""

from collections.abc import Iterable, Iterator

import bpy

from ..common.report import Report, listed
from ..common.slices import Slices
from ..view_layer.passes import passes_of_cycles_only
from .layer_omissions import layer_differences
from .object_omissions import OF_OBJECTS
from .omission import Omission
from .pass_omissions import passes_without
from .scene_omissions import OF_SCENES

_AT_ONCE = 32
"""Objects between which nobody looks at the clock."""


class OmissionList:
    """List of the omissions that the objects of a depsgraph and its scene use."""

    def __init__(self) -> None:
        self._users: dict[Omission, dict[int, str]] = {}
        """By what they use, the names of objects by session_uid."""
        self._known: set[int] = set()
        """session_uid of those that were looked at."""

    def look_at_all(self, depsgraph: bpy.types.Depsgraph, slices: Slices) -> None:
        """Take note of the objects of a depsgraph that it does not know. Raises Unfinished when the slice is over."""
        for source in objects_of(depsgraph):
            if source.original.session_uid not in self._known:
                self.look_at([source])
                if len(self._known) % _AT_ONCE == 0:
                    slices.rest()

    def look_at(self, sources: Iterable[bpy.types.Object]) -> None:
        """Take note of evaluated objects, anew of those that it knows."""
        for source in sources:
            uid = source.original.session_uid
            self._known.add(uid)
            for omission in OF_OBJECTS:
                if omission.is_used(source):
                    self._users.setdefault(omission, {})[uid] = source.name
                elif omission in self._users:
                    self._users[omission].pop(uid, None)

    def warn(self, depsgraph: bpy.types.Depsgraph, report: Report) -> None:
        """Have the report name what the objects so far, the scene and its view layer use, each once."""
        scene, layer = depsgraph.scene_eval, depsgraph.view_layer_eval
        without, switched_off = passes_without(layer), passes_of_cycles_only(layer)
        with report.about("omissions"):
            for omission, users in self._users.items():
                if users:
                    report.warn(f"{omission.title} ({listed(users.values())}): {omission.consequence}")
            for omission in OF_SCENES:
                if omission.is_used(scene):
                    report.warn(f"{omission.title}: {omission.consequence}")
            for difference in layer_differences(scene, layer):
                report.warn(difference)
            if without:
                report.warn(f"Passes that RPPM does not have: {', '.join(without)}; links from them stay black")
            if switched_off:
                report.warn(
                    f"Passes that are on for Cycles only: {', '.join(switched_off)}; switch them on in View Layer > "
                    "Passes, or take all of Cycles' settings with Sampling > Advanced > Copy from Cycles"
                )


def objects_of(depsgraph: bpy.types.Depsgraph) -> Iterator[bpy.types.Object]:
    """The evaluated objects that a depsgraph holds, what is multiplied included."""
    return (block for block in depsgraph.ids if isinstance(block, bpy.types.Object))
