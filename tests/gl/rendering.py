# SPDX-License-Identifier: GPL-3.0-or-later
"""Iterations of scenes that are built anew."""

import numpy as np

from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import Scene


def iterated(mapper: ProgressivePhotonMapper, scene: Scene, iterations: int = 1) -> ProgressivePhotonMapper:
    """The mapper after iterations of a scene that is built anew."""
    mapper.build(scene)
    for _ in range(iterations):
        mapper.iterate()
    return mapper


def radiance_of(mapper: ProgressivePhotonMapper, scene: Scene, iterations: int = 1) -> np.ndarray:
    """(H, W, 4) mean radiance and alpha of iterations of a scene that is built anew."""
    return iterated(mapper, scene, iterations).film.read_radiance()
