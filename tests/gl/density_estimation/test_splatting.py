# SPDX-License-Identifier: GPL-3.0-or-later
"""Direct and indirect splatting against all pairs of photons and importons in NumPy."""

import numpy as np
import pytest
import scenes
from packed_normals import unpack
from rendering import iterated, radiance_of

from rppm_addon.integrator.common.records.importons import IMPORTON, PHOTON_FACTOR_SHIFT, GatherFlag
from rppm_addon.integrator.common.records.photon_paths import PHOTON_FLAG_BITS, PhotonFlag
from rppm_addon.integrator.density_estimation import splat_sums, splatting
from rppm_addon.integrator.density_estimation.density_estimator import DensityEstimator
from rppm_addon.scene import DensityEstimation, DirectLight

DISK_FACTOR = 3.0
"""Factor of the least radius in shaders/common/disk_radius.glsl."""
ROUTES = DensityEstimation.RASTERIZED, DensityEstimation.GRID


def brute_force(importons, photons, wide):
    """(n, 3) radiance of diffuse importons: Eq. 1 over all pairs, with the side and plane tests, each photon within its
    footprint's radius.

    Importons of paths that gather take no indirect photons. Diffused ones count as often as points of the disk were
    tried, which is taken from the importon.
    """
    stored = photons[(photons["flags"] & PhotonFlag.STORED) != 0]
    normals, flux = unpack(stored["geometric_normal"]), stored["flux"].astype(np.float64)
    diffused, indirect = (
        (stored["flags"] & flag) != 0 for flag in (PhotonFlag.AFTER_ROUGH_BOUNCE, PhotonFlag.INDIRECT)
    )
    footprints = (stored["flags"] & ~np.uint32((1 << PHOTON_FLAG_BITS) - 1)).view(np.float32)
    result = np.zeros((len(importons), 3))
    for index, importon in enumerate(importons):
        if importon["radius"] <= 0:
            continue
        offset = (stored["position"] - importon["position"]).astype(np.float64)
        disk = min(DISK_FACTOR * importon["minimum_radius"], importon["radius"])
        clear = np.where(footprints > 0, np.clip(footprints, importon["minimum_radius"], importon["radius"]), disk)
        radius = np.where(diffused, max(disk, wide), clear).astype(np.float64)
        distance2 = (offset**2).sum(1)
        geometric, shading = unpack(importon["geometric_normal"][None])[0], unpack(importon["diffuse_normal"][None])[0]
        near = (distance2 < radius**2) & (normals @ geometric > 0.7) & (abs(offset @ geometric) <= 0.35 * radius)
        near &= (stored["direction"] @ shading > 0) & ~shut_off(stored, normals, offset, geometric, radius)
        if importon["gathers"] & GatherFlag.ORIGIN:
            near &= ~indirect
        cosine = (stored["direction"][near] * normals[near]).sum(1)
        correction = np.minimum(abs(stored["direction"][near] @ shading) / np.maximum(abs(cosine), 1e-5), 4)
        kernel = 2 * (1 - distance2[near] / radius[near] ** 2) / (np.pi * radius[near] ** 2)
        kernel *= np.where(diffused[near], max(importon["gathers"] >> PHOTON_FACTOR_SHIFT, 1), 1)
        result[index] = importon["diffuse"] * (flux[near] * (kernel * correction)[:, None]).sum(0)
    return result


def shut_off(
    photons: np.ndarray, normals: np.ndarray, offset: np.ndarray, geometric: np.ndarray, radius: np.ndarray
) -> np.ndarray:
    """is_shut_off of surface_tolerance.glsl, for photons that arrive on an importon's side."""
    away = np.minimum(photons["distance"], 1e20).astype(np.float64)  # of suns infinite
    height, origin = offset @ geometric, offset @ geometric + away * (photons["direction"] @ geometric)
    sheets = np.maximum(height, (offset * normals).sum(1)) < 1e-4 * radius
    return sheets & (origin < 0.01 * abs(height) + 1e-4 * (away + radius))


def diffuse_room(**settings):
    fixed = {
        "photons": 4096, "direct_light": DirectLight.PHOTONS, "radius_scale": 60.0, "filter_width": 0.0,
        "density_estimation": DensityEstimation.RASTERIZED,
    }  # fmt: skip
    scene = scenes.room(24, **{"use_final_gather": False, **fixed, **settings})
    scene.instances = scene.instances[:5] + scene.instances[6:]  # the mirror stays
    return scene


def importons_of_segments(mapper, monkeypatch, count: int) -> list[np.ndarray]:
    """(count,) importons of each segment that is to come, with radius 0 where the path has ended before."""
    found = []
    splat = DensityEstimator.splat

    def watched(estimator, taking, timers) -> None:
        importons = mapper.stages.importons.importons.read(IMPORTON.dtype, count).copy()
        importons["radius"][np.setdiff1d(np.arange(count), mapper.stages.importons.active.read())] = 0.0
        found.append(importons)
        splat(estimator, taking, timers)

    monkeypatch.setattr(DensityEstimator, "splat", watched)
    return found


