# SPDX-License-Identifier: GPL-3.0-or-later
"""Lobes of fibers: what is not absorbed is scattered, sampling has the pdf that is told, and light is attenuated as in
closed form."""

from pathlib import Path

import numpy as np
import pytest
import scenes
from rendering import iterated, radiance_of

from rppm_addon.gl.buffers.records import Record
from rppm_addon.integrator.common.records.closures import MicrofacetKind
from rppm_addon.integrator.common.records.photon_paths import PhotonFlag
from rppm_addon.scene import Light, LightKind, Material, NodeGraph, World

Record(
    "HairTestParameters",
    f0="vec3", count="uint", tint="vec3", kind="uint", ior="float", sine="float", h="float", offset="float",
)  # fmt: skip
SHADER = str(Path(__file__).with_name("hair.comp"))
COUNT = 1 << 16


def run(context, library, kind, sine, h=0.0, f0=(0.0, 0.0, 0.0), tint=(0.3, 0.3, 1.0), ior=1.55, offset=0.0):
    """(4, COUNT, 4): weights of samples and the pdf there; BSDF times cosine and pdf over uniform directions; functions
    of the direction of samples, and weighted by the pdf."""
    results = context.moderngl.buffer(reserve=64 * COUNT)
    library.compute(SHADER, {"HAIR_LOBES": 1}).run(
        COUNT,
        {"Results": results},
        {"f0": f0, "count": COUNT, "tint": tint, "kind": kind, "ior": ior, "sine": sine, "h": h, "offset": offset},
    )
    table = np.frombuffer(results.read(), np.float32).reshape(COUNT, 4, 4)
    results.release()
    return table.transpose(1, 0, 2).astype(np.float64)


def assert_equal_means(a, b):
    """Within 4.5 standard errors."""
    error = np.sqrt((a.var() + b.var()) / COUNT)
    assert abs(a.mean() - b.mean()) < 4.5 * error + 1e-6


def assert_sampled_by_its_pdf(drawn, expected):
    for moment in range(4):
        assert_equal_means(drawn[:, moment], expected[:, moment])


@pytest.mark.parametrize("kind", [MicrofacetKind.HAIR_REFLECTION, MicrofacetKind.HAIR_TRANSMISSION])
@pytest.mark.parametrize("shape", [(0.3, 0.4, 0.0), (0.8, 0.5, -0.2)])
def test_hair(context, library, kind, shape):
    """Every sample has the weight 1 but for those along the fiber; lights are seen on one side only."""
    for sine in (0.0, -0.6):
        weights, values, drawn, expected = run(context, library, kind, sine, f0=shape)
        assert np.isin(weights[:, :3], (0.0, 1.0)).all() and weights[:, 0].mean() > 0.99
        assert np.all(drawn[weights[:, 0] == 0.0, 0] == 0.0)
        lit = values[:, 0] > 0.0
        assert np.allclose(values[lit, 0], values[lit, 3]) and 0.2 < lit.mean() < 0.55
        assert_sampled_by_its_pdf(drawn[:, :1] * drawn, expected)


@pytest.mark.parametrize("roughness", [(0.3, 0.3, 1.0), (0.8, 0.15, 0.4), (0.2, 0.9, 1.0)])
@pytest.mark.parametrize(("sine", "h"), [(0.0, 0.0), (0.5, 0.6), (-0.8, -0.95)])
def test_chiang_in_a_white_furnace(context, library, roughness, sine, h):
    """A fiber that absorbs nothing scatters all light, and just so as it is sampled."""
    weights, values, drawn, expected = run(context, library, MicrofacetKind.HAIR_CHIANG, sine, h, tint=roughness)
    assert weights[:, :3].mean() == pytest.approx(1.0, abs=1e-4)
    noise = values[:, 0].std() / np.sqrt(COUNT)
    assert values[:, 0].mean() == pytest.approx(1.0, abs=4.5 * noise + 0.005)
    assert_sampled_by_its_pdf(drawn, expected)


