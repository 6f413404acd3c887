# SPDX-License-Identifier: GPL-3.0-or-later
"""Panoramas, lenses, borders, shifts and clip distances, against Cycles."""

import math
from collections.abc import Callable

import bpy
import numpy as np
import pytest
from support.families import some_each_time

from ..engines import PIXEL_CENTERS, compare_with_cycles, cycles_channels, render_frame, stacked, unfilter
from ..scenes import (
    DIFFUSE,
    EMISSION,
    background,
    ball,
    box,
    camera,
    light,
    link_object,
    material,
    new_scene,
    place,
    plane,
)

PHOTONS = {"photons": 4096, "photon_path_length": 6, "iterations": 12, "seeds": 2}
"""Settings with which the noise of a block is about a percent."""


def room() -> bpy.types.Object:
    """A box of colored sides with a ball in it, and a camera in its middle, looking along Y, tilted."""
    new_scene(world=0.0)
    box((2.0, 2.5, 1.5), material(DIFFUSE, Color=(0.4, 0.4, 0.4)))
    for at, turn, color in (
        ((-1.99, 0.0, 0.0), (0.0, 90.0, 0.0), (0.4, 0.2, 0.1)),
        ((1.99, 0.0, 0.0), (0.0, -90.0, 0.0), (0.1, 0.4, 0.2)),
        ((0.0, 2.49, 0.0), (90.0, 0.0, 0.0), (0.1, 0.2, 0.4)),
        ((0.0, 0.0, -1.49), (0.0, 0.0, 0.0), (0.4, 0.4, 0.2)),
    ):
        plane(1.0, material(DIFFUSE, Color=color), place(at=at, turn=turn))
    ball(0.5, material(DIFFUSE, Color=(0.5, 0.5, 0.5)), place(at=(0.7, 1.4, -0.5)))
    light("POINT", 60.0, place(at=(-0.4, 0.3, 0.9)), shadow_soft_size=0.15)
    return camera((0.1, -0.4, 0.1), (0.3, 1.0, 0.0))


PANORAMAS = {
    "equirectangular": {"panorama_type": "EQUIRECTANGULAR"},
    "equirectangular_part": {
        "panorama_type": "EQUIRECTANGULAR",
        "longitude_min": -1.0, "longitude_max": 2.5, "latitude_min": -0.4, "latitude_max": 1.2,
    },
    "equidistant": {"panorama_type": "FISHEYE_EQUIDISTANT", "fisheye_fov": math.radians(200.0)},
    "equisolid": {"panorama_type": "FISHEYE_EQUISOLID", "fisheye_lens": 10.5, "fisheye_fov": math.radians(150.0)},
    "mirrorball": {"panorama_type": "MIRRORBALL"},
    "polynomial": {
        "panorama_type": "FISHEYE_LENS_POLYNOMIAL", "fisheye_fov": math.radians(140.0),
        "fisheye_polynomial_k1": -0.06, "fisheye_polynomial_k2": -3e-4,
    },
    "cubemap_face": {"panorama_type": "EQUIANGULAR_CUBEMAP_FACE"},
    "cylindrical": {
        "panorama_type": "CENTRAL_CYLINDRICAL", "central_cylindrical_radius": 2.0,
        "central_cylindrical_range_v_min": -1.0, "central_cylindrical_range_u_max": 1.5,
    },
}  # fmt: skip


def configure(data: object, properties: dict) -> None:
    """Set properties by Blender's names; lens__ stands for dof."""
    for name, value in properties.items():
        owner, _, name = name.rpartition("__")
        setattr(data.dof if owner == "dof" else data, name, value)


PANORAMAS_EACH_TIME = ("equirectangular", "polynomial", "mirrorball", "cubemap_face")
"""The others each have a row of features."""


@pytest.mark.parametrize("name", some_each_time(PANORAMAS, lambda name: name in PANORAMAS_EACH_TIME))
def test_panorama(renderer, name):
    data = room().data
    data.type = "PANO"
    configure(data, PANORAMAS[name])
    pictures, reference = compare_with_cycles(renderer, f"panorama_{name}", 128, **PHOTONS)
    # The pixel filter reaches over the rim: black as far as the next pixels are.
    lit = np.pad(reference.max(axis=(0, -1)) > 0.0, 1, mode="edge")
    outside = ~np.any([lit[i : i + 64, j : j + 64] for i in range(3) for j in range(3)], axis=0)
    assert (pictures[:, outside] == 0.0).all()
    assert outside.any() == (name in ("equidistant", "equisolid", "mirrorball", "polynomial"))


def frame(scene: bpy.types.Scene) -> None:
    """An oblong frame of oblong pixels, of which a border shows a part of 64 x 64 pixels."""
    render = scene.render
    render.resolution_x, render.resolution_y = 128, 96
    render.pixel_aspect_x, render.pixel_aspect_y = 1.0, 1.3
    render.use_border = render.use_crop_to_border = True
    render.border_min_x, render.border_max_x = 40.5 / 128, 104.5 / 128
    render.border_min_y, render.border_max_y = 16.5 / 96, 80.5 / 96


