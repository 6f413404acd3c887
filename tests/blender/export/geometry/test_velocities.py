# SPDX-License-Identifier: GPL-3.0-or-later
"""Velocities of volumes, which motion blur takes from grids of OpenVDB files and of fluid domains."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_object
from domains_of_gas import domain_of_gas
from support.media.vdb_files import write_vdb
from support.moving import blur, taken_scene

from rppm_addon.blender.export.geometry.volumes.velocities import VelocityBlur
from rppm_addon.blender.export.geometry.volumes.volume_meshes import GridSource

STEP = 0.1
MATRIX = np.diag([STEP, STEP, STEP, 1.0])
COUNTS = (12, 10, 8)
FPS = 24.0


def cloud(scene, tmp_path, unit="SECOND", scale=1.0, **velocities):
    """A volume object with density in some voxels in the middle."""
    density = np.zeros(COUNTS, np.float32)
    density[5:7, 4:6, 3:5] = 1.0
    data = bpy.data.volumes.new("Cloud")
    data.filepath = str(write_vdb(tmp_path / "cloud.vdb", MATRIX, density=density, **velocities))
    data.grids.load()  # Blender looks up the grid of velocities
    data.velocity_grid = "wind" if "wind" in velocities or "wind_x" in velocities else "velocity"
    data.velocity_unit, data.velocity_scale = unit, scale
    return add_object(scene, "Cloud", data)


def wind(*way):
    return np.broadcast_to(np.array(way, np.float32), (*COUNTS, 3)).copy()


def volume_and_box():
    scene = taken_scene()
    assert scene.warnings == []
    (instance,) = scene.instances
    mesh = scene.meshes[instance.mesh]
    return mesh.volume, (mesh.positions.min(axis=0), mesh.positions.max(axis=0))


@pytest.mark.parametrize(
    ("position", "rest_time"), [("START", 0.0), ("CENTER", 0.5), ("END", -0.5)], ids=["start", "center", "end"]
)
def test_velocities_by_second(scene, tmp_path, position, rest_time):
    cloud(scene, tmp_path, scale=3.0, velocity=wind(24.0, 0.0, -12.0))
    blur(0.5, position)
    volume, _ = volume_and_box()
    assert volume.grids.keys() == {"density"}
    assert volume.motion.rest_time == rest_time
    ways = volume.motion.displacements.values[1:-1, 1:-1, 1:-1]
    np.testing.assert_allclose(ways, np.broadcast_to(3.0 * 0.5 * np.array([1.0, 0.0, -0.5]), ways.shape), rtol=1e-6)
    np.testing.assert_allclose(volume.motion.displacements.matrix @ [1, 1, 1, 1], [0, 0, 0, 1], atol=1e-6)


def test_velocities_by_frame(scene, tmp_path):
    """They are those of the shutter's whole time, as in Cycles."""
    cloud(scene, tmp_path, unit="FRAME", wind=wind(0.0, 0.2, 0.0))
    blur(0.5)
    volume, _ = volume_and_box()
    np.testing.assert_allclose(volume.motion.displacements.values[1:-1, 1:-1, 1:-1, 1], 0.2, rtol=1e-6)


def test_the_box_holds_all_places_that_values_come_to(scene, tmp_path):
    """By whole voxels, and no further than the velocities."""
    cloud(scene, tmp_path, unit="FRAME", velocity=wind(0.34, -10.0, 0.0))
    blur()
    _, (low, high) = volume_and_box()
    # Density and a border of one voxel, and up to two voxels of motion; velocities end a voxel beyond their grid.
    np.testing.assert_allclose(low, [0.2, -0.1, 0.2], atol=1e-6)
    np.testing.assert_allclose(high, [0.9, 1.0, 0.5], atol=1e-6)


def test_components_in_grids_of_their_own(scene, tmp_path):
    """Their voxels may begin at other places."""
    way = np.random.default_rng(1).random((*COUNTS, 3)).astype(np.float32)
    way[0, :, :, 0] = way[:, 0, :, 1] = 0.0  # left out by OpenVDB
    cloud(scene, tmp_path, unit="FRAME", wind_x=way[..., 0], wind_y=way[..., 1], wind_z=way[..., 2])
    blur()
    volume, _ = volume_and_box()
    places = np.stack(np.meshgrid(*map(np.arange, COUNTS), indexing="ij"), axis=-1) * STEP
    found = volume.motion.displacements.at(places.reshape(-1, 3))
    np.testing.assert_allclose(found, way.reshape(-1, 3), atol=1e-5)


def test_velocities_that_are_no_vectors_are_named(scene, tmp_path):
    cloud(scene, tmp_path, velocity=np.ones(COUNTS))
    blur()
    found = taken_scene()
    assert found.shutter is None
    (warning,) = found.warnings
    assert 'Object "Cloud": its velocities are no grid of vectors' in warning


@pytest.mark.parametrize("bad", [np.nan, np.inf, 1e30])
def test_velocities_that_cannot_be_rendered_count_as_none(scene, tmp_path, bad):
    ways = wind(1.0, 0.0, 0.0)
    ways[3] = bad
    cloud(scene, tmp_path, unit="FRAME", velocity=ways)
    blur()
    values = volume_and_box()[0].motion.displacements.values
    assert not values[4].any() and (values[5, 1:-1, 1:-1, 0] == 1.0).all()


def _without(scene, made, how):
    if how == "scene":
        scene.render.use_motion_blur = False
    elif how == "object":
        made.cycles.use_motion_blur = False
    elif how == "scale":
        made.data.velocity_scale = 0.0
    else:
        scene.render.motion_blur_shutter = 0.0


@pytest.mark.parametrize("how", ["scene", "object", "scale", "shutter"])
def test_what_is_not_blurred_has_no_motion(scene, tmp_path, how):
    made = cloud(scene, tmp_path, velocity=wind(1.0, 0.0, 0.0))
    blur()
    _without(scene, made, how)
    volume, (low, _) = volume_and_box()
    assert volume.motion is None and volume.grids.keys() == {"density"}
    np.testing.assert_allclose(low, [0.4, 0.3, 0.2], atol=1e-6)


def test_velocities_of_gas():
    """They are as coarse as the simulation, and by second."""
    velocities = np.random.default_rng(1).random((3, 2, 4, 3)).astype(np.float32)
    domain = domain_of_gas(
        density_grid=np.ones(8 * 3 * 2 * 4, np.float32), velocity_grid=velocities.transpose(2, 1, 0, 3).ravel()
    )
    motion = GridSource(domain).read(VelocityBlur(0.25, 0.5), None, "Gas").motion
    np.testing.assert_allclose(motion.displacements.values[1:-1, 1:-1, 1:-1], 2.0 * 0.25 * velocities, rtol=1e-6)
    np.testing.assert_allclose(motion.displacements.matrix @ [1, 1, 1, 1], [-1.0, -1.0, -3.0, 1.0])
    assert GridSource(domain).read(None, None, "Gas").motion is None
