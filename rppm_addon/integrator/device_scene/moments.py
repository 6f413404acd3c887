# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of iterations while a shutter is open."""

import numpy as np

from ..common.low_discrepancy import van_der_corput


def moment(iteration: int, seed: int) -> float:
    """Return the time of an iteration (from 1) as the fraction, 0 to 1, of the light that the shutter lets pass before.

    Of 2^k iterations each has a 2^k-th of the time, and a random place in it. That the points of what else an
    iteration decides go through their indices in a shuffled order keeps it, such as the place on the lens, independent
    of the time.
    """
    scramble = int(np.random.default_rng((seed, 1)).integers(1 << 32))
    return van_der_corput(iteration - 1, scramble)
