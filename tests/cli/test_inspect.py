# SPDX-License-Identifier: GPL-3.0-or-later
"""rppm inspect: the deep cubemap as pictures and numbers."""

import json

import numpy as np
import PIL.Image

from rppm_addon.commands.inspection import false_colors
from rppm_addon.pictures import read_exr

from .conftest import rppm_here, succeed


def test_a_saved_scene_is_inspected(tmp_path, saved_scene):
    png, exr, report = tmp_path / "new" / "cost.png", tmp_path / "cost.exr", tmp_path / "cost.json"
    outputs = ("-o", png, "-o", exr, "--json", report)
    output, _ = succeed(rppm_here, "inspect", saved_scene, *outputs, "--quantity", "list")
    picture = read_exr(exr)
    listed = picture.layer("List")
    inside = np.indices(listed.shape)[1] < 7  # the floor fills the left
    assert np.all(listed[inside] >= 1) and np.all(listed[:, 9:] == 0)
    np.testing.assert_array_equal(picture.combined[..., 2], listed)
    assert np.all(picture.layer("Entries") >= picture.layer("Tests"))
    with PIL.Image.open(png) as image:
        colors = np.asarray(image.convert("RGB")).astype(int)
    assert colors[:, :7].sum(-1).min() > colors[:, 9:].sum(-1).max()
    told = json.loads(report.read_text())
    assert told["counts"]["triangle"] == 2
    assert told["memory_bytes"]["deep cubemap entries"] > 0
    assert "steps" in output and "deep cubemap cells" in output and "yellow" in output


def test_an_unknown_quantity_is_refused(tmp_path, saved_scene):
    status, _, errors = rppm_here("inspect", saved_scene, "-o", tmp_path / "x.png", "--quantity", "speed")
    assert status == 2 and "speed" in errors and "steps" in errors


def test_false_colors_get_brighter():
    brightness = false_colors(np.linspace(0, 1, 64)).astype(int) @ (2, 7, 1)
    assert np.all(np.diff(brightness) >= 0)
    np.testing.assert_array_equal(false_colors(np.array([1.0])), false_colors(np.array([7.0])))
