# SPDX-License-Identifier: GPL-3.0-or-later
"""Who gets the device for how long."""

import pytest

from rppm_addon.session.worker.fair_share import FairShare


def run(share, turns, costs, weights):
    """Time that each has got after so many turns."""
    spent = dict.fromkeys(costs, 0.0)
    for _ in range(turns):
        chosen = share.next(costs)
        share.charge(chosen, costs[chosen], weights[chosen])
        spent[chosen] += costs[chosen]
    return spent


def test_time_is_shared_by_weight_whatever_a_turn_takes():
    costs, weights = {"viewport": 0.03, "final": 0.5, "other": 0.001}, {"viewport": 1.0, "final": 3.0, "other": 1.0}
    spent = run(FairShare(), 20000, costs, weights)
    total = sum(spent.values())
    assert {key: time / total for key, time in spent.items()} == pytest.approx(
        {"viewport": 0.2, "final": 0.6, "other": 0.2}, rel=0.01
    )


def test_who_comes_late_neither_waits_nor_takes_all():
    share = FairShare()
    run(share, 100, {"final": 1.0}, {"final": 3.0})
    costs, weights = {"final": 1.0, "viewport": 1.0}, {"final": 3.0, "viewport": 1.0}
    spent = run(share, 8, costs, weights)
    assert spent["viewport"] == pytest.approx(2.0, abs=1.0) and spent["final"] == pytest.approx(6.0, abs=1.0)


def test_pauses_are_not_owed():
    share = FairShare()
    costs, weights = {"a": 1.0, "b": 1.0}, {"a": 1.0, "b": 1.0}
    run(share, 10, costs, weights)
    run(share, 1000, {"a": 1.0}, weights)
    assert run(share, 10, costs, weights) == pytest.approx({"a": 5.0, "b": 5.0}, abs=1.0)


def test_who_pauses_after_a_long_turn_still_owes_it():
    share = FairShare()
    share.next(["a", "b"])
    share.charge("a", 100.0, 1.0)
    assert run(share, 50, {"b": 1.0}, {"b": 1.0})["b"] == 50.0
    assert run(share, 50, {"a": 1.0, "b": 1.0}, {"a": 1.0, "b": 1.0})["b"] >= 49.0


def test_nobody():
    assert FairShare().next([]) is None
