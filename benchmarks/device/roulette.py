# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures Russian roulette of splat fragments, after the paper's Fig. 5: what it saves and what it costs."""

import numpy as np

from rppm_addon.scene.settings import DirectLight

from ..machine import Clock
from .rendering import Rendering, mean_seconds, scale_of
from .scenes import Subject
from .statistics import variances


def roulette(subject: Subject, clock: Clock, quick: bool) -> dict:
    """Splatting times and relative variance without and with roulette, the latter also at equal time.

    The variance is that of independent renders. Direct light comes by photons and rays go through pixel
    centers, so that nothing but photons and paths brings noise.
    """
    scale = scale_of(clock, quick)
    count = scale.seed_iterations
    fixed = {"direct_light": DirectLight.PHOTONS, "filter_width": 0.0}
    seconds: dict[bool, list[dict[str, float]]] = {False: [], True: []}
    pictures: dict[bool, list[list[np.ndarray]]] = {False: [], True: []}
    with Rendering(subject, clock, scale) as rendering:
        whole = {}
        for rejects in (False, True):
            rendering.start(**fixed, use_splat_roulette=rejects)
            rendering.iterate()  # programs are made
            whole[rejects] = sum(rendering.mean_iteration(count).values())
        marks = (count, max(1, round(count * whole[False] / whole[True])))
        for seed in range(scale.seeds):
            for rejects in (False, True):
                rendering.start(**fixed, seed=seed, use_splat_roulette=rejects)
                found = {}
                for iteration in range(1, max(marks) + 1):
                    times = rendering.iterate()
                    if iteration <= count:
                        seconds[rejects].append(times)
                    if iteration in marks:
                        radiance = rendering.mapper.film.read_radiance()[..., :3]
                        found[iteration] = radiance.mean(axis=-1, dtype=float)
                pictures[rejects].append([found[mark] for mark in marks])
        described = rendering.description
    variance, *ratios = variances(np.array(pictures[False]), np.array(pictures[True]))
    return described | {
        "seeds": scale.seeds,
        "iterations": count,
        "iterations_at_equal_time": marks[1],
        "seconds_without": mean_seconds(seconds[False]),
        "seconds_with": mean_seconds(seconds[True]),
        "relative_variance": variance,
        "variance_ratio": dict(zip(("with", "equal time"), ratios)),
    }
