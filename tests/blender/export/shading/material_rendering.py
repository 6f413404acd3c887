# SPDX-License-Identifier: GPL-3.0-or-later
"""Small pictures of materials, to see that they are finite."""

import numpy as np
from blender_scenes import add_light, add_mesh, export, set_world

from rppm_addon.scene import Scene


def stage(scene, material, size=16):
    """A quad with the material that fills the picture, a quad that it lights, a sun, a light and a gray world."""
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.camera.data.type, scene.camera.data.ortho_scale = "ORTHO", 2.0
    shown = add_mesh(scene, "Shown")
    shown.data.materials.append(material)
    shown.data.uv_layers.new(name="UVMap")
    add_mesh(scene, "Wall", [(-1, -1, 0), (-1, 1, 0), (-1, 1, 2), (-1, -1, 2)], [(0, 1, 2, 3)])
    add_light(scene, "SUN", "Sun", energy=1.0)
    add_light(scene, "POINT", "Light", energy=10.0)
    set_world(scene, (0.2, 0.2, 0.2))
    scene.rppm.samples, scene.rppm.photons, scene.rppm.cubemap_resolution = 1, 512, 16


def picture(renderer, scene) -> tuple[np.ndarray, list[str], Scene]:
    """(size, size, 3) radiance, all of it finite, the warnings of export and render, and the exported scene."""
    exported = export(scene)
    result = renderer.render(exported)
    combined = result.frame.combined
    assert np.isfinite(combined).all()
    assert all(np.isfinite(values).all() for values in result.frame.passes.values())
    assert (combined[..., :3] >= 0.0).all()
    for warning in result.statistics.warnings:
        assert "cannot be read" not in warning and "driver does not compile" not in warning, warning
    return combined[..., :3], result.statistics.warnings, exported


def staged(renderer, scene, material) -> tuple[np.ndarray, list[str], Scene]:
    """The picture of a material on the stage."""
    stage(scene, material)
    return picture(renderer, scene)
