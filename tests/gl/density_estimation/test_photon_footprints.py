# SPDX-License-Identifier: GPL-3.0-or-later
"""Footprints of photons against the rays beside them, traced in NumPy."""

import numpy as np
import pytest
import scenes
from rendering import iterated
from test_footprints import GROUND, Plane, chain_materials, mirroring_ball, trace

from rppm_addon.integrator.common.records.photon_paths import PHOTON_FLAG_BITS, PhotonFlag
from rppm_addon.integrator.density_estimation.radii import EXPECTED_CAUSTIC_PHOTONS
from rppm_addon.scene import DirectLight, Light, LightKind, Mesh

STRENGTH = 50.0
BLUR_FRACTION = 0.5
STEP = 1e-4
ROUNDED = 2.0**-13
"""Radii keep 14 bits, rounded down."""


def traced_photons(mapper, light: Light, surfaces: list, meshes: list[Mesh]) -> tuple[np.ndarray, np.ndarray]:
    """(segments, n) photons that came to the chain's last surface, which alone stores them, and the radii of their
    footprints there, (n,) meters."""
    parts = zip(meshes, chain_materials(surfaces), strict=True)
    settings = {"photons": 8192, "photon_path_length": len(surfaces), "direct_light": DirectLight.PHOTONS}
    iterated(mapper, scenes.scene_of(scenes.camera((0, 0, 9), (0, 0.1, 0), 0.5, 8), *parts, lights=[light], **settings))
    photons = mapper.read_photons()
    there = photons[:, (photons[-1]["flags"] & PhotonFlag.STORED) != 0]
    return there, (there[-1]["flags"] & ~np.uint32((1 << PHOTON_FLAG_BITS) - 1)).view(np.float32)


def landed_area(origin: np.ndarray, rays: np.ndarray, surfaces: list, photons: np.ndarray) -> np.ndarray:
    """(n,) where photons landed, the area that rays cover by the solid angle between them, m^2/sr; NaN of those that
    came another way."""
    aside = np.cross(rays, [0.6, 0.48, 0.64])
    aside /= np.linalg.norm(aside, axis=-1, keepdims=True)
    across = np.cross(rays, aside)
    beside = rays + STEP * np.stack([0 * aside, aside, -aside, across, -across])
    beside /= np.linalg.norm(beside, axis=-1, keepdims=True)
    with np.errstate(invalid="ignore"):
        landed = trace(np.broadcast_to(origin, beside.shape), beside, surfaces)[0]
    area = np.linalg.norm(np.cross(landed[1] - landed[2], landed[3] - landed[4]), axis=-1) / (2 * STEP) ** 2
    return np.where(np.linalg.norm(photons["position"] - landed[0], axis=-1) < 0.01, area, np.nan)


MIRROR = Plane((3, 0, 2), (-1, 0.4, -0.9))
ENTRY, EXIT = Plane((0, 0, 1.5), (0, 0, 1), 1.5), Plane((0, 0, 0.5), (0, 0, 1), 1 / 1.5)
BALL, BALL_MESH = mirroring_ball()
WIDE_GROUND = GROUND.rectangle("ground", 40)
BY_MIRROR = [MIRROR, GROUND], [MIRROR.rectangle("mirror", 1.5), WIDE_GROUND]
SLAB = [ENTRY.rectangle("entry", 6), EXIT.rectangle("exit", 6, flip=True), GROUND.rectangle("ground", 6)]
CHAINS = {
    "straight": ([GROUND], [GROUND.rectangle("ground", 9)], 2e-3),
    "mirror": (*BY_MIRROR, 2e-3),
    "slab": ([ENTRY, EXIT, GROUND], SLAB, 5e-3),
    "ball": ([BALL, GROUND], [BALL_MESH, WIDE_GROUND], 0.03),  # facets slant up to 0.4 degrees off the sphere
}


@pytest.mark.parametrize(("surfaces", "meshes", "tolerance"), CHAINS.values(), ids=CHAINS)
def test_a_footprint_holds_as_many_photons_as_it_should(mapper, surfaces, meshes, tolerance):
    """By the area over which a photon's solid angle comes to be spread."""
    position = np.array([0.0, 0.0, 2.0])
    light = Light("light", LightKind.POINT, scenes.placed(*position), np.full(3, STRENGTH))
    photons, radii = traced_photons(mapper, light, surfaces, meshes)
    solid_angles = photons[0]["flux"][:, 0].astype(float) / STRENGTH
    area = landed_area(position, -photons[0]["direction"].astype(float), surfaces, photons[-1]) * solid_angles
    came = np.isfinite(area) & (area > 0) & (area < 1.0)
    assert came.sum() > 50
    expected = np.sqrt(EXPECTED_CAUSTIC_PHOTONS / np.pi * area[came])
    np.testing.assert_allclose(radii[came], expected, rtol=tolerance + ROUNDED)


def test_a_large_light_blurs_footprints(mapper):
    """By half of what a pinhole at the first hit shows of it."""
    half = 0.5
    light = Light("light", LightKind.AREA, scenes.placed(0, 0, 2), np.full(3, STRENGTH), size=(2 * half, 2 * half))
    light.matrix[:3, :3] = np.array([[0, 0, -1], [0, 1, 0], [1, 0, 0]])  # toward the mirror
    photons, radii = traced_photons(mapper, light, *BY_MIRROR)
    rays = -photons[0]["direction"].astype(float)
    solid_angles = photons[0]["flux"][:, 0].astype(float) / (STRENGTH * (2 * half) ** 2 * rays[:, 0])
    ways = [photons[0]["position"][:, 0] / rays[:, 0]]  # from the plane x = 0
    ways.append(np.linalg.norm(photons[1]["position"] - photons[0]["position"].astype(float), axis=-1))
    area = solid_angles * (ways[0] + ways[1]) ** 2 / abs(photons[1]["direction"][:, 2])
    blur = BLUR_FRACTION * half * ways[1] / ways[0]
    assert len(radii) > 50 and (blur**2 > EXPECTED_CAUSTIC_PHOTONS / np.pi * area).any()
    np.testing.assert_allclose(radii, np.sqrt(EXPECTED_CAUSTIC_PHOTONS / np.pi * area + blur**2), rtol=5e-3)


def test_a_suns_photons_stay_as_far_apart_as_they_leave(mapper):
    """In a plane mirror they do but for the slant of what they hit and the disk of the sun."""
    angle = 0.02
    toward = np.array([3.0, 0.0, -2.0]) / np.sqrt(13)
    light = Light("sun", LightKind.SUN, scenes.looking((0, 0, 4), tuple(toward + [0, 0, 4])), np.full(3, STRENGTH))
    light.sun_angle = angle
    photons, radii = traced_photons(mapper, light, *BY_MIRROR)
    area = photons[0]["flux"][:, 0].astype(float) / STRENGTH / abs(photons[1]["direction"][:, 2])
    way = np.linalg.norm(photons[1]["position"] - photons[0]["position"].astype(float), axis=-1)
    blur = BLUR_FRACTION * np.sin(angle / 2) * way
    assert len(radii) > 50
    np.testing.assert_allclose(radii, np.sqrt(EXPECTED_CAUSTIC_PHOTONS / np.pi * area + blur**2), rtol=5e-3)
