# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair of particle systems as strands, as Cycles has it (blender/curves.cpp)."""

import ctypes
import itertools
from collections.abc import Iterator
from dataclasses import dataclass

import bpy
import numpy as np

from .tubes import Strands

_KEY = np.dtype([("co", np.float32, 3), ("others", np.float32, 11), ("segments", np.int32)])
"""Blender's ParticleCacheKey."""
_SETTINGS, _PARTICLES, _CHILDREN, _PARENT_PATHS, _CHILD_PATHS = 2, 3, 4, 7, 8
"""Places of pointers in Blender's ParticleSystem."""
HAIRLESS_MODES = {"EDIT": "Edit Mode", "PARTICLE_EDIT": "Particle Edit"}
"""Modes in which an object has no hair, and their titles."""
_SAMPLES = 16
"""Strands whose keys are compared with what Blender's function says."""


@dataclass(frozen=True)
class HairSystem:
    """A particle system whose hair is rendered as paths."""

    system: bpy.types.ParticleSystem
    modifier: bpy.types.ParticleSystemModifier
    first: int
    """Parents are not rendered where they have children."""
    end: int
    steps: int

    @property
    def strand_count(self) -> int:
        """How many paths are rendered."""
        return self.end - self.first


def hair_modifiers(source: bpy.types.Object, render: bool) -> Iterator[bpy.types.ParticleSystemModifier]:
    """The modifiers of an evaluated object that bring hair as paths to a render, or else a viewport."""
    for modifier in source.modifiers:
        if modifier.type != "PARTICLE_SYSTEM" or not (modifier.show_render if render else modifier.show_viewport):
            continue
        settings = modifier.particle_system.settings
        if settings.type == "HAIR" and settings.render_type == "PATH":
            yield modifier


def hair_systems(source: bpy.types.Object, render: bool) -> Iterator[HairSystem]:
    """The systems of an evaluated object with hair as a render, or else a viewport, shows it: as in Cycles none in
    HAIRLESS_MODES."""
    for modifier in () if source.mode in HAIRLESS_MODES else hair_modifiers(source, render):
        system, settings = modifier.particle_system, modifier.particle_system.settings
        parents, children = len(system.particles), len(system.child_particles)
        first = parents if settings.child_type != "NONE" and children else 0
        steps = (1 << (settings.render_step if render else settings.display_step)) + 1
        if settings.kink == "SPIRAL":
            steps += settings.kink_extra_steps
        if parents + children > first:
            yield HairSystem(system, modifier, first, parents + children, steps)


def read_hair(source: bpy.types.Object, systems: list[HairSystem], to_object: np.ndarray) -> Strands:
    """The strands of an evaluated object's systems; to_object: (4, 4) from the world."""
    keys, radii, slots, counts = [], [], [], []
    most_slot = max(len(source.material_slots) - 1, 0)
    for hair in systems:
        found = _paths(source, hair, to_object)
        settings = hair.system.settings
        keys.append(found.reshape(-1, 3))
        radii.append(_radii(found, settings))
        slots.append(np.full(len(found), min(max(settings.material - 1, 0), most_slot), np.int32))
        counts.append(np.full(len(found), hair.steps, np.int32))
    starts = np.concatenate([[0], np.cumsum(np.concatenate(counts))]).astype(np.int32)
    return Strands(np.concatenate(keys), np.concatenate(radii), starts, np.concatenate(slots))


def _radii(paths: np.ndarray, settings: bpy.types.ParticleSettings) -> np.ndarray:
    """(strands * steps,) float32 of paths (strands, steps, 3), by how far along the strand the keys lie."""
    lengths = np.sqrt((np.diff(paths, axis=1) ** 2).sum(axis=-1))
    passed = np.concatenate([np.zeros((len(paths), 1), np.float32), np.cumsum(lengths, axis=1)], axis=1)
    left = 1.0 - np.divide(passed, passed[:, -1:], out=np.zeros_like(passed), where=passed[:, -1:] > 0.0)
    shape = settings.shape
    if shape != 0.0:
        # At 1 and -1 the exponents have no bound.
        left = np.clip(left, 0.0, 1.0) ** (1.0 + shape if shape < 0.0 else 1.0 / max(1.0 - shape, 1e-6))
    scale = 0.5 * settings.radius_scale
    root, tip = scale * settings.root_radius, scale * settings.tip_radius
    radii = left * (root - tip) + tip
    if settings.use_close_tip:
        radii[:, -1] = 0.0
    return radii.astype(np.float32).reshape(-1)


