# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps of what the nodes of lights give by place or direction, for shaders/lights/light_maps.glsl."""

import math
from dataclasses import dataclass, field
from typing import Literal

import moderngl
import numpy as np

from ...gl.buffer_sets import BufferSet
from ...gl.buffers.textures import TextureKind
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...materials.evaluation import LightSurface, LightSurfaceKind, MapShape
from ...materials.tables import MaterialTables
from ...materials.traits.emitted import LightVariation, light_variation
from ...scene.images import Image
from ...scene.lights import Light, LightKind
from ..common.require import require
from ..surfaces.surface_attributes import object_record

_PATTERN_WIDTH, _WIDEST_MAP = 1024, 2048
_COARSE = (32, 16)
"""Pixels by which it is known how a light falls off with the distance."""
_WIDEST_CONE = 1.2
"""Half an angle in radians up to which a spot's directions lie on a square rather than on a sphere."""
_MAX_TEXELS = 1 << 24


@dataclass
class LightNodes:
    """Factor by which the nodes of a light multiply its strength. At a distance d in meters it is ``scale`` times the
    map times d^falloff d^2 / (smoothing + d^2), which the Light Falloff node's outputs are."""

    scale: np.ndarray
    """(3,), the whole factor where there is no map."""
    mean: np.ndarray
    """(3,) of that times the map, over the light."""
    falloff: float = 0.0
    smoothing: float = 0.0
    shape: MapShape | None = None
    extent: float = 0.0
    """Tangent of half the angle that the map of a cone shows; 0 for other maps."""
    place: tuple[float, float, float, float] = field(default=(0.0, 0.0, 0.0, 0.0))
    """Among the maps: left, bottom, width, height from 0 to 1."""


_TEXTURE = TextureKind(["light_maps"], "f2", repeats=(True, True))


class LightMaps(BufferSet):
    """The maps of all lights in one texture. Each has a border of one texel, so that filtering meets nothing else."""

    def __init__(self, context: Context, library: ProgramLibrary, sizes: object = None) -> None:
        super().__init__(context, library, sizes)
        self._context = context
        self._texture: moderngl.Texture | None = None
        self.nodes: dict[int, LightNodes] = {}
        """Results of the nodes of lights, by the index of the light."""

    def build(self, lights: list[Light], images: list[Image], materials: MaterialTables) -> None:
        """Evaluate the nodes of all lights that have some."""
        with_nodes = {index: light for index, light in enumerate(lights) if light.graph is not None}
        varying = {index: light_variation(require(light.graph)) for index, light in with_nodes.items()}
        shapes = {index: _shape(with_nodes[index], varies) for index, varies in varying.items() if varies}
        sizes = {index: _size(with_nodes[index], shape, images) for index, shape in shapes.items()}
        widest = min(int(self._context.limits["GL_MAX_TEXTURE_SIZE"]), 2 * (_WIDEST_MAP + 2))
        places, (width, height) = packed_places(sizes, widest)
        texels = np.zeros((height, width, 4), np.float16)
        self.nodes = {}
        for index, light in with_nodes.items():
            nodes = self.nodes[index] = _even(light, varying[index], shapes.get(index), materials)
            if index not in places:
                continue
            x, y, map_width, map_height = places[index]
            pixels = _asked(light, shapes[index], (map_width, map_height), 1.0, materials)
            largest = float(np.abs(pixels).max(initial=0.0))
            falls = (1.0 + nodes.smoothing) * np.ones(3)
            nodes.scale = falls * largest
            nodes.mean = falls * mean_of(pixels, light, shapes[index])
            normalized = pixels / largest if largest > 0.0 else pixels
            texels[y : y + map_height + 2, x : x + map_width + 2, :3] = bordered(normalized, shapes[index])
            nodes.place = (x + 1) / width, (y + 1) / height, map_width / width, map_height / height
        if self._texture is not None:
            self.disown(self._texture)
        texture = _TEXTURE.make(self._context.moderngl, (width, height), texels.tobytes())
        self._texture = self.own(texture, "light maps")

    @property
    def texture(self) -> moderngl.Texture:
        """The maps of all lights, which light_maps.glsl reads."""
        return require(self._texture)


