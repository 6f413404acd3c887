# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes of light groups: parts of Combined by the lights that they come from."""

import numpy as np
import pytest
import scenes
from support.render_states import assert_goes_on

from rppm_addon.gl.buffer_sets import sum_by_name
from rppm_addon.integrator.common import band
from rppm_addon.scene import Scene, World
from rppm_addon.scene.settings import DensityEstimation, DirectLight

GROUPS = ("lamps", "shining", "world")
ROUNDING = {"rtol": 2e-6, "atol": 2e-6}
RASTERIZED = {"use_final_gather": False, "density_estimation": DensityEstimation.RASTERIZED}
BY_PHOTONS = {"direct_light": DirectLight.PHOTONS, "use_final_gather": False}


def colored(light_groups: tuple[str, ...] = GROUPS, size: int = 24, **settings: object) -> Scene:
    """The room of all kinds of surfaces, whose lights give a channel each: the lamps red, an object green, the world
    blue."""
    settings = {"iterations": 2, "photons": 4096, "passes": ()} | settings
    scene = scenes.crowded_room(size, light_groups=light_groups, **settings)
    for light in scene.lights:
        light.strength, light.light_group = light.strength * (1.0, 0.0, 0.0), "lamps"
    scene.world = World(np.array([0.0, 0.0, 0.6]), light_group="world")
    number, shining = next((n, m) for n, m in enumerate(scene.materials) if m.name == "glow")
    emission = next(node for node in shining.graph.nodes if node.kind == "emission")
    emission.inputs["color"] = (0.0, 1.0, 0.0)
    for instance in scene.instances:
        if number in instance.materials:
            instance.light_group = "shining"
    return scene


def light_of(frame, group: str) -> np.ndarray:
    return frame.passes[f"Combined_{group}"]


@pytest.mark.parametrize(
    "settings", [{}, RASTERIZED, {**BY_PHOTONS, "use_splat_roulette": True}], ids=["gathered", "rasterized", "photons"]
)
def test_each_light_has_its_own_pass(renderer, settings):
    frame = renderer.render(colored(**settings)).frame
    for channel, group in enumerate(GROUPS):
        light = light_of(frame, group)
        np.testing.assert_allclose(light[..., channel], frame.combined[..., channel], **ROUNDING, err_msg=group)
        assert light[..., channel].max() > 0.0, group
        others = np.delete(light, channel, axis=-1)
        assert np.abs(others).max() <= 1e-5 * light.max(), group


def test_bands_of_rows_give_the_same_passes(renderer, monkeypatch):
    whole = renderer.render(colored()).frame
    monkeypatch.setattr(band, "MAXIMUM_BAND_PIXELS", 24 * 10)
    parts = renderer.render(colored(seed=0, use_final_gather=False)).frame
    monkeypatch.undo()
    one = renderer.render(colored(use_final_gather=False)).frame
    assert not np.array_equal(whole.combined, one.combined)
    for group in GROUPS:
        np.testing.assert_array_equal(light_of(one, group), light_of(parts, group), group)


def test_combined_and_a_group_are_the_same_whatever_else_is_one(renderer):
    all_groups = renderer.render(colored()).frame
    one = renderer.render(colored(("shining", "nobody"))).frame
    without = renderer.render(colored(())).frame
    np.testing.assert_array_equal(without.combined, all_groups.combined)
    np.testing.assert_array_equal(without.combined, one.combined)
    np.testing.assert_array_equal(light_of(all_groups, "shining"), light_of(one, "shining"))
    assert list(one.passes) == ["Combined_shining", "Combined_nobody"]
    assert not light_of(one, "nobody").any()
    assert not without.passes


def test_passes_are_exposed(renderer):
    scene = colored(size=8, iterations=1, photons=256)
    plain = renderer.render(scene).frame
    scene.exposure = 4.0
    np.testing.assert_allclose(light_of(renderer.render(scene).frame, "lamps"), 4.0 * light_of(plain, "lamps"))


def test_a_render_goes_on_bit_for_bit(mapper):
    scene = colored(size=8, photons=256)
    state = assert_goes_on(mapper, scene, "passes", "pass_counts", "radiance", iterations=3, stops=(1,))
    assert state.passes["Combined_shining"].any()


def test_groups_that_are_off_take_no_memory(renderer):
    scene = scenes.room(16, photons=256)
    without = sum_by_name(renderer.memory(scene).working.values())
    scene.settings = scene.settings.with_values(light_groups=("key", "rim"))
    working, pixels = sum_by_name(renderer.memory(scene).working.values()), 16 * 16
    assert {name: size for name, size in working.items() if size != without.get(name, 0)} == {
        "split of direct light": 32 * pixels,
        "table of light groups": 64,
        "gathered radiance of light groups": 2 * 48 * pixels,
        "light of groups": 2 * 24 * pixels,
        "passes of light groups": 2 * 12 * pixels,
        "radiance before emission": 16 * pixels,
        "gathered light of a group": 16 * pixels,
        "reused light of a group": 16 * pixels,
    }