def reflectance(cosine, ior):
    """Fresnel's, of unpolarized light that comes from outside."""
    inside = np.sqrt(1.0 - (1.0 - cosine**2) / ior**2)
    parallel = (ior * cosine - inside) / (ior * cosine + inside)
    across = (cosine - ior * inside) / (cosine + ior * inside)
    return 0.5 * (parallel**2 + across**2)


def attenuations(sigma, sine, h, ior):
    """Chiang et al. 2016, section 3: of R, TT, TRT and all that follows."""
    cosine = np.sqrt(1.0 - sine**2)
    index = np.sqrt(ior**2 - sine**2) / cosine
    passed = np.exp(-sigma * 2.0 * np.sqrt(1.0 - (h / index) ** 2) / np.sqrt(1.0 - (sine / ior) ** 2))
    f = reflectance(cosine * np.sqrt(1.0 - h**2), ior)
    tt = (1.0 - f) ** 2 * passed
    return f, tt, tt * passed * f, tt * (passed * f) ** 2 / (1.0 - passed * f)


@pytest.mark.parametrize(("sine", "h"), [(0.0, 0.3), (0.6, -0.7)])
def test_chiang_absorbs_as_in_closed_form(context, library, sine, h):
    sigma = np.array([0.2, 1.0, 4.0])
    _, values, drawn, expected = run(context, library, MicrofacetKind.HAIR_CHIANG, sine, h, sigma, offset=0.05)
    for channel in range(3):
        albedo = sum(attenuations(sigma[channel], sine, h, 1.55))
        noise = values[:, channel].std() / np.sqrt(COUNT)
        assert values[:, channel].mean() == pytest.approx(albedo, abs=4.5 * noise + 0.005)
    assert_sampled_by_its_pdf(drawn, expected)


def test_chiang_sends_light_around_the_fiber(context, library):
    """Met at the middle of a narrow fiber, R goes back and TT goes on; met beside it, R is mirrored by the normal."""
    middle, beside = (
        run(context, library, MicrofacetKind.HAIR_CHIANG, 0.0, h, (1e3, 1e3, 1e3), (0.05, 0.05, 1.0))[2]
        for h in (0.0, np.sqrt(0.5))
    )
    assert middle[:, 2].mean() < 0.01 and beside[:, 2].mean() > 0.97  # y^2


def test_chiang_tilts_what_it_reflects(context, library):
    """Scales turn R by twice their angle toward the root."""
    smooth, offset = (0.3, 0.05, 1.0), 0.1
    _, _, drawn, _ = run(context, library, MicrofacetKind.HAIR_CHIANG, 0.0, 0.0, (1e3, 1e3, 1e3), smooth, offset=offset)
    assert drawn[:, 1].mean() == pytest.approx(-np.sin(2.0 * offset), abs=0.01)


@pytest.mark.parametrize("shape", [(1.0, 0.3, 1.0), (0.7, 0.5, 1.0), (1.0, 0.2, 0.1)])
@pytest.mark.parametrize(("sine", "h"), [(0.0, 0.0), (-0.5, 0.4)])
def test_huang_is_sampled_as_it_is_evaluated(context, library, shape, sine, h):
    """Sampling and evaluation are two formulas of Huang et al. 2022, which agree but for what Simpson's rule misses and
    for light that is reflected within more than once, which both guess: little where a fiber absorbs."""
    sigma = (1.0, 1.0, 1.0)
    weights, values, drawn, expected = run(context, library, MicrofacetKind.HAIR_HUANG, sine, h, sigma, shape)
    albedo = weights[:, 1].mean()
    assert values[:, 1].mean() == pytest.approx(albedo, rel=0.08)
    for moment in range(4):
        assert drawn[:, moment].mean() == pytest.approx(expected[:, moment].mean(), abs=0.08 * albedo)


def test_huang_in_a_white_furnace(context, library):
    """A fiber that absorbs nothing scatters as much as comes to it, whatever its roughness, as energy that microfacets
    lose is given back."""
    for roughness in (0.1, 0.3, 0.5):
        for sine in (0.0, 0.6):
            weights, *_ = run(context, library, MicrofacetKind.HAIR_HUANG, sine, tint=(1.0, roughness, 1.0))
            assert weights[:, 1].mean() == pytest.approx(1.0, abs=0.03)


