# SPDX-License-Identifier: GPL-3.0-or-later
"""Closures of shader nodes against Cycles: radiance under a point light, pixel by pixel."""

import numpy as np
import pytest

from . import closures
from .closures import ABOVE, GRAZING, INSIDE, INSIDE_OUT, THROUGH, View

COLOR = (0.8, 0.5, 0.2)
TINT = (0.4, 0.8, 0.9)
TILTED = tuple((np.array([0.38, -0.2, 0.9]) / np.linalg.norm([0.38, -0.2, 0.9])).tolist())
BENT = tuple((np.array([0.8, -0.8, 0.4]) / np.linalg.norm([0.8, -0.8, 0.4])).tolist())
"""A normal that mirrors most viewers' directions to below the surface."""

EXACT = 0.006
"""Rounding: packed normals, and the place in a pixel's middle hundredth where Cycles looks, at grazing angles."""
TABLES = 0.016
"""Layers hide what lies below by albedo tables of 16 x 16 x 16 values, Cycles' and ours."""
F82_FOR_CONDUCTORS = 0.03
"""Between normal incidence and 82 degrees the F82 curve is not the conductor's."""


both_views = pytest.mark.parametrize("view", [ABOVE, GRAZING], ids=["above", "grazing"])


def brightest_beside(pixels: np.ndarray) -> np.ndarray:
    """The maximum of each pixel and its eight neighbors."""
    square = pixels.reshape(closures.SIZE, closures.SIZE, 3)
    padded = np.pad(square, ((1, 1), (1, 1), (0, 0)), mode="edge")
    size = closures.SIZE
    return np.max([padded[i : i + size, j : j + size] for i in range(3) for j in range(3)], axis=0).reshape(-1, 3)


def assert_alike(
    library, folder, kind: str, view: View, options: dict, inputs: dict, tolerance: float, normal=None, choices=1
) -> None:
    """Every pixel's channels agree within a share of the brightest beside it, or of a fiftieth of all.

    The neighbors count because Cycles looks anywhere in a pixel's middle hundredth.
    """
    points, cycles = closures.by_cycles(kind, view, options, inputs, normal)
    with library.context.moderngl:
        ours = closures.by_closure(library, folder, kind, view, points, options, inputs, normal, choices)
    seen = np.isfinite(points).all(axis=1)
    cycles, ours, brightest = cycles[seen], ours[seen], brightest_beside(cycles)[seen]
    assert len(cycles) > 300 and cycles.max() > 0.0
    if view.camera[2] * view.light[2] < 0.0 and "ior" in inputs:
        # Cycles lights pairs of directions that no microfacet links but one seen from behind.
        cycles = np.where(ours > 0.0, cycles, 0.0)
    error = (ours - cycles) / np.maximum(brightest, 0.02 * cycles.max())
    print(f"{kind} {options} {inputs}: mean {ours.mean() / cycles.mean():.5f} worst {np.abs(error).max():.5f}")
    assert np.abs(error).max() < tolerance
    assert abs(ours.mean() / cycles.mean() - 1.0) < tolerance / 3.0


