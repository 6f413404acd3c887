# SPDX-License-Identifier: GPL-3.0-or-later
"""Particles that instances stand for."""

import bpy

from ...scene import Particle


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
        random=_hash(index) / 0xFFFFFFFF,
        age=frame - particle.birth_time,
        lifetime=particle.lifetime,
        size=particle.size,
        location=tuple(particle.location),
        velocity=tuple(particle.velocity),
        angular_velocity=tuple(particle.angular_velocity),
    )


def _hash(key: int) -> int:
    """Jenkins' final mix of (key, 0), as Cycles makes a particle's random number of its index."""
    mask = 0xFFFFFFFF

    def rotated(x: int, k: int) -> int:
        return ((x << k) | (x >> (32 - k))) & mask

    start = 0xDEADBEEF + (2 << 2) + 13 & mask
    a, b, c = (start + key) & mask, start, start
    c = ((c ^ b) - rotated(b, 14)) & mask
    a = ((a ^ c) - rotated(c, 11)) & mask
    b = ((b ^ a) - rotated(a, 25)) & mask
    c = ((c ^ b) - rotated(b, 16)) & mask
    a = ((a ^ c) - rotated(c, 4)) & mask
    b = ((b ^ a) - rotated(a, 14)) & mask
    return ((c ^ b) - rotated(b, 24)) & mask