def _paths(source: bpy.types.Object, hair: HairSystem, to_object: np.ndarray) -> np.ndarray:
    """(strands, steps, 3) float32 keys in the object's space."""
    found = _paths_in_memory(hair)
    found = None if found is None else _moved(found, to_object)
    picked = range(0, hair.strand_count, max(hair.strand_count // _SAMPLES, 1))
    if found is not None:
        checked = _paths_by_function(source, hair, picked, to_object)
        size = max(float(np.abs(checked).max(initial=0.0)), 1e-6)
        if np.allclose(found[list(picked)], checked, rtol=0.0, atol=1e-4 * size):
            return found
    return _paths_by_function(source, hair, range(hair.strand_count), to_object)


def _paths_by_function(source: bpy.types.Object, hair: HairSystem, strands: range, to_object: np.ndarray) -> np.ndarray:
    """Return the paths (strands, steps, 3) of some strands by Blender's function, which gives one key at a time."""
    ask, first = hair.system.co_hair, hair.first
    keys = [
        tuple(ask(object=source, particle_no=first + strand, step=step))
        for strand, step in itertools.product(strands, range(hair.steps))
    ]
    paths = np.array(keys, np.float32).reshape(len(strands), hair.steps, 3)
    # Of steps behind the end of a path that was cut the function says nothing: paths stay there.
    known_steps = np.where(paths.any(axis=-1), np.arange(hair.steps), 0)
    steps = np.maximum.accumulate(known_steps, axis=1)
    return _moved(np.take_along_axis(paths, steps[:, :, None], axis=1), to_object)


def _moved(places: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """Places (..., 3) float32, moved by a matrix (4, 4)."""
    return places @ matrix[:3, :3].T.astype(np.float32) + matrix[:3, 3].astype(np.float32)


def _paths_in_memory(hair: HairSystem) -> np.ndarray | None:
    """All at once in world space, where they lie in Blender's memory; None where that does not look as it should.

    The layout is not documented. Three pointers whose values Blender tells must be in their places.
    """
    system = hair.system
    words = (ctypes.c_uint64 * (_CHILD_PATHS + 1)).from_address(system.as_pointer())
    parents, children = len(system.particles), len(system.child_particles)
    if words[_SETTINGS] != system.settings.as_pointer():
        return None
    if parents and words[_PARTICLES] != system.particles[0].as_pointer():
        return None
    if children and words[_CHILDREN] != system.child_particles[0].as_pointer():
        return None
    of_parents = hair.first == 0
    paths = []
    if of_parents:
        paths.append(_cached(words[_PARENT_PATHS], parents, hair.steps))
    if children:
        paths.append(_cached(words[_CHILD_PATHS], children, hair.steps))
    return None if any(path is None for path in paths) else np.concatenate(paths)


def _cached(address: int, count: int, steps: int) -> np.ndarray | None:
    """(count, steps, 3) of the paths to which an array of pointers leads; None where there is none."""
    if address == 0 or address % 8:
        return None
    pointers = np.frombuffer((ctypes.c_uint64 * count).from_address(address), np.uint64).astype(np.int64)
    if (pointers == 0).any() or (pointers % 4 != 0).any():
        return None
    result = np.empty((count, steps, 3), np.float32)
    gaps = np.diff(pointers)
    stride = int(gaps[0]) if count > 1 else _KEY.itemsize * steps
    if stride < _KEY.itemsize * steps or stride % _KEY.itemsize:
        return None
    # Paths lie one behind the other in blocks.
    breaks = np.concatenate([[0], np.flatnonzero(gaps != stride) + 1, [count]])
    for begin, end in itertools.pairwise(breaks.tolist()):
        size = (end - begin - 1) * stride + steps * _KEY.itemsize
        memory = (ctypes.c_char * size).from_address(int(pointers[begin]))
        keys = np.ndarray((end - begin, steps), _KEY, memory, strides=(stride, _KEY.itemsize))
        result[begin:end] = keys["co"]
        _stop_at_ends(result[begin:end], keys["segments"][:, 0])
    return result


def _stop_at_ends(paths: np.ndarray, segments: np.ndarray) -> None:
    """Paths that were cut stay where they end, in place."""
    last = paths.shape[1] - 1
    short = np.flatnonzero(segments < last)
    if len(short):
        steps = np.minimum(np.arange(last + 1), np.maximum(segments[short], 0)[:, None])
        paths[short] = np.take_along_axis(paths[short], steps[:, :, None], axis=1)


def surface_uv(systems: list[HairSystem], layer: int) -> np.ndarray:
    """(strands, 2) float32, where strands grow on a UV map of their surface, by its number. Asks Blender of each."""
    result = []
    for hair in systems:
        particles, ask, modifier = hair.system.particles, hair.system.uv_on_emitter, hair.modifier
        parents = len(particles)
        for number in range(hair.first, hair.end):
            particle = particles[number if number < parents else 0]
            result.append(tuple(ask(modifier, particle=particle, particle_no=number, uv_no=layer))[:2])
    return np.array(result, np.float32).reshape(-1, 2)
