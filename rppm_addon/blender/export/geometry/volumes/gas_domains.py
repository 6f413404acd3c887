# SPDX-License-Identifier: GPL-3.0-or-later
"""Smoke and fire of fluid domains."""

import bpy
import numpy as np

from .....scene.volumes import VolumeGrid

_GRIDS = {"density": 1, "flame": 1, "temperature": 1, "color": 4, "heat": 1}
"""Channels of the grids that domain settings have, by the names of the attributes."""
_COLOR = 4
"""Channels of colors, whose alpha is not read."""
_SHOWN = {"density", "flame"}
"""Attributes without which a domain has neither smoke nor fire."""


def is_gas_domain(source: bpy.types.Object) -> bool:
    """True where Cycles takes a mesh object for the smoke and fire in it, baked or not, and does not show its mesh."""
    settings = _domain_settings(source)
    return settings is not None and settings.domain_type == "GAS"


def _domain_settings(source: bpy.types.Object) -> "bpy.types.FluidDomainSettings | None":
    return next((modifier.domain_settings for modifier in _domains(source)), None)


def _domains(source: bpy.types.Object) -> list[bpy.types.FluidModifier]:
    fluids = [modifier for modifier in source.modifiers if modifier.type == "FLUID"]
    return [modifier for modifier in fluids if modifier.fluid_type == "DOMAIN"]


def read_gas(source: bpy.types.Object) -> dict[str, VolumeGrid]:
    """The grids of an evaluated domain by name; empty where nothing is baked."""
    if not any(modifier.show_render or modifier.show_viewport for modifier in _domains(source)):
        return {}  # Blender's module may abort where the simulation was not evaluated
    read = {name: _read(source, f"{name}_grid", channels) for name, channels in _GRIDS.items()}
    found = {name: grid for name, grid in read.items() if grid is not None}
    return found if found.keys() & _SHOWN else {}


def read_gas_velocities(source: bpy.types.Object) -> tuple[VolumeGrid | None, float]:
    """The velocities (x, y, z, 3) of the gas of an evaluated domain that read_gas has read, None without any, and their
    factor to meters a second."""
    return _read(source, "velocity_grid", 3), _domain_settings(source).velocity_scale


def _read(source: bpy.types.Object, name: str, channels: int) -> VolumeGrid | None:
    """A grid of a domain by the name of its property, with a border of one voxel; None where it is empty."""
    settings, mesh = _domain_settings(source), source.data
    resolution = np.array(settings.domain_resolution, np.int64)
    values = np.array(getattr(settings, name), np.float32)
    count = values.size // channels
    scale = round((count / max(int(np.prod(resolution)), 1)) ** (1.0 / 3.0))  # of the noise, which is finer
    counts = resolution * max(scale, 1)
    if count == 0 or count != np.prod(counts) or not values.any():
        return None
    x, y, z = counts
    values = values.reshape(z, y, x, channels).transpose(2, 1, 0, 3)[..., : 3 if channels == _COLOR else channels]
    step = 2.0 * np.array(mesh.texspace_size) / counts
    matrix = np.diag([*step, 1.0])
    matrix[:3, 3] = np.array(mesh.texspace_location) - np.array(mesh.texspace_size) - 0.5 * step
    return VolumeGrid(np.pad(values, [(1, 1)] * 3 + [(0, 0)]), matrix)
