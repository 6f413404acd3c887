# SPDX-License-Identifier: GPL-3.0-or-later
"""Glass that refracts each wavelength by an index of its own: a prism against Snell's law, and white light."""

import dataclasses

import numpy as np
import pytest
import scenes
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.common.records.photon_paths import PhotonFlag
from rppm_addon.materials import dispersion
from rppm_addon.materials.albedo_tables import fresnel
from rppm_addon.scene import Camera, DirectLight, Instance, Light, LightKind, Material, RenderSettings, Scene, World

INDEX, ABBE_NUMBER = 1.6, 30.0
WEDGE = np.radians(30.0)
OUTWARD = -np.array([np.sin(WEDGE), 0.0, np.cos(WEDGE)])
"""Outward normal of the wedge's lower face."""


def glass(kind: LobeKind = LobeKind.GLASS, **inputs: float) -> Material:
    return dataclasses.replace(material("glass", Lobe(kind, ior=INDEX, **inputs)), abbe_number=ABBE_NUMBER)


def prism(material_: Material, camera: Camera | None = None, **settings: object) -> Scene:
    """A wedge over a floor, in a sun's light straight from above: that leaves through its lower face, which slants."""
    slope = np.tan(WEDGE)
    floor = scenes.rectangle("floor", (-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0))
    top = scenes.rectangle("top", (-1, -1, 3), (1, -1, 3), (1, 1, 3), (-1, 1, 3))
    bottom = scenes.rectangle("bottom", (-1, 1, 2 + slope), (1, 1, 2 - slope), (1, -1, 2 - slope), (-1, -1, 2 + slope))
    instances = [Instance(index, np.eye(4), [kind]) for index, kind in enumerate((0, 1, 1))]
    camera = camera or Camera(scenes.looking((0, -3, 1), (0, 0, 0)), (-0.5, 0.5, -0.5, 0.5), 8, 8)
    sun = Light("sun", LightKind.SUN, scenes.looking((0, 0, 9), (0, 0.001, 0)), np.full(3, 1.0))
    materials = [scenes.diffuse(0.5, 0.5, 0.5), material_]
    return Scene(camera, [floor, top, bottom], instances, materials, [sun], settings=RenderSettings(**settings))


@pytest.mark.parametrize("kind", [LobeKind.GLASS, pytest.param(LobeKind.PRINCIPLED, marks=pytest.mark.long)])
def test_a_prism_bends_each_wavelength_by_its_own_index(mapper, kind):
    inputs = {"transmission_weight": 1.0} if kind is LobeKind.PRINCIPLED else {}
    settings = {"photons": 16384, "photon_path_length": 3, "direct_light": DirectLight.PHOTONS}
    mapper.build(prism(glass(kind, **inputs), **settings))
    mapper.iterate()
    photons = mapper.read_photons()[2]
    flags = photons["flags"] & (PhotonFlag.STORED | PhotonFlag.AFTER_ROUGH_BOUNCE)
    through = photons[flags == PhotonFlag.STORED]
    assert len(through) > 500
    # From the angle to the normal of the lower face, the index; from the index, the wavelength and its color.
    outward = -np.array([np.sin(WEDGE), 0.0, np.cos(WEDGE)])
    index = np.linalg.norm(np.cross(-through["direction"].astype(float), outward), axis=1) / np.sin(WEDGE)
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
    settings = {"photons": 16384, "photon_path_length": 3, "direct_light": DirectLight.PHOTONS}
    mapper.build(prism(material("glasses", *glasses), **settings))
    mapper.iterate()
    photons = mapper.read_photons()[2]
    flags = photons["flags"] & (PhotonFlag.STORED | PhotonFlag.AFTER_ROUGH_BOUNCE)
    through = photons[flags == PhotonFlag.STORED]
    colors, channels = through["flux"] > 0.0, through["flux"].argmax(axis=1)
    counts = np.bincount(channels, minlength=3)
    assert (colors.sum(axis=1) == 1).all() and counts.min() > 100
    index = np.linalg.norm(np.cross(through["direction"].astype(float), OUTWARD), axis=1) / np.sin(WEDGE)
    np.testing.assert_allclose(index, indices[channels], rtol=1e-3)


def test_white_stays_white(mapper):
    """A ball in a white world, which refracts all light twice: each pixel has seen all wavelengths evenly."""
    ball = scenes.sphere("ball")
    camera = Camera(scenes.looking((0, -5, 0), (0, 0, 0)), (-0.1, 0.1, -0.1, 0.1), 24, 24)
    settings = RenderSettings(photons=64, camera_path_length=4, filter_width=0.0)
    materials = [glass(LobeKind.REFRACTION)]
    scene = Scene(camera, [ball], [Instance(0, np.eye(4), [0])], materials, [], World(np.ones(3)), settings=settings)
    mapper.build(scene)
    mapper.iterate()
    colors = mapper.film.read_radiance()[..., :3].reshape(-1, 3).astype(float)
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
    mapper.build(prism(dispersing, photons=16384, photon_path_length=3, direct_light=DirectLight.PHOTONS))
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
