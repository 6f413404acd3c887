# SPDX-License-Identifier: GPL-3.0-or-later
"""Bytes on the device against the paper's 32 R + 64 M L (section 5.1)."""

import dataclasses

import numpy as np
import pytest
import scenes

from rppm_addon.gl.buffer_sets import sum_by_name
from rppm_addon.integrator.common.band import MAXIMUM_BAND_PIXELS
from rppm_addon.integrator.memory import expected_memory
from rppm_addon.scene import AccelerationStructure, DensityEstimation, Instancing
from rppm_addon.scene.errors import DeviceError

ROUTES = DensityEstimation.RASTERIZED, DensityEstimation.GRID
BVH = AccelerationStructure.BVH
SETTINGS = {"photons": 3000, "photon_path_length": 5, "camera_path_length": 2, "iterations": 1}


@pytest.mark.parametrize("length", [1, 5])
def test_photons_take_64_bytes_a_segment(renderer, length):
    """Room for four segments is there beforehand; the fifth has few paths left, which find room in it."""
    memory = renderer.memory(scenes.room(16, **SETTINGS | {"photon_path_length": length}))
    assert (memory.pixels, memory.photons, memory.segments) == (256, 3000, length)
    assert memory.ppm["photons"] == 64 * 3000 * min(length, 4)
    assert memory.paper_bytes == 32 * 256 + 64 * 3000 * length


def test_a_megapixel_takes_no_more_than_in_the_paper(renderer):
    memory = renderer.memory(scenes.room(1024, **SETTINGS))
    assert memory.pixels == 1 << 20
    assert memory.ppm["film"] == 16 << 20
    assert memory.ppm["gathered radiance"] == 48 * MAXIMUM_BAND_PIXELS
    assert memory.ppm_bytes - memory.ppm["photons"] <= 32 << 20
    assert memory.ppm_bytes <= memory.paper_bytes


@pytest.mark.parametrize("route", ROUTES)
def test_all_buffers_of_a_render_are_reckoned(renderer, route):
    """None twice, none forgotten, and the lists as long as the first iteration makes them."""
    scene = scenes.room(16, density_estimation=route, **SETTINGS)
    memory = renderer.memory(scene)
    told = renderer.render(scene).statistics.memory_bytes
    groups = [memory.ppm, *memory.working.values()]
    assert {name: size for sizes in groups for name, size in sizes.items()} == told
    assert sum(map(len, groups)) == len(told)
    assert memory.total_bytes == sum(told.values())
    assert told["stored photons"] > 4 * 3000 * 4
    rasterized = route is DensityEstimation.RASTERIZED
    assert ("splat jobs" in told) == rasterized == ("sorted photons" not in told)
    assert told["splat jobs" if rasterized else "sorted photons"] > 16 * 3000


def test_every_stage_is_in_a_group(mapper):
    mapper.build(scenes.room(16, **SETTINGS))
    assert sum_by_name(mapper.stages.memory_groups.values()) == mapper.stages.memory_bytes


def test_buffers_of_the_camera_have_the_size_of_a_band(renderer):
    """Twice the rows beyond a band's pixels double the film and nothing else."""
    scene = scenes.room(16, **SETTINGS | {"photons": 64})
    wide = dataclasses.replace(scene.camera, width=2048, height=MAXIMUM_BAND_PIXELS // 2048)
    one = renderer.memory(dataclasses.replace(scene, camera=wide))
    two = renderer.memory(dataclasses.replace(scene, camera=dataclasses.replace(wide, height=2 * wide.height)))
    assert two.ppm["film"] == 2 * one.ppm["film"]
    assert {**two.ppm, "film": 0} == {**one.ppm, "film": 0}
    assert {**two.working, "passes": 0} == {**one.working, "passes": 0}


@pytest.mark.parametrize("route", ROUTES)
@pytest.mark.parametrize(("width", "height"), [(16, 16), (2048, 200)])
def test_what_the_settings_alone_take_is_known_beforehand(renderer, width, height, route):
    scene = scenes.room(16, density_estimation=route, **SETTINGS)
    scene = dataclasses.replace(scene, camera=dataclasses.replace(scene.camera, width=width, height=height))
    rasterized = route is DensityEstimation.RASTERIZED
    memory, expected = renderer.memory(scene), expected_memory(width, height, 3000, 5, rasterized)
    assert expected.ppm == memory.ppm and expected.paper_bytes == memory.paper_bytes
    for group, sizes in expected.working.items():
        assert sizes == {name: memory.working[group][name] for name in sizes}
        # Nothing but what depends on the scene or the camera's kind is left out.
        lists = {"splat jobs"} if rasterized else {"photon grid", "sorted photons"}
        assert set(memory.working[group]) - set(sizes) <= {"visibility buffer", *lists}


@pytest.mark.parametrize(("width", "height"), [(16, 16), (2048, 200)])
def test_hits_on_instances_are_known_beforehand(renderer, width, height):
    """Where two levels are asked for, so that what a scene takes beside does not depend on the resolution."""
    found = []
    for instancing in (Instancing.EXPANDED, Instancing.TWO_LEVELS):
        scene = scenes.room(16, instancing=instancing, acceleration_structure=BVH, **SETTINGS)
        scene = dataclasses.replace(scene, camera=dataclasses.replace(scene.camera, width=width, height=height))
        found.append(renderer.memory(scene).working["scene"])
    expanded, in_levels = found
    expected = expected_memory(width, height, 3000, 5, in_two_levels=True).working["scene"]
    assert in_levels["hit origins"] == expected["hit origins"]
    for name in ("world triangles", "triangle attributes"):
        rest = in_levels[name] - expected[name]  # of what is expanded, and of the ball in object space
        assert 0 < rest <= expanded[name] + 2 * 256 * 48  # each part begins where a block may


def test_bytes_of_an_instance_that_is_not_expanded(mapper):
    """As docs/troubleshooting.md says: 208 and 96 of any, and 208 more."""

    def total(count: int) -> int:
        scene = scenes.room(16, instancing=Instancing.TWO_LEVELS, acceleration_structure=BVH, **SETTINGS)
        places = np.random.default_rng(1).uniform(-0.5, 0.5, (count, 3))
        scene.instances += [dataclasses.replace(scene.instances[-1], matrix=scenes.placed(*at, 0.01)) for at in places]
        mapper.build(scene)
        return sum(mapper.memory_bytes.values())

    few, many = total(160), total(1600)
    assert (many - few) / 1440 == pytest.approx(208 + 96 + 208, abs=8)  # a few nodes are kept for instances that move


def test_too_many_instances_are_refused_with_how_many_have_room(mapper, context, monkeypatch):
    scene = scenes.room(16, instancing=Instancing.TWO_LEVELS, acceleration_structure=BVH, **SETTINGS)
    (ball,) = scene.instances[-1:]
    scene.instances += [dataclasses.replace(ball, matrix=scenes.placed(0.1, 0.1, 0.1, 0.01)) for _ in range(5093)]
    monkeypatch.setitem(context.limits, "GL_MAX_SHADER_STORAGE_BLOCK_SIZE", 1 << 20)
    monkeypatch.setitem(context.__dict__, "max_texels", 1 << 16)  # of 16 bytes, as many bytes
    with pytest.raises(DeviceError, match=r"shading instances needs .* \(5,041 of 5,100 items\) .*; remove instances"):
        mapper.build(scene)
    scene.instances = scene.instances[:5041]
    mapper.build(scene)
