# SPDX-License-Identifier: GPL-3.0-or-later
"""Bake passes, made of the passes of a picture."""

import numpy as np
import pytest

from rppm_addon.scene.errors import SettingsError
from rppm_addon.scene.passes import passes_named
from rppm_addon.session.render.bake_passes import BAKE_TYPES, BakeFilter, BakePass
from rppm_addon.session.render.results import Frame

ALL = -1
"""Pass filter that Blender's operator hands over when nothing was chosen."""
LOBES = ("Diffuse", "Glossy", "Transmission")


@pytest.fixture
def frame():
    """A pixel whose passes of light add up to Combined."""
    random = np.random.default_rng(1)

    def color():
        return random.uniform(0.1, 1.0, (1, 1, 3)).astype(np.float32)

    passes = {f"{lobe} {part}": color() for lobe in LOBES for part in ("Direct", "Indirect", "Color")}
    passes |= {name: color() for name in ("Emission", "Environment", "Normal", "UV", "Position", "Ambient Occlusion")}
    passes["Roughness"] = np.float32([[0.25]])
    light = sum((passes[f"{lobe} Direct"] + passes[f"{lobe} Indirect"]) * passes[f"{lobe} Color"] for lobe in LOBES)
    combined = np.concatenate([light + passes["Emission"] + passes["Environment"], np.float32([[[0.5]]])], axis=-1)
    return Frame(combined, passes)


@pytest.mark.parametrize("kind", BAKE_TYPES)
def test_the_passes_that_it_asks_for_are_enough(kind, frame):
    wanted = BakePass.of_blender(kind, ALL)
    assert {entry.name for entry in passes_named(wanted.passes)} == set(wanted.passes)
    picture = wanted.picture(Frame(frame.combined, {name: frame.passes[name] for name in wanted.passes}))
    assert picture.shape == (1, 1, 4) and picture[0, 0, 3] == (0.5 if kind == "COMBINED" else 1.0)


def test_roughness_is_gray(frame):
    picture = BakePass.of_blender("ROUGHNESS", ALL).picture(frame)
    np.testing.assert_array_equal(picture, np.float32([[[0.25, 0.25, 0.25, 1.0]]]))


def test_combined_is_the_sum_of_its_parts(frame):
    whole = BakePass.of_blender("COMBINED", ALL)
    assert whole.passes == ()
    np.testing.assert_array_equal(whole.picture(frame), frame.combined)
    everything = BakeFilter.DIFFUSE | BakeFilter.GLOSSY | BakeFilter.TRANSMISSION | BakeFilter.EMIT
    parts = [
        BakePass.of_blender("COMBINED", contents)
        for contents in (everything | BakeFilter.DIRECT, everything & ~BakeFilter.EMIT | BakeFilter.INDIRECT)
    ]
    seen = frame.passes["Environment"]  # which no switch turns off
    total = sum(part.picture(frame)[..., :3] - seen for part in parts) + seen
    np.testing.assert_allclose(total, frame.combined[..., :3], rtol=1e-6)


def test_combined_without_some_lobes(frame):
    contents = BakeFilter.GLOSSY | BakeFilter.DIRECT
    expected = frame.passes["Glossy Direct"] * frame.passes["Glossy Color"] + frame.passes["Environment"]
    picture = BakePass.of_blender("COMBINED", contents).picture(frame)
    np.testing.assert_allclose(picture[..., :3], expected, rtol=1e-6)


@pytest.mark.parametrize("lobe", LOBES)
def test_light_of_a_lobe_with_and_without_its_color(lobe, frame):
    direct, indirect, color = (frame.passes[f"{lobe} {part}"] for part in ("Direct", "Indirect", "Color"))
    for contents, expected in {
        BakeFilter.DIRECT: direct,
        BakeFilter.INDIRECT: indirect,
        BakeFilter.COLOR: color,
        BakeFilter.DIRECT | BakeFilter.INDIRECT: direct + indirect,
        BakeFilter.DIRECT | BakeFilter.COLOR: direct * color,
        BakeFilter.DIRECT | BakeFilter.INDIRECT | BakeFilter.COLOR: (direct + indirect) * color,
    }.items():
        picture = BakePass.of_blender(lobe.upper(), contents).picture(frame)
        np.testing.assert_allclose(picture[..., :3], expected, rtol=1e-6, err_msg=str(contents))


def test_what_is_not_offered():
    with pytest.raises(SettingsError, match="does not bake the type SHADOW; choose one of Combined"):
        BakePass.of_blender("SHADOW", ALL)
