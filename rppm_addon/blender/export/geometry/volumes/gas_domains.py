# SPDX-License-Identifier: GPL-3.0-or-later
"""Smoke and fire of fluid domains."""

import bpy
import numpy as np

from .....scene.volumes import VolumeGrid

_GRIDS = {"density": 1, "flame": 1, "temperature": 1, "color": 4, "heat": 1}
"""Channels of the grids that domain settings have, by the names of the attributes."""
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
    settings, mesh = _domain_settings(source), source.data
    resolution = np.array(settings.domain_resolution, np.int64)
    low = np.array(mesh.texspace_location) - np.array(mesh.texspace_size)
    found = {}
    for name, channels in _GRIDS.items():
        values = np.array(getattr(settings, f"{name}_grid"), np.float32)
        count = values.size // channels
        scale = round((count / max(int(np.prod(resolution)), 1)) ** (1.0 / 3.0))  # of the noise, which is finer
        counts = resolution * max(scale, 1)
        if count == 0 or count != np.prod(counts) or not values.any():
            continue
        x, y, z = counts
        values = values.reshape(z, y, x, channels).transpose(2, 1, 0, 3)[..., : 3 if channels == 4 else 1]
        step = 2.0 * np.array(mesh.texspace_size) / counts
        matrix = np.diag([*step, 1.0])
        matrix[:3, 3] = low - 0.5 * step  # with a border of one voxel
        found[name] = VolumeGrid(np.pad(values, [(1, 1)] * 3 + [(0, 0)]), matrix)
    return found if found.keys() & _SHOWN else {}
