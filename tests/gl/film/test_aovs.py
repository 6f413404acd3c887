# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes of AOV Output nodes."""

import numpy as np
import scenes
from support.lobes import Lobe, LobeKind, material
from support.render_states import assert_goes_on

from rppm_addon.scene import AovOutput, Light, LightKind, Link, Scene

AOVS = ("Place.RGBA", "Height.X", "Unused.X")


def pane_over_floor(pane: Lobe, aovs: tuple[str, ...] = AOVS, **settings) -> Scene:
    """A camera 3 m above a floor whose right half is missing, with a pane 1 m above it. The floor writes where it is,
    and 7, the pane a color and 0.5."""
    upper, lower = material("pane", pane), scenes.diffuse(1, 1, 1)
    upper.graph.aovs = [AovOutput("Place", (0.25, 0.5, 1.0), 9.0), AovOutput("Height", 9.0, 0.5)]
    position = lower.graph.add("new_geometry", "position")
    lower.graph.aovs = [AovOutput("Place", position), AovOutput("Height", value=Link(position.node, "position"))]
    lower.graph.aovs.append(AovOutput("Height", value=7.0))
    left = scenes.rectangle("floor", (-4, -4, 0), (0, -4, 0), (0, 4, 0), (-4, 4, 0))
    camera, sun = scenes.camera((0, 0, 3), (0, 0, 0), 0.5, 8), Light("sun", LightKind.SUN, np.eye(4), np.ones(3))
    fixed = {"passes": (), "aovs": aovs, "photons": 64, "iterations": 8, "filter_width": 0.0}
    parts = (scenes.square("pane", 2.0, 1.0), upper), (left, lower)
    return scenes.scene_of(camera, *parts, lights=[sun], **fixed | settings)


def test_values_of_the_first_surface(renderer):
    """A mirror's, and nothing of what is behind it or seen in it."""
    passes = renderer.render(pane_over_floor(Lobe(LobeKind.GLOSSY))).frame.passes
    assert list(passes) == ["Place", "Height", "Unused"]
    np.testing.assert_allclose(passes["Place"], np.broadcast_to((0.25, 0.5, 1.0, 1.0), (8, 8, 4)), rtol=1e-6)
    np.testing.assert_allclose(passes["Height"], 0.5, rtol=1e-6)
    assert passes["Unused"].shape == (8, 8) and not passes["Unused"].any()


def test_what_is_seen_through_adds_its_own(renderer):
    """As in Cycles: all surfaces up to the first that hides more than half, none by its share."""
    passes = renderer.render(pane_over_floor(Lobe(LobeKind.TRANSPARENT))).frame.passes
    places = scenes.floor_places(scenes.camera((0, 0, 3), (0, 0, 0), 0.5, 8))
    left = places[..., 0] < 0.0
    color = np.where(left[..., None], places, 0.0) + (0.25, 0.5, 1.0)
    np.testing.assert_allclose(passes["Place"][..., :3], color, atol=1e-4)
    np.testing.assert_allclose(passes["Place"][..., 3], 1.0 + left, rtol=1e-6)
    height = 0.5 + np.where(left, places.mean(-1) + 7.0, 0.0)  # a vector's mean becomes a value
    np.testing.assert_allclose(passes["Height"], height, atol=1e-4)


def test_a_render_goes_on_bit_for_bit_and_the_picture_stays(mapper):
    scene = pane_over_floor(Lobe(LobeKind.TRANSPARENT), filter_width=1.5)
    state = assert_goes_on(mapper, scene, "passes", "pass_counts", "radiance")
    assert state.passes["Place"].any()
    without = pane_over_floor(Lobe(LobeKind.TRANSPARENT), (), filter_width=1.5)
    mapper.update(without)
    for _ in range(4):
        mapper.iterate()
    np.testing.assert_array_equal(mapper.film.read_radiance(), state.radiance)
