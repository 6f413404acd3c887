# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials and images in GPU buffers, as shaders/materials/ reads them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..gl.buffer_sets import BufferSet, Part
from ..gl.buffers.buffers import GrowingBuffer
from ..gl.context.context import Context
from ..gl.programs.programs import ProgramLibrary
from ..gl.programs.sources import CompileError
from ..scene.images import Image
from ..scene.materials import Material
from ..scene.node_graphs import NodeGraph
from ..scene.passes import RenderPass, aov_passes
from ..scene.scene import Scene
from ..scene.storage.sharing import same_members
from . import albedo_tables, dispersion
from .compiler.compiler import (
    NEUTRAL_TEXT,
    CompiledGraph,
    GraphError,
    NodeRayCounts,
    Resource,
    compile_displacement,
    compile_graph,
)
from .evaluation import GraphEvaluator, LightSurface
from .records import IMAGE_ENTRY, MATERIAL, MOST_MEDIA, TexelFormat
from .traits.emitted import Emits, emits
from .traits.interiors import Interior
from .traits.transparency import passes_shadow_rays
from .traits.view_dependence import depends_on_view


def default_material() -> Material:
    """Return the material of faces that have none, as in Blender."""
    graph = NodeGraph()
    graph.surface = graph.add("bsdf_diffuse", "bsdf", color=(0.8, 0.8, 0.8))
    return Material("default", graph)


_DARK = "it gives nothing"


def first_line(error: Exception) -> str:
    """Return the first line of a driver's message with "error" in it, or else its first 200 characters, for messages of
    one line."""
    return next((line for line in str(error).splitlines() if "error" in line.lower()), str(error).strip()[:200])


def _texels(image: Image) -> tuple[np.ndarray, TexelFormat]:
    pixels, srgb = np.ascontiguousarray(image.pixels), image.encoding == "SRGB"
    if pixels.dtype == np.uint8:
        return pixels.reshape(-1, 4).view(np.uint32).ravel(), TexelFormat.SRGB_BYTES if srgb else TexelFormat.BYTES
    halves = np.clip(np.nan_to_num(pixels), -65504, 65504).astype(np.float16)
    return halves.reshape(-1, 4).view(np.uint32).ravel(), TexelFormat.SRGB_HALF if srgb else TexelFormat.HALF


@dataclass(frozen=True)
class DisplacingGraph:
    """Compiled graph that displaces the vertices of a material's faces."""

    text: str
    """GLSL."""
    first_constant: int
    """In the buffer MaterialData."""
    keeps_normals: bool
    """Whether they stay what they were before, as the same nodes turn them by bump."""


