# SPDX-License-Identifier: GPL-3.0-or-later
"""Choice of the number of photons of each iteration: as many as lower the error most in a given time.

The variance of an iteration is a part v_p / n that n photons make, and the rest v_c; its cost is n c_p + c_c. Their
product, the variance after a given time, is least with n = sqrt(v_p c_c / (v_c c_p)).
"""

import math
from dataclasses import dataclass, field

import numpy as np

from ...scene.common.declared import declared
from .iteration import LEARNING_ITERATIONS

_CAMERA_VERTEX, _SHADOW_RAY, _PHOTON_PAIR, _BEAM_PAIR = 1.0, 0.5, 0.1, 0.3
"""Costs in units of a photon's ray with its hit: a vertex of a camera path, a shadow ray there, a photon that a pixel
takes, and a photon beam that it meets. They are fixed numbers, not measured ones, so that renders are the same on every
run."""
_MAX_HALVINGS, _FEWEST = 4.0, 512
"""Most halvings of the first iteration's number of photons, and the fewest photons that halvings leave: so many go on
looking for light that no photon has found."""
_STEPS = 2.0
"""For each halving. What a frame differs in from the one before seldom changes so coarse a number, so that the photons
and their noise stay where they are; of the best time no more than half a percent is lost."""
_DARK = 0.01
"""Constant that is added to the squared luminance to which squared errors are relative."""
_AROUND, _LEFT_OUT = 2, 0.001
"""Pixels to each side whose mean luminance errors are relative to; the part of the pixels, the worst, left out."""
EVENNESS = 2.25
"""Factor by which the variance of the mean of many iterations is lower than if they were independent, as their sample
points are even: along edges the mean of 64 has 1.5 times less error than two halves of them show
(film/noise_estimate.py). Photons have no such gain, as the guide sends them elsewhere and radii shrink."""
_NO_NOISE = 1e-9
"""Relative variance that counts as none."""
_SETTLED = LEARNING_ITERATIONS.bit_length()


@dataclass(frozen=True)
class PhotonCounts:
    """Photons of the first iteration, and of those after each iteration that later ones learn from, as far as they
    are known."""

    numbers: tuple[int, ...] = field(metadata=declared(minimum=1))

    @property
    def first(self) -> int:
        """Photons of the first iteration."""
        return self.numbers[0]

    @property
    def latest(self) -> int:
        """Photons of an iteration after all that were learned from."""
        return self.numbers[-1]

    def of(self, iteration: int) -> int:
        """Photons of an iteration, counted from 1."""
        learned = min((iteration - 1).bit_length(), _SETTLED)
        return self.numbers[min(learned, len(self.numbers) - 1)]

    def emitted(self, skipped: int, iterations: int) -> int:
        """Photons of so many iterations after those skipped."""
        end, total = skipped + iterations, 0
        for learned, last in enumerate([*(1 << power for power in range(_SETTLED)), end]):
            first = 1 if learned == 0 else (1 << (learned - 1)) + 1
            total += max(min(last, end) - max(first, skipped + 1) + 1, 0) * self.of(first)
        return total

    def followed_by(self, photons: int) -> "PhotonCounts":
        """The same, with what the next iterations have."""
        return PhotonCounts((*self.numbers, photons))


@dataclass(frozen=True)
class NoiseSamples:
    """Samples of an iteration at some pixels, (rows, columns) float64 luminances each."""

    rest: np.ndarray
    """Light that comes without photons, and what gathering rays found."""
    all: np.ndarray
    """``rest`` and the light that photons bring."""
    signed: np.ndarray
    """Light that photons bring, each photon path with a random sign."""
    signed_final_gather: np.ndarray
    """The part of that which gathering rays found."""

    @classmethod
    def of(cls, values: np.ndarray) -> "NoiseSamples":
        """From (rows, columns, 4) values: the rest, all, and the signed sums at importons and by rays."""
        whole = np.nan_to_num(values.astype(np.float64), posinf=0.0, neginf=0.0)
        rest, found, direct, final_gather = np.moveaxis(whole, -1, 0)
        return cls(rest, found, direct + final_gather, final_gather)