SINGLE = {
    "diffuse": ("bsdf_diffuse", {}, {"color": COLOR}),
    "diffuse_rough": ("bsdf_diffuse", {}, {"color": COLOR, "roughness": 0.5}),
    "diffuse_roughest": ("bsdf_diffuse", {}, {"color": COLOR, "roughness": 1.0}),
    "subsurface_of_no_size": ("subsurface_scattering", {}, {"color": COLOR, "scale": 0.0}),
    "sheen": ("bsdf_sheen", {"distribution": "MICROFIBER"}, {"color": COLOR, "roughness": 0.3}),
    "sheen_rough": ("bsdf_sheen", {"distribution": "MICROFIBER"}, {"color": COLOR, "roughness": 0.87}),
    "velvet": ("bsdf_sheen", {"distribution": "ASHIKHMIN"}, {"color": COLOR, "roughness": 0.43}),
    "glossy": ("bsdf_glossy", {"distribution": "GGX"}, {"color": COLOR, "roughness": 0.5}),
    "glossy_multi": ("bsdf_glossy", {"distribution": "MULTI_GGX"}, {"color": COLOR, "roughness": 0.7}),
    "glossy_stretched": (
        "bsdf_glossy", {"distribution": "MULTI_GGX"},
        {"color": COLOR, "roughness": 0.5, "anisotropy": 0.6, "rotation": 0.1},
    ),
    "glossy_across": (
        "bsdf_glossy", {"distribution": "GGX"}, {"color": COLOR, "roughness": 0.5, "anisotropy": -0.5, "rotation": 0.2}
    ),
    "glossy_beckmann": ("bsdf_glossy", {"distribution": "BECKMANN"}, {"color": COLOR, "roughness": 0.7}),
    "glossy_beckmann_stretched": (
        "bsdf_glossy", {"distribution": "BECKMANN"},
        {"color": COLOR, "roughness": 0.5, "anisotropy": 0.6, "rotation": 0.1},
    ),
    "glossy_ashikhmin": ("bsdf_glossy", {"distribution": "ASHIKHMIN_SHIRLEY"}, {"color": COLOR, "roughness": 0.7}),
    "glossy_ashikhmin_stretched": (
        "bsdf_glossy", {"distribution": "ASHIKHMIN_SHIRLEY"},
        {"color": COLOR, "roughness": 0.5, "anisotropy": 0.6, "rotation": 0.1},
    ),
    "metal_beckmann": (
        "bsdf_metallic", {"distribution": "BECKMANN", "fresnel_type": "F82"}, {"base_color": COLOR, "roughness": 0.4}
    ),
    "metal": (
        "bsdf_metallic", {"distribution": "MULTI_GGX", "fresnel_type": "F82"},
        {"base_color": COLOR, "edge_tint": (0.3, 0.6, 0.9), "roughness": 0.6, "anisotropy": 0.4, "rotation": 0.1},
    ),
    "principled_metal": (
        "bsdf_principled", {"distribution": "MULTI_GGX"},
        {"base_color": COLOR, "metallic": 1.0, "specular_tint": TINT, "anisotropic": 0.7, "anisotropic_rotation": 0.15},
    ),
    "principled_black": (
        "bsdf_principled", {"distribution": "MULTI_GGX"},
        {"base_color": 0.0, "roughness": 0.7, "specular_ior_level": 0.9, "specular_tint": TINT},
    ),
    "principled_low_ior": (
        "bsdf_principled", {"distribution": "GGX"}, {"base_color": 0.0, "ior": 0.7, "roughness": 0.6}
    ),
}  # fmt: skip


@both_views
@pytest.mark.parametrize("name", SINGLE)
def test_single_lobes(library, folder, name, view):
    kind, options, inputs = SINGLE[name]
    assert_alike(library, folder, kind, view, options, inputs, EXACT)


@pytest.mark.parametrize("view", [ABOVE, THROUGH, INSIDE, INSIDE_OUT], ids=["above", "through", "inside", "inside_out"])
@pytest.mark.parametrize("distribution", ["BECKMANN", "GGX", "MULTI_GGX"])
def test_glass(library, folder, view, distribution):
    inputs = {"color": COLOR, "roughness": 0.5, "ior": 1.5}
    assert_alike(library, folder, "bsdf_glass", view, {"distribution": distribution}, inputs, EXACT)
    if distribution == "BECKMANN":
        return
    inputs = {"base_color": COLOR, "roughness": 0.4, "ior": 1.3, "transmission_weight": 1.0, "specular_tint": TINT}
    assert_alike(library, folder, "bsdf_principled", view, {"distribution": distribution}, inputs, EXACT)


@pytest.mark.parametrize("view", [THROUGH, INSIDE_OUT], ids=["through", "inside_out"])
def test_refraction_and_translucency(library, folder, view):
    inputs = {"color": COLOR, "roughness": 0.4, "ior": 1.4}
    for distribution in ("BECKMANN", "GGX"):
        assert_alike(library, folder, "bsdf_refraction", view, {"distribution": distribution}, inputs, EXACT)
    assert_alike(library, folder, "bsdf_translucent", view, {}, {"color": COLOR}, EXACT)


