# SPDX-License-Identifier: GPL-3.0-or-later
"""Particles that instances stand for."""

import bpy
import numpy as np

from ....scene import Particle
from ..common.hashing import hashed

_COLUMNS = {"birth_time": 1, "lifetime": 1, "size": 1, "location": 3, "velocity": 3, "angular_velocity": 3}


class ParticleTable:
    """The particles of one slice of a pass over a depsgraph, those of a system read together."""

    def __init__(self) -> None:
        self._frame = 0.0
        self._systems: dict[int, list[tuple]] = {}

    def begin(self, frame: float) -> None:
        """Begin a slice at a frame of the scene."""
        self._frame = frame

    def forget(self) -> None:
        """Forget all particles, which may change after the slice."""
        self._systems = {}

    def of(self, instance: bpy.types.DepsgraphObjectInstance) -> Particle | None:
        """Return the values of the Particle Info node for an instance; None when it stands for no particle.

        instance: one that an object multiplies.
        """
        system = instance.particle_system
        if system is None:
            return None
        key = system.as_pointer()
        if key not in self._systems:
            self._systems[key] = _rows(system)
        index = instance.persistent_id[0]
        if not 0 <= index < len(self._systems[key]):
            return None
        birth, *rest = self._systems[key][index]
        return Particle(float(index), hashed(index), self._frame - birth, *rest)


def _rows(system: bpy.types.ParticleSystem) -> list[tuple]:
    """Return the values of _COLUMNS for each particle."""
    particles, columns = system.particles, []
    for name, width in _COLUMNS.items():
        values = np.empty(width * len(particles), np.float32)
        particles.foreach_get(name, values)
        columns.append(values.tolist() if width == 1 else list(map(tuple, values.reshape(-1, width).tolist())))
    return list(zip(*columns, strict=True))
