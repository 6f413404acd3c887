# SPDX-License-Identifier: GPL-3.0-or-later
"""Views of stereo and multiview beside Cycles'."""

import bpy
import numpy as np
import OpenEXR
import pytest

from ..engines import unfilter
from ..scenes import camera, material, new_scene, place, plane

EYES = ("left", "right")


def colored_squares() -> bpy.types.Scene:
    """Squares that shine in colors of their own, at several distances, before a camera with its eyes far apart."""
    scene = new_scene(48)
    for number in range(6):
        color = (0.2 + 0.15 * number, 1.0 - 0.15 * number, 0.5)
        shining = material("ShaderNodeEmission", Color=color, Strength=1.0)
        plane(0.45, shining, place(at=(0.8 * (number % 3 - 1), -0.5 * number, 0.5 * (number // 3) - 0.25),
                                  turn=(90.0, 0.0, 0.0)))  # fmt: skip
    eyes = camera((0.3, -6.0, 0.4), (0.0, 0.0, 0.0), 40.0).data.stereo
    eyes.interocular_distance, eyes.convergence_distance = 0.4, 5.0
    scene.render.use_multiview = True
    scene.render.image_settings.views_format = "MULTIVIEW"
    unfilter()
    scene.cycles.samples = 1
    scene.rppm.samples, scene.rppm.photons, scene.rppm.filter_width = 1, 64, 0.0
    return scene


def views(scene: bpy.types.Scene, engine: str, path) -> dict[str, np.ndarray]:
    """(H, W, 3) by the name of the view."""
    scene.render.engine, scene.render.filepath = engine, str(path / f"{engine}.exr")
    bpy.ops.render.render(write_still=True)
    found = {}
    with OpenEXR.File(scene.render.filepath, separate_channels=True) as file:
        for part in file.parts:
            planes = part.channels
            if "ViewLayer.Combined.R" in planes:
                found[part.header["view"]] = np.stack(
                    [planes[f"ViewLayer.Combined.{channel}"].pixels for channel in "RGB"], axis=-1
                )
    return found


def check(scene: bpy.types.Scene, path, least: float = 0.15) -> None:
    mine, expected = (views(scene, engine, path) for engine in ("RPPM", "CYCLES"))
    assert list(mine) == list(expected) == list(EYES)
    for eye in EYES:
        assert (expected[eye] > 0.0).any(axis=-1).mean() > least
        same = np.isclose(mine[eye], expected[eye], rtol=1e-3, atol=1e-3).all(axis=-1)
        assert same.mean() > 0.99, f"{eye}: more than edges differ"
    assert (mine["left"] != mine["right"]).any(axis=-1).mean() > 0.02


@pytest.mark.skipif(bpy.app.version < (5, 0), reason="files of older versions name views otherwise")
@pytest.mark.parametrize("mode", ["OFFAXIS", "PARALLEL", "TOE"])
@pytest.mark.parametrize("pivot", ["LEFT", "CENTER"])
def test_eyes_see_what_those_of_cycles_see(registered, tmp_path, mode, pivot):
    scene = colored_squares()
    eyes = scene.camera.data.stereo
    eyes.convergence_mode, eyes.pivot = mode, pivot
    check(scene, tmp_path)


@pytest.mark.skipif(bpy.app.version < (5, 0), reason="files of older versions name views otherwise")
@pytest.mark.parametrize("kind", ["PERSPECTIVE", "EQUIRECTANGULAR", "MIRRORBALL", "FISHEYE_EQUIDISTANT"])
@pytest.mark.parametrize("mode", ["OFFAXIS", "PARALLEL"])
def test_eyes_that_look_around_see_what_those_of_cycles_see(registered, tmp_path, kind, mode):
    scene = colored_squares()
    scene.camera.matrix_world = place(at=(0.3, -3.0, 0.4), turn=(75.0, 10.0, 5.0))
    lens = scene.camera.data
    if kind != "PERSPECTIVE":
        lens.type, lens.panorama_type = "PANO", kind
    eyes = lens.stereo
    eyes.use_spherical_stereo, eyes.use_pole_merge = True, mode == "OFFAXIS"
    eyes.convergence_mode = mode
    eyes.pole_merge_angle_from, eyes.pole_merge_angle_to = 0.1, 0.7
    check(scene, tmp_path, least=0.02)


@pytest.mark.skipif(bpy.app.version < (5, 0), reason="files of older versions name views otherwise")
def test_cameras_of_multiview_are_those_of_cycles(registered, tmp_path):
    scene = colored_squares()
    scene.render.views_format = "MULTIVIEW"
    scene.camera.name, scene.camera.data.shift_x = "Camera_L", 0.1
    camera((-1.0, -5.0, 0.2), (0.0, 0.0, 0.0), 50.0).name = "Camera_R"
    scene.camera = bpy.data.objects["Camera_L"]
    check(scene, tmp_path)
