# SPDX-License-Identifier: GPL-3.0-or-later
"""Albedo tables against closed forms and an independent quadrature."""

import numpy as np
import pytest

from rppm_addon.materials import albedo_tables as tables


def quadrature_albedo(alpha: float, cosine: float) -> float:
    """Albedo of the white GGX mirror by a product rule over outgoing directions."""
    z, phi = np.meshgrid(*(np.polynomial.legendre.leggauss(n)[0] for n in (600, 400)), indexing="ij")
    wz, wp = (np.polynomial.legendre.leggauss(n)[1] for n in (600, 400))
    z, phi = 0.5 * (z + 1), np.pi * (phi + 1)
    weight = np.outer(0.5 * wz, np.pi * wp)
    wo = np.array([np.sqrt(1 - cosine**2), 0, cosine])
    s = np.sqrt(1 - z * z)
    wi = np.stack([s * np.cos(phi), s * np.sin(phi), z], -1)
    h = wi + wo
    h /= np.linalg.norm(h, axis=-1, keepdims=True)
    density = alpha**2 / (np.pi * (h[..., 2] ** 2 * (alpha**2 - 1) + 1) ** 2)

    def smith(c):
        return 0.5 * (np.sqrt(1 + alpha**2 * (1 - c * c) / (c * c)) - 1)

    value = density / (1 + smith(cosine) + smith(z)) / (4 * cosine)
    return float((value * weight).sum())


@pytest.mark.parametrize("roughness", [0.5, 0.8, 1.0])
@pytest.mark.parametrize("cosine", [0.3, 0.7, 1.0])
def test_white_albedo_matches_quadrature(roughness, cosine):
    white, _, _ = tables.lobe_albedos(roughness**2, cosine, np.array([]), 20000)
    assert white == pytest.approx(quadrature_albedo(roughness**2, cosine), abs=2e-3)


def test_smooth_lobes_lose_nothing():
    etas = np.array([1.1, 1.5, 2.4])
    for cosine in (0.2, 0.6, 1.0):
        white, interpolation, glass = tables.lobe_albedos(1e-4, cosine, etas, 4096)
        assert white == pytest.approx(1, abs=1e-3)
        np.testing.assert_allclose(glass, 1, atol=2e-3)
        f0 = ((etas - 1) / (etas + 1)) ** 2
        np.testing.assert_allclose(interpolation, (tables.fresnel(cosine, etas) - f0) / (1 - f0), atol=2e-3)


def test_fresnel_at_known_angles():
    assert tables.fresnel(np.array(1.0), 1.5) == pytest.approx(0.04)
    assert tables.fresnel(np.array(1e-9), 1.5) == pytest.approx(1.0, abs=1e-6)
    assert tables.fresnel(np.array(0.5), 1 / 1.5) == 1.0  # beyond the critical angle of 41.8 degrees
    # Brewster's angle: only the s half reflects, ((n^2 - 1) / (n^2 + 1))^2 / 2
    brewster = np.cos(np.arctan(1.5))
    assert tables.fresnel(np.array(brewster), 1.5) == pytest.approx(0.5 * (1.25 / 3.25) ** 2)


def test_stored_tables_are_those_that_the_module_computes():
    stored = tables.load()
    size, cube = tables.WHITE_SIZE, tables.SIZE
    white = stored[: size * size].reshape(size, size)
    dielectric, glass = stored[size * size + size :][: 2 * cube**3].reshape(2, cube, cube, cube)
    assert len(stored) == size * size + size + 3 * cube**3 + 3 * size * size + 2 * cube * cube
    rng = np.random.default_rng(0)
    for r, c in rng.integers(1, size, (6, 2)):
        value = tables.lobe_albedos((r / (size - 1)) ** 2, c / (size - 1), np.array([]), tables.SAMPLES)[0]
        assert white[r, c] == pytest.approx(value, abs=1e-5)
    for z, r, c in rng.integers(1, cube, (4, 3)):
        eta = np.array([tables.index_of(z / (cube - 1))])
        _, interpolation, whole = tables.lobe_albedos((r / (cube - 1)) ** 2, c / (cube - 1), eta, tables.SAMPLES)
        assert dielectric[z, r, c] == pytest.approx(interpolation[0], abs=1e-5)
        assert glass[z, r, c] == pytest.approx(whole[0], abs=1e-5)
