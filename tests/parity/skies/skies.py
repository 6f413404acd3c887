# SPDX-License-Identifier: GPL-3.0-or-later
"""Cycles' Sky Texture as numbers: renders of nothing but the world, a value per pixel center."""

import functools
import math
from collections.abc import Iterable, Iterator

import bpy
import numpy as np

from rppm_addon.scene.sky import Sky

from ..engines import render_cycles
from ..net import Net
from ..scenes import background, link_object, new_scene

HEIGHT = 32
_SCATTERING = (
    *("sun_elevation", "sun_rotation", "sun_disc", "sun_size", "sun_intensity"),
    *("altitude", "air_density", "aerosol_density", "ozone_density"),
)
_ANALYTIC = ("sun_direction", "turbidity", "ground_albedo")


def _world(sky: Sky) -> bpy.types.Node:
    scene = new_scene(world=1.0)
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 0.01
    scene.world.cycles.sampling_method = "NONE"
    net = Net(scene.world.node_tree)
    node = net.node("TexSky")
    _set(node, sky)
    net.set(background().inputs["Color"], node.outputs[0])
    return node


def _set(node: bpy.types.Node, sky: Sky) -> None:
    node.sky_type = sky.sky_type
    for name in _SCATTERING if sky.scatters else _ANALYTIC:
        setattr(node, name, getattr(sky, name))


def _camera(elevation: float, azimuth: float) -> bpy.types.Camera:
    made = link_object(bpy.data.cameras.new("Camera"))
    made.rotation_euler = (math.pi / 2 + elevation, 0.0, -azimuth)
    bpy.context.scene.camera = made
    return made.data


def _seen() -> np.ndarray:
    """(n, 3) float64, as many as pixels."""
    return render_cycles(samples=1, seeds=1)[0].reshape(-1, 3)


def _directions() -> np.ndarray:
    """(n, 3) float64 unit vectors of the pixels as rendered: the narrowest filter still moves them by 0.005 pixels,
    which shows beside the sun."""
    net = Net(bpy.context.scene.world.node_tree)
    net.set(background().inputs["Color"], net.scaled(net.out("TexCoord", "Generated"), 1.0, 2.0))
    directions = _seen() - 2.0
    return directions / np.linalg.norm(directions, axis=1, keepdims=True)


def _look_around() -> None:
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y = 2 * HEIGHT, HEIGHT
    data = _camera(0.0, 0.0)
    data.type = "PANO"
    (data if hasattr(data, "panorama_type") else data.cycles).panorama_type = "EQUIRECTANGULAR"


@functools.cache
def _directions_around() -> np.ndarray:
    _world(Sky())
    _look_around()
    return _directions()


def panorama(sky: Sky) -> tuple[np.ndarray, np.ndarray]:
    """Radiance and unit directions, (2 HEIGHT^2, 3) float64 each, evenly spaced in azimuth and elevation."""
    directions = _directions_around()
    _world(sky)
    _look_around()
    return _seen(), directions


def panoramas(skies: Iterable[Sky]) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """As panorama, for many skies."""
    directions = _directions_around()
    node = _world(Sky())
    _look_around()
    for sky in skies:
        _set(node, sky)
        yield _seen(), directions


def close_ups(skies: Iterable[Sky], angle: float, size: int = 48) -> tuple[list[np.ndarray], np.ndarray]:
    """Radiance of each sky, and unit directions, (size^2, 3) float64 each, of square pictures of the sun, which is at
    the same place in all skies.

    angle: the camera's field of view, radians.
    """
    seen = []
    for sky in skies:
        _world(sky)
        render = bpy.context.scene.render
        render.resolution_x = render.resolution_y = size
        _camera(*sky.sun_angles()).angle = angle
        seen.append(_seen())
    return seen, _directions()
