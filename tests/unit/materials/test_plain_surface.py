# SPDX-License-Identifier: GPL-3.0-or-later
"""Node graphs as plain surfaces."""

import numpy as np
import pytest

from rppm_addon.materials.nodes import KINDS
from rppm_addon.materials.placeholders.plain_surface import GLASS_OPACITY, mean_color, plain_surface
from rppm_addon.scene import Image, Link, NodeGraph

RED, BLUE = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)


def principled(graph, **inputs):
    return graph.add("bsdf_principled", "bsdf", **inputs)


def surface_of(make, *images):
    graph = NodeGraph()
    graph.surface = make(graph)
    return plain_surface(graph, images)


def test_constants_are_taken_as_they_are():
    found = surface_of(
        lambda graph: principled(
            graph, base_color=RED, metallic=0.25, roughness=0.75, alpha=0.5, emission_color=BLUE, emission_strength=3.0
        )
    )
    np.testing.assert_array_equal(found.color, RED)
    assert (found.metallic, found.roughness, found.opacity) == (0.25, 0.75, 0.5)
    np.testing.assert_allclose(found.emission, (0.0, 0.0, 1.5))


def test_mixed_shaders_count_by_their_weights():
    def make(graph):
        red, blue = (graph.add("bsdf_diffuse", "bsdf", color=color) for color in (RED, BLUE))
        mixed = graph.add("mix_shader", "shader", fac=0.25, shader=red, shader_001=blue)
        clear = graph.add("bsdf_transparent", "bsdf")
        return graph.add("mix_shader", "shader", fac=0.5, shader=mixed, shader_001=clear)

    found = surface_of(make)
    np.testing.assert_allclose(found.color, (0.75, 0.0, 0.25))
    assert found.opacity == 0.5


def test_glass_is_a_veil():
    assert surface_of(lambda graph: graph.add("bsdf_glass", "bsdf")).opacity == pytest.approx(GLASS_OPACITY)
    found = surface_of(lambda graph: principled(graph, transmission_weight=1.0, metallic=0.5))
    assert found.opacity == pytest.approx(0.5 + 0.5 * GLASS_OPACITY)


def test_emission_adds_to_what_it_is_added_to():
    def make(graph):
        light = graph.add("emission", "emission", color=RED, strength=2.0)
        return graph.add("add_shader", "shader", shader=light, shader_001=graph.add("bsdf_diffuse", "bsdf", color=BLUE))

    found = surface_of(make)
    np.testing.assert_array_equal(found.color, BLUE)
    np.testing.assert_array_equal(found.emission, (2.0, 0.0, 0.0))
    assert found.opacity == 1.0


@pytest.mark.parametrize("encoding", ["LINEAR", "SRGB"])
def test_linked_images_count_by_their_mean(encoding):
    pixels = np.zeros((300, 200, 4), np.uint8)
    pixels[:150, :, 0] = 255
    image = Image("halves", pixels, encoding)
    found = surface_of(lambda graph: principled(graph, base_color=graph.add("tex_image", "color", image=0)), image)
    np.testing.assert_allclose(found.color, (0.5, 0.0, 0.0), atol=0.02)
    np.testing.assert_array_equal(mean_color(image), found.color)


def test_bytes_are_decoded():
    gray = np.full((2, 2, 4), 128, np.uint8)
    assert mean_color(Image("gray", gray, "SRGB"))[0] == pytest.approx(0.2159, abs=1e-3)
    assert mean_color(Image("gray", gray, "LINEAR"))[0] == pytest.approx(128 / 255)
    assert np.isfinite(mean_color(Image("bad", np.full((2, 2, 4), np.nan, np.float32)))).all()


def test_links_are_followed_to_colors():
    def make(graph):
        noise = graph.add("tex_noise", "fac")
        ramp = graph.add("val_to_rgb", "color", table=np.array([[*RED, 1.0], [*BLUE, 1.0]], np.float32), fac=noise)
        return principled(graph, base_color=ramp, roughness=noise)

    found = surface_of(make)
    np.testing.assert_allclose(found.color, (0.5, 0.0, 0.5))
    assert found.roughness == 0.5


def test_broken_graphs_have_a_surface():
    for surface in (None, Link(0, "bsdf"), Link(7, "bsdf"), Link(-1, "bsdf")):
        graph = NodeGraph(surface=surface)
        graph.add("no_such_kind", color=RED)
        assert plain_surface(graph, []).opacity == 1.0
    looping = NodeGraph()
    looping.surface = looping.add("mix_shader", "shader", shader=Link(0, "shader"), shader_001=Link(0, "shader"))
    assert np.isfinite(plain_surface(looping, []).color).all()
    assert surface_of(lambda graph: principled(graph, base_color=(np.nan,) * 3)).color.tolist() == [0.8] * 3


@pytest.mark.parametrize("name", [name for name, kind in KINDS.items() if kind.is_shader])
def test_every_shader_has_one(name):
    found = surface_of(lambda graph: graph.add(name, next(iter(KINDS[name].outputs))))
    assert np.isfinite([*found.color, *found.emission, found.metallic, found.roughness]).all()
    assert 0.0 <= found.opacity <= 1.0


def test_a_volume_alone_is_clear():
    assert surface_of(lambda graph: graph.add("volume_boundary", "bsdf")).opacity == 0.0
