# SPDX-License-Identifier: GPL-3.0-or-later
"""Work that is cut into pieces: how large they are, and that pictures do not depend on it."""

from types import SimpleNamespace

import numpy as np
import pytest
import scenes
from rendering import iterated

from rppm_addon.gl.context import pacing as pacing_module
from rppm_addon.gl.context.pacing import Pace, Pacing
from rppm_addon.scene import DensityEstimation


class Device:
    """Takes a time for each item, on a clock of its own; notes what it is given. ``seconds_per_item`` may change."""

    def __init__(self, monkeypatch, seconds_per_item):
        self.clock = 0.0
        self.seconds_per_item = seconds_per_item
        self.seconds_per_dispatch = 0.0
        self.given = []
        self.is_software = True
        monkeypatch.setattr(pacing_module, "time", SimpleNamespace(perf_counter=lambda: self.clock))

    def function(self, *_):
        return lambda *_: None

    def finish(self):
        pass

    def run(self, pacing, pace, items):
        """The items' ranges as they were given; ``...`` for all at once."""
        self.given = []
        pacing.run(pace, lambda: items, lambda: self._take(items, ...), lambda first, count: self._take(count, first))
        return self.given

    def _take(self, items, first):
        self.given.append((first, items))
        self.clock += self.seconds_per_dispatch + items * self.seconds_per_item


@pytest.mark.parametrize("seconds_per_item", [1e-7, 1e-5, 1e-3])
def test_no_piece_is_longer_than_allowed(monkeypatch, seconds_per_item):
    device = Device(monkeypatch, seconds_per_item)
    pacing, pace = Pacing(device), Pace()
    for items in (100_000, 100_000, 20):
        given = device.run(pacing, pace, items)
        assert sum(count for _, count in given) == items
        assert max(count for _, count in given) * seconds_per_item <= pacing.max_seconds
        firsts = [first for first, _ in given]
        if firsts != [...]:
            assert firsts == np.cumsum([0, *(count for _, count in given[:-1])]).tolist()
    assert device.given == [(..., 20)]


def test_what_is_fast_is_given_whole_from_the_second_time_on(monkeypatch):
    device = Device(monkeypatch, 1e-7)
    pacing, pace = Pacing(device), Pace()
    sizes = [count for _, count in device.run(pacing, pace, 10_000)]
    assert sizes[:4] == [64, 128, 256, 512]
    assert device.run(pacing, pace, 10_000) == [(..., 10_000)]
    pacing.forget()  # another scene: its speed is not known
    assert device.run(pacing, pace, 10_000)[0] == (0, 64)


def test_what_a_few_items_take_says_nothing_of_many(monkeypatch):
    device = Device(monkeypatch, 1e-7)
    device.seconds_per_dispatch = 1e-3
    pacing, pace = Pacing(device), Pace()
    for _ in range(2):
        device.run(pacing, pace, 10_000)
    device.run(pacing, pace, 1)
    assert device.run(pacing, pace, 10_000) == [(..., 10_000)]


def test_what_becomes_slow_is_cut_finer(monkeypatch):
    device = Device(monkeypatch, 1e-6)
    pacing, pace = Pacing(device), Pace()
    for _ in range(2):
        device.run(pacing, pace, 50_000)
    assert device.given == [(..., 50_000)]
    device.seconds_per_item = 1e-4
    device.run(pacing, pace, 50_000)  # nobody could know
    given = device.run(pacing, pace, 50_000)
    assert max(count for _, count in given) * device.seconds_per_item <= pacing.max_seconds


def picture(mapper, library, longest):
    """Return the radiance after two iterations, with so many seconds for a piece, and the number of pieces."""
    pacing = library.pacing
    before, pacing.max_seconds = pacing.pieces, longest
    pacing.forget()
    try:
        iterated(mapper, scenes.room(24, photons=2048, density_estimation=DensityEstimation.RASTERIZED), 2)
    finally:
        pacing.max_seconds = pacing_module.LONGEST_SECONDS
    return mapper.film.read_radiance(), pacing.pieces - before


def test_pictures_do_not_depend_on_the_pieces(mapper, other_mapper, library, monkeypatch):
    whole, _ = picture(mapper, library, 1e9)
    monkeypatch.setattr(pacing_module, "_FEWEST_ITEMS", 3)
    cut, pieces = picture(other_mapper, library, 1e-6)
    assert pieces > 500
    np.testing.assert_array_equal(cut, whole)


def test_devices_that_are_not_waited_for_are_timed_by_their_clock(mapper, other_mapper, library, monkeypatch):
    """As on a GPU: with its queries, and counts that are only read of programs that take long."""
    expected, _ = picture(mapper, library, 1e9)
    monkeypatch.setattr(Pacing, "_is_waited_for", property(lambda self: False))
    np.testing.assert_array_equal(picture(other_mapper, library, 1e9)[0], expected)
    np.testing.assert_array_equal(picture(other_mapper, library, 1e-3)[0], expected)
