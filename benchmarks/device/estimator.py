# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurements of the estimator, after the paper's Figs. 9, 10, 12 and 13: values for a line in a figure's JSON.

Times are seconds, lengths meters. A point's ``seconds`` are those of an iteration by stage; their sum
is the iteration's time.
"""

from ..machine import Clock
from .rendering import Rendering, scale_of
from .scenes import Subject
from .statistics import fit_line

_MOST_BLOCKS = 48
_RADIUS_FACTORS = (0.125, 0.25, 0.5, 1.0, 2.0)


def iterations(subject: Subject, clock: Clock, quick: bool) -> dict:
    """Stage times along a render (Fig. 9), as means of blocks of iterations."""
    scale = scale_of(clock, quick)
    length = -(-scale.iterations // _MOST_BLOCKS)
    blocks = []
    with Rendering(subject, clock, scale) as rendering:
        rendering.start()
        rendering.iterate()  # programs are made
        rendering.start()
        for first in range(1, scale.iterations + 1, length):
            seconds = rendering.mean_iteration(min(length, scale.iterations + 1 - first))
            radius = rendering.mapper.splat_radii[0]
            blocks.append({"first": first, "last": rendering.mapper.iteration, "radius": radius, "seconds": seconds})
        return rendering.description | {"iterations": scale.iterations, "blocks": blocks}


def path_lengths(subject: Subject, clock: Clock, quick: bool) -> dict:
    """Stage times by the length of photon and camera paths (Fig. 10), both changed together."""
    scale = scale_of(clock, quick)
    points = []
    with Rendering(subject, clock, scale) as rendering:
        for length in scale.path_lengths:
            rendering.start(photon_path_length=length, camera_path_length=length)
            points.append({"length": length, "seconds": _after_the_first(rendering, scale.repetitions)})
        return rendering.description | {"repetitions": scale.repetitions, "points": points}


def photon_batches(subject: Subject, clock: Clock, quick: bool) -> dict:
    """Iteration time by photons of an iteration (Fig. 12), with a straight line through it."""
    scale = scale_of(clock, quick)
    points = []
    with Rendering(subject, clock, scale) as rendering:
        for photons in scale.batches:
            rendering.start(photons=photons)
            points.append({"photons": photons, "seconds": _after_the_first(rendering, scale.repetitions)})
        return rendering.description | _with_line(points, "photons", scale.repetitions)


def resolutions(subject: Subject, clock: Clock, quick: bool) -> dict:
    """Iteration time by pixels of the frame (Fig. 13), with a straight line through it."""
    scale = scale_of(clock, quick)
    points = []
    with Rendering(subject, clock, scale) as rendering:
        for width, height in scale.sizes:
            rendering.start((width, height))
            seconds = _after_the_first(rendering, scale.repetitions)
            points.append({"size": [width, height], "pixels": width * height, "seconds": seconds})
        return rendering.description | _with_line(points, "pixels", scale.repetitions)


def splat_radius(subject: Subject, clock: Clock, quick: bool) -> dict:
    """Stage times by the radius of splats, all importons having it, as a factor of the automatic r_max.

    The wide radius of global photons is multiplied by the same factor: Eq. 2 shrinks both alike.
    """
    scale = scale_of(clock, quick)
    points = []
    with Rendering(subject, clock, scale) as rendering:
        rendering.start()
        automatic = rendering.mapper.splat_radii[0]
        for factor in _RADIUS_FACTORS:
            rendering.start(radius_minimum=factor * automatic, radius_maximum=factor * automatic)
            rendering.mapper.learning.learn = lambda *_: None  # which would change photons and wide radius
            rendering.iterate()  # finds the wide radius
            rendering.mapper.learning.radius_schedule.wide_radius *= factor
            # The same photons and camera rays at each radius, as these follow the iteration's number.
            seconds = rendering.mean_iteration(scale.repetitions)
            narrow, wide = rendering.mapper.splat_radii
            points.append({"factor": factor, "radius": narrow, "wide_radius": wide, "seconds": seconds})
        return rendering.description | {"repetitions": scale.repetitions, "points": points}


def _after_the_first(rendering: Rendering, repetitions: int) -> dict[str, float]:
    """Mean of iterations without the first, which makes programs and lets lists grow."""
    rendering.iterate()
    return rendering.mean_iteration(repetitions)


def _with_line(points: list[dict], key: str, repetitions: int) -> dict:
    totals = [sum(point["seconds"].values()) for point in points]
    return {
        "repetitions": repetitions,
        "points": points,
        "line": fit_line([point[key] for point in points], totals),
    }
