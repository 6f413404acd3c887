# SPDX-License-Identifier: GPL-3.0-or-later
"""Grids of OpenVDB files, read by the module that Blender brings along."""

import importlib
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType
from typing import Any

import bpy
import numpy as np

from .....scene.errors import RppmError
from .....scene.volumes import VolumeGrid
from .velocities import merged

MAX_VOXELS = 1 << 24
"""Voxels of a grid, at most; of larger ones each second voxel is read, along each axis, or less."""
_AXES = 3
"""Components of a vector."""


class VolumeError(RppmError):
    """A volume that cannot be read; the message says why and names the remedy."""


@dataclass
class VolumeFile:
    """The grids of a volume, read into memory."""

    grids: dict[str, VolumeGrid] = field(default_factory=dict)
    """By name, those of velocities aside."""
    velocities: VolumeGrid | None = None
    """(x, y, z, 3); None where there are none, or nobody asked for them."""
    messages: list[str] = field(default_factory=list)
    """Texts about what is left out."""


def read_grids(volume: bpy.types.Volume, with_velocities: bool = False) -> VolumeFile:
    """The grids of an evaluated volume. Raises VolumeError."""
    grids = volume.grids
    if not grids.load() or not all(grid.load() for grid in grids):  # the first reads their names
        path = bpy.path.abspath(volume.filepath)
        raise VolumeError(f"{path}: {grids.error_message or 'it cannot be read'}; choose another file")
    openvdb = _module()
    with tempfile.TemporaryDirectory(prefix="rppm-") as folder:
        path = str(Path(folder) / "volume.vdb")
        try:  # as modifiers made it, and also where there is no file
            is_saved = grids.save(path)
        except RuntimeError as error:
            raise VolumeError(f"{volume.filepath}: {str(error).strip()}; choose another file") from error
        if not is_saved:
            raise VolumeError(f"{volume.filepath}: {grids.error_message or 'it cannot be read'}; choose another file")
        found, velocities = VolumeFile(), {}
        names = _velocity_names(volume)
        for name in dict.fromkeys(metadata.name for metadata in openvdb.readAllGridMetadata(path)):
            if with_velocities or name not in names:
                try:
                    grid = _read(openvdb.read(path, name), name, found.messages)
                except (RuntimeError, TypeError, ValueError):  # such as of points
                    found.messages.append(f'its grid "{name}" holds no numbers and is left out')
                    continue
                if grid is not None:
                    (velocities if name in names else found.grids)[name] = grid
    if velocities:
        found.velocities = _velocities(volume, velocities)
        if found.velocities is None:
            found.messages.append(
                "its velocities are no grid of vectors, nor three grids of the same voxels, and do not blur it; choose "
                "another Velocity Grid"
            )
    return found


def _velocities(volume: bpy.types.Volume, found: Mapping[str, VolumeGrid]) -> VolumeGrid | None:
    """The velocities of a volume among its grids by name; None where they are no vectors."""
    whole = found.get(volume.velocity_grid)
    if whole is not None and whole.values.shape[3] == _AXES:
        return whole
    components = [found.get(name) for name in _component_names(volume)]
    scalars = [grid for grid in components if grid is not None and grid.values.shape[3] == 1]
    return merged(scalars) if len(scalars) == _AXES else None


def _module() -> ModuleType:
    try:
        return importlib.import_module("openvdb")
    except ImportError:
        pass
    if hasattr(bpy.utils, "expose_bundled_modules"):
        bpy.utils.expose_bundled_modules()
    for name in ("openvdb", "pyopenvdb"):
        try:
            return importlib.import_module(name)
        except ImportError:
            continue
    raise VolumeError("this Blender brings no module openvdb along; use Blender 4.4 or newer for volumes")


def _component_names(volume: bpy.types.Volume) -> tuple[str, str, str]:
    return volume.velocity_x_grid, volume.velocity_y_grid, volume.velocity_z_grid


def _velocity_names(volume: bpy.types.Volume) -> set[str]:
    return {volume.velocity_grid, *_component_names(volume)} - {""}


def _read(grid: Any, name: str, messages: list[str]) -> VolumeGrid | None:
    """The active part of a grid, with a border of one voxel; None where it has none, or no numbers."""
    value = grid.background
    channels = len(value) if isinstance(value, tuple | list) else 1
    if isinstance(value, str) or channels not in (1, 3) or "Mask" in type(grid).__name__:
        messages.append(f'its grid "{name}" holds no numbers and is left out')
        return None
    if grid.activeVoxelCount() == 0:
        return None
    low, high = (np.array(corner) for corner in grid.evalActiveVoxelBoundingBox())
    counts = high - low + 1
    if np.prod(counts, dtype=np.float64) > (1 << 31):
        messages.append(f'its grid "{name}" has {" x ".join(map(str, counts))} voxels, too many to be read')
        return None
    values = np.zeros((*counts, channels) if channels > 1 else counts, np.float32)
    grid.copyToArray(values, ijk=tuple(map(int, low)))
    matrix = _index_to_object(grid.transform)
    matrix[:3, 3] += matrix[:3, :3] @ low
    values, step = _coarser(values.reshape(*counts, channels))
    if step > 1:
        messages.append(f'its grid "{name}" has more than {MAX_VOXELS:,} voxels; {step**3} are rendered as one')
    matrix[:3, 3] += matrix[:3, :3] @ np.full(3, 0.5 * (step - 1))
    matrix[:3, :3] *= step
    matrix[:3, 3] -= matrix[:3, :3] @ np.ones(3)
    return VolumeGrid(np.pad(values, [(1, 1)] * 3 + [(0, 0)]), matrix)


def _index_to_object(transform: Any) -> np.ndarray:
    """(4, 4) matrix of a linear transform."""
    origin = np.array(transform.indexToWorld((0, 0, 0)))
    matrix = np.eye(4)
    for axis in range(3):
        matrix[:3, axis] = np.array(transform.indexToWorld(tuple(float(axis == k) for k in range(3)))) - origin
    matrix[:3, 3] = origin
    return matrix


def _coarser(values: np.ndarray) -> tuple[np.ndarray, int]:
    """Values (x, y, z, channels) of at most MAX_VOXELS voxels, and how many voxels became one along each axis."""
    step = 1
    while np.prod([-(-count // step) for count in values.shape[:3]]) > MAX_VOXELS:
        step += 1
    if step == 1:
        return values, 1
    padded = np.pad(values, [(0, -count % step) for count in values.shape[:3]] + [(0, 0)])
    x, y, z = (count // step for count in padded.shape[:3])
    return padded.reshape(x, step, y, step, z, step, -1).mean(axis=(1, 3, 5), dtype=np.float32), step
