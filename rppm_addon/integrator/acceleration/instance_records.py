# SPDX-License-Identifier: GPL-3.0-or-later
"""Records of instances that rays place in the world."""

import numpy as np

from .acceleration_structure import MARGIN
from .instances import BOTTOM_LEVEL_INSTANCE, InstancedMeshes


def instance_records(instanced: InstancedMeshes, roots: np.ndarray, reach: float) -> np.ndarray:
    """BOTTOM_LEVEL_INSTANCE records, at least one. roots: (n,) that of each instance; reach: how far from the world's
    origin anything is, meters."""
    records = BOTTOM_LEVEL_INSTANCE.zeros(max(len(instanced.which), 1))
    if not len(instanced.which):
        return records
    for row in range(3):
        records[f"to_object{row}"] = instanced.inverses[:, row]
        records[f"row{row}"] = instanced.entries[f"row{row}"]
    for name in ("pivot", "set_code"):
        records[name] = instanced.entries[name]
    records["first_triangle"] = instanced.mesh_first_triangles[instanced.which]
    records["root"] = roots
    records["placement"] = instanced.placements
    records["mirrored"] = instanced.are_mirrored
    # Rounding of a ray's origin, and of the vertices in the world.
    scales = np.linalg.norm(instanced.inverses[:, :, :3], axis=(1, 2))
    records["margin"] = MARGIN * reach * scales
    return records
