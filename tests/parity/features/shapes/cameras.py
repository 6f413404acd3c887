# SPDX-License-Identifier: GPL-3.0-or-later
"""Cameras: projections, lenses, shifts, fits and film."""

import math

import bpy

from ...net import material
from ...scenes import background
from .. import stage
from ..rows import Kind, Row, add


def cam(name: str, change, kind: Kind = Kind.VALUES, **members: object) -> None:
    """A row of a camera before glowing coordinates."""

    def build() -> None:
        stage.empty()
        surface, net = material()
        stage.set_up(surface)
        net.output(net.emission(net.scaled(net.out("TexCoord", "Object"), 0.15, 0.5)))
        background().inputs["Strength"].default_value = 0.05
        change(bpy.context.scene.camera.data)

    add(Row("Camera", name, build, kind, **members))


def _set(**properties):
    def change(camera) -> None:
        for name, value in properties.items():
            owner = camera.dof if hasattr(camera.dof, name) and not hasattr(camera, name) else camera
            setattr(owner, name, value)

    return change


def _panorama(kind, **properties):
    return lambda camera: _set(type="PANO", panorama_type=kind, **properties)(camera)


cam("perspective", _set())
cam("wide angle", _set(angle=math.radians(100.0)))
cam("orthographic", _set(type="ORTHO", ortho_scale=3.4))
cam("shift", _set(shift_x=0.2, shift_y=-0.1))
cam("orthographic, shift", _set(type="ORTHO", ortho_scale=4.0, shift_x=-0.15))
cam("sensor fit VERTICAL", _set(sensor_fit="VERTICAL", sensor_height=18.0))
cam("clipped", _set(clip_start=4.2, clip_end=5.4))
cam("equirectangular", _panorama("EQUIRECTANGULAR"))
cam("fisheye", _panorama("FISHEYE_EQUIDISTANT", fisheye_fov=math.radians(120.0)))
cam("fisheye, equisolid", _panorama("FISHEYE_EQUISOLID", fisheye_lens=15.0, fisheye_fov=math.radians(150.0)))
cam("mirror ball", _panorama("MIRRORBALL"))
cam("cylinder", _panorama("CENTRAL_CYLINDRICAL"))
cam("depth of field", _set(use_dof=True, focus_distance=4.0, aperture_fstop=0.15), Kind.LIGHT, effort=2)
_blades = {"aperture_blades": 5, "aperture_rotation": 0.4, "aperture_ratio": 1.5}
_lens = _set(use_dof=True, focus_distance=3.6, aperture_fstop=0.12, **_blades)
cam("depth of field, 5 blades", _lens, Kind.LIGHT, effort=2)


def _film(**properties):
    def change(camera) -> None:
        render = bpy.context.scene.render
        for name, value in properties.items():
            setattr(render, name, value)

    return change


_border = {"border_min_x": 0.25, "border_max_x": 0.75, "border_min_y": 0.125, "border_max_y": 0.875}
cam("border", _film(use_border=True, use_crop_to_border=True, **_border))
cam("oblong pixels", _film(pixel_aspect_x=2.0, pixel_aspect_y=1.0))
cam("transparent film", _film(film_transparent=True))


def _expose(camera) -> None:
    for settings in (bpy.context.scene.cycles, bpy.context.scene.rppm):
        settings.film_exposure = 1.7


cam("exposure", _expose)
