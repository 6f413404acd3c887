# SPDX-License-Identifier: GPL-3.0-or-later
"""BSDF lobes: sampling against evaluation, conservation, reciprocity."""

from pathlib import Path

import numpy as np
import pytest

from rppm_addon.gl.records import Record
from rppm_addon.integrator import records  # noqa: F401  declares MicrofacetLobe
from rppm_addon.materials import albedo_tables

Record(
    "LobeTestParameters",
    weight="vec3", count="uint", f0="vec3", kind="uint", alpha="float", ior="float", cosine="float", radiance="uint",
)  # fmt: skip
SHADER = str(Path(__file__).with_name("lobe_albedo.comp"))
MIRROR, METAL, DIELECTRIC, GLASS, REFRACTION = 1, 2, 3, 4, 5
COUNT = 1 << 18


def run(context, library, kind, alpha, ior, cosine, radiance=1, weight=(1, 1, 1), f0=(1, 1, 1)):
    results = context.moderngl.buffer(reserve=48 * COUNT)
    library.compute(SHADER).run(
        COUNT,
        {"Results": results},
        {
            "weight": weight,
            "count": COUNT,
            "f0": f0,
            "kind": kind,
            "alpha": alpha,
            "ior": ior,
            "cosine": cosine,
            "radiance": radiance,
        },
    )
    table = np.frombuffer(results.read(), np.float32).reshape(COUNT, 3, 4).astype(np.float64)
    results.release()
    return table[:, 0], table[:, 1], table[:, 2]


def assert_equal_means(sampled, evaluated, what):
    """Two Monte Carlo means agree within their standard errors (4.5 sigma)."""
    error = np.hypot(sampled.std() / np.sqrt(COUNT), evaluated.std() / np.sqrt(COUNT))
    difference = sampled.mean() - evaluated.mean()
    print(f"{what}: sampled {sampled.mean():.5f} evaluated {evaluated.mean():.5f} +- {error:.5f}")
    assert abs(difference) < 4.5 * error + 1e-6, what


@pytest.mark.parametrize("kind", [MIRROR, METAL, DIELECTRIC, GLASS, REFRACTION])
@pytest.mark.parametrize("alpha", [0.2, 0.6, 1.0])
@pytest.mark.parametrize("ior", [1.5, 1 / 1.5])
def test_sampling_has_the_mean_of_evaluation(context, library, kind, alpha, ior):
    for cosine in (0.35, 0.95):
        sampled, evaluated, _ = run(
            context, library, kind, alpha, ior, cosine, f0=(0.3, 0.5, 0.9), weight=(0.9, 0.8, 0.7)
        )
        for side in (0.0, 1.0):
            for channel in (0, 2):
                a = np.where(sampled[:, 3] == side, sampled[:, channel], 0)
                b = np.where(evaluated[:, 3] == side, evaluated[:, channel], 0)
                assert_equal_means(
                    a, b, f"kind {kind} alpha {alpha} ior {ior:.2f} cosine {cosine} side {side} channel {channel}"
                )


@pytest.mark.parametrize("alpha", [0.0, 0.3, 1.0])
@pytest.mark.parametrize("ior", [1.5, 1 / 1.5])
def test_albedo_is_that_of_the_tables(context, library, alpha, ior):
    for cosine in (0.4, 1.0):
        white, _, glass = albedo_tables.lobe_albedos(max(alpha, 1e-4), cosine, np.array([ior]), 65536)
        mirror_samples, _, _ = run(context, library, MIRROR, alpha, 1.0, cosine)
        glass_samples, _, _ = run(context, library, GLASS, alpha, ior, cosine, radiance=0)
        assert mirror_samples[:, 0].mean() == pytest.approx(white, abs=5e-3)
        assert glass_samples[:, 0].mean() == pytest.approx(glass[0], abs=5e-3)
        assert mirror_samples[:, :3].max() < 1.0001 and glass_samples[:, :3].max() < 1.0001


def test_radiance_and_flux_differ_by_the_squared_index(context, library):
    radiance, _, _ = run(context, library, REFRACTION, 0.3, 1.5, 0.8, radiance=1)
    flux, _, _ = run(context, library, REFRACTION, 0.3, 1.5, 0.8, radiance=0)
    assert radiance[:, 0].mean() * 1.5**2 == pytest.approx(flux[:, 0].mean(), rel=1e-5)


@pytest.mark.parametrize("kind", [MIRROR, METAL, DIELECTRIC, GLASS])
def test_lobes_are_reciprocal(context, library, kind):
    ior = 1.5
    _, _, pairs = run(context, library, kind, 0.5, ior, 0.6, f0=(0.4, 0.4, 0.4), weight=(1, 1, 1))
    reflected = pairs[(pairs[:, 2] == 0) & (pairs[:, 0] > 1e-4)]
    np.testing.assert_allclose(reflected[:, 0], reflected[:, 1], rtol=2e-3)
    if kind == GLASS:
        # f(wo, wi) / n_i^2 = f(wi, wo) / n_o^2 for radiance (Veach 1997, eq. 5.14); ours carries the
        # index ratio of its own side
        through = pairs[(pairs[:, 2] == 1) & (pairs[:, 0] > 1e-4)]
        assert len(through) > 1000
        np.testing.assert_allclose(through[:, 0] * ior**2, through[:, 1], rtol=5e-3)