class MaterialTables(BufferSet):
    """The buffers Materials, MaterialData, Images, Texels and AlbedoTables, and the GLSL of the graphs.

    ``programs`` lists the distinct texts that materials need, ``attribute_names`` the mesh attributes that their
    nodes read, ``emits`` says of each material whether it emits light; faces without a material have the
    ``default_material``, the last.
    """

    remedy = "use smaller or fewer image textures"
    _evaluator = Part(GraphEvaluator)

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        super().__init__(context, library)
        names = ("Materials", "MaterialData", "Images", "Texels", "AlbedoTables")
        self._buffers = {
            name: self.own(GrowingBuffer(context, f"material {name}", self.remedy, texel_bytes=16)) for name in names
        }
        self._buffers["AlbedoTables"].upload(np.concatenate([albedo_tables.load(), dispersion.table().ravel()]))
        self.default_material = 0
        self.programs: list[str] = []
        self.attribute_names: list[str] = []
        self.emits: list[Emits] = []
        self.any_depends_on_view = False
        """Whether what a material scatters depends on where it is seen from."""
        self.materials_with_media: frozenset[int] = frozenset()
        """By index, those whose inside is filled."""
        self.media_emit = False
        """True where any medium shines."""
        self.any_passes_shadow_rays = False
        """True where shadow rays may pass the surfaces of a material."""
        self.displacing: dict[int, DisplacingGraph] = {}
        """By index, those materials that move vertices."""
        self.users: dict[str, list[str]] = {}
        """By text, the names of the materials that it belongs to."""
        self.rays: dict[str, NodeRayCounts] = {}
        """By text, what its nodes ask of rays."""
        self._others: dict[int, tuple[str, int, str]] = {}
        self._media: list[Interior] = []
        """Kept, as ``_others`` has their graphs by id."""
        self._images: list[Image] = []
        self._scene: Scene | None = None

    @property
    def buffers(self) -> dict:
        """moderngl buffers by block name."""
        return {name: buffer.buffer for name, buffer in self._buffers.items()}

    def build(self, scene: Scene) -> None:
        """Compile the graphs of a scene and upload their constants, and the images that they use.

        A graph that is not well formed is replaced by a gray surface, or gives no light, with a warning in
        scene.warnings.
        """
        self.follow(scene)
        self.default_material = len(scene.materials)
        materials = [*scene.materials, default_material()]
        aovs = aov_passes(scene.settings.aovs)
        compiled, self.emits, self.users, self.rays = [], [], {}, {}
        for material in materials:
            owner = f'Material "{material.name}"'
            graph, emission = self._compile(
                material.graph,
                owner,
                "it is gray",
                aovs,
                material.abbe_number,
                on_round_shapes=material.on_round_shapes,
            )
            compiled.append(graph)
            self.emits.append(emission)
            self.users.setdefault(graph.text, []).append(material.name)
            self.rays[graph.text] = graph.rays.united(self.rays.get(graph.text, graph.rays))
        self.programs = list(dict.fromkeys(graph.text for graph in compiled))
        number = {text: index for index, text in enumerate(self.programs)}
        layout = _Layout(scene.images)
        records = MATERIAL.zeros(len(materials))
        for record, material, graph in zip(records, materials, compiled, strict=True):
            record["program"] = number[graph.text]
            record["first_constant"] = layout.add(material.graph, graph)
            record["opaque_shadow"] = not material.transparent_shadow
            record["passes_shadow_rays"] = (
                material.transparent_shadow and material.interior is None and passes_shadow_rays(material.graph)
            )
            record["pass_index"] = material.pass_index
            record["depends_on_view"] = depends_on_view(material.graph)
        self.any_depends_on_view = bool(records["depends_on_view"].any())
        self.any_passes_shadow_rays = bool(records["passes_shadow_rays"].any())
        self.displacing = self._compile_displacements(scene.materials, layout)
        media = self._media = [Interior.of(material.interior) for material in materials]
        others = [("The world", scene.world.graph)]
        others += [(f'Light "{light.name}"', light.graph) for light in scene.lights]
        for material, interior in zip(materials, media, strict=True):
            owner = f'The volume of material "{material.name}"'
            others += [(owner, interior.absorption), (owner, interior.emission)]
            if interior.varies:
                scene.warn(f"{owner} varies from place to place, which is not rendered; one value stands for all")
        self._others = {}
        for owner, other in others:
            if other is not None:
                compiled_graph, _ = self._compile(other, owner, _DARK, traces_rays=False)
                self._others[id(other)] = compiled_graph.text, layout.add(other, compiled_graph), owner
        self.attribute_names = list(layout.attributes)
        self._buffers["MaterialData"].upload(layout.data())
        self._upload_images(layout.images())
        self._number_media(records, media)
        self._buffers["Materials"].upload(records)

    def _number_media(self, records: np.ndarray, interiors: list[Interior]) -> None:
        """Enter what the materials' interiors are made of into their records."""
        coefficients = np.zeros((len(records), 2, 3), np.float32)
        for values, interior in zip(coefficients, interiors, strict=True):
            for value, graph in zip(values, (interior.absorption, interior.emission), strict=True):
                if graph is not None:
                    value[:] = np.maximum(self.evaluate(graph)[0, 0], 0.0)
        filled = np.flatnonzero(coefficients.any(axis=(1, 2)))
        if len(filled) > MOST_MEDIA:
            self._scene.warn(f"{len(filled)} materials have volumes; those of the first {MOST_MEDIA} are rendered")
            filled = filled[:MOST_MEDIA]
        records["medium"][filled] = 1 + np.arange(len(filled))
        records["medium_bits"] = max(len(filled).bit_length(), 1)
        records["medium_absorption"][: len(filled)] = coefficients[filled, 0]
        records["medium_emission"][: len(filled)] = coefficients[filled, 1]
        self.materials_with_media = frozenset(filled.tolist())
        self.media_emit = bool(coefficients[filled, 1].any())

    def follow(self, scene: Scene) -> None:
        """Warn in this scene and evaluate as its camera sees, though what was built may have come with another."""
        self._scene = scene

    def _upload_images(self, images: list[Image]) -> None:
        """Upload the images, unless they are the very objects of the last build. Whoever changes an image gives a new
        one."""
        if same_members(images, self._images):
            return
        self._images = []  # should an upload fail
        entries, texels = _image_records(images)
        self._buffers["Images"].upload(entries)
        self._buffers["Texels"].upload(texels)
        self._images = images

    def _compile_displacements(self, materials: list[Material], layout: "_Layout") -> dict[int, DisplacingGraph]:
        found = {}
        for index, material in enumerate(materials):
            if material.graph.displacement is None:
                continue
            try:
                compiled = compile_displacement(material.graph)
            except GraphError as error:
                self._scene.warn(f'Material "{material.name}": {error}; it displaces nothing')
                continue
            first = layout.add(material.graph, compiled)
            found[index] = DisplacingGraph(compiled.text, first, material.graph.normal is not None)
        return found

    def _compile(
        self,
        graph: NodeGraph,
        owner: str,
        remedy: str,
        aovs: Sequence[RenderPass] = (),
        abbe_number: float | None = None,
        *,
        on_round_shapes: bool = False,
        traces_rays: bool = True,
    ) -> tuple[CompiledGraph, Emits]:
        try:
            compiled = compile_graph(graph, aovs, abbe_number, on_round_shapes=on_round_shapes, traces_rays=traces_rays)
            return compiled, emits(graph)
        except GraphError as error:
            self._scene.warn(f"{owner}: {error}; {remedy}")
            return CompiledGraph(NEUTRAL_TEXT), Emits.NOTHING

    def evaluate(
        self,
        graph: NodeGraph,
        width: int = 1,
        height: int = 1,
        from_camera: bool = False,
        ray_length: float = 0.0,
        light_surface: LightSurface | None = None,
    ) -> np.ndarray:
        """(height, width, 3) float32 emission of a graph of the scene that belongs to no surface.

        Pixels are the directions of an equirectangular map, row 0 at the bottom; from_camera: as the camera sees it;
        ray_length: what Light Path tells, meters; light_surface: whose nodes they are, with a map of another shape.
        """
        text, first, owner = self._others[id(graph)]
        try:
            return self._evaluator.run(
                text, first, self.buffers, width, height, from_camera, ray_length, self._scene, light_surface
            )
        except CompileError as error:
            self._scene.warn(f"{owner}: the driver does not compile its nodes ({first_line(error)}); {_DARK}")
            return np.zeros((height, width, 3), np.float32)


