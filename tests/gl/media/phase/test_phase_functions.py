# SPDX-License-Identifier: GPL-3.0-or-later
"""Phase functions: their norm, their mean cosine, and samples that follow them."""

import numpy as np
import pytest
from support.media.phase_values import values_and_samples

from rppm_addon.materials import phase_functions as phases
from rppm_addon.materials.records import PhaseFunctionKind

COUNT = 1 << 16
FIRST = 1e-6
"""First of the squared sines of half the angle: the cosine tells smaller ones no better."""
KIND = PhaseFunctionKind


def half_sines() -> np.ndarray:
    """(COUNT,) squared sines of half the angle, from straight on to straight back, dense at both ends, as single
    precision has them of cosines."""
    ends = np.geomspace(FIRST, 0.5, COUNT // 2)
    sines = np.concatenate([ends, 1.0 - ends[-2::-1], [1.0]])
    return 0.5 * (1.0 - (1.0 - 2.0 * sines).astype(np.float32).astype(np.float64))


def fractions(values: np.ndarray, before: float) -> np.ndarray:
    """(COUNT,) fraction of the light that is scattered at most by the angle of each of ``half_sines``; before: by less
    than the first."""
    steps = 0.5 * (values[1:] + values[:-1]) * np.diff(half_sines())
    return 4.0 * np.pi * np.concatenate([[0.0], np.cumsum(steps)]) + before


def fournier_forand_fraction(parameters: phases.Parameters, x: float) -> float:
    """Fraction of the light within squared sines of half the angle (Fournier and Jonasz 1999), double precision."""
    n, nu, factor, _ = parameters
    delta = 4.0 * x / (3.0 * (n - 1.0) ** 2)
    power = delta**nu
    peak = (1.0 - delta * power - (1.0 - power) * x) / ((1.0 - delta) * power)
    return peak + 0.5 * factor * (1.0 - 2.0 * x) * x * (1.0 - x)


G = (-0.95, -0.5, -0.2, -0.1, -0.01, 0.0, 1e-3, 0.02, 0.14, 0.16, 0.5, 0.9, 0.99)
CASES = {
    **{f"Henyey-Greenstein {g}": (KIND.HENYEY_GREENSTEIN, phases.henyey_greenstein(g)) for g in G},
    **{f"Draine {g} {a}": (KIND.DRAINE, phases.draine(g, a)) for g in G for a in (0.0, 0.5, 1.0, 30.0, 250.0)},
    "Rayleigh": (KIND.RAYLEIGH, phases.rayleigh()),
    **{
        f"Fournier-Forand {n} {b}": (KIND.FOURNIER_FORAND, phases.fournier_forand(n, b))
        for n in (1.05, 1.33, 1.6, 1.0 + (2.0 / 3.0) ** 0.5, 2.0)
        for b in (0.02, 0.1, 0.3, 0.45)
    },
    **{
        f"Mie {d} {model.mie_lobe}": (model.kind, model.parameters(d))
        for d in (0.02, 0.3, 1.4, 3.0, 20.0)
        for model in phases.MODELS["MIE"]
    },
}


@pytest.mark.parametrize("name", CASES)
def test_phase_functions_scatter_all_light_and_samples_follow_them(context, library, name):
    kind, parameters = CASES[name]
    values, samples = values_and_samples(context, library, kind, parameters, 1.0 - 2.0 * half_sines())
    before = 4.0 * np.pi * values[0] * FIRST
    g = parameters[0]
    if kind is KIND.HENYEY_GREENSTEIN and g > 0.0:
        before = (1.0 - g * g) / (2.0 * g) * (1.0 / (1.0 - g) - 1.0 / np.sqrt((1.0 - g) ** 2 + 4.0 * g * FIRST))
    if kind is KIND.FOURNIER_FORAND:
        before = fournier_forand_fraction(parameters, FIRST)
    fraction = fractions(values, before)
    assert (values > 0.0).all() and np.abs(samples).max() <= 1.0
    assert fraction[-1] == pytest.approx(1.0, abs=2e-3)
    turned = 0.5 * (1.0 - samples)
    random = (np.arange(COUNT) + 0.5) / COUNT
    told = turned > 2.0 * FIRST
    np.testing.assert_allclose(np.interp(turned, half_sines(), fraction)[told], 1.0 - random[told], atol=3e-3)
    assert (~told).mean() == pytest.approx(np.interp(2.0 * FIRST, half_sines(), fraction), abs=5e-3)


@pytest.mark.parametrize("g", [*G, -1.0, 1.0])
def test_the_mean_cosine_is_the_anisotropy(context, library, g):
    _, samples = values_and_samples(
        context, library, KIND.HENYEY_GREENSTEIN, phases.henyey_greenstein(g), 1.0 - 2.0 * half_sines()
    )
    assert samples.mean() == pytest.approx(g, abs=1.1e-3)


@pytest.mark.parametrize("alpha", [0.5, 250.0])
@pytest.mark.parametrize("g", G)
def test_the_mean_cosine_of_draine(context, library, g, alpha):
    """Draine 2003, Eq. 7."""
    _, samples = values_and_samples(context, library, KIND.DRAINE, phases.draine(g, alpha), 1.0 - 2.0 * half_sines())
    expected = g * (1.0 + alpha * (3.0 + 2.0 * g * g) / 5.0) / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0)
    assert samples.mean() == pytest.approx(expected, abs=2e-3)


def test_rayleigh_scatters_as_dipoles_do(context, library):
    values, samples = values_and_samples(context, library, KIND.RAYLEIGH, phases.rayleigh(), 1.0 - 2.0 * half_sines())
    cosines = 1.0 - 2.0 * half_sines()
    np.testing.assert_allclose(values, 3.0 / (16.0 * np.pi) * (1.0 + cosines**2), rtol=1e-5)
    assert (samples**2).mean() == pytest.approx(0.4, abs=1e-4)


@pytest.mark.parametrize("backscatter", [0.005, 0.02, 0.1, 0.3])
@pytest.mark.parametrize("ior", [1.05, 1.33, 1.6, 1.9])
def test_fournier_and_forand_scatter_backward_what_they_are_asked_to(context, library, ior, backscatter):
    _, samples = values_and_samples(
        context, library, KIND.FOURNIER_FORAND, phases.fournier_forand(ior, backscatter), 1.0 - 2.0 * half_sines()
    )
    assert (samples < 0.0).mean() == pytest.approx(backscatter, abs=1e-3)
