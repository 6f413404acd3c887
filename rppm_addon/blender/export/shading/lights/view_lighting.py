# SPDX-License-Identifier: GPL-3.0-or-later
"""The light of a rendered viewport by its shading popover: with or without the scene's lights, under the scene's world
or a studio light, as Cycles shows them."""

import functools
import math
from dataclasses import dataclass, replace

import bpy
import numpy as np

from .....scene import Image, NodeGraph, Scene, World
from .....scene.lights import Light

BLUR_RADIANS = math.pi / 4.0
"""Within about which a background of a blur of 1 is the mean."""
_LEAST_BLUR = 0.02
"""Less is not seen."""
_MOST_ROWS = 128


@dataclass(frozen=True)
class ViewLighting:
    """Lighting settings of a viewport's shading; the defaults leave all to the scene."""

    use_scene_lights: bool = True
    use_scene_world: bool = True
    path: str = ""
    """The file of the studio light, in place of the world; "" is none."""
    rotation: float = 0.0
    """Radians about Z."""
    intensity: float = 1.0
    alpha: float = 0.0
    """How much of the studio light is seen behind all else."""
    blur: float = 0.0
    """Blur of the studio light as it is seen behind all else, 0 to 1."""
    background: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Color that is seen behind all else as far as the studio light is not."""


def view_lighting(shading: bpy.types.View3DShading, world: bpy.types.World | None) -> ViewLighting:
    """Return the lighting of a viewport; ``world``: the scene's, whose viewport color is the background of studio
    lights."""
    lights, of_world = shading.use_scene_lights_render, shading.use_scene_world_render
    if of_world:
        return ViewLighting(lights)
    studio = shading.selected_studio_light
    return ViewLighting(
        lights,
        False,
        "" if studio is None else studio.path,
        shading.studiolight_rotate_z,
        shading.studiolight_intensity,
        shading.studiolight_background_alpha,
        round(shading.studiolight_background_blur, 2),
        (0.0, 0.0, 0.0) if world is None else tuple(world.color),
    )


def relit(scene: Scene, lighting: ViewLighting, picture: Image | None) -> Scene:
    """The scene in this light; ``picture``: of the studio light, without which only its background is seen."""
    if lighting.use_scene_lights and lighting.use_scene_world:
        return scene

    def is_kept(light: Light) -> bool:
        return lighting.use_scene_world if light.of_world else lighting.use_scene_lights

    lights = [light for light in scene.lights if is_kept(light)]
    if lighting.use_scene_world:
        return replace(scene, lights=lights)
    images = list(scene.images)
    world = World(np.ones(3), _graph(lighting, picture, images), mist=scene.world.mist)
    return replace(scene, lights=lights, world=world, images=images)


def _graph(lighting: ViewLighting, picture: Image | None, images: list[Image]) -> NodeGraph:
    """The nodes that Cycles makes of a studio light, whose images are added."""
    graph = NodeGraph()
    black = (0.0, 0.0, 0.0)

    def shown(image: Image) -> object:
        images.append(image)
        color = graph.add("tex_environment", "color", image=len(images) - 1, vector=place)
        strength = (lighting.intensity,) * 3
        options = {"blend_type": "MULTIPLY"}
        return graph.add("mix_rgb", "color", options=options, fac=1.0, color1=color, color2=strength)

    light: object = black
    behind: object = black
    if picture is not None:
        turn = (0.0, 0.0, lighting.rotation)
        position = graph.add("new_geometry", "position")
        place = graph.add("mapping", "vector", options={"vector_type": "VECTOR"}, vector=position, rotation=turn)
        light = behind = shown(picture)
        if lighting.blur >= _LEAST_BLUR and lighting.alpha > 0.0:
            behind = shown(_Blurred(picture).by(lighting.blur))
    seen = graph.add("mix_rgb", "color", fac=lighting.alpha, color1=lighting.background, color2=behind)
    by_camera = graph.add("light_path", "is_camera_ray")
    color = graph.add("mix_rgb", "color", fac=by_camera, color1=light, color2=seen)
    graph.surface = graph.add("background", "background", color=color, strength=1.0)
    return graph


class _Blurred:
    """An image that is blurred as often as asked for, and once for the same blur."""

    def __init__(self, image: Image) -> None:
        self._image = image

    def __hash__(self) -> int:
        return id(self._image)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Blurred) and other._image is self._image

    @functools.lru_cache(maxsize=4)  # noqa: B019 - few are kept
    def by(self, blur: float) -> Image:
        return Image(f"{self._image.name}, blurred", blurred_panorama(self._image.pixels, blur * BLUR_RADIANS))


def blurred_panorama(pixels: np.ndarray, width: float) -> np.ndarray:
    """(rows, 2 rows, 4) float32 of an equirectangular picture, (height, width, channels), seen through a lobe on the
    sphere, exp((cos - 1) / width^2), of so many radians."""
    rows = int(min(max(round(2.0 * math.pi / width), 16), _MOST_ROWS, pixels.shape[0]))
    columns = 2 * rows
    areas = np.cos(_latitudes(pixels.shape[0]))
    weighted = areas[:, None, None] * pixels[..., :3]
    area, latitude = _averaged(areas, rows, 0), _latitudes(rows)
    spectrum = np.fft.rfft(_averaged(_averaged(weighted, rows, 0), columns, 1), axis=1)
    turns = 2.0 * math.pi * np.arange(columns) / columns
    result = np.ones((rows, columns, 4), np.float32)
    for row, angle in enumerate(latitude):
        cosine = np.sin(angle) * np.sin(latitude)[:, None] + np.cos(angle) * np.outer(np.cos(latitude), np.cos(turns))
        lobe = np.exp((cosine - 1.0) / width**2)
        product = (np.fft.rfft(lobe, axis=1)[..., None] * spectrum).sum(axis=0)
        weight = (lobe * area[:, None]).sum()
        result[row, :, :3] = np.maximum(np.fft.irfft(product, columns, axis=0) / weight, 0.0)
    return result


def _latitudes(rows: int) -> np.ndarray:
    """(rows,) radians, from below."""
    return math.pi * ((np.arange(rows) + 0.5) / rows - 0.5)


def _averaged(values: np.ndarray, count: int, axis: int) -> np.ndarray:
    """Means of so many parts of an axis that are as long as each other, or by one longer."""
    edges = np.arange(count) * values.shape[axis] // count
    lengths = np.diff(edges, append=values.shape[axis])
    shape = [1] * values.ndim
    shape[axis] = count
    return np.add.reduceat(values, edges, axis=axis) / lengths.reshape(shape)
