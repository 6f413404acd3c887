# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared parts of the modules that test rows."""

from collections.abc import Collection

import pytest

from rppm_addon.session.render.renderer import Renderer

from .measure import measure, shortcomings
from .rows import Row
from .suite import ROWS

PART = 0.5
"""Fraction of the iterations that `make parity` takes: as many as the limits ask for."""


def parameters(groups: Collection[str], short: Collection[str]) -> list:
    """The rows of groups; but for those with these ids, with the long tests."""
    return [
        pytest.param(row, id=row.id, marks=[] if row.id in short else [pytest.mark.long])
        for row in ROWS
        if row.group in groups
    ]


def assert_near_cycles(row: Row, renderer: Renderer) -> None:
    """Render a row and hold it to its limits."""
    found = measure(row, renderer, PART)
    print(
        f"{row.id}: mean {found.mean:.2%} +- {found.mean_error:.2%}, block {found.block:.2%}, "
        f"pixels that differ {found.wrong:.2%}"
    )
    assert not shortcomings(row, found)
