# SPDX-License-Identifier: GPL-3.0-or-later
"""A floor below level glass, an interface or a slab: the surfaces, and what refraction does to light and view.

Formulas in float64, shared with no shader; arrays as in path_quadrature.py.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from path_quadrature import Spot
from path_scenes import facing_down, level
from support.lobes import Lobe, LobeKind

from rppm_addon.scene import Mesh

AIR, INDEX = 1.0, 1.5
INTERFACE = 0.6
"""Height of an interface above the floor, meters; all below is glass."""
SLAB = 0.6, 0.8
"""Heights of a slab's faces above the floor, meters."""


@dataclass(frozen=True)
class Layer:
    thickness: float
    """Meters along z."""
    index: float


def layers(top: float, slab: bool) -> list[Layer]:
    """From a height down to the floor."""
    if slab and top > SLAB[1]:
        return [Layer(top - SLAB[1], AIR), Layer(SLAB[1] - SLAB[0], INDEX), Layer(SLAB[0], AIR)]
    if slab:
        return [Layer(top, AIR)]
    if top > INTERFACE:
        return [Layer(top - INTERFACE, AIR), Layer(INTERFACE, INDEX)]
    return [Layer(top, INDEX)]


def panes(slab: bool) -> list[tuple[Mesh, Lobe]]:
    """The faces of the glass, with their normals out of it."""
    glass = Lobe(LobeKind.GLASS, color=(1.0, 1.0, 1.0), ior=INDEX)
    if slab:
        return [(facing_down("bottom", SLAB[0], -2.0, 2.0), glass), (level("top", SLAB[1], -2.0, 2.0, 2.0), glass)]
    return [(level("top", INTERFACE, -2.0, 2.0, 2.0), glass)]


def transmittance(index_before: float, index_behind: float, sine_before: np.ndarray) -> np.ndarray:
    """Unpolarised Fresnel transmittance of flux by the amplitudes of both polarisations (Born and Wolf, 1.5.2)."""
    cosine = np.sqrt(1 - sine_before**2)
    behind = np.sqrt(1 - (sine_before * index_before / index_behind) ** 2)
    across = (index_before * cosine - index_behind * behind) / (index_before * cosine + index_behind * behind)
    within = (index_behind * cosine - index_before * behind) / (index_behind * cosine + index_before * behind)
    return 1 - (across**2 + within**2) / 2


def through(layers: Sequence[Layer], sine: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How far rays that start with a sine to the vertical go sideways, meters, and the transmittance of flux."""
    aside, passed = np.zeros_like(sine), np.ones_like(sine)
    before = layers[0].index
    for layer in layers:
        if layer.index != before:
            passed = passed * transmittance(before, layer.index, sine)
            sine = sine * before / layer.index  # Snell
            before = layer.index
        aside = aside + layer.thickness * sine / np.sqrt(1 - sine**2)
    return aside, passed


def refracted_irradiance(spot: Spot, layers: Sequence[Layer], points: np.ndarray) -> np.ndarray:
    """Irradiance of a level floor at points (..., 3) below a point-like spot, through layers from the light down: as
    the renderer has it, over the squared index of the floor's layer by the light's.

    The flux of a ring of directions lands on a ring of the floor, whose width comes from differentiating where rays
    land; the direction that lands at a point is bracketed by bisection.
    """
    assert spot.radius == 0
    offset = (points - spot.position)[..., :2]
    aside = np.maximum(np.linalg.norm(offset, axis=-1), 1e-9)
    low, high = np.zeros_like(aside), np.full_like(aside, 0.5 * np.pi - 1e-3)
    for _ in range(60):
        middle = (low + high) / 2
        short = through(layers, np.sin(middle))[0] < aside
        low, high = np.where(short, middle, low), np.where(short, high, middle)
    angle, step = (low + high) / 2, 1e-5
    passed = through(layers, np.sin(angle))[1]
    widening = (through(layers, np.sin(angle + step))[0] - through(layers, np.sin(angle - step))[0]) / (2 * step)
    sideways = np.sin(angle)[..., None] * offset / aside[..., None]
    directions = np.concatenate([sideways, -np.cos(angle)[..., None]], -1)
    ratio = layers[0].index / layers[-1].index
    return spot.along(directions) * passed * np.sin(angle) / (aside * widening) * ratio**2


def seen_through(
    layers: Sequence[Layer], origin: np.ndarray, directions: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Where camera rays that start downwards or upwards in the first layer leave the last one, the directions
    (..., 3) with which they do, and the share of radiance over the squared index that comes back along them: the
    transmittance."""
    sine = np.linalg.norm(directions[..., :2], axis=-1)
    aside, passed = through(layers, sine)
    level = directions[..., :2] / np.maximum(sine, 1e-12)[..., None]
    side = np.sign(directions[..., 2])
    height = sum(layer.thickness for layer in layers)
    ends = np.concatenate([origin[:2] + aside[..., None] * level, (origin[2] + side * height)[..., None]], -1)
    ratio = layers[0].index / layers[-1].index
    last = sine * ratio
    leaving = np.concatenate([last[..., None] * level, (side * np.sqrt(1 - last**2))[..., None]], -1)
    return ends, leaving, passed