def is_sphere(light: Light) -> bool:
    """Whether the normals of a light are those of a sphere, and not the light's direction."""
    return light.kind in (LightKind.POINT, LightKind.SPOT) and light.radius > 0.0 and not light.soft_falloff


def _shape(light: Light, varies: LightVariation) -> MapShape:
    if light.kind is LightKind.AREA:
        return MapShape.PLACES if varies.place or varies.uv else MapShape.DIRECTIONS
    if light.kind is LightKind.SUN:
        return MapShape.CONE
    if light.kind is LightKind.SPOT:
        if is_sphere(light) and varies.place:
            return MapShape.NORMALS
        return MapShape.CONE if varies.uv or 0.5 * light.spot_angle < _WIDEST_CONE else MapShape.DIRECTIONS
    return MapShape.NORMALS if is_sphere(light) and (varies.place or varies.uv) else MapShape.DIRECTIONS


def _extent(light: Light) -> float:
    """Tangent of half of what a cone's map shows."""
    half = 0.5 * light.spot_angle if light.kind is LightKind.SPOT else max(0.5 * light.sun_angle, 1e-3)
    return math.tan(min(half, 1.57))


def _size(light: Light, shape: MapShape, images: list[Image]) -> tuple[int, int]:
    """Width and height of a map that shows the pixels of the images in use."""
    if light.kind is LightKind.SUN and light.sun_angle <= 0.0:
        return 1, 1
    widths = [
        images[node.image].pixels.shape[1] for node in require(light.graph).nodes if 0 <= node.image < len(images)
    ]
    spherical = shape in (MapShape.NORMALS, MapShape.DIRECTIONS)
    least = _PATTERN_WIDTH if spherical else _PATTERN_WIDTH // 2
    width = min(max([least, *widths]), _WIDEST_MAP)
    return width, width // 2 if spherical else width


