# SPDX-License-Identifier: GPL-3.0-or-later
"""Photon grids by themselves: no photon within reach is missed, wherever it lies and however many there are."""

import numpy as np
import pytest
from support.iteration_block import iteration_buffer

from rppm_addon.gl.buffers.buffers import GrowingBuffer
from rppm_addon.integrator.common.active_paths import ActivePaths
from rppm_addon.integrator.common.records.camera_paths import CAMERA_PATH
from rppm_addon.integrator.common.records.importons import IMPORTON, GatherFlag
from rppm_addon.integrator.common.records.photon_paths import PHOTON_FLAG_BITS, PHOTON_ORIGIN, PhotonFlag
from rppm_addon.integrator.common.records.photons import PHOTON, PHOTON_CONTRIBUTED
from rppm_addon.integrator.common.stage_sizes import StageSizes
from rppm_addon.integrator.density_estimation.photon_grid import PhotonGrid
from rppm_addon.integrator.density_estimation.radii import SplatRadii
from rppm_addon.integrator.density_estimation.splat_sums import SplatSums
from rppm_addon.integrator.density_estimation.stored_photons import (
    PhotonList,
    SplatTargets,
    StoredPhotons,
)

UP = 0
"""The packed unit vector (0, 0, 1)."""


class Device:
    """Photons and importons on a floor, all facing up, and the grid that they meet by."""

    def __init__(self, context, library) -> None:
        self._context, self._library = context, library

    def gather(
        self, photons: np.ndarray, importons: np.ndarray, radii: SplatRadii
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(photons,) bool of those that contributed, (importons,) global photons taken, (importons,) bool of those
        whose sums are more than 0."""
        buffers = [
            GrowingBuffer(self._context, name) for name in ("photons", "importons", "photon origins", "range", "paths")
        ]
        directions, whole = PHOTON_ORIGIN.zeros(len(photons)), np.uint32([0, len(photons)])
        paths = CAMERA_PATH.zeros(len(importons))
        for buffer, array in zip(buffers, (photons, importons, directions, whole, paths), strict=True):
            buffer.upload(array)
        sizes = StageSizes(len(importons), 1, photons=len(photons), photon_segments=1)
        listed = PhotonList(self._context, self._library, sizes)
        blocks = dict(zip(("Photons", "PhotonOrigins", "PhotonRange"), (b.buffer for b in (buffers[0], *buffers[2:4]))))
        listed.collect(blocks, len(photons), takes_direct=True)
        sums = SplatSums(self._context, self._library, sizes)
        sums.count_in(1e-6, 0, 1)
        sums.clear()
        iteration = iteration_buffer(self._context, photon_flux=1.0, wide_radius=radii.wide)
        grid = PhotonGrid(self._context, self._library, sizes)
        stored = StoredPhotons(
            buffers[0].buffer, listed.buffer, listed.count, listed.count - listed.global_photon_count,
            listed.global_photon_count, listed.indirect_count,
            buffers[2].buffer, 1.0, radii,
            float(np.abs(photons["position"]).max()), iteration,
        )  # fmt: skip
        active = ActivePaths(self._context, self._library, "paths", "take fewer")
        active.fill(len(importons))
        taking = SplatTargets(buffers[1].buffer, buffers[4].buffer, active, False, True, None, np.zeros(3))
        grid.prepare(stored)
        grid.splat(stored, taking, sums)
        contributed = buffers[0].read(PHOTON.dtype, len(photons))["depth"] & PHOTON_CONTRIBUTED != 0
        result = contributed, sums.photons_taken(len(importons))[:, 0], sums.read(len(importons)).any(axis=(1, 2))
        for part in (*buffers, active, listed, sums, grid, iteration):
            part.release()
        return result


@pytest.fixture
def device(context, library):
    return Device(context, library)


def photons_at(positions: np.ndarray, flags: int) -> np.ndarray:
    photons = PHOTON.zeros(len(positions))
    photons["position"], photons["flags"], photons["flux"] = positions, PhotonFlag.STORED | flags, 1.0
    photons["direction"], photons["geometric_normal"], photons["distance"] = (0, 0, 1), UP, 1.0
    return photons


def importons_at(positions: np.ndarray, radii: np.ndarray, gathers: int = 0) -> np.ndarray:
    importons = IMPORTON.zeros(len(positions))
    importons["position"], importons["radius"], importons["gathers"] = positions, radii, gathers
    importons["minimum_radius"] = radii
    importons["direction"], importons["diffuse"] = (0, 0, 1), 1.0
    importons["geometric_normal"] = importons["diffuse_normal"] = importons["shading_normal"] = UP
    return importons


@pytest.mark.parametrize(
    "flags", [0, PhotonFlag.AFTER_ROUGH_BOUNCE, PhotonFlag.AFTER_ROUGH_BOUNCE | PhotonFlag.INDIRECT]
)
@pytest.mark.parametrize("offset", [(0.0, 0.0), (1e4, -1e4), (-3e4, 7.0)])
@pytest.mark.parametrize("largest", [0.4, 0.02])
def test_no_photon_within_reach_is_missed(device, flags, offset, largest):
    """Radii far below the largest, and floats that are coarser than the smallest of them."""
    random = np.random.default_rng(11)
    side = 16
    centers = np.stack(np.meshgrid(np.arange(side), np.arange(side)), -1).reshape(-1, 2) * 2.1 * largest
    reach = largest * random.choice([1.0, 0.4, 0.3, 0.1, 0.06], len(centers))
    around = random.uniform(-1.05, 1.05, (len(centers), 40, 2))
    around[:, :20] = np.tile([(0.9995, 0), (-0.9995, 0), (0, 0.9995), (0, -0.9995)], (5, 1))
    around *= reach[:, None, None] * random.uniform(0.998, 1.0, (len(centers), 40, 1))

    def on_floor(points: np.ndarray) -> np.ndarray:
        points = points.reshape(-1, 2) + offset
        return np.concatenate([points, np.zeros((len(points), 1))], axis=1).astype(np.float32)

    photons, importons = photons_at(on_floor(centers[:, None] + around), flags), importons_at(on_floor(centers), reach)
    radii = SplatRadii(largest, 0.5 * reach.min())
    contributed, diffused, _ = device.gather(photons, importons, radii)
    offsets = photons["position"].astype(np.float64) - importons["position"][:, None].astype(np.float64)
    distances = np.linalg.norm(offsets, axis=-1)
    reach = importons["radius"].astype(np.float64)[:, None]
    inside, near = distances < reach * (1 - 1e-5), distances < reach * (1 + 1e-5)
    assert inside.sum() > 4000 and (~near.any(axis=0)).sum() > 500
    assert contributed[inside.any(axis=0)].all() and not contributed[~near.any(axis=0)].any()
    if flags:
        assert (diffused >= inside.sum(axis=1)).all() and (diffused <= near.sum(axis=1)).all()
    else:
        assert not diffused.any()


def test_photons_count_within_their_footprints(device):
    """Between the importon's least radius and its largest; photons that know none within three least ones."""
    least, most = 0.1, 0.5
    footprints = np.array([0.0, 0.05, 0.2, 0.9], np.float32)
    radii = np.array([3 * least, least, 0.2, most])
    distances = np.linspace(0.01, 0.6, 60)
    importons = importons_at(np.stack([distances, 0 * distances, 0 * distances], 1), np.full(60, most))
    importons["minimum_radius"] = least
    for footprint, radius in zip(footprints, radii, strict=True):
        bits = int(np.float32(footprint).view(np.uint32)) & ~((1 << PHOTON_FLAG_BITS) - 1)
        photon = photons_at(np.zeros((1, 3), np.float32), bits)
        contributed, _, any_light = device.gather(photon, importons, SplatRadii(most, most))
        assert contributed.all()
        np.testing.assert_array_equal(any_light, distances < radius * (1 - 1e-4))


@pytest.mark.parametrize("flags", [0, PhotonFlag.AFTER_ROUGH_BOUNCE])
def test_as_many_photons_as_one_likes_lie_in_a_cell(device, flags):
    """llvmpipe ends the loops of a thread after 65535 rounds; nothing may be lost for that."""
    count = 150_000
    random = np.random.default_rng(3)
    positions = np.zeros((count, 3), np.float32)
    positions[:, :2] = random.uniform(-0.01, 0.01, (count, 2))
    importons = importons_at(np.array([[0.001 * k, 0, 0] for k in range(20)], np.float32), np.full(20, 0.05))
    importons["radius"][7] = 0.0
    contributed, diffused, any_light = device.gather(photons_at(positions, flags), importons, SplatRadii(0.05, 0.05))
    takes = np.arange(20) != 7
    assert contributed.all()
    np.testing.assert_array_equal(diffused, np.where(takes & (flags != 0), count, 0))
    np.testing.assert_array_equal(any_light, takes)


def test_who_takes_what(device):
    """Importons whose paths gather take no indirect photons; those without a radius nothing at all."""
    positions = np.zeros((3, 3), np.float32)
    photons = photons_at(positions, 0)
    photons["flags"] |= np.array(
        [0, PhotonFlag.AFTER_ROUGH_BOUNCE, PhotonFlag.AFTER_ROUGH_BOUNCE | PhotonFlag.INDIRECT], np.uint32
    )
    both = GatherFlag.HIT | GatherFlag.ORIGIN
    for gathers, expected in ((0, 2), (GatherFlag.ORIGIN, 1), (GatherFlag.HIT, 2), (both, 1)):
        importons = importons_at(np.zeros((2, 3), np.float32), np.array([0.1, 0.0], np.float32), gathers)
        contributed, diffused, any_light = device.gather(photons, importons, SplatRadii(0.1, 0.2))
        np.testing.assert_array_equal(contributed, [True, True, not gathers & GatherFlag.ORIGIN])
        np.testing.assert_array_equal(diffused, [expected, 0])
        np.testing.assert_array_equal(any_light, [True, False])
    nothing = importons_at(np.zeros((2, 3), np.float32), np.zeros(2))
    contributed, diffused, _ = device.gather(photons, nothing, SplatRadii(0.1, 0.2))
    assert not contributed.any() and not diffused.any()