class _Layout:
    """Constants of all materials one after the other, and then their tables."""

    def __init__(self, images: list[Image]) -> None:
        self._images = images
        self._numbers: list[float] = []
        self._tables: list[np.ndarray] = []
        self._pending: list[tuple[int, int]] = []
        """Where the start of which table goes."""
        self._used: dict[int, int] = {}
        self.attributes: dict[str, int] = {}

    def add(self, graph: NodeGraph, compiled: CompiledGraph) -> int:
        """Take the constants of a graph; returns where they start."""
        first = len(self._numbers)
        for constant in compiled.constants:
            self._numbers.append(self._number(graph, constant) if isinstance(constant, Resource) else constant)
        return first

    def _number(self, graph: NodeGraph, resource: Resource) -> float:
        node = graph.nodes[resource.node]
        if resource.what == "image":
            return float(self._image(node.image))
        if resource.what == "attribute":
            return float(self.attributes.setdefault(resource.name or node.attribute, len(self.attributes)))
        table = np.zeros(4, np.float32) if node.table is None else np.asarray(node.table, np.float32)
        if node.kind == "tex_image_tiles":
            table = np.array([-1.0 if image < 0 else self._image(int(image)) for image in table.ravel()], np.float32)
        self._pending.append((len(self._numbers), len(self._tables)))
        self._tables.append(table.ravel())
        return 0.0

    def _image(self, image: int) -> int:
        return self._used.setdefault(image if 0 <= image < len(self._images) else -1, len(self._used))

    def data(self) -> np.ndarray:
        """(n,) float32 of constants and tables."""
        starts = len(self._numbers) + np.concatenate([[0], np.cumsum([len(table) for table in self._tables])])
        for place, table in self._pending:
            self._numbers[place] = float(starts[table])
        return np.concatenate([np.array(self._numbers or [0.0], np.float32), *self._tables]).astype(np.float32)

    def images(self) -> list[Image]:
        """The images in use, at least one; one that is missing is magenta."""
        return [_MISSING if index < 0 else self._images[index] for index in self._used] or [_MISSING]


def _image_records(images: list[Image]) -> tuple[np.ndarray, np.ndarray]:
    """(n,) IMAGE_ENTRY records, and (m,) uint32, the images' texels one after the other."""
    entries = IMAGE_ENTRY.zeros(len(images))
    texels, first = [], 0
    for entry, image in zip(entries, images, strict=True):
        data, kind = _texels(image)
        height, width = image.pixels.shape[:2]
        entry["first_texel"], entry["width"], entry["height"], entry["format"] = first, width, height, kind
        texels.append(data)
        first += len(data)
    return entries, np.concatenate(texels)


_MISSING = Image("missing", np.array([[[255, 0, 255, 255]]], np.uint8), "LINEAR")
