# SPDX-License-Identifier: GPL-3.0-or-later
"""All figures: how each is measured, and on which scenes."""

import logging
from collections.abc import Callable

import benchmark_estimator
import benchmark_figures
import benchmark_roulette
from benchmark_machine import Clock
from benchmark_scenes import SAMPLE, Subject

log = logging.getLogger("benchmark")

_ESTIMATOR: dict[str, Callable[[Subject, Clock, bool], dict]] = {
    "iterations": benchmark_estimator.iterations,
    "path_lengths": benchmark_estimator.path_lengths,
    "photon_batches": benchmark_estimator.photon_batches,
    "resolutions": benchmark_estimator.resolutions,
    "splat_radius": benchmark_estimator.splat_radius,
    "roulette": benchmark_roulette.roulette,
}
_ESTIMATOR_SCENES = (
    SAMPLE, "pool", "fireplace_room", "glass_caustics", "bathroom", "diamond_ring", "sponza_dabrovic",
)  # fmt: skip
"""The sample, and scenes that resemble the paper's."""
_SOFTWARE_SCENES = (SAMPLE, "pool", "fireplace_room", "glass_caustics")
_QUICK_SCENES = (SAMPLE, "pool")

MEASUREMENTS = benchmark_figures.MEASUREMENTS | _ESTIMATOR
FIGURES = tuple(MEASUREMENTS)


def scenes_of(figure: str, quick: bool, is_software: bool) -> tuple[str, ...]:
    """Names of the scenes that a figure shows."""
    if figure in _ESTIMATOR:
        return _QUICK_SCENES if quick else _SOFTWARE_SCENES if is_software else _ESTIMATOR_SCENES
    return (benchmark_figures.QUICK_SCENES if quick else benchmark_figures.SCENES)[figure]


def is_possible(figure: str) -> bool:
    """Whether the renderer can do what the figure is about; warns where it cannot."""
    if figure == "bins" and not benchmark_figures.can_choose_bins():
        log.warning("bins is left out: DeepCubemap takes no most_bins")
        return False
    return True
