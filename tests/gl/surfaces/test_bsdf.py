# SPDX-License-Identifier: GPL-3.0-or-later
"""BSDF lobes: sampling against evaluation, conservation, reciprocity."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from rppm_addon.gl.buffers.records import Record
from rppm_addon.integrator.common.records.closures import MicrofacetKind
from rppm_addon.materials import albedo_tables

Record(
    "LobeTestParameters",
    weight="vec3", count="uint", f0="vec3", kind="uint", tint="vec3", alpha="float", ior="float", cosine="float",
    aspect="float", radiance="uint", beckmann="uint",
)  # fmt: skip
SHADER = str(Path(__file__).with_name("lobe_albedo.comp"))
_, MIRROR, METAL, DIELECTRIC, GLASS, REFRACTION, COATED_GLASS, SHEET, SHEEN, VELVET, *_ = MicrofacetKind
TOON, GLOSSY_TOON = MicrofacetKind.TOON, MicrofacetKind.GLOSSY_TOON
COUNT = 1 << 18


@dataclass
class Lobe:
    """Results of a lobe, (COUNT, 4) each: samples with their side, evaluations with theirs, pairs for reciprocity,
    and functions of the direction weighted by sampling and by density."""

    sampled: np.ndarray
    evaluated: np.ndarray
    pairs: np.ndarray
    drawn: np.ndarray
    expected: np.ndarray


def run(context, library, kind, alpha, ior, cosine, radiance=1, defines=None, **values) -> Lobe:
    """Samples and evaluations of a lobe seen at a cosine; values: further parameters of the shader."""
    white = dict.fromkeys(("weight", "f0", "tint"), (1, 1, 1))
    lobe = {"kind": kind, "alpha": alpha, "ior": ior, "cosine": cosine, "radiance": radiance, "count": COUNT}
    results = context.moderngl.buffer(reserve=80 * COUNT)
    library.compute(SHADER, defines or {}).run(
        COUNT, {"Results": results}, {"aspect": 1.0, "beckmann": False, **white, **lobe, **values}
    )
    table = np.frombuffer(results.read(), np.float32).reshape(COUNT, 20)
    results.release()
    columns = np.empty((20, COUNT))  # which tests go through one by one
    for first in range(0, COUNT, 1024):  # that stay in the cache
        columns[:, first : first + 1024] = table[first : first + 1024].T
    return Lobe(*(columns[first : first + 4].T for first in range(0, 20, 4)))


def assert_equal_means(sampled, evaluated, what):
    """Two Monte Carlo means agree within their standard errors (4.5 sigma)."""
    means = sampled.mean(), evaluated.mean()
    variances = (values @ values / COUNT - mean**2 for values, mean in zip((sampled, evaluated), means))
    error = np.sqrt(max(sum(variances), 0.0) / COUNT)
    assert abs(means[0] - means[1]) < 4.5 * error + 1e-6, what


def assert_sampled_as_evaluated(lobe: Lobe, what: str) -> None:
    for side in (0.0, 1.0):
        for channel in (0, 2):
            a = np.where(lobe.sampled[:, 3] == side, lobe.sampled[:, channel], 0)
            b = np.where(lobe.evaluated[:, 3] == side, lobe.evaluated[:, channel], 0)
            assert_equal_means(a, b, f"{what} side {side} channel {channel}")
    for moment in range(4):
        assert_equal_means(lobe.drawn[:, moment], lobe.expected[:, moment], f"{what} moment {moment}")


COLORS = {"f0": (0.3, 0.5, 0.9), "weight": (0.9, 0.8, 0.7)}


@pytest.mark.parametrize("kind", [MIRROR, METAL, DIELECTRIC, GLASS, REFRACTION, SHEET])
@pytest.mark.parametrize("alpha", [0.2, 0.6, 1.0])
@pytest.mark.parametrize("ior", [1.5, 1 / 1.5])
def test_sampling_has_the_mean_of_evaluation(context, library, kind, alpha, ior):
    for cosine in (0.35, 0.95):
        lobe = run(context, library, kind, alpha, ior, cosine, **COLORS)
        assert_sampled_as_evaluated(lobe, f"kind {kind} alpha {alpha} ior {ior:.2f} cosine {cosine}")


@pytest.mark.parametrize("kind", [METAL, GLASS])
@pytest.mark.parametrize("aspect", [0.4, 0.8])
def test_stretched_and_tinted_lobes(context, library, kind, aspect):
    for cosine in (0.35, 0.95):
        lobe = run(context, library, kind, 0.4, 1.5, cosine, tint=(0.2, 0.6, 0.4), aspect=aspect, **COLORS)
        assert_sampled_as_evaluated(lobe, f"kind {kind} aspect {aspect} cosine {cosine}")


@pytest.mark.parametrize("kind", [MIRROR, GLASS, REFRACTION])
@pytest.mark.parametrize(("alpha", "aspect"), [(0.1, 1.0), (0.6, 1.0), (0.4, 0.4)])
def test_beckmann(context, library, kind, alpha, aspect):
    """Sampled by GGX's visible normals: weights are bounded by 4/e, the largest ratio of the densities, and masking."""
    for cosine in (0.35, 0.95):
        lobe = run(context, library, kind, alpha, 1.5, cosine, aspect=aspect, beckmann=True)
        assert_sampled_as_evaluated(lobe, f"Beckmann, kind {kind} alpha {alpha} aspect {aspect} cosine {cosine}")
        across = alpha / aspect * np.sqrt(1.0 / cosine**2 - 1.0)
        assert lobe.sampled[:, :3].max() <= 4.0 / np.e * 0.5 * (1.0 + np.hypot(1.0, across)) + 1e-3