def packed_places(
    sizes: dict[int, tuple[int, int]], widest: int
) -> tuple[dict[int, tuple[int, int, int, int]], tuple[int, int]]:
    """(x, y, width, height) of maps side by side in rows, and the width and height of all, borders included. Maps
    become smaller where all of them would be too large."""
    while True:
        places, x, y, row, width = {}, 0, 0, 0, 1
        for index in sorted(sizes, key=lambda index: -sizes[index][1]):
            across, up = sizes[index]
            if x + across + 2 > widest:
                x, y, row = 0, y + row, 0
            places[index] = (x, y, across, up)
            x, row = x + across + 2, max(row, up + 2)
            width = max(width, x)
        height = max(y + row, 1)
        if height <= widest and width * height <= _MAX_TEXELS:
            return places, (width, height)
        sizes = {index: (max(across // 2, 1), max(up // 2, 1)) for index, (across, up) in sizes.items()}


def bordered(pixels: np.ndarray, shape: MapShape) -> np.ndarray:
    """A map with a texel more on every side."""
    around: Literal["wrap", "edge"] = "wrap" if shape in (MapShape.NORMALS, MapShape.DIRECTIONS) else "edge"
    return np.pad(np.pad(pixels, ((0, 0), (1, 1), (0, 0)), around), ((1, 1), (0, 0), (0, 0)), "edge")


def _asked(
    light: Light, shape: MapShape, size: tuple[int, int], distance: float, materials: MaterialTables
) -> np.ndarray:
    axes = np.asarray(light.matrix, np.float64)[:3, :3]
    lengths = np.maximum(np.linalg.norm(axes, axis=0), 1e-9)
    normal, u, v = -axes[:, 2] / lengths[2], axes[:, 0], axes[:, 1]
    if light.kind is LightKind.AREA:
        kind = LightSurfaceKind.AREA
        width, height = light.size if light.shape in ("RECTANGLE", "ELLIPSE") else (light.size[0], light.size[0])
        u, v = 0.5 * width * u, 0.5 * height * v
    else:
        kind = LightSurfaceKind.SPHERE
        if light.kind is LightKind.SUN:
            kind = LightSurfaceKind.SUN_OF_A_WORLD if light.of_world else LightSurfaceKind.SUN
            u, v = u * lengths[2] / lengths[0], v * lengths[2] / lengths[1]
        u, v = (_extent(light) * axis / lengths[2] for axis in (u, v))
    light_surface = LightSurface(
        kind, shape, np.asarray(light.matrix)[:3, 3], normal, u, v, light.radius if is_sphere(light) else 0.0,
        object_record(light.matrix),
    )  # fmt: skip
    return materials.evaluate(require(light.graph), *size, ray_length=distance, light_surface=light_surface)


def mean_of(pixels: np.ndarray, light: Light, shape: MapShape) -> np.ndarray:
    """(3,) of a map over what the light is seen by."""
    height, width = pixels.shape[:2]
    y, x = ((np.arange(n) + 0.5) / n for n in (height, width))
    if shape in (MapShape.NORMALS, MapShape.DIRECTIONS):
        azimuth, polar = (0.5 - x)[None, :] * 2.0 * np.pi, ((1.0 - y) * np.pi)[:, None]
        weight = np.sin(polar) * np.ones_like(azimuth)
        if light.kind is not LightKind.POINT:
            axis = -np.asarray(light.matrix, np.float64)[:3, 2]
            axis = axis / max(float(np.linalg.norm(axis)), 1e-9)
            cosine = np.sin(polar) * (axis[0] * np.cos(azimuth) + axis[1] * np.sin(azimuth)) + axis[2] * np.cos(polar)
            widest = 0.5 * np.pi if light.kind is LightKind.AREA or is_sphere(light) else 0.5 * light.spot_angle
            weight = weight * np.clip((cosine - math.cos(widest)) / (1.0 - math.cos(widest)), 0.0, 1.0)
    else:
        r2 = (2.0 * x[None, :] - 1.0) ** 2 + (2.0 * y[:, None] - 1.0) ** 2
        weight = np.ones((height, width))
        if shape is MapShape.CONE:
            weight = (1.0 + _extent(light) ** 2 * r2) ** -1.5
        if shape is MapShape.CONE or light.shape in ("DISK", "ELLIPSE"):
            weight = weight * (r2 <= 1.0)
    return np.einsum("yxc,yx->c", pixels.astype(np.float64), weight) / max(weight.sum(), 1e-30)


def _even(light: Light, varies: LightVariation, shape: MapShape | None, materials: MaterialTables) -> LightNodes:
    """The factor of all of a light and how it falls off."""
    asked = shape or MapShape.DIRECTIONS
    extent = _extent(light) if asked is MapShape.CONE else 0.0

    def mean(distance: float) -> np.ndarray:
        return mean_of(_asked(light, asked, _COARSE, distance, materials), light, asked)

    near_values = mean(1.0)
    found = LightNodes(near_values, near_values, shape=shape, extent=extent)
    if light.kind is LightKind.SUN or not varies.distance:
        return found
    near, twice, far, farther = (float(np.abs(value).sum()) for value in (near_values, *map(mean, (2.0, 1e4, 2e4))))
    if min(near, twice, far, farther) <= 0.0:
        return found
    found.falloff = math.log2(farther / far)
    grown = min(0.25 * twice / near / 2.0**found.falloff, 0.999)  # a quarter without smoothing
    found.smoothing = (4.0 * grown - 1.0) / (1.0 - grown) if grown > 0.2501 else 0.0
    found.scale = found.mean = near_values * (1.0 + found.smoothing)
    return found