@both_views
def test_physical_conductor(library, folder, view):
    options = {"distribution": "MULTI_GGX", "fresnel_type": "PHYSICAL_CONDUCTOR"}
    assert_alike(library, folder, "bsdf_metallic", view, options, {"roughness": 0.6}, F82_FOR_CONDUCTORS)


LAYERS = {
    "plain": {},
    "rough": {"roughness": 1.0, "diffuse_roughness": 0.6},
    "tinted": {"specular_ior_level": 0.9, "specular_tint": TINT},
    "dense": {"ior": 2.5, "roughness": 0.7},
    "thin": {"ior": 0.7},
    "sheen": {"sheen_weight": 0.7, "sheen_roughness": 0.4, "sheen_tint": (0.9, 0.6, 0.3)},
    "coat": {"coat_weight": 1.0, "coat_roughness": 0.3, "coat_ior": 1.7, "coat_tint": TINT, "roughness": 0.8},
    "coat_rough": {"coat_weight": 0.5, "coat_roughness": 0.9, "roughness": 0.8},
    "subsurface": {"subsurface_weight": 1.0, "subsurface_scale": 0.0},
}


@pytest.mark.parametrize("view", [ABOVE, GRAZING, INSIDE], ids=["above", "grazing", "inside"])
@pytest.mark.parametrize("distribution", ["GGX", "MULTI_GGX"])
@pytest.mark.parametrize("name", LAYERS)
def test_principled_layers(library, folder, name, distribution, view):
    inputs = {"base_color": COLOR, "roughness": 0.4, **LAYERS[name]}
    assert_alike(library, folder, "bsdf_principled", view, {"distribution": distribution}, inputs, TABLES)


@both_views
def test_all_of_principled(library, folder, view):
    """Six lobes, of which the closure holds three: choices make the mean."""
    inputs = {
        "base_color": COLOR, "metallic": 0.3, "roughness": 0.5, "transmission_weight": 0.4, "coat_weight": 0.6,
        "coat_roughness": 0.2, "sheen_weight": 0.5, "diffuse_roughness": 0.5, "anisotropic": 0.4,
        "specular_tint": (0.9, 0.7, 0.8),
    }  # fmt: skip
    assert_alike(library, folder, "bsdf_principled", view, {"distribution": "MULTI_GGX"}, inputs, TABLES, choices=1000)


MAPPED = {
    "diffuse": ("bsdf_diffuse", {}, {"color": COLOR}),
    "diffuse_rough": ("bsdf_diffuse", {}, {"color": COLOR, "roughness": 0.8}),
    "glossy": ("bsdf_glossy", {"distribution": "GGX"}, {"roughness": 0.3}),
    "glossy_stretched": ("bsdf_glossy", {"distribution": "GGX"}, {"roughness": 0.5, "anisotropy": 0.5}),
    "glass": ("bsdf_glass", {"distribution": "GGX"}, {"roughness": 0.4, "ior": 1.5}),
    "sheen": ("bsdf_sheen", {"distribution": "MICROFIBER"}, {"color": COLOR}),
    "velvet": ("bsdf_sheen", {"distribution": "ASHIKHMIN"}, {"color": COLOR}),
}


@both_views
@pytest.mark.parametrize("name", MAPPED)
def test_normals(library, folder, name, view):
    """A normal off the surface's own, which diffuse light is shadowed for."""
    kind, options, inputs = MAPPED[name]
    assert_alike(library, folder, kind, view, options, inputs, EXACT, TILTED)


def test_translucency_with_a_normal(library, folder):
    assert_alike(library, folder, "bsdf_translucent", THROUGH, {}, {"color": COLOR}, EXACT, TILTED)