def covered(kind, thickness: float, film: float, follows=True) -> dict:
    """Members of a lobe under a film, as film_lobes.glsl packs them."""
    word = int(np.float16(thickness).view(np.uint16)) << 13 | round(8191 * film / (1 + film))
    colors = {"f0": (0.3, 0.5, 0.9), "weight": (0.9, 0.8, 0.7), "defines": {"THIN_FILM_LOBES": 1}}
    if kind == DIELECTRIC:
        colors["f0"] = (-0.02, 0.03, 0.05)
    if kind == METAL:
        colors["f0"] = (-0.3, -0.5 if follows else 0.5, 0.9)
        return colors | {"tint": (0.3, 0.4, 0.6), "ior": float(np.uint32(word + 0x37800000).view(np.float32))}
    return colors | {"tint": ((word & 511) / 511, (word >> 9 & 1023) / 1023, (word >> 19) / 511)}


@pytest.mark.parametrize("alpha", [0.1, 0.6])
@pytest.mark.parametrize(
    ("kind", "ior", "follows"),
    [(DIELECTRIC, 1.5, False), (COATED_GLASS, 1.5, False), (COATED_GLASS, 1 / 1.5, False), (METAL, 1.0, True),
     (METAL, 1.0, False)],
)  # fmt: skip
def test_thin_films(context, library, kind, ior, follows, alpha):
    """Their reflection is the same from both sides, as the angle to the microfacets is."""
    for cosine in (0.35, 0.95):
        lobe = run(context, library, **{"kind": kind, "alpha": alpha, "ior": ior, "cosine": cosine}
                   | covered(kind, 350.0, 1.8, follows))  # fmt: skip
        assert_sampled_as_evaluated(lobe, f"film on {kind} of {ior:.2f}, alpha {alpha} cosine {cosine}")
        means = lobe.sampled[:, :3].mean(axis=0)
        assert 0.0 < means.max() < 1.0
        reflected = lobe.pairs[(lobe.pairs[:, 2] == 0) & (lobe.pairs[:, :2] > 1e-4).all(axis=1)]
        assert len(reflected) > 1000 and lobe.evaluated[:, :3].max() > 0.0
        np.testing.assert_allclose(reflected[:, 0], reflected[:, 1], rtol=5e-3, atol=1e-4)


ASHIKHMIN = {"tint": (0.0, 0.0, 0.0), "defines": {"ASHIKHMIN_LOBES": 1}}


@pytest.mark.parametrize(("alpha", "aspect"), [(0.1, 1.0), (0.4, 0.4), (1.0, 1.0)])
def test_ashikhmin_and_shirley(context, library, alpha, aspect):
    """Weights are at most 1, and the BSDF is the same from both sides."""
    for cosine in (0.35, 0.95):
        lobe = run(context, library, MIRROR, alpha, 1.5, cosine, aspect=aspect, **ASHIKHMIN)
        assert_sampled_as_evaluated(lobe, f"Ashikhmin and Shirley, alpha {alpha} aspect {aspect} cosine {cosine}")
        assert lobe.sampled[:, :3].max() <= 1.0 + 1e-6 and lobe.pairs[:, 0].max() > 0.0
        np.testing.assert_allclose(lobe.pairs[:, 0], lobe.pairs[:, 1], rtol=2e-3, atol=1e-6)


def test_the_smoothest_of_ashikhmin_and_shirley_are_mirrors(context, library):
    for alpha in (0.0, 1e-4):
        drawn = run(context, library, MIRROR, alpha, 1.5, 0.6, **ASHIKHMIN).drawn
        np.testing.assert_allclose(drawn, drawn[:1].repeat(len(drawn), axis=0), atol=5e-3)
        np.testing.assert_allclose(drawn[:, 0], 1.0)


@pytest.mark.parametrize("coefficients", [(0.15, -0.1, 0.0), (0.7, 0.0, 0.0), (0.3, -0.17, 0.0)])
def test_sheen(context, library, coefficients):
    """A linearly transformed cosine: all of it is scattered, by the density of its samples."""
    for cosine in (0.35, 0.95):
        lobe = run(context, library, SHEEN, 1.0, 1.0, cosine, f0=coefficients)
        assert_sampled_as_evaluated(lobe, f"sheen {coefficients} cosine {cosine}")
        assert (lobe.sampled[:, :3] == 1.0).mean() > 0.999
        assert lobe.expected[:, 0].mean() == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize("sigma", [0.2, 0.5, 1.0])
