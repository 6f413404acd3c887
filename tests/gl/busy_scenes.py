# SPDX-License-Identifier: GPL-3.0-or-later
"""A room in which all kinds of paths are, and what cameras, materials and settings make of it."""

import dataclasses

import numpy as np
import scenes
from moving_scenes import everything_moves
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import Aperture, Camera, DirectLight, Instance, Light, LightKind, Panorama, PanoramaKind, Scene
from rppm_addon.scene.images import Image
from rppm_addon.scene.passes import FILM_PASSES


def busy_room(direct_light: DirectLight = DirectLight.RAYS) -> Scene:
    """Caustics, light scattered between walls, glossy paths, a pane that some camera paths end on, and a second light
    whose photons are of less use."""
    scene = scenes.room(
        16, direct_light=direct_light, photons=4096, camera_path_length=4, photon_path_length=4, radius_scale=100.0,
        use_splat_roulette=True, passes=tuple(entry.name for entry in FILM_PASSES),
    )  # fmt: skip
    rough = Lobe(LobeKind.GLOSSY, weight=0.5, color=(0.8, 0.5, 0.3), roughness=0.6)
    scene.materials[1] = material("rough", rough, Lobe(LobeKind.DIFFUSE, weight=0.5, color=(0.7, 0.1, 0.1)))
    light = np.eye(4)
    light[:3, 3] = (0.9, 0.9, 0.9)
    scene.lights.append(Light("in the corner", LightKind.POINT, light, np.full(3, 0.5)))
    scene.materials.append(material("pane", Lobe(LobeKind.PRINCIPLED, alpha=0.4, roughness=0.0)))
    corners = (-0.5, -0.8, -0.5), (0.5, -0.8, -0.5), (0.5, -0.8, 0.5), (-0.5, -0.8, 0.5)
    scene.meshes.append(scenes.rectangle("pane", *corners))
    scene.instances.append(Instance(len(scene.meshes) - 1, np.eye(4), [len(scene.materials) - 1]))
    return scene


WIDTH, HEIGHT = 36, 24


def wide(scene: Scene, **settings: object) -> Scene:
    camera = dataclasses.replace(scene.camera, width=WIDTH, height=HEIGHT)
    return dataclasses.replace(scene, camera=camera, settings=dataclasses.replace(scene.settings, **settings))


def busy(**settings: object) -> Scene:
    """Caustics, light between walls, rough and glossy paths, a pane that ends some paths."""
    return wide(busy_room(), **{"photons": 2000, "use_splat_roulette": False, "radius_scale": 40.0, **settings})


def panorama() -> Scene:
    scene = busy()
    camera = Camera(
        scenes.placed(0.1, -0.2, 0.0), (0, 1, 0, 1), WIDTH, HEIGHT, panorama=Panorama(PanoramaKind.EQUIRECTANGULAR)
    )
    return dataclasses.replace(scene, camera=camera)


def lens() -> Scene:
    scene = busy()
    scene.camera.aperture = Aperture(0.1, 3.0)
    return scene


def orthographic() -> Scene:
    scene = busy()
    scene.camera.orthographic, scene.camera.window = True, (-1.2, 1.2, -0.8, 0.8)
    return scene


def looking_back() -> Scene:
    """A wall that shows what it is made of by the angle to the viewer."""
    scene = busy()
    facing = material("facing", Lobe(LobeKind.DIFFUSE, color=(0.2, 0.8, 0.3)), Lobe(LobeKind.GLOSSY, roughness=0.3))
    graph = facing.graph
    share = graph.add("layer_weight", "facing", blend=0.5)
    graph.surface = graph.add("mix_shader", "shader", fac=share, shader_001=graph.surface)
    scene.materials[0] = facing
    return scene


def catching() -> Scene:
    scene = busy()
    scene.instances[0] = dataclasses.replace(scene.instances[0], shadow_catcher=True)
    return scene


def textured_emitter() -> Scene:
    scene = busy()
    pixels = np.random.default_rng(5).random((4, 4, 4), np.float32)
    scene.images.append(Image("glow", pixels))
    scene.materials[2] = material("glow", Lobe(LobeKind.EMISSION, color=(2, 1, 0.5), color_image=0))
    return scene


def scaled(factor: float) -> Scene:
    """All lengths times a factor."""
    scene = busy()
    grown = np.diag([factor, factor, factor, 1.0])

    def placed(matrix: np.ndarray) -> np.ndarray:
        result = matrix.copy()
        result[:3, 3] *= factor
        return result

    instances = [dataclasses.replace(item, matrix=grown @ item.matrix) for item in scene.instances]
    lights = []
    for light in scene.lights:
        size, power = tuple(factor * side for side in light.size), factor**2 if light.kind is LightKind.POINT else 1.0
        lights.append(
            dataclasses.replace(light, matrix=placed(light.matrix), size=size, strength=light.strength * power)
        )
    near, far = factor * scene.camera.clip_start, factor * scene.camera.clip_end
    camera = dataclasses.replace(scene.camera, matrix=placed(scene.camera.matrix), clip_start=near, clip_end=far)
    return dataclasses.replace(scene, instances=instances, lights=lights, camera=camera)


SCENES = {
    "room": lambda: wide(scenes.room(8, photons=2000)),
    "busy": busy,
    "roulette": lambda: busy(use_splat_roulette=True),
    "photons for direct light": lambda: busy(direct_light=DirectLight.PHOTONS),
    "without final gather": lambda: busy(use_final_gather=False, direct_light=DirectLight.PHOTONS),
    "roulette without final gather": lambda: busy(use_final_gather=False, use_splat_roulette=True),
    "one segment": lambda: busy(camera_path_length=1),
    "wide radius": lambda: busy(radius_scale=400.0),
    "radii far apart": lambda: busy(radius_minimum=0.001, radius_maximum=0.3, direct_light=DirectLight.PHOTONS),
    "panorama": panorama,
    "lens": lens,
    "orthographic": orthographic,
    "motion": lambda: everything_moves(busy(), 1.0),
    "looking back": looking_back,
    "shadow catcher": catching,
    "textured emitter": textured_emitter,
    "small": lambda: scaled(1e-4),
    "huge": lambda: scaled(3e4),
    "dark": lambda: dataclasses.replace(busy(), lights=[]),
}
