# SPDX-License-Identifier: GPL-3.0-or-later
"""All figures: how each is measured, and on which scenes."""

import logging
from collections.abc import Callable

from ..machine import Clock
from . import estimator, figures, gather, roulette
from .scenes import SAMPLE, Subject

log = logging.getLogger("benchmark")

_ESTIMATOR: dict[str, Callable[[Subject, Clock, bool], dict]] = {
    "iterations": estimator.iterations,
    "path_lengths": estimator.path_lengths,
    "photon_batches": estimator.photon_batches,
    "resolutions": estimator.resolutions,
    "splat_radius": estimator.splat_radius,
    "roulette": roulette.roulette,
    "final_gather": gather.final_gather,
}
_ESTIMATOR_SCENES = (
    SAMPLE, "pool", "fireplace_room", "glass_caustics", "bathroom", "diamond_ring", "sponza_dabrovic",
)  # fmt: skip
"""The sample, and scenes that resemble the paper's."""
_SOFTWARE_SCENES = (SAMPLE, "pool", "fireplace_room", "glass_caustics")
_QUICK_SCENES = (SAMPLE, "pool")

MEASUREMENTS = figures.MEASUREMENTS | _ESTIMATOR
FIGURES = tuple(MEASUREMENTS)


def scenes_of(figure: str, quick: bool, is_software: bool) -> tuple[str, ...]:
    """Names of the scenes that a figure shows."""
    if figure in _ESTIMATOR:
        return _QUICK_SCENES if quick else _SOFTWARE_SCENES if is_software else _ESTIMATOR_SCENES
    return (figures.QUICK_SCENES if quick else figures.SCENES)[figure]


def is_possible(figure: str) -> bool:
    """Whether the renderer can do what the figure is about; warns where it cannot."""
    if figure == "bins" and not figures.can_choose_bins():
        log.warning("bins is left out: DeepCubemap takes no max_bins")
        return False
    return True
