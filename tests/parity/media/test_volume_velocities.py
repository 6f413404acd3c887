# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes that their velocities blur.

Cycles' side is Biased: without, Cycles takes no light from places to which values come far from where they are in the
middle of the shutter's time.
"""

import bpy
import numpy as np
import pytest
from support.media.vdb_files import write_vdb
from support.moving import blur

from ..cameras.moments import render_blurred
from ..comparison import Tolerance, compare
from ..engines import render_cycles
from ..net import Net, diffuse, material
from ..scenes import camera, light, new_scene, place, plane

NEAR = Tolerance(mean=0.015, block=0.04, mode=0.015)
SETTINGS = {"photons": 4096, "iterations": 64, "max_bounces": 16, "transparent_max_bounces": 16}
STEP, VOXELS = 0.1, 28


def wind(at: np.ndarray, turns: bool) -> np.ndarray:
    """Velocities at places (x, y, z, 3), meters a frame: around an axis or aside, with a little of the other."""
    still = np.zeros(at.shape[:3])
    if turns:
        return np.stack([-1.1 * at[..., 1], 1.1 * at[..., 0], still + 0.1], axis=-1)
    return np.stack([0.8 + 0.2 * at[..., 2], still, 0.3 * at[..., 0]], axis=-1)


def cloud(folder, surface: bpy.types.Material, turns: bool, by_second: bool) -> bpy.types.Object:
    """A block of smoke aside of the middle, around which there are velocities."""
    matrix = np.diag([STEP, STEP, STEP, 1.0])
    matrix[:3, 3] = -STEP * (VOXELS - 1) / 2
    at = np.stack(np.meshgrid(*[np.arange(VOXELS)] * 3, indexing="ij"), axis=-1) * STEP + matrix[:3, 3]
    density = (np.abs(at - [0.2, 0.0, 0.0]) < [0.55, 0.25, 0.45]).all(axis=-1) * (1.0 + 0.5 * at[..., 2])
    velocity = wind(at, turns) * (bpy.context.scene.render.fps if by_second else 1.0)
    data = bpy.data.volumes.new("Cloud")
    data.filepath = str(write_vdb(folder / "cloud.vdb", matrix, density=density, velocity=velocity))
    data.grids.load()  # Blender looks up the grid of velocities
    data.velocity_unit = "SECOND" if by_second else "FRAME"
    data.materials.append(surface)
    made = bpy.data.objects.new("Cloud", data)
    made.matrix_world = place(at=(-0.1, 0.0, 1.2), turn=(0.0, 0.0, 20.0))
    bpy.context.collection.objects.link(made)
    return made


def absorbing(net: Net) -> bpy.types.NodeSocket:
    return net.out("VolumePrincipled", inputs={"Color": (0.0, 0.0, 0.0), "Density": 2.0})


def scattering(net: Net) -> bpy.types.NodeSocket:
    return net.out("VolumePrincipled", inputs={"Color": (0.8, 0.6, 0.4), "Density": 1.5})


def shining(net: Net) -> bpy.types.NodeSocket:
    density = net.out("Attribute", "Fac", attribute_name="density")
    return net.out("Emission", inputs={"Color": (1.0, 0.5, 0.2), "Strength": density})


ROWS = {
    "slides": (absorbing, False, True, 1.0, "CENTER"),
    "slides_on": (absorbing, False, False, 0.5, "START"),
    "has_slid": (absorbing, False, True, 0.5, "END"),
    "turns": (scattering, True, False, 1.0, "CENTER"),
    "shines": (shining, True, True, 1.0, "START"),
}
"""Shaders of the cloud, whether it turns, whether its velocities are by second, and when the shutter is open."""


@pytest.mark.parametrize("name", [pytest.param(name, marks=pytest.mark.long) for name in ROWS])
def test_velocities_blur_as_in_cycles(renderer, tmp_path, name):
    shader, turns, by_second, shutter, position = ROWS[name]
    new_scene(world=0.3)
    plane(4.0, diffuse("Floor", (0.6, 0.55, 0.5)))
    if shader is not shining:
        light("AREA", 150.0, place(at=(1.0, -1.0, 5.0)), shape="SQUARE", size=1.0)
    camera((0.0, -6.0, 2.6), (0.0, 0.0, 1.0), 38.0)
    made, net = material("Smoke")
    net.output(Volume=shader(net))
    cloud(tmp_path, made, turns, by_second)
    blur(shutter, position)
    cycles = bpy.context.scene.cycles
    cycles.volume_biased, cycles.volume_step_rate = True, 0.5
    reference = render_cycles(256)
    cycles.volume_biased = False
    compare(f"velocity_{name}", render_blurred(renderer, **SETTINGS), reference, NEAR)
