# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that a .blend links to and that are not there: Blender goes on without what is in them."""

import bpy

from .report import Report, listed


def warn_of_missing(report: Report) -> None:
    """Name the libraries of the open file of which something is missing, and what."""
    for library in bpy.data.libraries:
        missing = [user.name for user in library.users_id if user.is_missing]
        if not missing and not library.is_missing:
            continue
        where = "is missing" if library.is_missing else "does not have all that is linked"
        left_out = f": {listed(missing)} left out" if missing else ""
        report.warn(f'the library "{library.filepath}" {where}{left_out}; put it back, or link to another file')
