# SPDX-License-Identifier: GPL-3.0-or-later
"""The pass Vector beside Cycles', pixel by pixel."""

import numpy as np
import pytest
from support.moving import FRAME, animate, taken_scene

from ..engines import PIXEL_CENTERS, cycles_pass, unfilter
from ..scenes import DIFFUSE, PRINCIPLED, box, camera, light, material, new_scene, place, plane


@pytest.fixture
def moving():
    """A box that flies, one that turns, a sheet that bends, an instance of which what brings it moves, a floor at rest,
    and a pane that nothing is seen of; a camera that moves and zooms."""
    scene = new_scene(resolution=48)
    plane(3.0, material(DIFFUSE), place(at=(0.0, 0.0, -0.6)))
    animate(
        box((0.3, 0.3, 0.3), material(DIFFUSE), place()), "location", (-0.6, 0.2, 0.0), (-0.5, 0, 0), (-0.2, 0, 0.1)
    )
    turning = box((0.3, 0.1, 0.3), material(DIFFUSE), place(at=(0.5, 0.0, 0.0)))
    animate(turning, "rotation_euler", (0.0, 0.0, -0.3), (0.0, 0.0, 0.0), (0.2, 0.0, 0.4))
    turning.cycles.use_motion_blur = False  # has no say here
    bending = plane(0.4, material(DIFFUSE), place(at=(0.0, 0.6, 0.4), turn=(80.0, 0.0, 0.0)))
    bending.shape_key_add(name="Basis")
    key = bending.shape_key_add(name="Bent")
    key.data[0].co.z += 0.5
    animate(key, "value", 0.0, 0.4, 1.0)
    pane = plane(2.0, material(PRINCIPLED, Alpha=0.0), place(at=(0.0, -1.0, 0.0), turn=(90.0, 0.0, 0.0)))
    animate(pane, "location", (-1.0, -1.0, 0.0), (0.0, -1.0, 0.0), (1.0, -1.0, 0.0))
    light("POINT", 50.0, place(at=(0.0, -1.5, 3.0)))
    seen_from = camera((0.3, -3.0, 1.2), (0.0, 0.0, 0.0))
    animate(seen_from, "location", (0.25, -3.0, 1.2), (0.3, -3.0, 1.2), (0.3, -2.9, 1.2))
    animate(seen_from.data, "lens", 48.0, 50.0, 51.0)
    scene.view_layers[0].use_pass_vector = True
    scene.frame_set(FRAME)
    return scene


def cycles_vectors() -> np.ndarray:
    """(H, W, 4), row 0 at the bottom."""
    unfilter()
    return cycles_pass("Vector", "XYZW")


def test_vectors_are_those_of_cycles(renderer, moving):
    """Not of orthographic cameras: those of Cycles are of a perspective before and after."""
    expected = cycles_vectors()
    scene = taken_scene()
    assert scene.neighbors is not None and scene.shutter is None and scene.warnings == []
    scene.settings = scene.settings.with_values(**PIXEL_CENTERS)
    vectors = renderer.render(scene).frame.passes["Vector"]
    same = np.isclose(vectors, expected, rtol=1e-2, atol=2e-2).all(axis=-1)
    assert same.mean() > 0.97, "more than edges differ"
    assert (np.abs(expected).max(axis=(0, 1)) > 2.0).all()


def test_with_motion_blur_there_are_none(renderer, moving):
    moving.render.use_motion_blur = True
    scene = taken_scene()
    assert scene.neighbors is None and scene.shutter is not None
    scene.settings = scene.settings.with_values(iterations=1, photons=64)
    assert not renderer.render(scene).frame.passes["Vector"].any()


PANORAMAS = {
    "EQUIRECTANGULAR": {},
    "CENTRAL_CYLINDRICAL": {},
    "EQUIANGULAR_CUBEMAP_FACE": {},
    "MIRRORBALL": {},
    "FISHEYE_EQUIDISTANT": {"fisheye_fov": 3.0},
    "FISHEYE_EQUISOLID": {"fisheye_lens": 10.5, "fisheye_fov": 3.0},
    "FISHEYE_LENS_POLYNOMIAL": {"fisheye_fov": 2.4},
}


@pytest.mark.parametrize("kind", PANORAMAS)
def test_vectors_of_panoramas_are_those_of_cycles(renderer, moving, kind):
    data = moving.camera.data
    if kind not in data.bl_rna.properties["panorama_type"].enum_items:
        pytest.skip("not in this version of Blender")
    data.animation_data_clear()
    data.type, data.panorama_type = "PANO", kind
    for name, value in PANORAMAS[kind].items():
        setattr(data, name, value)
    expected = cycles_vectors()
    scene = taken_scene()
    assert scene.neighbors is not None and scene.warnings == []
    scene.settings = scene.settings.with_values(**PIXEL_CENTERS)
    vectors = renderer.render(scene).frame.passes["Vector"]
    shown = expected.any(axis=-1) & (np.abs(expected).max(axis=-1) < 20.0)  # not across the edge
    same = np.isclose(vectors, expected, rtol=5e-3, atol=2e-3).all(axis=-1)
    assert shown.sum() > 100
    assert same[shown].mean() > 0.95, "more than edges differ"
    assert (np.abs(expected[shown]).max(axis=0) > 0.2).all()
