# SPDX-License-Identifier: GPL-3.0-or-later
"""A room that gets the light of the world through a hole."""

import dataclasses
import math

import numpy as np
import scenes
from path_scenes import lobe, view
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import Image, Instance, Scene, World
from rppm_addon.scene.meshes import RayVisibility

FLOOR, BLACK, GRAY = np.array([0.9, 0.7, 0.5]), np.zeros(3), np.full(3, 0.6)
HEIGHT, HALF, HOLE = 1.0, 1.0, 0.25
"""Height of the room, half of its width, and half of the width of the square hole in its ceiling, meters."""


def room(walls: np.ndarray, **settings: object) -> Scene:
    """A floor under a ceiling with a hole, between walls of one color, in a white world, seen from within."""
    a, b, h = HALF, HOLE, HEIGHT
    corners = [(-a, -a), (a, -a), (a, a), (-a, a)]
    sides = zip(corners, [*corners[1:], corners[0]], strict=True)
    meshes = [scenes.rectangle("wall", (*p, 0), (*q, 0), (*q, h), (*p, h)) for p, q in sides]
    ceiling = [((-a, -a), (a, -b)), ((-a, b), (a, a)), ((-a, -b), (-b, b)), ((b, -b), (a, b))]
    for (x0, y0), (x1, y1) in ceiling:
        meshes.append(scenes.rectangle("ceiling", (x0, y0, h), (x1, y0, h), (x1, y1, h), (x0, y1, h)))
    shared = {"iterations": 6, "photons": 1 << 16, "photon_path_length": 4, "camera_path_length": 4}
    shared |= {"filter_width": 0.0, "radius_minimum": 0.05, "radius_maximum": 0.05}
    camera, floor = view((-0.4, 0.0, 0.7), (0.0, 0.0, 0.0), 0.2), scenes.square("floor", a)
    scene = scenes.scene_of(
        camera, (floor, material("floor", lobe("D", FLOOR))), world=World(np.ones(3)), **shared | settings
    )
    scene.materials.append(material("walls", lobe("D", walls)))
    for number, mesh in enumerate(meshes, 1):
        scene.meshes.append(mesh)
        scene.instances.append(Instance(number, np.eye(4), [1]))
    return scene


def hole_form_factor(scene: Scene) -> np.ndarray:
    """(H, W) of the hole, from what each pixel sees of the floor (Howell, configuration B-4, by corners)."""
    place = scenes.floor_places(scene.camera)

    def corner(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Return the form factor of a rectangle from above the place to (u, v) off it."""
        s, t = u / np.hypot(HEIGHT, u), v / np.hypot(HEIGHT, v)
        return (s * np.arctan(v / np.hypot(HEIGHT, u)) + t * np.arctan(u / np.hypot(HEIGHT, v))) / (2 * math.pi)

    right, left = HOLE - place[..., 0], -HOLE - place[..., 0]
    top, bottom = HOLE - place[..., 1], -HOLE - place[..., 1]
    return corner(right, top) - corner(left, top) - corner(right, bottom) + corner(left, bottom)


def uneven_sky() -> Image:
    """Clouds of different brightness, and a sun seen through the hole."""
    pixels = np.random.default_rng(3).uniform(0.0, 1.0, (8, 16, 4)).astype(np.float32) * 3.0
    pixels = np.repeat(np.repeat(pixels, 16, 0), 16, 1)
    pixels[116:120, 88:92] = 500.0
    return Image("world", pixels)


def with_pane(scene: Scene, low: float, z: float) -> Scene:
    """Above the hole, from x = low on, a clear pane that stops no shadow rays."""
    corners = [(low, -0.4, z), (0.4, -0.4, z), (0.4, 0.4, z), (low, 0.4, z)]
    clear = material("clear", Lobe(LobeKind.TRANSPARENT, color=(1.0, 1.0, 1.0)))
    number, shown = len(scene.materials), RayVisibility.ALL & ~RayVisibility.SHADOW
    instance = Instance(len(scene.meshes), np.eye(4), [number], visibility=shown)
    return dataclasses.replace(
        scene,
        meshes=[*scene.meshes, scenes.rectangle("pane", *corners)],
        materials=[*scene.materials, clear],
        instances=[*scene.instances, instance],
    )
