# SPDX-License-Identifier: GPL-3.0-or-later
"""Features of materials, lights, worlds and cameras against Cycles.

`make parity` measures, prints and draws the same. Rows that need more samples than the others run with the long tests,
and so do all but a few of those in which a node drives an input of the Principled BSDF, as they take long to compile,
and all but the first of those kinds of nodes whose values have tests of their own.
"""

import numpy as np
import pytest

from .flip import flip
from .lighting import portals
from .row_tests import assert_near_cycles
from .shapes import displacement, strands
from .suite import ROWS
from .surfaces import ashikhmin_shirley, fibers, media, metallic, ray_nodes, ray_portals
from .values import zones_and_closures

DRIVEN_OFTEN = ("Driven: Base Color by an image", "Driven: Roughness by noise", "Driven: Normal by a bump")


MODULES_OF_THEIR_OWN = {
    ashikhmin_shirley.GROUP, displacement.GROUP, *fibers.GROUPS, media.GROUP, metallic.GROUP, portals.GROUP,
    *ray_nodes.GROUPS, ray_portals.GROUP, *strands.GROUPS, zones_and_closures.GROUP,
}  # fmt: skip
VALUES_ELSEWHERE = {
    "Textures", "Radial Tiling", "Mapping", "Math", "Vector Math", "Mix", "Color Ramp", "Colors", "Map Range",
    "Vector Transform",
}  # fmt: skip
"""Groups of nodes each of whose options test_texture_values.py and test_node_values.py compare over more values."""

ONE_MORE = {
    *(f"Image Texture: extension {extension}, Closest" for extension in ("REPEAT", "EXTEND", "MIRROR")),
    *(f"Image Texture: projection {projection}, Object" for projection in ("BOX", "SPHERE", "TUBE")),
    "Image Texture: extension MIRROR, Cubic",
}
"""Each extension, projection and interpolation is there once more."""


def takes_long(row, first_of_group: bool) -> bool:
    if row.group in VALUES_ELSEWHERE and not first_of_group:
        return True
    return row.effort > 1 or row.id in ONE_MORE or (row.id.startswith("Driven: ") and row.id not in DRIVEN_OFTEN)


def parameters():
    groups = set()
    for row in (row for row in ROWS if row.group not in MODULES_OF_THEIR_OWN):
        long = takes_long(row, row.group not in groups)
        groups.add(row.group)
        yield pytest.param(row, id=row.id, marks=[pytest.mark.long] if long else [])


@pytest.mark.parametrize("row", list(parameters()))
def test_feature(renderer, row):
    assert_near_cycles(row, renderer)


def test_flip_is_that_of_its_authors():
    """Means that the authors' own evaluator (flip-evaluator 1.7) gives."""
    y, x = np.mgrid[0:40, 0:48]
    reference = np.stack([0.5 + 0.4 * np.sin(x / 5), 0.5 + 0.4 * np.cos(y / 7), (x + y) / 88 * 0.8 + 0.1], axis=-1)
    inside = (x - 20) ** 2 + (y - 20) ** 2 < 64
    changed = np.clip(reference + np.where(inside, 0.2, 0.0)[..., None] * [1.0, -0.5, 0.7], 0.0, 1.0)
    assert flip(reference, changed).mean() == pytest.approx(0.065898, rel=1e-3)
    assert flip(np.zeros((40, 48, 3)), np.ones((40, 48, 3))).mean() == pytest.approx(0.96740, rel=1e-3)
    assert flip(reference, reference).max() == 0.0
