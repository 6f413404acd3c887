# SPDX-License-Identifier: GPL-3.0-or-later
"""Photon beams on the raster: quads cover every camera ray that passes within a radius, and their pairs are counted."""

import fog
import numpy as np
import pytest
import scenes
from rendering import iterated

from rppm_addon.integrator.common.records.photons import PHOTON, PHOTON_CONTRIBUTED
from rppm_addon.integrator.media.beams import BEAM_TARGET, PHOTON_BEAM
from rppm_addon.scene import World

FLIGHT = {"photons": 1024, "max_bounces": 8, "volume_bounces": 31}
SIZE = 48
SLACK = 1e-3
"""Relative distance from a bound within which floats may decide either way."""


def met_beams(beams: np.ndarray, targets: np.ndarray, radius: float, pixels: float) -> np.ndarray:
    """(beams) bool: whether one of the rays passes well within a beam's radius, meters, or so many at distance 1,
    whichever is larger."""
    found = np.zeros(len(beams), bool)
    for target in targets:
        direction, between = target["direction"].astype(float), target["origin"] - beams["origin"].astype(float)
        cosine = beams["direction"] @ direction
        sine2 = 1.0 - cosine**2
        along_ray, along_beam = between @ direction, np.einsum("ij,ij->i", between, beams["direction"])
        with np.errstate(divide="ignore", invalid="ignore"):
            distance, way = (cosine * along_beam - along_ray) / sine2, (along_beam - cosine * along_ray) / sine2
        offset = between + distance[:, None] * direction - way[:, None] * beams["direction"]
        within = np.linalg.norm(offset, axis=1) < (1.0 - SLACK) * np.maximum(radius, pixels * distance)
        end = (1.0 - SLACK) * beams["extent"]
        found |= within & (distance > SLACK) & (way > SLACK * beams["extent"]) & (way < end) & (sine2 > SLACK)
    return found


def records(buffer, record, count: int, header: int = 0) -> np.ndarray:
    """Records of a buffer behind so many bytes."""
    size = header + count * record.dtype.itemsize
    return buffer.read(np.uint8, size)[header:].view(record.dtype)


@pytest.mark.parametrize("half", [0.3, 1.0], ids=["narrow", "wide"])
def test_all_beams_that_rays_meet_give_light(mapper, half):
    """In fog that fills the world, beams also pass close to the camera, and from before it to behind it."""
    camera = fog.camera((0.0, -4.0, 0.0), (0.6, 0.0, 0.0), half, SIZE)
    world = World(volume=fog.volume(0.05))
    scene = fog.scene_of(
        camera, lights=[fog.lamp(0.0, 0.0, 0.5)], world=world, photons=1024, max_bounces=8, volume_bounces=31
    )
    iterated(mapper, scene)
    stage = mapper.stages.photon_beams
    beams = records(stage.beams, PHOTON_BEAM, stage.beam_count, header=16)
    targets = records(stage._targets, BEAM_TARGET, SIZE * SIZE, header=16)
    photons = records(mapper.stages.photons.photons, PHOTON, mapper.stages.photons.slots)
    gave_light = photons["depth"][beams["photon"]] & PHOTON_CONTRIBUTED != 0
    pixel = (camera.window[1] - camera.window[0]) / camera.width
    met = met_beams(beams, targets, stage.radius, stage.radius_pixels * pixel)
    assert met.sum() > 50
    print(f"\n{half}: {met.sum()} met, {(met & ~gave_light).sum()} of them without light")
    assert not (met & ~gave_light).any()


@pytest.mark.parametrize("density", [0.3, 6.0], ids=["beams", "points"])
def test_pairs_are_counted(mapper, density):
    """By the choice of the number of photons; where a medium shines, camera paths leave dense fog to points."""
    camera = fog.camera((0.0, -4.0, 0.0), (0.0, 0.0, 0.0), 0.3, 16)
    box = scenes.box("box", 1.0), fog.fog(density, 0.5, emission=0.1), scenes.placed(0.0, 0.0, 0.0, 1.0)
    lights = [fog.lamp(0.0, 0.0, 2.0)]
    scene = fog.scene_of(camera, box, lights=lights, photons=0, max_bounces=16, volume_bounces=4)
    stages = iterated(mapper, scene, 2).stages
    beams, points = stages.photon_beams.count_pairs(), stages.medium_photons.count_pairs()
    print(f"\n{density}: {beams} beams, {points} points")
    assert (beams > 256) == (density < 1.0) == (points < 256)
