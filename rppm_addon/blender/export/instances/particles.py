# SPDX-License-Identifier: GPL-3.0-or-later
"""Particles that instances stand for."""

import bpy
import numpy as np

from ....scene import Particle, ParticleArray
from ..common.hashing import hashed_numbers

_COLUMNS = {"birth_time": 1, "lifetime": 1, "size": 1, "location": 3, "velocity": 3, "angular_velocity": 3}


class ParticleTable:
    """The particles of one slice of a pass over a depsgraph, those of a system read together."""

    def __init__(self) -> None:
        self._frame = 0.0
        self._systems: dict[int, ParticleArray] = {}
        """Particles by the addresses of their systems."""

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
        particles, index = self.read(system), instance.persistent_id[0]
        return particles[index] if 0 <= index < len(particles) else None

    def read(self, system: bpy.types.ParticleSystem) -> ParticleArray:
        """All particles of a system."""
        key = system.as_pointer()
        if key not in self._systems:
            self._systems[key] = _particles(system, self._frame)
        return self._systems[key]


class ParticleRows:
    """The particles that instances of one slice stand for, noted one by one."""

    def __init__(self, table: ParticleTable) -> None:
        self._table = table
        self._system: bpy.types.ParticleSystem | None = None
        """System of the previous particle."""
        self._sources: list[ParticleArray] = []
        self._which: list[int] = []
        """For each instance the index of the source, -1 for none."""
        self._rows: list[int] = []

    def add(self, instance: bpy.types.DepsgraphObjectInstance) -> None:
        """Note the particle of an instance that an object multiplies, or that it stands for none."""
        system = instance.particle_system
        if system is None:
            self._which.append(-1)
            self._rows.append(0)
            return
        if system != self._system:
            self._sources.append(self._table.read(system))
            self._system = system
        self._which.append(len(self._sources) - 1)
        self._rows.append(instance.persistent_id[0])

    def end(self) -> tuple[np.ndarray, ParticleArray | None]:
        """End the slice. Returns (instances,) bool, whether each stands for a particle, and the particles of all, of
        which those of the others say nothing; None where no instance stands for one."""
        which, rows, sources = np.array(self._which), np.array(self._rows), self._sources
        self._system, self._sources, self._which, self._rows = None, [], [], []
        lengths = np.array([*map(len, sources), 0])
        found = (rows >= 0) & (rows < lengths[which])
        if not found.any():
            return found, None
        starts = np.cumsum(lengths) - lengths
        source = sources[0] if len(sources) == 1 else ParticleArray.joined(sources)
        return found, source.rows(np.where(found, rows + starts[which], 0))


def _particles(system: bpy.types.ParticleSystem, frame: float) -> ParticleArray:
    """Read the particles of a system at a frame of the scene."""
    particles, columns = system.particles, {}
    for name, width in _COLUMNS.items():
        values = np.empty(width * len(particles), np.float32)
        particles.foreach_get(name, values)
        columns[name] = values if width == 1 else values.reshape(-1, width)
    index = np.arange(len(particles))
    age = frame - columns.pop("birth_time").astype(np.float64)
    return ParticleArray(index.astype(np.float64), hashed_numbers(index), age, **columns)
