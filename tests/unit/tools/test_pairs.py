# SPDX-License-Identifier: GPL-3.0-or-later
"""The figures of tools/pairs and its table."""

import json

import numpy as np
import pytest

from tools.pairs.__main__ import difference, finished, line_of, stage_of, write_sheets
from tools.pairs.figures import figures_of
from tools.pairs.sheets import pair_image


def noisy(seed: int, level: float = 1.0, noise: float = 0.02) -> np.ndarray:
    """Two pictures (2, 32, 40, 4) of an even gray."""
    pictures = np.full((2, 32, 40, 4), level) + np.random.default_rng(seed).normal(0.0, noise, (2, 32, 40, 4))
    pictures[..., 3] = 1.0
    return pictures


def test_equal_pictures_are_equal():
    figures = figures_of(noisy(1), noisy(2))
    assert figures.mean == pytest.approx(1.0, abs=4.0 * figures.error)
    assert figures.error < 0.001
    assert figures.off == 0.0
    assert figures.flip == pytest.approx(figures.flip_of_noise, abs=0.01)


def test_bright_spots_move_the_mean_and_not_the_median():
    theirs = noisy(1)
    ours = theirs * 1.02
    ours[:, 3, 5, :3] = 1e4
    figures = figures_of(ours, theirs)
    assert figures.median == pytest.approx(1.02)
    assert figures.mean > 5.0


def test_blocks_are_off_by_a_tenth_beyond_noise():
    theirs = noisy(1)
    ours = noisy(2)
    ours[:, :8, :16, :3] += 0.2
    ours[:, 8:16, :8, :3] += 0.05
    assert figures_of(ours, theirs).off == pytest.approx(2 / 20)
    ours[..., :3] += noisy(3, 0.0, 5.0)[..., :3]
    assert figures_of(ours, theirs).off < 2 / 20


def test_alpha_counts():
    theirs, ours = noisy(1), noisy(1)
    ours[:, 8:16, 16:24, 3] = 0.0
    assert figures_of(ours, theirs).off == pytest.approx(1 / 20)


def test_black_blocks_and_what_is_not_a_number():
    theirs, ours = noisy(1), noisy(1) * 0.9
    theirs[:, :16], ours[:, :16] = 0.0, 0.0
    assert figures_of(ours, theirs).median == pytest.approx(0.9)
    ours[:, 24:, :8] = np.nan
    assert figures_of(ours, theirs).off == pytest.approx(1 / 20)
    assert np.isnan(figures_of(theirs, np.zeros_like(theirs)).median)


def test_one_line_a_file(tmp_path):
    target = tmp_path / "a.b"
    assert finished(target) is None
    (tmp_path / "a.b.json").write_text(json.dumps({"failed": "RPPM: no camera"}))
    assert line_of("a.b", finished(target)).split(maxsplit=1) == ["a.b", "FAILED RPPM: no camera"]
    (tmp_path / "a.b.log").write_text("@stage opening\nnoise\n@stage Cycles\nmore\n")
    assert stage_of(tmp_path / "a.b.log") == "Cycles"
    figures = {"mean": 1.0, "error": 0.001, "median": 0.999, "off": 0.25, "flip": 0.02, "flip_of_noise": 0.01}
    report = {"figures": figures, "first_picture_seconds": 1.5, "warnings": ["one"], "suspects": ["lamps"]}
    assert "25.0%" in line_of("a", report)
    assert line_of("a", report).endswith("1  Cycles: lamps")


def test_what_differs_most_comes_first_on_the_sheets(tmp_path):
    reports = {}
    for name, level in (("alike", 1.0), ("darker", 0.5), ("gone", 0.1)):
        ours, theirs = noisy(1, level), noisy(2)
        pair_image(ours[0], theirs[0]).save(tmp_path / f"{name}.png")
        reports[name] = {"figures": figures_of(ours, theirs).__dict__}
    assert sorted(reports, key=lambda name: -difference(reports[name])) == ["gone", "darker", "alike"]
    write_sheets(tmp_path, {**reports, "broken": {"failed": "why"}})
    assert (tmp_path / "sheet_00.png").exists()
