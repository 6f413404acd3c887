# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials and images in GPU buffers, as shaders/materials/ reads them."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..gl.buffer_sets import BufferSet, Part, StorageBuffer
from ..gl.context.context import Context
from ..gl.programs.program import Bindable
from ..gl.programs.programs import ProgramLibrary
from ..gl.programs.sources import CompileError
from ..scene.images import Image
from ..scene.materials import Material
from ..scene.meshes import Instance
from ..scene.node_graphs import NodeGraph
from ..scene.scene import Scene
from ..scene.storage.sharing import same_members
from . import albedo_tables, dispersion
from .compiler.constant_layout import ConstantLayout
from .compiler.scene_graphs import NO_EFFECT, SceneGraphs, TextUse, UnattachedGraph
from .evaluation import GraphEvaluator, LightSurface
from .images import image_records
from .media.bricks import BRICK_VOXELS, Lattice
from .media.grids import PlacedMedium
from .media.tables import MediaTables
from .media.volume_attributes import VolumeAttributes
from .media.voxel_evaluation import VoxelEvaluator
from .records import IMAGE_ENTRY, MATERIAL
from .traits.emitted import Emits
from .traits.transparency import bounds_volume_alone, passes_shadow_rays
from .traits.view_dependence import depends_on_view


def default_material() -> Material:
    """Return the material of faces that have none, as in Blender."""
    graph = NodeGraph()
    graph.surface = graph.add("bsdf_diffuse", "bsdf", color=(0.8, 0.8, 0.8))
    return Material("default", graph)


