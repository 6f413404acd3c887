# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials as weighted sums of shader lobes with constant parameters."""

import enum
from dataclasses import dataclass, field

import numpy as np


class LobeKind(enum.IntEnum):
    """The shader nodes that a lobe can stand for. The numbers are those of the GLSL side."""

    DIFFUSE = 0
    GLOSSY = 1
    GLASS = 2
    REFRACTION = 3
    TRANSPARENT = 4
    EMISSION = 5
    PRINCIPLED = 6
    TRANSLUCENT = 7
    SHEEN = 8
    HOLDOUT = 9


@dataclass
class Lobe:
    """One shader node with the weight that Mix and Add Shader nodes give it.

    Parameters that the kind does not have are ignored.
    """

    kind: LobeKind
    weight: float = 1.0
    """Product of the mix factors on the way to the output."""
    color: tuple[float, float, float] = (1.0, 1.0, 1.0)
    """Base colour; EMISSION: radiance W/(m^2 sr), colour times strength."""
    color_image: int = -1
    """Index into Scene.images; its colour multiplies ``color``. -1 is none."""
    roughness: float = 0.0
    """As the user sees it: GGX alpha is its square."""
    ior: float = 1.5
    multiscatter: bool = True
    """GLOSSY, GLASS, PRINCIPLED: Cycles' Multiscatter GGX keeps the energy of rough surfaces."""
    metallic: float = 0.0
    specular_level: float = 0.5
    """PRINCIPLED: Specular IOR Level; 0.5 leaves the reflectivity that the IOR gives."""
    specular_tint: tuple[float, float, float] = (1.0, 1.0, 1.0)
    transmission: float = 0.0
    alpha: float = 1.0
    emission: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """PRINCIPLED: emission colour times strength, W/(m^2 sr)."""


@dataclass
class Material:
    """A surface, and the homogeneous absorption of what it encloses."""

    name: str
    lobes: list[Lobe] = field(default_factory=list)
    absorption: np.ndarray = field(default_factory=lambda: np.zeros(3))
    """(3,) float64, absorption coefficient of the interior in 1/m (Volume Absorption:
    density times one minus colour)."""
