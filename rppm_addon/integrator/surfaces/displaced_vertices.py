# SPDX-License-Identifier: GPL-3.0-or-later
"""Offsets of vertices by the displacement of materials, computed on the device."""

import dataclasses

import numpy as np

from ...gl.buffer_sets import BufferSet, Part, StorageBuffer
from ...gl.buffers.records import Record
from ...gl.context.context import Context
from ...gl.programs.program import ComputeProgram
from ...gl.programs.programs import ProgramLibrary
from ...gl.programs.sources import CompileError
from ...materials.tables import MaterialTables, first_line
from ...scene.meshes import SMOOTH_NORMALS, Instance, Mesh
from ...scene.scene import Scene
from ..common.affine import determinants
from .geometry import Geometry
from .placements import Placement
from .surface_attributes import SurfaceAttributes

DISPLACED_VERTEX = Record(
    "DisplacedVertex",
    normal="vec3",
    triangle="uint",
    corner="uint",
    first_constant="uint",
    unused0="uint",
    unused1="uint",
)
"""A vertex by a world triangle and which of its corners it is, with the normal along which it moves, object space, and
where the constants of the material's graph begin."""
Record(
    "DisplaceParameters",
    world_to_camera="mat4",
    window="vec4",
    world_origin="vec3",
    count="uint",
    attribute_count="uint",
    orthographic="uint",
    pixel_size="float",
)

_STAGE = "surfaces/geometry/displace.comp"
_AT_ONCE = 1 << 20
"""Vertices of a dispatch, whose buffers any device allows."""


def _triangle_materials(mesh: Mesh, instance: Instance) -> np.ndarray:
    """(triangles,) indices of the materials that an instance's triangles have, -1 for none."""
    materials = np.array(instance.materials or [-1], np.int64)
    return materials[np.minimum(mesh.triangle_slots, len(materials) - 1)]


def has_stand_in(library: ProgramLibrary, text: str) -> bool:
    """Whether the program of a displacement's GLSL is still to be compiled in the background (see ProgramLibrary)."""
    return library.has_stand_in(_STAGE, _inserts(text))


class DisplacedVertices(BufferSet):
    """Runs the programs of graphs on vertices instead of hits. Holds meshes of its own, so it does not live long."""

    remedy = "lower the subdivision of what is displaced"
    _vertices = StorageBuffer("displaced vertices", DISPLACED_VERTEX)
    _offsets = StorageBuffer("displacements", "vec4")
    _surface_attributes = Part(SurfaceAttributes)

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        super().__init__(context, library)
        self._library = library
        self._geometry = self.own(Geometry(context, library))

    def offsets(self, scene: Scene, materials: MaterialTables, shapes: list[tuple[Mesh, Instance]]) -> list[np.ndarray]:
        """(vertices, 3) float32 for each mesh with the instance that nodes are asked of: how far its vertices move, in
        object space; what is not finite counts as 0.

        Each vertex is asked once, at the first triangle with it whose material displaces, as in Cycles: so no cracks
        open where UV maps, edges or materials meet. Programs that the driver refuses displace nothing, with a warning
        in scene.warnings. Raises DeviceError.
        """
        for text in {graph.text for graph in materials.displacing.values()}:
            self._library.expect(_STAGE, _inserts(text))
        meshes = [mesh for mesh, _ in shapes]
        instances = [dataclasses.replace(instance, mesh=place) for place, (_, instance) in enumerate(shapes)]
        alone = Scene(scene.camera, meshes, instances, scene.materials, world_origin=scene.world_origin)
        self._geometry.build(alone, materials.default_material)
        self._surface_attributes.build(alone, self._geometry, materials.attribute_names)
        found = [np.zeros((len(mesh.positions), 3), np.float32) for mesh in meshes]
        for placement in self._geometry.placements:
            mesh, offsets = meshes[placement.instance.mesh], found[placement.instance.mesh]
            wanted = _triangle_materials(mesh, placement.instance)
            first = _first_corners(mesh, np.isin(wanted, list(materials.displacing)))
            vertices = np.flatnonzero(first >= 0)
            given_by = wanted[first[vertices] // 3]
            for material in np.unique(given_by).tolist():
                graph, own = materials.displacing[material], vertices[given_by == material]
                program = self._program(graph.text, scene, scene.materials[material].name)
                if program is None:
                    continue
                for some in np.array_split(own, -(-len(own) // _AT_ONCE)):
                    records = _records(mesh, placement, first[some], graph.first_constant)
                    offsets[some] = self._run(program, records, scene, materials)
        return found

    def _program(self, text: str, scene: Scene, material: str) -> ComputeProgram | None:
        try:
            return self._library.compute(_STAGE, inserts=_inserts(text))
        except CompileError as error:
            reason = first_line(error)
            scene.warn(f'Material "{material}": the driver does not compile its displacement ({reason}); it has none')
            return None

    def _run(self, program: ComputeProgram, records: np.ndarray, scene: Scene, materials: MaterialTables) -> np.ndarray:
        camera = scene.camera
        self._vertices.upload(records)
        self._offsets.require_items(len(records))
        buffers = {
            **materials.blocks,
            **self._surface_attributes.blocks,
            "Triangles": self._geometry.triangles.buffer,
            "Attributes": self._geometry.attributes.buffer,
            "DisplacedVertices": self._vertices.buffer,
            "Offsets": self._offsets.buffer,
        }
        parameters = {
            "world_to_camera": np.linalg.inv(camera.matrix),
            "window": camera.window,
            "world_origin": scene.world_offset,
            "count": len(records),
            "attribute_count": self._surface_attributes.count,
            "orthographic": camera.orthographic,
            "pixel_size": camera.pixel_size,
        }
        program.run(len(records), {name: buffers[name] for name in program.blocks}, parameters)
        offsets = self._offsets.read(np.float32, 4 * len(records)).reshape(-1, 4)[:, :3]
        return np.where(np.isfinite(offsets), offsets, np.float32(0.0))


def _inserts(text: str) -> dict[str, str]:
    return {"materials/generated.glsl": text}


def _first_corners(mesh: Mesh, displaces: np.ndarray) -> np.ndarray:
    """(vertices,) 3 * triangle + corner where each vertex comes first among triangles that are displaced (triangles,);
    -1 where it does not."""
    places = (3 * np.flatnonzero(displaces)[:, None] + np.arange(3)).ravel()[::-1]
    first = np.full(len(mesh.positions), -1, np.int64)
    first[mesh.corner_vertices[mesh.triangle_corners.reshape(-1)[places]]] = places  # of several the last stays
    return first


def _records(mesh: Mesh, placement: Placement, places: np.ndarray, first_constant: int) -> np.ndarray:
    """DISPLACED_VERTEX of the corners 3 * triangle + corner of an instance's mesh."""
    records = DISPLACED_VERTEX.zeros(len(places))
    corners = mesh.triangle_corners.reshape(-1)[places]
    smooth = mesh.attributes.get(SMOOTH_NORMALS)
    records["normal"] = mesh.corner_normals[corners] if smooth is None else smooth.values[corners, :3]
    records["triangle"] = placement.first_triangle + places // 3
    corner = places % 3
    (determinant,) = determinants(np.asarray(placement.instance.matrix)[None])
    records["corner"] = (3 - corner) % 3 if determinant < 0.0 else corner
    records["first_constant"] = first_constant
    return records
