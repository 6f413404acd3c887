# SPDX-License-Identifier: GPL-3.0-or-later
"""The report's measurements, kept from one run to the next."""

import dataclasses

import numpy as np
import pytest

from . import report
from .measure import compared
from .suite import ROWS


@pytest.fixture
def measured(monkeypatch, tmp_path):
    """The rows that were measured, by name, in place of rendering them; all is kept in tmp_path."""
    names = []

    def measure(row, _):
        names.append(row.id)
        light = np.random.default_rng(len(names)).random((2, 4, 16, 16, 3))
        return compared(light[0], light[1], False, (f"warning {len(names)}",))

    monkeypatch.setattr(report, "measure", measure)
    monkeypatch.setattr(report, "OUTPUT", tmp_path)
    monkeypatch.setattr(report, "Renderer", lambda: pytest.MonkeyPatch.context())
    for verb in ("register", "unregister"):
        monkeypatch.setattr(report.rppm_addon, verb, lambda: None)
    return names


def test_a_report_continues_with_the_rows_that_it_has_not_measured(measured, monkeypatch):
    first_row, two_rows = f"^{ROWS[0].id}$", f"^({ROWS[0].id}|{ROWS[1].id})$"
    ((_, first, wrong),) = report.run(first_row, again=False)
    continued = report.run(two_rows, again=False)
    assert measured == [ROWS[0].id, ROWS[1].id]
    for member in dataclasses.fields(first):
        np.testing.assert_array_equal(getattr(continued[0][1], member.name), getattr(first, member.name))
    assert continued[0][1].warnings == ("warning 1",) and continued[0][2] == wrong
    report.run(first_row, again=True)
    monkeypatch.setattr(report, "sources_digest", lambda: "of other sources")
    report.run(first_row, again=False)
    assert measured[2:] == 2 * [ROWS[0].id]
