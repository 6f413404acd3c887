# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that a .blend links to and that are not there: Blender goes on without what is in them."""

from collections.abc import Iterator

import bpy

from ..common.report import Report, listed


def warn_of_missing(report: Report) -> None:
    """Name the libraries of the open file of which something is missing, and what."""
    if not bpy.data.libraries:
        return
    missing: dict[bpy.types.Library, list[str]] = {library: [] for library in bpy.data.libraries}
    for block in _blocks():  # once, where Blender's Library.users_id would go through all for each library
        if block.is_missing and block.library in missing:
            missing[block.library].append(block.name)
    for library, names in missing.items():
        if not names and not library.is_missing:
            continue
        where = "is missing" if library.is_missing else "does not have all that is linked"
        left_out = f": {listed(names)} left out" if names else ""
        report.warn(f'the library "{library.filepath}" {where}{left_out}; put it back, or link to another file')


def _blocks() -> Iterator[bpy.types.ID]:
    """All of the open file."""
    for kind in bpy.data.bl_rna.properties:
        if kind.type == "COLLECTION":
            yield from getattr(bpy.data, kind.identifier)