def test_huang_reflects_as_a_cylinder_does(context, library):
    """R of a smooth cylinder seen across sends light by twice the angle of its normal, evenly over its width, times
    Fresnel's reflectance."""
    weights, _, drawn, _ = run(context, library, MicrofacetKind.HAIR_HUANG, 0.0, 0.0, (1e3, 1e3, 1e3), (1.0, 0.01, 1.0))
    h = (np.arange(4096) + 0.5) / 4096
    reflected = reflectance(np.sqrt(1.0 - h**2), 1.55)
    assert weights[:, 1].mean() == pytest.approx(reflected.mean(), rel=0.02)
    sideways = np.sin(2.0 * np.arcsin(h)) ** 2
    assert drawn[:, 2].mean() == pytest.approx((reflected * sideways).mean(), rel=0.03)


def test_fibers_store_no_photons_however_smooth_lobes_must_be_to_be_followed(mapper):
    """A hairy wall beside a floor is the same bit for bit."""
    graph = NodeGraph()
    graph.surface = graph.add("bsdf_hair", "bsdf", color=(0.9, 0.6, 0.3), roughnessu=0.3, roughnessv=0.5)
    wall = scenes.rectangle("wall", (-1, 1, 0), (1, 1, 0), (1, 1, 1), (-1, 1, 1))
    parts = (scenes.square("floor", 1.0), scenes.diffuse(0.5, 0.5, 0.5)), (wall, Material("hair", graph))
    facing_wall = scenes.looking((0, -1.5, 1.2), (0, 1, 0.4))
    light = Light("light", LightKind.AREA, facing_wall, np.full(3, 3.0), size=(2.0, 2.0))
    camera = scenes.camera((0, -0.2, 2), (0, 0.4, 0), 0.3, 8)
    found = [
        radiance_of(
            mapper, scenes.scene_of(camera, *parts, lights=[light], photons=1024, specular_roughness=roughness), 2
        )
        for roughness in (0.5, 0.0)
    ]
    np.testing.assert_array_equal(*found)


@pytest.mark.parametrize("by_sun", [True, False])
def test_photons_leave_out_where_viewers_see_no_light(mapper, by_sun):
    """Viewers of hair on a mesh see no sampled light where they are between its mirrored and straight way around
    the fiber and the normal; viewers elsewhere do. All viewers see a world's light: paths find it."""
    graph = NodeGraph()
    options = {"model": "HUANG", "parametrization": "COLOR"}
    graph.surface = graph.add("bsdf_hair_principled", "bsdf", options=options, color=(0.9, 0.9, 0.9))
    sheet = scenes.rectangle("sheet", (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0))
    sun = Light("sun", LightKind.SUN, scenes.looking((0, 0, 0), (1, 1, -1)), np.ones(3))
    scene = scenes.scene_of(
        scenes.camera((0, -1, 3), (0, 0, 0), 0.3, 8), (sheet, Material("hair", graph)), photons=16384,
        lights=[sun] if by_sun else [], world=World(np.ones(3) * (not by_sun)), photon_path_length=2,
    )  # fmt: skip
    first, second = iterated(mapper, scene).read_photons()
    on = (first["flags"] & PhotonFlag.ACTIVE != 0) & (first["flags"] & PhotonFlag.ESCAPED == 0)
    on &= second["flags"] & PhotonFlag.ACTIVE != 0
    on &= first["position"][:, 1] < first["position"][:, 0]  # the triangle whose fibers run along x
    light, viewer = first["direction"][on].astype(float), -second["direction"][on].astype(float)
    side = np.cross((1.0, 0.0, 0.0), viewer)
    hidden = light[:, 2] * side[:, 2] * (side * light).sum(axis=1)
    assert len(hidden) > 1000
    unseen = (hidden < -1e-3).mean()
    assert unseen == 0.0 if by_sun else unseen > 0.05
    assert (hidden > 1e-3).mean() > 0.3
