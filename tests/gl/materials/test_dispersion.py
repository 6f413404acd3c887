# SPDX-License-Identifier: GPL-3.0-or-later
"""Glass that refracts each wavelength by an index of its own: a prism against Snell's law, and white light."""

import dataclasses

import numpy as np
import pytest
import scenes
from rendering import iterated, radiance_of
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.common.records.photon_paths import PhotonFlag
from rppm_addon.materials import dispersion
from rppm_addon.materials.albedo_tables import fresnel
from rppm_addon.scene import DirectLight, Light, LightKind, Material, Scene, World

INDEX, ABBE_NUMBER = 1.6, 30.0
WEDGE = np.radians(30.0)
OUTWARD = -np.array([np.sin(WEDGE), 0.0, np.cos(WEDGE)])
"""Outward normal of the wedge's lower face."""


def glass(kind: LobeKind = LobeKind.GLASS, **inputs: float) -> Material:
    return dataclasses.replace(material("glass", Lobe(kind, ior=INDEX, **inputs)), abbe_number=ABBE_NUMBER)


def prism(glass: Material) -> Scene:
    """A wedge over a floor, in a sun's light straight from above: that leaves through its lower face, which slants."""
    slope = np.tan(WEDGE)
    bottom = scenes.rectangle("bottom", (-1, 1, 2 + slope), (1, 1, 2 - slope), (1, -1, 2 - slope), (-1, -1, 2 + slope))
    parts = (scenes.square("floor", 9.0), scenes.diffuse(0.5, 0.5, 0.5)), (scenes.square("top", 1.0, 3.0), glass)
    sun = Light("sun", LightKind.SUN, scenes.looking((0, 0, 9), (0, 0.001, 0)), np.full(3, 1.0))
    scene = scenes.scene_of(
        scenes.camera((0, -3, 1), (0, 0, 0), 0.5, 8), *parts, (bottom, glass), lights=[sun],
        photons=16384, photon_path_length=3, direct_light=DirectLight.PHOTONS,
    )  # fmt: skip
    scene.instances[2].materials = [1]  # both faces are of one body
    return scene


def refracted(mapper, glass: Material) -> tuple[np.ndarray, np.ndarray]:
    """Photons that came through the prism, and the index that bent them, by their angle to its lower face's normal."""
    photons = iterated(mapper, prism(glass)).read_photons()[2]
    flags = photons["flags"] & (PhotonFlag.STORED | PhotonFlag.AFTER_ROUGH_BOUNCE)
    through = photons[flags == PhotonFlag.STORED]
    sines = np.linalg.norm(np.cross(through["direction"].astype(float), OUTWARD), axis=1)
    return through, sines / np.sin(WEDGE)


@pytest.mark.parametrize("kind", [LobeKind.GLASS, pytest.param(LobeKind.PRINCIPLED, marks=pytest.mark.long)])
def test_a_prism_bends_each_wavelength_by_its_own_index(mapper, kind):
    inputs = {"transmission_weight": 1.0} if kind is LobeKind.PRINCIPLED else {}
    through, index = refracted(mapper, glass(kind, **inputs))
    assert len(through) > 500
    # From the index the wavelength and its color.
    table = dispersion.table().astype(float)
    shift = (index - INDEX) * ABBE_NUMBER / (INDEX - 1)
    assert shift.min() < table[-8, 3] and shift.max() > table[8, 3]
    colors = np.stack([np.interp(shift, table[::-1, 3], channel) for channel in table[::-1, :3].T], axis=1)
    found = through["flux"] / through["flux"].sum(axis=1, keepdims=True)
    np.testing.assert_allclose(found, colors / colors.sum(axis=1, keepdims=True), atol=0.01)


def test_three_glasses_are_three_indices(mapper):
    """Glasses of red, green and blue that are added: a photon is of one color from the first of them on, and bends by
    that one's index at the second face, too."""
    indices = np.array([1.5, 1.6, 1.7])
    glasses = [Lobe(LobeKind.GLASS, color=color, ior=ior) for color, ior in zip(np.eye(3), indices, strict=True)]
    through, index = refracted(mapper, material("glasses", *glasses))
    colors, channels = through["flux"] > 0.0, through["flux"].argmax(axis=1)
    assert (colors.sum(axis=1) == 1).all() and np.bincount(channels, minlength=3).min() > 100
    np.testing.assert_allclose(index, indices[channels], rtol=1e-3)


def test_white_stays_white(mapper):
    """A ball in a white world, which refracts all light twice: each pixel has seen all wavelengths evenly."""
    camera, ball = scenes.camera((0, -5, 0), (0, 0, 0), 0.1, 24), (scenes.sphere("ball"), glass(LobeKind.REFRACTION))
    settings = {"photons": 64, "camera_path_length": 4, "filter_width": 0.0}
    scene = scenes.scene_of(camera, ball, world=World(np.ones(3)), **settings)
    colors = radiance_of(mapper, scene)[..., :3].reshape(-1, 3).astype(float)
    np.testing.assert_allclose(colors.sum(axis=1), 3.0, atol=0.1)
    assert (colors.std(axis=0) > 0.5).all()  # each path has its own
    for _ in range(15):
        mapper.iterate()
    colors = mapper.film.read_radiance()[..., :3].reshape(-1, 3).astype(float)
    assert (colors.std(axis=0) < 0.1).all()
    error = colors.std(axis=0) / np.sqrt(len(colors))
    np.testing.assert_array_less(abs(colors.mean(axis=0) - 1.0), 4 * error)


def test_reflected_and_refracted_light_are_white_together(mapper):
    """Photons that came to the upper face are compared in channels apart, within four times their standard error: by
    chance, a twentieth of them is reflected."""
    dispersing = dataclasses.replace(glass(), abbe_number=8.0)
    mapper.build(prism(dispersing))
    arrived, left, escaped = np.zeros(3), np.zeros(3), np.zeros(3)
    for _ in range(8):
        mapper.iterate()
        first, second = mapper.read_photons()[:2]
        struck = (first["position"][:, 2] > 1.0) & (first["flags"] & PhotonFlag.ACTIVE != 0)
        arrived += first["flux"][struck].sum(axis=0, dtype=float)
        left += second["flux"][struck].sum(axis=0, dtype=float)
        escaped += second["flux"][struck & (second["flags"] & PhotonFlag.ESCAPED != 0)].sum(axis=0, dtype=float)
    share = struck.mean()
    error = np.sqrt(0.05 / (8 * share * len(struck)))
    table = dispersion.table().astype(float)
    index = INDEX + (INDEX - 1) / 8.0 * table[:, 3]
    reflectance = fresnel(np.array(1.0), index)
    # What is refracted is over the squared index.
    expected = dispersion.mean(table[:, :3] * (reflectance + (1 - reflectance) / index**2)[:, None])
    np.testing.assert_allclose(left / arrived, expected, atol=4 * error)
    # More of blue light is reflected, as its index is higher.
    expected = dispersion.mean(table[:, :3] * reflectance[:, None]) / dispersion.mean(reflectance)
    assert expected[2] - expected[0] > 0.1
    np.testing.assert_allclose(escaped / escaped.mean(), expected / expected.mean(), atol=0.03)