@pytest.mark.parametrize("route", ROUTES)
def test_direct_splats_are_all_pairs(mapper, route):
    iterated(mapper, diffuse_room(camera_path_length=1, density_estimation=route))
    count = 24 * 24
    importons = mapper.stages.importons.importons.read(IMPORTON.dtype, count)
    expected = brute_force(importons, mapper.read_photons().ravel(), mapper.splat_radii[1])
    got = mapper.film.read_radiance().reshape(-1, 4)[:, :3]
    light = mapper.stages.importons.radiances.read(np.float32, 4 * count).reshape(-1, 4)[:, :3]
    assert (expected > 0).any(axis=1).mean() > 0.8
    np.testing.assert_allclose(got - light, expected, rtol=2e-3, atol=2e-4 * expected.max())


@pytest.mark.parametrize("resolution", [16, 32, 128])
@pytest.mark.parametrize("center", [None, (0.1, 0.999, 0.02), (0.0, 0.0, 0.0), (-0.99999, 0.2, -0.99999)])
def test_indirect_splats_are_all_pairs(mapper, monkeypatch, resolution, center):
    """Also with the cubemap's center on a wall, in a corner and on the planes between its faces."""
    monkeypatch.setattr(splatting, "_CUBE_RESOLUTION", resolution)
    count = 24 * 24
    gathered = []
    for segments in (1, 2):  # the sums hold the direct splats, too
        mapper.build(diffuse_room(camera_path_length=segments))
        if center is not None:
            mapper.device_scene.acceleration.center = np.array(center)
        seen = importons_of_segments(mapper, monkeypatch, count)
        mapper.iterate()
        gathered.append(mapper.stages.density_estimator.sums.read(count)[:, 0])
    importons = seen[1]  # those seen in the mirror
    expected = brute_force(importons, mapper.read_photons().ravel(), mapper.splat_radii[1])
    got = (gathered[1] - gathered[0]) * mapper.stages.density_estimator.sums.quantum
    assert (expected > 0).any(axis=1).sum() > 15
    np.testing.assert_allclose(got, expected, rtol=2e-3, atol=2e-4 * expected.max())


@pytest.mark.parametrize("route", ROUTES)
def test_gathering_splats_are_all_pairs(mapper, monkeypatch, route):
    """First hits take what came straight or by the mirror; where the gathering rays end, all photons count."""
    mapper.build(diffuse_room(camera_path_length=2, use_final_gather=True, density_estimation=route))
    count = 24 * 24
    seen = importons_of_segments(mapper, monkeypatch, count)
    mapper.iterate()
    first, last = seen[:2]
    photons, wide = mapper.read_photons().ravel(), mapper.splat_radii[1]
    assert (first["gathers"][first["radius"] > 0] == GatherFlag.ORIGIN).all()
    parts = [brute_force(importons, photons, wide) for importons in (first, last)]
    sums = mapper.stages.density_estimator.sums
    got = sums.read(count) * sums.quantum
    found = (last["gathers"][:, None] & GatherFlag.HIT) != 0
    assert (last["gathers"] >> PHOTON_FACTOR_SHIFT).max() > 1  # of some disks a part lies off the surface
    assert all((part > 0).any(axis=1).mean() > 0.5 for part in parts)
    # What the ray finds is summed apart; behind the mirror the last segment is the first that stores.
    for place, expected in enumerate((parts[0] + np.where(found, 0, parts[1]), np.where(found, parts[1], 0))):
        np.testing.assert_allclose(got[:, place], expected, rtol=2e-3, atol=2e-4 * expected.max())


def gathered_picture(mapper, **settings) -> np.ndarray:
    return radiance_of(mapper, diffuse_room(camera_path_length=2, **settings), 2)[..., :3].astype(np.float64)


@pytest.mark.parametrize("route", ROUTES)
@pytest.mark.parametrize("shift", [12, 40])
def test_sums_do_not_depend_on_what_they_count_in(mapper, monkeypatch, shift, route):
    """Coarse quanta round by their share only; fine ones fill the high words."""
    expected = gathered_picture(mapper, density_estimation=route)
    monkeypatch.setattr(splat_sums, "_PHOTON_QUANTA", 1 << shift)
    got = gathered_picture(mapper, density_estimation=route)
    assert (mapper.stages.density_estimator.sums.read(24 * 24) >= 1 << 32).any() == (shift == 40)
    np.testing.assert_allclose(got, expected, rtol=1e-6, atol=2.0 ** -min(shift, 20) * expected.mean())


def test_splat_roulette_keeps_the_mean(mapper):
    """Half of the pairs are left out and the others count twice: the picture's mean stays, its noise grows."""
    full = gathered_picture(mapper)
    halves = [gathered_picture(mapper, use_splat_roulette=True, seed=0) for _ in range(2)]
    assert (halves[0] == halves[1]).all()
    assert (abs(halves[0] - full) > 0.01 * full.mean()).mean() > 0.5
    assert halves[0].mean() == pytest.approx(full.mean(), rel=0.01)