def test_velvet(context, library, sigma):
    for cosine in (0.35, 0.95):
        lobe = run(context, library, VELVET, 1.0, 1.0, cosine, f0=(sigma, 0.0, 0.0))
        assert_sampled_as_evaluated(lobe, f"velvet {sigma} cosine {cosine}")
        # Light along the surface is left out.
        reflected = lobe.pairs[(lobe.pairs[:, 2] == 0) & (lobe.pairs[:, :2] > 1e-4).all(axis=1)]
        np.testing.assert_allclose(reflected[:, 0], reflected[:, 1], rtol=2e-3)


@pytest.mark.parametrize("kind", [TOON, GLOSSY_TOON])
@pytest.mark.parametrize(("size", "fading"), [(0.05, 0.1), (0.5, 0.0), (0.8, 0.6)])
def test_toon(context, library, kind, size, fading):
    """A cone of even density. Photons are scattered by the same BSDF, seen from where they go."""
    edge = min(size + fading, 1.0) * np.pi / 2
    shape = size * np.pi / 2, fading * np.pi / 2, 1 - np.cos(edge)
    for cosine in (0.35, 0.95):
        lobe = run(context, library, kind, 1.0, 1.0, cosine, f0=shape)
        what = f"toon {kind} {size} {fading} cosine {cosine}"
        for channel in (0, 2):
            assert_equal_means(lobe.sampled[:, channel], lobe.evaluated[:, channel], what)
        flux = run(context, library, kind, 1.0, 1.0, cosine, f0=shape, radiance=0)
        # Of uniform pairs: what leaves to wi, of light from wo.
        assert_equal_means(flux.sampled[:, 0], flux.pairs[:, 1] * flux.pairs[:, 3], f"{what} flux")


@pytest.mark.parametrize("alpha", [0.0, 0.3, 1.0])
@pytest.mark.parametrize("ior", [1.5, 1 / 1.5])
def test_albedo_is_that_of_the_tables(context, library, alpha, ior):
    for cosine in (0.4, 1.0):
        white, _, glass = albedo_tables.lobe_albedos(max(alpha, 1e-4), cosine, np.array([ior]), 65536)
        mirror_samples = run(context, library, MIRROR, alpha, 1.0, cosine).sampled
        glass_samples = run(context, library, GLASS, alpha, ior, cosine).sampled
        assert mirror_samples[:, 0].mean() == pytest.approx(white, abs=5e-3)
        assert glass_samples[:, 0].mean() == pytest.approx(glass[0], abs=5e-3)
        assert mirror_samples[:, :3].max() < 1.0001 and glass_samples[:, :3].max() < 1.0001


def test_radiance_and_flux_differ_by_the_squared_index(context, library):
    radiance = run(context, library, REFRACTION, 0.3, 1.5, 0.8, radiance=1).sampled
    flux = run(context, library, REFRACTION, 0.3, 1.5, 0.8, radiance=0).sampled
    assert radiance[:, 0].mean() == pytest.approx(flux[:, 0].mean() * 1.5**2, rel=1e-5)


@pytest.mark.parametrize("kind", [MIRROR, METAL, DIELECTRIC, GLASS])
@pytest.mark.parametrize("aspect", [1.0, 0.5])
def test_lobes_are_reciprocal(context, library, kind, aspect):
    ior = 1.5
    pairs = run(context, library, kind, 0.5, ior, 0.6, f0=(0.4, 0.4, 0.4), aspect=aspect).pairs
    reflected = pairs[(pairs[:, 2] == 0) & (pairs[:, 0] > 1e-4)]
    np.testing.assert_allclose(reflected[:, 0], reflected[:, 1], rtol=2e-3)
    if kind == GLASS and aspect == 1.0:
        # f(wo, wi) / n_i^2 = f(wi, wo) / n_o^2 for radiance (Veach 1997, eq. 5.14); for radiance over the squared
        # index, f(wo, wi) n_o^2 = f(wi, wo) n_i^2
        through = pairs[(pairs[:, 2] == 1) & (pairs[:, 0] > 1e-4)]
        assert len(through) > 1000
        np.testing.assert_allclose(through[:, 0], through[:, 1] * ior**2, rtol=5e-3)


def test_a_sheet_is_a_mirror_on_the_other_side(context, library):
    """The same from both sides, without a change of radiance, whatever its index."""
    sheet, mirror = (run(context, library, kind, 0.5, 1.5, 0.6, **COLORS) for kind in (SHEET, MIRROR))
    through = sheet.pairs[sheet.pairs[:, 2] == 1]
    assert (through[:, 0] > 1e-4).sum() > 1000
    np.testing.assert_allclose(through[:, 0], through[:, 1], rtol=2e-3, atol=1e-4)
    passed, reflected = sheet.sampled, mirror.sampled
    assert (passed[:, 3] == 1).all() and (reflected[:, 3] == 0).all()
    np.testing.assert_array_equal(passed[:, :3], reflected[:, :3])
