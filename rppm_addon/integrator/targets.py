# SPDX-License-Identifier: GPL-3.0-or-later
"""What photons are aimed at: the objects that make caustics."""

import numpy as np

from ..scene.materials import Lobe, LobeKind, Material
from ..scene.scene import Scene
from .geometry import Geometry

_MOST = 64
_SHARPEST_ROUGHNESS = 0.22
_LARGEST = 0.5


def _makes_caustics(lobe: Lobe) -> bool:
    if lobe.roughness > _SHARPEST_ROUGHNESS or lobe.weight < 0.05:
        return False
    if lobe.kind is LobeKind.PRINCIPLED:
        return lobe.alpha * max(lobe.metallic, lobe.transmission) > 0.1
    return lobe.kind in (LobeKind.GLASS, LobeKind.REFRACTION, LobeKind.GLOSSY)


def caustic_targets(scene: Scene, geometry: Geometry) -> np.ndarray:
    """(n, 4) float32 bounding spheres, centre and radius in metres, of up to 64 objects with sharp
    specular lobes. Objects half as large as the scene are none: photons meet them anyway."""

    def sharp(material: Material) -> bool:
        return any(_makes_caustics(lobe) for lobe in material.lobes)

    casters = [sharp(material) for material in scene.materials]
    spheres = []
    for placement in geometry.placements:
        if not any(casters[m] for m in placement.instance.materials if 0 <= m < len(casters)):
            continue
        low, high = placement.low, placement.high
        radius = 0.5 * float(np.linalg.norm(high - low))
        if np.isfinite(radius) and 0 < radius < _LARGEST * geometry.radius:
            spheres.append([*(0.5 * (low + high)), radius])
    spheres.sort(key=lambda sphere: -sphere[3])
    return np.array(spheres[:_MOST], np.float32).reshape(-1, 4)