def _relative_mean(squares: np.ndarray, luminance: np.ndarray) -> float:
    """The mean of squares over the squared luminance of the pixels around, without the worst few."""
    around = np.cumsum(np.cumsum(np.pad(luminance, _AROUND + np.array([[1, 0], [1, 0]]), "edge"), 0), 1)
    side = 2 * _AROUND + 1
    mean = (around[side:, side:] - around[:-side, side:] - around[side:, :-side] + around[:-side, :-side]) / side**2
    relative = np.sort((squares / (np.square(mean) + _DARK)).ravel())
    kept = relative[: len(relative) - int(_LEFT_OUT * len(relative))]
    return float(kept.mean()) if len(kept) else 0.0


@dataclass(frozen=True)
class NoiseVariances:
    """Variances of the noise of photons and of all else, from the iterations that are learned from."""

    photons: float = 0.0
    """Number of photons that the photons' part was measured with, all iterations together."""
    photon_sum: float = 0.0
    """The sum of their variance v_p by their number."""
    rest_sum: float = 0.0
    """The sum of v_c over pairs of iterations."""
    pairs: int = 0
    rest_photon_variance: float = 0.0
    """Part of v_c that photons made in the last iteration, at the ends of gathering rays."""

    def with_first(self, samples: NoiseSamples) -> "NoiseVariances":
        """After the first iteration, whose radii are too wide to show the photons' noise."""
        return NoiseVariances(rest_photon_variance=_relative_mean(np.square(samples.signed_final_gather), samples.all))

    def with_next(self, photons: int, samples: NoiseSamples, rest: np.ndarray, growth: float) -> "NoiseVariances":
        """After another iteration with so many photons.

        rest: that of the iteration learned from before. growth: how many times the variance of photons is larger in the
        iterations to come, as their radii shrink.
        """
        final_gather = _relative_mean(np.square(samples.signed_final_gather), samples.all)
        apart = _relative_mean(np.square(samples.rest - rest), samples.all - 0.5 * (samples.rest - rest))
        return NoiseVariances(
            self.photons + photons,
            self.photon_sum + growth * photons**2 * _relative_mean(np.square(samples.signed), samples.all),
            self.rest_sum + 0.5 * max(apart - final_gather - self.rest_photon_variance, 0.0),
            self.pairs + 1,
            final_gather,
        )

    def best_photons(self, first: int, photon_cost: float, rest_cost: float) -> int:
        """Photons with which the variance after a given time is least, of at most ``first``; photon_cost: of each."""
        if not self.pairs:
            return first
        photon_variance = self.photon_sum / max(self.photons, 1.0)
        rest_variance = max(self.rest_sum / self.pairs / EVENNESS, _NO_NOISE)
        wanted = math.sqrt(photon_variance * rest_cost / (rest_variance * max(photon_cost, 1.0)))
        steps = round(_STEPS * math.log2(first / max(wanted, 1.0)))
        halvings = min(max(steps / _STEPS, 0.0), _MAX_HALVINGS, max(math.log2(first / _FEWEST), 0.0))
        return round(first * 0.5**halvings)


def camera_cost(vertices: int, shadow_rays: int) -> float:
    """Cost of an iteration's camera paths, in photon rays, from their vertices and the shadow rays of each."""
    return vertices * (_CAMERA_VERTEX + _SHADOW_RAY * shadow_rays)


def photon_cost(photons: int, segments: int, pairs: int, beam_pairs: int = 0) -> float:
    """Cost of one of so many photons, in photon rays, from the rays of all, the pairs of photons and pixels, and those
    of photon beams and pixels."""
    return (segments + _PHOTON_PAIR * pairs + _BEAM_PAIR * beam_pairs) / max(photons, 1)