def first_line(error: Exception) -> str:
    """Return the first line of a driver's message with "error" in it, or else its first 200 characters, for messages of
    one line."""
    return next((line for line in str(error).splitlines() if "error" in line.lower()), str(error).strip()[:200])


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

    ``programs`` has the distinct texts that materials need, with the materials of each; ``attribute_names`` the mesh
    attributes that their nodes read; ``emits`` says of each material whether it emits light; faces without a material
    have the ``default_material``, the last.
    """

    remedy = "use smaller or fewer image textures"
    _materials = StorageBuffer("material Materials", MATERIAL, texel_bytes=16, block="Materials")
    _data = StorageBuffer("material MaterialData", "float", texel_bytes=16, block="MaterialData")
    _image_entries = StorageBuffer("material Images", IMAGE_ENTRY, texel_bytes=16, block="Images")
    _texels = StorageBuffer("material Texels", "uint", texel_bytes=16, block="Texels")
    _albedo_tables = StorageBuffer("material AlbedoTables", "float", texel_bytes=16, block="AlbedoTables")
    media = Part(MediaTables)
    _evaluator = Part(GraphEvaluator)
    _voxel_evaluator = Part(VoxelEvaluator)
    _volume_attributes = Part(VolumeAttributes)

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        super().__init__(context, library)
        self._albedo_tables.upload(np.concatenate([albedo_tables.load(), dispersion.table().ravel()]))
        self.default_material = 0
        self.programs: dict[str, TextUse] = {}
        self.attribute_names: list[str] = []
        self.emits: list[Emits] = []
        self.any_depends_on_view = False
        """Whether what a material scatters depends on where it is seen from."""
        self.any_passes_shadow_rays = False
        """True where shadow rays may pass the surfaces of a material."""
        self.any_resolves_shadow_rays = False
        """True where they may pass such as do more than to bound a volume."""
        self.displacing: dict[int, DisplacingGraph] = {}
        """By index, those materials that move vertices."""
        self._unattached: dict[int, tuple[UnattachedGraph, int]] = {}
        """Graphs that belong to no surface, with the places of their constants, by the graph's identity."""
        self._images: list[Image] = []
        self._scene: Scene | None = None

    def build(self, scene: Scene) -> None:
        """Compile the graphs of a scene and upload their constants, and the images that they use.

        A graph that is not well formed is replaced by a gray surface, or gives no light, with a warning in
        scene.warnings.
        """
        self.follow(scene)
        self.default_material = len(scene.materials)
        materials = [*scene.materials, default_material()]
        graphs = SceneGraphs(scene, materials)
        self.emits, self.programs = graphs.emits, graphs.texts
        layout = ConstantLayout(scene.images)
        records = _material_records(materials, graphs, layout)
        self.any_depends_on_view = bool(records["depends_on_view"].any())
        self.any_passes_shadow_rays = bool(records["passes_shadow_rays"].any())
        self.any_resolves_shadow_rays = bool((records["passes_shadow_rays"] > records["bounds_volume"]).any())
        self.displacing = {
            index: DisplacingGraph(
                compiled.text,
                layout.add(materials[index].graph, compiled),
                materials[index].graph.normal is not None,
            )
            for index, compiled in graphs.displacements.items()
        }
        self._unattached = {
            id(entry.graph): (entry, layout.add(entry.graph, entry.compiled)) for entry in graphs.unattached
        }
        self.attribute_names = list(layout.attributes)
        self._data.upload(layout.data())
        self._upload_images(layout.images())
        self.media.build(scene, records, graphs.interiors, graphs.world_interior, self.evaluate)
        self._materials.upload(records)

    def place_media(self, scene: Scene) -> bool:
        """Give each instance whose medium varies a material of its own; returns whether there are any."""
        if not self.media.places.any:
            return False
        self._materials.upload(self.media.place(scene))
        return True

    def bake_media(
        self,
        scene: Scene,
        placed: Sequence[Instance],
        bounds: tuple[np.ndarray, np.ndarray],
        blocks: Mapping[str, Bindable],
    ) -> None:
        """Bake the media that vary, after place_media.

        placed: the instances of the scene that have triangles; bounds: of the scene, low and high, (3,) each; blocks:
        what nodes read of instances, by name.
        """
        if not self.media.places.any:
            return

        bound = {**self.blocks, **blocks}

        def evaluate(graph: NodeGraph, lattice: Lattice, placed: PlacedMedium) -> np.ndarray:
            entry, first = self._unattached[id(graph)]
            self._volume_attributes.upload(self.attribute_names, placed.volume, placed.attributes)
            try:
                return self._voxel_evaluator.run(
                    entry.compiled.text,
                    first,
                    bound,
                    scene,
                    lattice,
                    placed.instance,
                    placed.matrix,
                    self._volume_attributes.blocks,
                )
            except CompileError as error:
                scene.warn(f"{entry.owner}: the driver does not compile its nodes ({first_line(error)}); {NO_EFFECT}")
                return np.zeros((int(np.prod(lattice.bricks)), BRICK_VOXELS, 3), np.float32)

        self.media.bake(scene, list(self.media.places.media(scene, placed, bounds)), evaluate, self.evaluate)

    def follow(self, scene: Scene) -> None:
        """Warn in this scene and evaluate as its camera sees, though what was built may have come with another."""
        self._scene = scene

    def _upload_images(self, images: list[Image]) -> None:
        """Upload the images, unless they are the very objects of the last build. Whoever changes an image gives a new
        one."""
        if same_members(images, self._images):
            return
        self._images = []  # should an upload fail
        entries, texels = image_records(images)
        self._image_entries.upload(entries)
        self._texels.require_items(sum(map(len, texels)))
        offset = 0
        for part in texels:
            self._texels.write(part, offset)
            offset += part.nbytes
        self._images = images

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
        ray_length: Ray Length of Light Path, meters; light_surface: whose nodes they are, with a map of another shape.
        """
        return np.concatenate(list(self.evaluated(graph, width, height, from_camera, ray_length, light_surface)))

    def evaluated(
        self,
        graph: NodeGraph,
        width: int,
        height: int,
        from_camera: bool = False,
        ray_length: float = 0.0,
        light_surface: LightSurface | None = None,
    ) -> Iterator[np.ndarray]:
        """Bands of (rows, width, 3) float32 of what evaluate gives, from the lowest on."""
        entry, first = self._unattached[id(graph)]
        text, scene = entry.compiled.text, self._scene
        assert scene is not None  # which has the graph
        try:
            yield from self._evaluator.run(
                text, first, self.blocks, width, height, from_camera, ray_length, scene, light_surface
            )
        except CompileError as error:
            scene.warn(f"{entry.owner}: the driver does not compile its nodes ({first_line(error)}); {NO_EFFECT}")
            yield np.zeros((height, width, 3), np.float32)


def _material_records(materials: list[Material], graphs: SceneGraphs, layout: ConstantLayout) -> np.ndarray:
    """(n,) MATERIAL records, whose constants are added to the layout."""
    number = {text: index for index, text in enumerate(graphs.texts)}
    records = MATERIAL.zeros(len(materials))
    for record, material, compiled in zip(records, materials, graphs.surfaces, strict=True):
        record["program"] = number[compiled.text]
        record["first_constant"] = layout.add(material.graph, compiled)
        record["opaque_shadow"] = not material.transparent_shadow
        record["passes_shadow_rays"] = material.transparent_shadow and passes_shadow_rays(material.graph)
        record["bounds_volume"] = material.transparent_shadow and bounds_volume_alone(material.graph)
        record["pass_index"] = material.pass_index
        record["depends_on_view"] = depends_on_view(material.graph)
    return records