@both_views
def test_normals_are_bent_until_they_reflect(library, folder, view):
    inputs = {"roughness": 0.5}
    assert_alike(library, folder, "bsdf_glossy", view, {"distribution": "GGX"}, inputs, EXACT, BENT)


@both_views
def test_layers_with_a_normal(library, folder, view):
    """The coat keeps the surface's normal, the sheen is between both."""
    inputs = {"base_color": COLOR, "coat_weight": 0.5, "coat_roughness": 0.4, "sheen_weight": 0.7}
    assert_alike(library, folder, "bsdf_principled", view, {"distribution": "MULTI_GGX"}, inputs, TABLES, TILTED)


BLACK, RED = {"base_color": 0.0, "thin_film_ior": 1.8}, {"base_color": (0.8, 0.4, 0.3), "thin_film_ior": 1.6}
FILMS = {
    "dielectric": ("bsdf_principled", {}, BLACK),
    "tinted": ("bsdf_principled", {}, BLACK | {"specular_tint": (0.9, 0.5, 0.2), "specular_ior_level": 0.8}),
    "of_the_base_itself": ("bsdf_principled", {}, {"base_color": 0.0, "thin_film_ior": 1.5}),
    "over_a_base": ("bsdf_principled", {}, {"base_color": (0.3, 0.6, 0.8)}),
    "metal": ("bsdf_principled", {}, {**RED, "metallic": 1.0, "specular_tint": (1.0, 0.7, 0.5)}),
    "metal_f82": ("bsdf_metallic", {"fresnel_type": "F82"}, RED),
    "conductor": ("bsdf_metallic", {"fresnel_type": "PHYSICAL_CONDUCTOR"}, {"thin_film_ior": 1.4}),
    "glass": ("bsdf_glass", {}, {"color": 1.0, "thin_film_ior": 1.8}),
    "transmission": ("bsdf_principled", {}, {"base_color": (0.9, 0.8, 0.5), "transmission_weight": 1.0}),
}


def assert_film_alike(library, folder, name: str, view: View, distribution: str, roughness: float, thickness: float):
    """The mean of each channel agrees within 1 %, or within a fifth of that of the brightest."""
    kind, options, inputs = FILMS[name]
    options = options | {"distribution": distribution}
    inputs = inputs | {"roughness": roughness, "thin_film_thickness": thickness}
    points, cycles = closures.by_cycles(kind, view, options, inputs)
    with library.context.moderngl:
        ours = closures.by_closure(library, folder, kind, view, points, options, inputs)
    seen = np.isfinite(points).all(axis=1)
    ours, cycles = ours[seen], cycles[seen]
    if view.camera[2] * view.light[2] < 0.0:  # as in assert_alike
        cycles = np.where(ours > 0.0, cycles, 0.0)
    ours, cycles = ours.mean(axis=0), cycles.mean(axis=0)
    error = (ours - cycles) / np.maximum(cycles, 0.2 * cycles.max())
    print(f"film {name} {roughness} {thickness} {distribution}: {np.round(ours / cycles, 4)}, off {np.round(error, 4)}")
    assert np.abs(error).max() < 0.01


@both_views
@pytest.mark.parametrize("distribution", ["GGX", "MULTI_GGX"])
@pytest.mark.parametrize(("roughness", "thickness"), [(0.1, 400.0), (0.3, 200.0), (0.6, 400.0), (0.6, 700.0)])
@pytest.mark.parametrize("name", FILMS)
def test_thin_films(library, folder, name, roughness, thickness, distribution, view):
    """Each microfacet has the colors of its own angle."""
    assert_film_alike(library, folder, name, view, distribution, roughness, thickness)


@pytest.mark.parametrize("view", [THROUGH, INSIDE, INSIDE_OUT], ids=["through", "inside", "inside_out"])
@pytest.mark.parametrize("roughness", [0.3, 0.6])
@pytest.mark.parametrize("name", ["glass", "transmission"])
def test_light_that_thin_films_pass(library, folder, name, roughness, view):
    """On its way in and out of glass."""
    assert_film_alike(library, folder, name, view, "GGX", roughness, 400.0)
