# SPDX-License-Identifier: GPL-3.0-or-later
"""Features of materials, lights, worlds and cameras against Cycles.

`make parity` measures, prints and draws the same. Rows that need more samples than the others run with the long tests,
and so do all but a few of those in which a node drives an input of the Principled BSDF: they take long to compile.
"""

import numpy as np
import pytest

from .flip import flip
from .measure import measure, shortcomings
from .suite import ROWS

DRIVEN_OFTEN = ("Driven: Base Color by an image", "Driven: Roughness by noise", "Driven: Normal by a bump")


def takes_long(row) -> bool:
    return row.effort > 1 or (row.id.startswith("Driven: ") and row.id not in DRIVEN_OFTEN)


PARAMETERS = [pytest.param(row, id=row.id, marks=[pytest.mark.long] if takes_long(row) else []) for row in ROWS]


@pytest.mark.parametrize("row", PARAMETERS)
def test_feature(renderer, row):
    found = measure(row, renderer)
    print(
        f"{row.id}: mean {found.mean:.2%} +- {found.mean_error:.2%}, block {found.block:.2%}, FLIP {found.flip:.3f} "
        f"(noise {found.flip_noise:.3f}), pixels that differ {found.wrong:.2%}"
    )
    assert not shortcomings(row, found)


def test_flip_is_that_of_its_authors():
    """Means that the authors' own evaluator (flip-evaluator 1.7) gives."""
    y, x = np.mgrid[0:40, 0:48]
    reference = np.stack([0.5 + 0.4 * np.sin(x / 5), 0.5 + 0.4 * np.cos(y / 7), (x + y) / 88 * 0.8 + 0.1], axis=-1)
    inside = (x - 20) ** 2 + (y - 20) ** 2 < 64
    changed = np.clip(reference + np.where(inside, 0.2, 0.0)[..., None] * [1.0, -0.5, 0.7], 0.0, 1.0)
    assert flip(reference, changed).mean() == pytest.approx(0.065898, rel=1e-3)
    assert flip(np.zeros((40, 48, 3)), np.ones((40, 48, 3))).mean() == pytest.approx(0.96740, rel=1e-3)
    assert flip(reference, reference).max() == 0.0
