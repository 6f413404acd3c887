# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures final gather against the plain estimate: the error that each has left after as much time."""

import numpy as np

from ..machine import Clock
from .rendering import Rendering, scale_of
from .scenes import Subject
from .statistics import block_error

BLOCKS = (1, 4, 16)
"""Sides in pixels of the blocks whose means are compared: small ones show noise, large ones blotches and bias."""


def final_gather(subject: Subject, clock: Clock, quick: bool) -> dict:
    """Relative error by block against iterations and seconds, with and without final gather.

    The reference is a long render of another seed with final gather, whose photons' radii matter least. As a gathering
    ray is one more bounce, photon paths without it are longer by one.
    """
    scale = scale_of(clock, quick)
    with Rendering(subject, clock, scale) as rendering:
        rendering.start(use_final_gather=True, seed=1)
        for _ in range(scale.reference_iterations):
            rendering.iterate()
        reference = _radiance(rendering)
        curves = {}
        longest = 0.0
        for gathers in (True, False):
            length = rendering.description["photon_path_length"] + (0 if gathers else 1)
            rendering.start(use_final_gather=gathers, photon_path_length=length)
            seconds, curve = 0.0, []
            while rendering.mapper.iteration < scale.reference_iterations // 4 if gathers else seconds < longest:
                seconds += sum(rendering.iterate().values())
                iteration = rendering.mapper.iteration
                if iteration & (iteration - 1) == 0:
                    curve.append(_point(rendering, seconds, reference))
            if curve[-1]["iterations"] != rendering.mapper.iteration:
                curve.append(_point(rendering, seconds, reference))
            longest = seconds
            curves["gather" if gathers else "plain"] = curve
        return rendering.description | {
            "reference_iterations": scale.reference_iterations, "blocks": BLOCKS, "curves": curves,
        }  # fmt: skip


def _radiance(rendering: Rendering) -> np.ndarray:
    return rendering.mapper.film.read_radiance()[..., :3].mean(axis=-1, dtype=float)


def _point(rendering: Rendering, seconds: float, reference: np.ndarray) -> dict:
    picture = _radiance(rendering)
    errors = [block_error(picture, reference, side) for side in BLOCKS]
    return {"iterations": rendering.mapper.iteration, "seconds": seconds, "errors": errors}
