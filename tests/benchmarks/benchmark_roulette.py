# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures Russian roulette of splat fragments, after the paper's Fig. 5: what it saves and what it costs."""

import dataclasses

import numpy as np
from benchmark_machine import Clock
from benchmark_rendering import Rendering, mean_seconds, scale_of
from benchmark_scenes import Subject

from rppm_addon.scene import RenderSettings
from rppm_addon.scene.settings import DirectLight


def has_roulette() -> bool:
    """Whether the renderer has the setting."""
    return "splat_roulette" in {field.name for field in dataclasses.fields(RenderSettings)}


def roulette(subject: Subject, clock: Clock, quick: bool) -> dict:
    """Splatting times and relative variance without and with roulette, the latter also at equal time.

    The variance is that of independent renders with seeds of their own. Direct light comes by photons and
    rays go through pixel centres, so that nothing but photons and paths brings noise.
    """
    scale = scale_of(clock, quick)
    count = scale.seed_iterations
    fixed = {"direct_light": DirectLight.PHOTONS, "filter_width": 0.0}
    seconds: dict[bool, list[dict[str, float]]] = {False: [], True: []}
    pictures: dict[str, list[np.ndarray]] = {"without": [], "with": [], "equal time": []}
    with Rendering(subject, clock, scale) as rendering:

        def render(rejects: bool, seed: int, marks: dict[str, int]) -> list[dict[str, float]]:
            """Keep the picture after so many iterations under each mark's name; returns times of iterations."""
            rendering.start(**fixed, seed=seed, splat_roulette=rejects)
            times = []
            for iteration in range(1, max(count, *marks.values()) + 1):
                times.append(rendering.iterate())
                for name in (name for name, last in marks.items() if last == iteration):
                    pictures[name].append(rendering.mapper.film.read_radiance()[..., :3])
            return times[:count]

        whole = {}
        for rejects in (False, True):
            rendering.start(**fixed, splat_roulette=rejects)
            rendering.iterate()  # programs are made
            whole[rejects] = sum(rendering.mean_iteration(count).values())
        equal = max(1, round(count * whole[False] / whole[True]))
        for seed in range(scale.seeds):
            # Odd and even seeds: the two variances are independent.
            seconds[False] += render(False, 2 * seed, {"without": count})
            seconds[True] += render(True, 2 * seed + 1, {"with": count, "equal time": equal})
        described = rendering.description
    return described | {
        "seeds": scale.seeds,
        "iterations": count,
        "iterations_at_equal_time": equal,
        "seconds_without": mean_seconds(seconds[False]),
        "seconds_with": mean_seconds(seconds[True]),
        "relative_variance": {name: relative_variance(found) for name, found in pictures.items()},
        "variance_ratio": {
            name: variance_ratio(pictures[name], pictures["without"]) for name in ("with", "equal time")
        },
    }


def relative_variance(pictures: list[np.ndarray]) -> float:
    """Sum of the pixels' variances over the sum of their squared means; unbiased in both."""
    stack = np.asarray(pictures, float)
    variance = stack.var(axis=0, ddof=1)
    return float(variance.sum() / np.sum(stack.mean(axis=0) ** 2 - variance / len(stack)))


def variance_ratio(some: list[np.ndarray], others: list[np.ndarray]) -> list[float]:
    """Ratio of two relative variances and its standard error, by the jackknife over the renders of both."""
    ratio = relative_variance(some) / relative_variance(others)
    squared = 0.0
    for pictures, left_out in (
        (some, lambda rest: relative_variance(rest) / relative_variance(others)),
        (others, lambda rest: relative_variance(some) / relative_variance(rest)),
    ):
        count = len(pictures)
        found = np.array([left_out(pictures[:index] + pictures[index + 1 :]) for index in range(count)])
        squared += (count - 1) / count * np.sum((found - found.mean()) ** 2)
    return [float(ratio), float(np.sqrt(squared))]
