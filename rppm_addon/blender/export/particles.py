# SPDX-License-Identifier: GPL-3.0-or-later
"""Particles that instances stand for."""

import bpy

from ...scene import Particle
from .hashing import hashed


def particle_of(instance: bpy.types.DepsgraphObjectInstance, frame: float) -> Particle | None:
    """What the Particle Info node tells of an instance; None when it stands for no particle."""
    system = instance.particle_system if instance.is_instance else None
    if system is None:
        return None
    index = instance.persistent_id[0]
    if not 0 <= index < len(system.particles):
        return None
    particle = system.particles[index]
    return Particle(
        index=float(index),
        random=hashed(index),
        age=frame - particle.birth_time,
        lifetime=particle.lifetime,
        size=particle.size,
        location=tuple(particle.location),
        velocity=tuple(particle.velocity),
        angular_velocity=tuple(particle.angular_velocity),
    )
