# SPDX-License-Identifier: GPL-3.0-or-later
"""The world as a map of all directions and as a distribution to sample directions from."""

from collections.abc import Iterable

import moderngl
import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.textures import TextureKind
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...materials.tables import MaterialTables
from ...materials.traits.emitted import Emits, asks_for_path, emits
from ...scene.images import Image
from ...scene.lights import World
from ...scene.node_graphs import Link, NodeGraph, ShaderNode

_WIDEST = 512
_NARROWEST_MAP, _WIDEST_MAP = 1024, 4096
_LARGEST_HALF = 65504.0


def _reduced(brightness: np.ndarray) -> np.ndarray:
    """Brightness averaged over whole blocks until it is at most _WIDEST wide."""
    step = -(-brightness.shape[1] // _WIDEST)
    height, width = (n // step * step for n in brightness.shape)
    if step == 1 or height == 0:
        return brightness
    return brightness[:height, :width].reshape(height // step, step, width // step, step).mean(axis=(1, 3))


def distribution_of(brightness: np.ndarray) -> np.ndarray:
    """Cumulated probabilities of rows, then of the cells of each row, flat float32.

    ``brightness`` is (height, width), row 0 at the bottom; rows count by the sine of their polar angle.
    """
    return _directions_by(brightness + 0.01 * brightness.mean())


def _directions_by(brightness: np.ndarray) -> np.ndarray:
    height, _ = brightness.shape
    sine = np.sin(np.pi * (np.arange(height) + 0.5) / height)[:, None]
    weight = brightness * sine
    rows = weight.sum(axis=1)
    cells = np.cumsum(weight, axis=1) / np.where(rows > 0, rows, 1.0)[:, None]
    cells[:, -1] = 1.0
    cumulated = np.cumsum(rows) / rows.sum()
    cumulated[-1] = 1.0
    return np.concatenate([cumulated, cells.ravel()]).astype(np.float32)


_MAP = TextureKind(["environment_image", "environment_visible"], "f4", repeats=(True, False))
_FINE_MAP = TextureKind([], "f2", repeats=(True, False))
"""Maps that are wider than _WIDEST_MAP."""


class Environment(BufferSet):
    """The world for shaders/lights/environment.glsl; width 0 stands for a constant world.

    ``radiance`` (3,) is that of a constant world, or 1 where textures give it; ``mean_radiance`` (3,) W/(m^2 sr).
    """

    distribution = StorageBuffer("environment distribution", "float", block="EnvironmentDistribution")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: object = None) -> None:
        super().__init__(context, library, sizes)
        self._context = context
        self._textures: list[moderngl.Texture] = []
        self.width = self.height = 0
        self.radiance = self.mean_radiance = np.zeros(3)
        self.brightness: np.ndarray | None = None
        """(height, width) mean of the channels by direction, W/(m^2 sr), as directions are chosen by it; None of an
        even world."""
        self.image_width = 0
        """Pixels across the map that would show all of the world's image."""
        self.is_fine = False
        """True where rays, but for those that gather light, see a map wider than that of the light."""
        self._directions = np.zeros(0, np.float32)
        self.has_others = False
        """Whether there is another table of directions behind the world's."""

    @property
    def is_even(self) -> bool:
        """Whether it looks alike in all directions."""
        return self.width == 0

    @property
    def _widest(self) -> int:
        """Pixels across a map, at most."""
        return int(self._context.limits["GL_MAX_TEXTURE_SIZE"])

    @property
    def shown_width(self) -> int:
        """Pixels across what is shown of the world's image."""
        return min(self.image_width, self._widest)

    def build(self, world: World, images: list[Image], materials: MaterialTables) -> None:
        """Evaluate the world's nodes: once where they give one color, else for a map of all directions, and for
        another of what the camera sees where Light Path nodes distinguish it."""
        for texture in self._textures:
            self.disown(texture)
        self.width = self.height = 0
        self.brightness, self._directions, self.has_others = None, np.zeros(0, np.float32), False
        self.image_width, self.is_fine = 0, False
        self.radiance = self.mean_radiance = np.asarray(world.radiance, np.float64)
        if world.graph is None or emits(world.graph) is not Emits.VARYING:
            if world.graph is not None:
                self.radiance = self.mean_radiance = self.radiance * materials.evaluate(world.graph)[0, 0]
            self._textures = [self._texture(np.ones((1, 1, 3), np.float32))]
            return
        self.image_width = _map_width(world.graph, images)
        step = -(-self.shown_width // _WIDEST_MAP)
        width = self.shown_width // step // 2 * 2
        maps = [_means(materials.evaluated(world.graph, step * width, step * width // 2), step)]
        if asks_for_path(world.graph) and step == 1:
            maps.append(materials.evaluate(world.graph, width, width // 2, from_camera=True))
        maps = [pixels * self.radiance.astype(np.float32) for pixels in maps]
        self.radiance = np.ones(3)
        self._textures = [self._texture(pixels) for pixels in maps]
        if step > 1:
            self._textures.append(self._fine_texture(world, materials, step * width))
            self.is_fine = not asks_for_path(world.graph)
        sine = np.sin(np.pi * (np.arange(width // 2) + 0.5) / (width // 2))[:, None, None]
        # By magnitude, as what directions are chosen by: where light is negative, the rest does not outweigh it.
        self.mean_radiance = (np.abs(maps[0]) * sine).mean(axis=(0, 1), dtype=np.float64) / sine.mean()
        brightness = _reduced(np.abs(maps[0]).mean(axis=2, dtype=np.float64))
        self.height, self.width = brightness.shape
        self.brightness = brightness if brightness.max() > 0 else np.ones_like(brightness)
        self._directions = distribution_of(self.brightness)
        self.distribution.upload(self._directions)

    def add_directions(self, weights: np.ndarray | None) -> int:
        """Have another table of directions, chosen by weights (rows, columns) a steradian, behind the world's; None:
        have none. Returns where it begins."""
        if weights is not None or self.has_others:
            others = np.zeros(0, np.float32) if weights is None else _directions_by(weights)
            both = np.concatenate([self._directions, others])
            self.distribution.upload(both if len(both) else np.zeros(1, np.float32))
        self.has_others = weights is not None
        return len(self._directions)

    def _texture(self, pixels: np.ndarray) -> moderngl.Texture:
        rgba = np.ones((*pixels.shape[:2], 4), np.float32)
        rgba[..., :3] = pixels
        height, width = pixels.shape[:2]
        return self.own(_MAP.make(self._context.moderngl, (width, height), rgba.tobytes()), "environment")

    def _fine_texture(self, world: World, materials: MaterialTables, width: int) -> moderngl.Texture:
        """A map of half floats, as the camera sees it, made band by band: it may be larger than memory allows twice."""
        assert world.graph is not None
        texture = self.own(_FINE_MAP.make(self._context.moderngl, (width, width // 2)), "environment")
        first = 0
        for band in materials.evaluated(world.graph, width, width // 2, from_camera=True):
            rgba = np.ones((*band.shape[:2], 4), np.float16)
            rgba[..., :3] = np.clip(band * np.asarray(world.radiance, np.float32), -_LARGEST_HALF, _LARGEST_HALF)
            texture.write(rgba.tobytes(), viewport=(0, first, width, band.shape[0]))
            first += band.shape[0]
        return texture

    @property
    def textures(self) -> dict[str, moderngl.Texture]:
        """The maps by the names of their samplers in lights/environment.glsl: as light, and as the camera sees it."""
        return {"environment_image": self._textures[0], "environment_visible": self._textures[-1]}


def _means(bands: Iterable[np.ndarray], step: int) -> np.ndarray:
    """(H / step, W / step, 3) float32 means over squares of a map, of which bands of rows (rows, W, 3) come one after
    the other."""
    means, rest = [], np.zeros((0, 0, 3), np.float32)
    for band in bands:
        if step == 1:
            means.append(band)
            continue
        rest = np.concatenate([rest, band]) if len(rest) else band
        rows = len(rest) // step
        squares = rest[: rows * step].reshape(rows, step, rest.shape[1] // step, step, 3)
        means.append(squares.mean(axis=(1, 3), dtype=np.float32))
        rest = rest[rows * step :]
    return np.concatenate(means)


def _map_width(graph: NodeGraph, images: list[Image]) -> int:
    """Pixels across the map: those of an image that is shown as it is, else enough to show its pixels anywhere."""
    used = [node for node in graph.nodes if 0 <= node.image < len(images)]
    widest = max((images[node.image].pixels.shape[1] for node in used), default=0)
    patterns = any(node.kind.startswith("tex_") and node.image < 0 for node in graph.nodes)
    if used and not patterns and all(_is_plain(graph, node) for node in used):
        return max(widest + widest % 2, 2)
    return max(min(2 * widest, _WIDEST_MAP), widest + widest % 2, _NARROWEST_MAP)


def _is_plain(graph: NodeGraph, node: ShaderNode) -> bool:
    """Whether an image lies in the map pixel on pixel."""
    where = node.inputs.get("vector")
    linear = node.options.get("interpolation", "Linear") == "Linear"
    projections = {None, "EQUIRECTANGULAR", "SKY"}
    equirectangular = node.kind == "tex_environment" and node.options.get("projection") in projections
    direction = isinstance(where, Link) and (graph.nodes[where.node].kind, where.output) in _DIRECTIONS
    return linear and equirectangular and direction


_DIRECTIONS = {("generated_coord", "generated"), ("new_geometry", "position"), ("tex_coord", "object")}
"""Nodes and outputs that are the direction in a world."""
