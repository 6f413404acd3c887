# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that test a device: a room with all stages of Algorithm 1, and scenes whose radiance is known."""

from typing import Any

import numpy as np

from ..scene.camera import Camera
from ..scene.lights import Light, LightKind, World
from ..scene.materials import Material
from ..scene.meshes import Instance
from ..scene.node_graphs import NodeGraph
from ..scene.scene import Scene
from ..scene.settings import DirectLight, RenderSettings
from .meshes import box_sides, looking, placed, sphere


def _of_one_shader(name: str, kind: str, options: dict[str, object] | None = None, **inputs: Any) -> Material:
    graph = NodeGraph()
    graph.surface = graph.add(kind, "bsdf", options=options, **inputs)
    return Material(name, graph)


def room(width: int, height: int, iterations: int, seed: int = 0) -> Scene:
    """An open box with a ball of glass, one of metal and a coat, a lamp below the ceiling, a sun and a sky."""
    materials = [
        _of_one_shader("walls", "bsdf_diffuse", color=(0.75, 0.75, 0.75)),
        _of_one_shader("red", "bsdf_diffuse", color=(0.7, 0.1, 0.1)),
        _of_one_shader("green", "bsdf_diffuse", color=(0.1, 0.6, 0.1)),
        _of_one_shader("glass", "bsdf_glass", color=(1.0, 1.0, 1.0), roughness=0.0, ior=1.5),
        _of_one_shader(
            "coated metal", "bsdf_principled", base_color=(0.9, 0.6, 0.3), metallic=0.7, roughness=0.3, coat_weight=0.5
        ),
    ]
    meshes = [*box_sides()[:5], sphere("ball")]
    instances = [Instance(mesh, np.eye(4), [material]) for mesh, material in enumerate((0, 0, 0, 1, 2))]
    instances += [Instance(5, placed(-0.4, -0.1, -0.6, 0.35), [3]), Instance(5, placed(0.45, 0.3, -0.6, 0.35), [4])]
    lights = [
        Light("lamp", LightKind.AREA, placed(0, 0, 0.98), np.full(3, 12.0), size=(0.5, 0.5)),
        Light("sun", LightKind.SUN, looking((0, -3, 2), (0, 0, 0)), np.full(3, 0.5)),
    ]
    camera = Camera(looking((0, -3.6, 0), (0, 0, 0)), (-0.4, 0.4, -0.3, 0.3), width, height)
    settings = RenderSettings(iterations=iterations, seed=seed, photons=16384)
    return Scene(camera, meshes, instances, materials, lights, World(np.array([0.2, 0.25, 0.3])), settings=settings)


def furnace(size: int, iterations: int, direct_light: DirectLight) -> Scene:
    """Inside a box that emits 1 W/(m^2 sr) and reflects a half: 2 everywhere, but for the bounces that are left out."""
    graph = NodeGraph()
    emission = graph.add("emission", "emission", color=(1.0, 1.0, 1.0), strength=1.0)
    diffuse = graph.add("bsdf_diffuse", "bsdf", color=(0.5, 0.5, 0.5))
    graph.surface = graph.add("add_shader", "shader", shader=emission, shader_001=diffuse)
    instances = [Instance(mesh, np.eye(4), [0]) for mesh in range(6)]
    camera = Camera(looking((0.5, 0.3, 0.2), (-1.0, -0.4, -0.1)), (-0.8, 0.8, -0.8, 0.8), size, size)
    wanted = RenderSettings(iterations=iterations, photons=16384, photon_path_length=11, direct_light=direct_light)
    return Scene(camera, box_sides(), instances, [Material("glow", graph)], settings=wanted)


def glass_in_white(size: int, iterations: int) -> Scene:
    """A ball of rough glass that absorbs nothing, in a sky of 1 W/(m^2 sr): it cannot be seen."""
    glass = _of_one_shader(
        "white glass",
        "bsdf_glass",
        options={"distribution": "MULTI_GGX"},
        color=(1.0, 1.0, 1.0),
        roughness=0.3,
        ior=1.5,
    )
    camera = Camera(looking((0, -4, 0), (0, 0, 0)), (-0.27, 0.27, -0.27, 0.27), size, size)
    settings = RenderSettings(
        iterations=iterations, photons=1024, photon_path_length=1, camera_path_length=32, specular_roughness=1.0
    )
    return Scene(
        camera, [sphere("ball")], [Instance(0, np.eye(4), [0])], [glass], world=World(np.ones(3)), settings=settings
    )
