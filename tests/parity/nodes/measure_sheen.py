# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures Cycles' Microfiber sheen and writes rppm_addon/materials/sheen_tables.npz.

    cd tests && python -m parity.nodes.measure_sheen

The sheen is a linearly transformed cosine (Zeltner, Burley and Chiang, Practical Multiple-Scattering Sheen Using
Linearly Transformed Cosines, 2022): light from (x, y, z), z along the normal and x on the viewer's side, is
scattered by R z / pi (a / ((a x + b z)^2 + (a y)^2 + z^2))^2. Its square root is linear in a few products of a, b
and R^-1/2, so that the radiance under suns from some directions tells them. A plane whose roughness grows from row
to row is rendered for each cosine of the viewer; Cycles interpolates linearly between 32 x 32 values, whose places
are the ones looked at here. What cosine 0 would show is extrapolated from half a step and a whole one.
"""

import math
import os
import tempfile
from pathlib import Path

import bpy
import numpy as np
import OpenEXR
from mathutils import Matrix, Vector

from ..net import material
from ..scenes import new_scene

SIZE = 32
FILE = Path(__file__).parents[3] / "rppm_addon" / "materials" / "sheen_tables.npz"
DIRECTIONS = np.array(
    [(0.0, 0.3, 1.0), (1.0, 0.1, 1.0), (-1.0, 0.1, 1.0), (0.2, 1.0, 0.8), (-2.0, 0.3, 1.0), (2.0, 0.0, 1.0)]
)
"""To the suns, in the frame of normal and viewer."""


def _scene() -> tuple[bpy.types.Object, bpy.types.Object, bpy.types.Object]:
    """Plane, sun and camera; the roughness of row i of the picture is i / 31."""
    scene = new_scene(SIZE)
    scene.render.resolution_x = 4
    scene.cycles.samples, scene.cycles.max_bounces = 1, 0
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 0.01
    made, net = material("Sheen")
    along = net.out("SeparateXYZ", "Y", {0: net.out("TexCoord", "Object")})
    inputs = {0: along, 1: 1.0 / (SIZE - 1), 2: -0.5 / (SIZE - 1)}
    roughness = net.out("Math", 0, inputs, operation="MULTIPLY_ADD")
    net.output(net.out("BsdfSheen", 0, {"Color": 1.0, "Roughness": roughness}, distribution="MICROFIBER"))
    mesh = bpy.data.meshes.new("Plane")
    mesh.from_pydata([(-800, 0, 0), (800, 0, 0), (800, SIZE, 0), (-800, SIZE, 0)], [], [(0, 1, 2, 3)])
    mesh.materials.append(made)
    sun = bpy.data.lights.new("Sun", "SUN")
    sun.energy, sun.angle = 1.0, 0.0
    camera = bpy.data.cameras.new("Camera")
    camera.type, camera.ortho_scale, camera.clip_end = "ORTHO", SIZE, 10000.0
    objects = [bpy.data.objects.new("Object", data) for data in (mesh, sun, camera)]
    for each in objects:
        scene.collection.objects.link(each)
    scene.camera = objects[2]
    return tuple(objects)


def _picture() -> np.ndarray:
    """(32,) radiance of the rows."""
    with tempfile.TemporaryDirectory() as folder:
        scene = bpy.context.scene
        scene.render.engine, scene.render.filepath = "CYCLES", os.path.join(folder, "sheen.exr")
        bpy.ops.render.render(write_still=True)
        channels = OpenEXR.File(scene.render.filepath, separate_channels=True).channels()
        name = next(name for name in channels if name.endswith("Combined.R"))
        return channels[name].pixels[::-1, 1].astype(np.float64)


def measure(cosine: float, sun: bpy.types.Object, camera: bpy.types.Object) -> np.ndarray:
    """(3, 32) a, b and R by roughness for a viewer at this cosine to the normal."""
    sine = math.sqrt(max(0.0, 1.0 - cosine * cosine))
    viewer = Vector((sine, 0.0, cosine))
    # Rows along Y whatever the angle.
    camera.matrix_world = (
        Matrix.Translation(Vector((0.0, SIZE / 2, 0.0)) + 2000.0 * viewer)
        @ Matrix(((cosine, 0.0, sine), (0.0, 1.0, 0.0), (-sine, 0.0, cosine))).to_4x4()
    )
    rows, values = [], []
    for direction in DIRECTIONS / np.linalg.norm(DIRECTIONS, axis=1, keepdims=True):
        sun.matrix_world = Vector(direction).to_track_quat("Z", "Y").to_matrix().to_4x4()
        radiance = _picture()
        x, y, z = direction
        rows.append((x * x + y * y, x * z, z * z))
        values.append(np.sqrt(z / np.maximum(radiance, 1e-30)))
    # sqrt(z / v) = c ((a x + b z)^2 + (a y)^2 + z^2) with c = sqrt(pi / R) / a
    solution, *_ = np.linalg.lstsq(np.array(rows), np.array(values), rcond=None)
    lit = np.array(values).max(axis=0) < 1e10  # the least rough sheen is black
    error = np.abs(np.array(rows) @ solution / np.array(values) - 1.0)[:, lit].max()
    square, mixed, last = solution
    ratio = mixed / (2.0 * square)
    a = np.where(lit, np.sqrt(square / (last - square * ratio**2)), 1.0)
    ratio, albedo = np.where(lit, ratio, 0.0), np.where(lit, math.pi * (a / square) ** 2, 0.0)
    print(
        f"cosine {cosine:.4f}: the fit is off by {error:.1e} at most; albedo {albedo[1]:.4f} to {albedo[-1]:.4f}",
        flush=True,
    )
    return np.array([a, ratio * a, albedo])


def main() -> None:
    _, sun, camera = _scene()
    places = [0.5 / (SIZE - 1), *(k / (SIZE - 1) for k in range(1, SIZE))]
    tables = np.array([measure(cosine, sun, camera) for cosine in places])
    tables[0] = 2.0 * tables[0] - tables[1]
    tables[0, ::2] = np.maximum(tables[0, ::2], 0.0)
    a, b, albedo = np.moveaxis(tables, 0, -1).astype(np.float32)
    np.savez_compressed(FILE, a=a, b=b, albedo=albedo)


if __name__ == "__main__":
    main()