FRAMED = {
    "equirectangular": {"type": "PANO", **PANORAMAS["equirectangular"], "shift_x": 0.1, "shift_y": -0.05},
    "equisolid_vertical": {
        "type": "PANO", **PANORAMAS["equisolid"], "shift_x": -0.1, "shift_y": 0.1, "sensor_fit": "VERTICAL",
        "sensor_height": 30.0,
    },
    "perspective": {
        "lens": 18.0, "shift_x": 0.15, "shift_y": -0.1, "dof__use_dof": True, "dof__focus_distance": 1.5,
        "dof__aperture_fstop": 0.05,
    },
    "orthographic": {
        "type": "ORTHO", "ortho_scale": 2.5, "shift_x": 0.1, "shift_y": -0.1, "sensor_fit": "VERTICAL",
        "dof__use_dof": True, "dof__focus_distance": 1.5, "dof__aperture_fstop": 4.0,
    },
}  # fmt: skip


@pytest.mark.parametrize("name", FRAMED)
def test_border_shift_and_pixel_aspect(renderer, name):
    data = room().data
    configure(data, FRAMED[name])
    frame(bpy.context.scene)
    _, reference = compare_with_cycles(renderer, f"framed_{name}", 128, **PHOTONS)
    assert reference.shape[1:3] == (64, 64)


CLIPPED = {
    "perspective": {"lens": 15.0, "dof__use_dof": True, "dof__focus_distance": 2.0, "dof__aperture_fstop": 0.5},
    "orthographic": {
        "type": "ORTHO", "ortho_scale": 2.5,
        "dof__use_dof": True, "dof__focus_distance": 2.0, "dof__aperture_fstop": 4.0,
    },
    "equirectangular": {"type": "PANO", **PANORAMAS["equirectangular"]},
    "pinhole": {"lens": 15.0},
}  # fmt: skip


@pytest.mark.parametrize("name", some_each_time(CLIPPED, lambda name: name in ("perspective", "equirectangular")))
def test_clip_distances(renderer, name):
    """Sides of the room nearer than 1.6 m or farther than 2.3 m are cut away."""
    data = room().data
    background().inputs["Strength"].default_value = 0.02
    configure(data, CLIPPED[name] | {"clip_start": 1.6, "clip_end": 2.3})
    # All edges move together with the pixel filter.
    compare_with_cycles(renderer, f"clipped_{name}", 128, **PHOTONS | {"iterations": 64, "photons": 1024})


def bright_ball(**properties: object) -> None:
    """A small bright ball far behind the distance of focus, off the axis, before a dim wall."""
    new_scene(world=0.05)
    ball(0.1, material(EMISSION, Color=(1.0, 1.0, 1.0), Strength=4.0), place(at=(0.3, 4.0, 0.2)))
    plane(4.0, material(DIFFUSE, Color=(0.5, 0.5, 0.5)), place(at=(0.0, 5.0, 0.0), turn=(90.0, 0.0, 0.0)))
    light("AREA", 50.0, place(at=(0.0, 0.0, 3.0), turn=(50.0, 0.0, 0.0)), shape="SQUARE", size=1.0)
    data = camera((0.0, -1.0, 0.0), (0.0, 1.0, 0.0)).data
    data.dof.use_dof, data.dof.focus_distance = True, 2.0
    configure(data, properties)


OPENINGS = {
    "disk": {},
    "pentagon": {"dof__aperture_blades": 5, "dof__aperture_rotation": 0.3},
    "wide_triangle": {"dof__aperture_blades": 3, "dof__aperture_rotation": -0.4, "dof__aperture_ratio": 0.6},
    "tall_pentagon": {"dof__aperture_blades": 5, "dof__aperture_rotation": 1.0, "dof__aperture_ratio": 2.0},
}
PROJECTIONS = {
    "perspective": {"dof__aperture_fstop": 0.08},
    "orthographic": {"type": "ORTHO", "ortho_scale": 3.0, "dof__aperture_fstop": 1.5},
    "equidistant": {
        "type": "PANO", "panorama_type": "FISHEYE_EQUIDISTANT", "fisheye_fov": math.radians(70.0),
        "dof__aperture_fstop": 0.1,
    },
    "mirrorball": {
        "type": "PANO", "panorama_type": "MIRRORBALL", "dof__aperture_fstop": 0.02,
    },
}  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize(
    ("projection", "opening"),
    [("perspective", opening) for opening in OPENINGS]
    + [(projection, "wide_triangle") for projection in PROJECTIONS if projection != "perspective"],
)
def test_bokeh(renderer, projection, opening):
    bright_ball(**PROJECTIONS[projection], **OPENINGS[opening])
    settings = {"photons": 1024, "photon_path_length": 2, "iterations": 128, "seeds": 2}
    compare_with_cycles(renderer, f"bokeh_{projection}_{opening}", 1024, **settings)


