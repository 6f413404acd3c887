# SPDX-License-Identifier: GPL-3.0-or-later
"""Colors of wavelengths, and indices of refraction by them."""

import numpy as np
import pytest
from support.graphs import surface_graph

from rppm_addon.materials import dispersion
from rppm_addon.materials.colorimetry import COLOR_MATCHING, WAVELENGTHS
from rppm_addon.materials.compiler.compiler import compile_graph
from rppm_addon.materials.dispersion import LINE_C, LINE_D, LINE_F, index_shift


def test_the_mean_of_all_wavelengths_is_white():
    colors = dispersion.table()[:, :3].astype(float)
    np.testing.assert_allclose(0.5 * (colors[1:] + colors[:-1]).mean(axis=0), 1.0, atol=1e-6)
    assert colors.min() >= 0.0 and colors.sum(axis=1).max() < 3.2  # no path is much brighter than another
    # From violet to red: blue falls, red rises, and green is between.
    assert colors[4].argmax() == 2 and colors[-4].argmax() == 0 and colors[np.argmax(colors[:, 1]), 0] < 0.1


def test_the_observer_is_that_of_1931():
    np.testing.assert_allclose(dispersion.color_matching(WAVELENGTHS), COLOR_MATCHING, atol=0.035)


def test_wavelengths_ascend_and_none_is_left_out():
    wavelengths = dispersion.wavelengths()
    assert (np.diff(wavelengths) > 0.0).all()
    assert wavelengths[[0, -1]] == pytest.approx([dispersion.SHORTEST, dispersion.LONGEST])


def test_the_abbe_number_is_that_of_its_definition():
    index, abbe_number = 1.6, 36.0
    at_f, at_d, at_c = index + (index - 1) / abbe_number * index_shift(np.array([LINE_F, LINE_D, LINE_C]))
    assert at_d == index and (at_d - 1) / (at_f - at_c) == pytest.approx(abbe_number)


@pytest.mark.parametrize(("wavelength", "index"), [(404.66e-9, 1.53024), (435.83e-9, 1.52668), (706.52e-9, 1.51289)])
def test_crown_glass_has_the_indices_of_its_maker(wavelength, index):
    """N-BK7: n_d 1.51680, V_d 64.17; its lines h, g and r by Schott's data sheet."""
    found = 1.5168 + 0.5168 / 64.17 * index_shift(np.array([wavelength]))[0]
    assert found == pytest.approx(index, abs=7e-4)


def test_only_what_refracts_has_a_program_of_its_own():
    graph = surface_graph("bsdf_diffuse")
    assert compile_graph(graph, abbe_number=30.0) == compile_graph(graph)
    graph = surface_graph("bsdf_glass")
    dispersing = compile_graph(graph, abbe_number=30.0)
    assert dispersing.text != compile_graph(graph).text
    assert dispersing.text == compile_graph(graph, abbe_number=64.0).text
    assert set(dispersing.constants) - set(compile_graph(graph).constants) == {1 / 30}


def test_a_glass_is_found_by_the_indices_of_three_colors():
    """Light of the channels has in the mean the index of the table, by which it is found again."""
    values = dispersion.table().astype(float)
    index, abbe_number = 1.62, 36.0
    by_wavelength = index + (index - 1.0) / abbe_number * values[:, 3:]
    of_channels = dispersion.mean(values[:, :3] * by_wavelength)
    assert of_channels[0] < of_channels[1] < of_channels[2]
    assert dispersion.fitted(of_channels) == pytest.approx((index, abbe_number), rel=1e-5)
    assert dispersion.fitted(of_channels[::-1])[1] < 0.0
    assert dispersion.fitted(np.full(3, 1.5)) == pytest.approx((1.5, float("inf")))
