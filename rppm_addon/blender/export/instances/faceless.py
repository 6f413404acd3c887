# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects whose modifiers leave no faces to be rendered, so that none is lost in silence."""

import bpy

from ..common.report import Report, listed


class FacelessObjects:
    """Mesh objects whose modifiers leave no face; meshes that never had one are as users meant them."""

    def __init__(self) -> None:
        self._names: dict[int, str] = {}
        """By session_uid."""
        self._with_nodes: set[int] = set()
        self._multiplied: set[int] = set()
        self._bringers: set[int] = set()

    def note(self, source: bpy.types.Object) -> None:
        """Take note of an evaluated object whose own mesh has no face to be rendered."""
        original = source.original
        if original.type == "MESH" and len(original.data.polygons) > 0:
            self._names[original.session_uid] = source.name
            if any(modifier.type == "NODES" for modifier in source.modifiers):
                self._with_nodes.add(original.session_uid)

    def is_multiplied(self, uid: int) -> None:
        """Take note that another object shows instances of the object of this session_uid. Blender attributes what its
        own geometry nodes bring to that other object, too."""
        self._multiplied.add(uid)

    def brings_others(self, uid: int) -> None:
        """Take note that the object of this session_uid shows instances, strands or points."""
        self._bringers.add(uid)

    def warn(self, report: Report) -> None:
        """Have the report name those of which nothing is seen."""
        others = self._bringers | (self._multiplied & self._with_nodes)
        names = [name for uid, name in self._names.items() if uid not in others]
        if names:
            what = f"Object {listed(names)}: its" if len(names) == 1 else f"Objects {listed(names)}: their"
            report.warn(f"{what} modifiers leave no faces, so nothing is rendered; look at them in the Modifiers tab")