@pytest.mark.parametrize("transparent", [False, True])
@pytest.mark.parametrize("name", ["equirectangular", "equidistant", "mirrorball", "equisolid"])
def test_passes_of_panoramas(renderer, name, transparent):
    """Depth is the distance, and what a fisheye does not see is as Cycles leaves it, also before no background."""
    camera = room()
    bpy.data.objects.remove(bpy.data.objects["Mesh"])  # the box: behind the planes there is nothing
    camera.data.type = "PANO"
    configure(camera.data, PANORAMAS[name])
    bpy.context.scene.render.film_transparent = transparent
    layer = bpy.context.view_layer
    layer.use_pass_z = layer.use_pass_normal = True
    unfilter()
    expected, frame = cycles_channels(), render_frame(renderer, **PIXEL_CENTERS)
    seen = expected["Depth.Z"] < 100.0
    assert seen.any() and not seen.all()
    same = np.isclose(frame.passes["Depth"], expected["Depth.Z"], rtol=1e-3)
    assert same.mean() > 0.98, "more than edges differ"
    normals = stacked(expected, "Normal", "XYZ")
    assert (np.abs(frame.passes["Normal"] - normals).max(axis=-1) < 0.02).mean() > 0.98
    assert (np.abs(frame.combined[..., 3] - expected["Combined.A"]) < 1e-3).mean() > 0.98


def test_depth_of_field_in_a_room(renderer):
    data = room().data
    configure(data, {"lens": 24.0, "dof__use_dof": True, "dof__focus_distance": 1.0, "dof__aperture_fstop": 0.08})
    compare_with_cycles(renderer, "dof_room", 128, **PHOTONS)


@pytest.mark.long
def test_light_by_photons_alone(renderer):
    """Photons on the first surfaces, direct light as well, in a panorama and through a lens."""
    data = room().data
    data.type = "PANO"
    configure(data, PANORAMAS["equirectangular"] | {"dof__use_dof": True, "dof__aperture_fstop": 0.2})
    settings = PHOTONS | {"direct_light": "PHOTONS", "photons": 65536}
    pictures, _ = compare_with_cycles(renderer, "panorama_photons", 128, **settings)
    assert np.isfinite(pictures).all()


def scaled(*scale: float, **properties: object) -> Callable:
    def change(made: bpy.types.Object) -> None:
        made.scale = scale
        configure(made.data, properties)

    return change


def sheared(**properties: object) -> Callable:
    """As a child of what is scaled unevenly."""

    def change(made: bpy.types.Object) -> None:
        made.parent, made.rotation_euler = link_object(None, name="Parent"), (1.3, 0.4, 0.6)
        made.parent.scale = (1.4, 1.0, 0.7)
        configure(made.data, properties)

    return change


def through(kind: str) -> Callable:
    """Another object in place of the camera: an empty or a light."""

    def change(made: bpy.types.Object) -> None:
        data = bpy.data.lights.new("Spot", "SPOT") if kind == "spot" else None
        if data is not None:
            data.spot_size, data.energy = 1.2, 0.0
        bpy.context.scene.camera = link_object(data, made.matrix_world, kind)

    return change


AROUND = {"type": "PANO", "panorama_type": "EQUIRECTANGULAR"}
AS_THEY_COME = {
    "mirrored": scaled(-1.0, 1.0, 1.0), "mirrored_panorama": scaled(1.0, -1.0, 1.0, **AROUND),
    "upside_down": scaled(-2.0, -2.0, -2.0, shift_x=0.2),  # all three axes mirrored, with a lens off its middle
    "sheared": sheared(), "sheared_orthographic": sheared(type="ORTHO", ortho_scale=2.0),
    "sheared_panorama": sheared(**AROUND), "through_an_empty": through("empty"), "through_a_spot": through("spot"),
}  # fmt: skip


@pytest.mark.parametrize("name", AS_THEY_COME)
def test_depth_of_cameras_as_they_come(renderer, name):
    """Mirrored and sheared ones, and objects that are no cameras: the distance of what is seen in each pixel."""
    made = room()
    ball(0.3, material(DIFFUSE), place(at=(-0.6, 1.2, 0.4)))
    AS_THEY_COME[name](made)
    unfilter()
    bpy.context.view_layer.use_pass_z = True
    reference = cycles_channels()["Depth.Z"]
    depth = render_frame(renderer, **PIXEL_CENTERS, passes=("Depth",)).passes["Depth"]
    ratio = np.abs(depth / reference - 1.0)
    assert np.percentile(ratio, 95) < 2e-3  # edges fall to either side
