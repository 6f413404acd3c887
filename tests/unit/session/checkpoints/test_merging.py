# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts become one picture, or it is said which do not fit together."""

import numpy as np
import pytest
from support.checkpoints import pause, still_render, write_part

from rppm_addon.commands.merging import merge_parts, write_stills
from rppm_addon.pictures import Placement
from rppm_addon.scene.errors import CheckpointError


@pytest.fixture
def part(tmp_path):
    def write(first, end, **values):
        return write_part(tmp_path / f"part_{first}_{end}.exr", first, end, **values)

    return write


def test_the_mean_over_all_iterations(part):
    ranges = [(0, 3), (3, 4), (4, 9)]
    paths = [part(*ends) for ends in ranges]
    merged = merge_parts([paths[1], paths[2], paths[0]], incomplete=False)
    assert (merged.iterations, merged.photons) == (9, 2 * 100 + 7 * 60)
    assert (merged.seconds, merged.devices) == (30.0, ["a device"])
    assert [entry[:2] for entry in merged.parts] == ranges
    states = [pause(*ends).state for ends in ranges]
    mean = sum(state.radiance.astype(np.float64) * state.iterations_in_film for state in states) / 9
    np.testing.assert_allclose(merged.frame.combined[..., :3], 2.0 * mean[..., :3], rtol=1e-6)
    np.testing.assert_allclose(merged.frame.combined[..., 3], mean[..., 3], rtol=1e-6)
    for y, x in np.ndindex(merged.frame.passes["Depth"].shape):
        found = [state.passes["Depth"][y, x] for state in states if state.passes["Depth"][y, x] < 1e10]
        assert merged.frame.passes["Depth"][y, x] == (found[0] if found else np.float32(1e10))
        normals = [state.passes["Normal"][y, x] for state in states for _ in range(state.pass_counts[y, x, 0])]
        mean = np.mean(normals, 0) if normals else 0.0
        np.testing.assert_allclose(merged.frame.passes["Normal"][y, x], mean, atol=1e-6)


def test_iterations_that_are_missing(part):
    paths = [part(2, 4), part(7, 9)]
    with pytest.raises(CheckpointError, match="samples 0:2 and 4:7 are in no part; .*--samples-range 0:2"):
        merge_parts(paths, incomplete=False)
    assert merge_parts(paths, incomplete=True).iterations == 4


def test_iterations_that_are_there_twice(part):
    with pytest.raises(CheckpointError, match="part_0_5.exr and .*part_3_9.exr both have the samples 3:5"):
        merge_parts([part(0, 5), part(3, 9)], incomplete=True)
    with pytest.raises(CheckpointError, match="both have the samples 0:5"):
        merge_parts([part(0, 5), part(0, 5)], incomplete=False)


@pytest.mark.parametrize(
    ("values", "what"),
    [
        ({"scene": {"camera": "aa", "meshes": "other", "lights": "cc"}}, r"another scene .*\(other meshes\)"),
        ({"settings": still_render().settings | {"alpha": 0.6}}, r"settings .*\(alpha 0.6 instead of 0.7\)"),
    ],
)
def test_parts_of_another_still(part, values, what):
    with pytest.raises(CheckpointError, match=what):
        merge_parts([part(0, 5), part(5, 9, **values)], incomplete=False)


def test_parts_that_are_to_be_denoised_otherwise_fit_together(part):
    other = {"denoising_prefilter": "FAST", "denoising_quality": "FAST", "denoising_use_gpu": True}
    merged = merge_parts([part(0, 5), part(5, 9, settings=still_render().settings | other)], incomplete=False)
    assert merged.iterations == 9


def test_pictures_have_the_place_of_the_parts(part, tmp_path):
    merged = merge_parts([part(0, 5)], incomplete=False)
    assert merged.render.placement == Placement(16, 10, 3, 2)
    write_stills([merged], [tmp_path / "out.exr", tmp_path / "out.png"])
    assert (tmp_path / "out.png").stat().st_size > 0
