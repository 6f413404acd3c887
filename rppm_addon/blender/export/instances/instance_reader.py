# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads of Blender's objects what a pass over a depsgraph places: descriptions of instances, and lights."""

import functools

import bpy
import numpy as np

from ....scene import Instance, Light, RayVisibility
from ..common.hashing import hashed
from ..context import ExportContext
from ..geometry.meshes.attributes import attribute_of
from ..geometry.meshes.rendered_meshes import has_no_faces
from ..geometry.strands.particle_hair import HairSystem
from ..geometry.strands.round_meshes import ROUND_TYPES, Hair, RoundSource
from ..geometry.volumes.gas_domains import is_gas_domain
from ..geometry.volumes.volume_meshes import GridSource
from ..shading.lights.lights import export_light
from ..shading.nodes.material_table import MaterialTable
from ..shading.nodes.missing_attributes import MissingAttributes
from ..view_layer.layers import light_group_of
from ..view_layer.visibility import is_seen, visibility_of
from .faceless import FacelessObjects
from .instance_attributes import COORDINATES, AttributeNotes, InstanceAttributes
from .instance_description import InstanceDescription, Instancer
from .mesh_table import MeshTable

CONVERTED_TYPES = {"CURVE", "FONT", "META", "SURFACE"}
"""Object types that are rendered as the mesh that Blender makes of them."""
SURFACE_TYPES = {"MESH", "VOLUME", *CONVERTED_TYPES, *ROUND_TYPES}
"""Object types that are rendered as surfaces; that of a volume is the box around it."""

_USE_UV = {"tex_coord", "attribute", "normal_map", "tangent", "uvmap", "tex_image", "tex_image_tiles"}
_WHOLE = {"OBJECT", "INSTANCER"}
"""Domains of attributes that objects have as a whole."""


class InstanceReader:
    """Reads objects for one pass; meshes and materials that the tables know are not exported again."""

    def __init__(self, context: ExportContext, materials: MaterialTable, meshes: MeshTable) -> None:
        self._context = context
        self._materials = materials
        self._meshes = meshes
        self._wanted: dict[tuple[tuple[int, ...], frozenset[str]], tuple[set[str], bool]] = {}
        """Results of wanted_attributes, by materials and the attributes that rays sample."""
        self.instance_attributes = InstanceAttributes()
        self.faceless = FacelessObjects()
        self.missing = MissingAttributes(meshes.meshes, materials.materials, materials.attributes)

    def keep(self, instance: Instance) -> bool:
        """Keep the mesh of an unchanged instance in use; False where the mesh has been forgotten."""
        if not self._meshes.knows(instance.mesh):
            return False
        self._meshes.keep(instance.mesh)
        self.missing.note(instance)
        return True

    def instancer(self, source: bpy.types.Object, uid: int) -> Instancer:
        """Read an object that multiplies others. uid: its session_uid."""
        visibility = visibility_of(source)
        layer_visibility, holdout = self._context.masks.of(source, visibility, source.is_holdout)
        return Instancer(
            uid,
            source.color[:],
            visibility,
            layer_visibility,
            holdout,
            source.is_shadow_catcher,
            self._light_group(source),
            self._context.light_links.of(source),
            len(source.particle_systems) > 0,
        )

    def describe(
        self,
        source: bpy.types.Object,
        multiplied: bpy.types.DepsgraphObjectInstance | None = None,
        before: Instance | None = None,
    ) -> InstanceDescription | None:
        """Describe an object, without what its instancer passes on; None where nothing of it is rendered.

        multiplied: the entry of an object that another one multiplies. before: the instance of an object that at most
        was moved. Curves and the like have no mesh yet. Raises Unfinished when the slice is over.
        """
        kind = source.type
        if kind not in SURFACE_TYPES or (kind == "CURVES" and not self._context.curves.shown):
            return None
        visibility = visibility_of(source)
        if not is_seen(visibility):
            return None
        if before is not None and self._meshes.knows(before.mesh):
            # The rest is read again, as it may be animated without Blender naming the object as changed.
            self._meshes.keep(before.mesh)
            return self._described(source, before.mesh, before.materials, visibility, multiplied)
        holder = source if multiplied is None else multiplied.instance_object
        is_own = multiplied is None or holder.data == source.data
        if kind == "VOLUME" or (kind == "MESH" and is_own and is_gas_domain(source)):
            return self._describe_volume(source, visibility, multiplied) if self._context.filter.volumes else None
        if kind == "MESH" and not self._has_faces(source, is_own):
            return None  # and its materials are not needed
        materials, mesh = self._material_slots(source), None
        if kind not in CONVERTED_TYPES:
            owner = source if multiplied is None else multiplied.parent
            mesh = self._mesh_index(holder, source.data, materials, owner)
            if mesh is None:
                if kind == "MESH" and is_own:
                    self.faceless.note(source)
                return None
        return self._described(source, mesh, materials, visibility, multiplied)

    def _describe_volume(
        self,
        source: bpy.types.Object,
        visibility: RayVisibility,
        multiplied: bpy.types.DepsgraphObjectInstance | None,
    ) -> InstanceDescription | None:
        """Describe a volume, or the gas of a fluid domain; None where it has no voxels."""
        grids = GridSource(source)
        materials = [self._materials.of_volume(place, grids.is_gas) for place in self._material_slots(source)]
        mesh = self._mesh_index(source, grids, materials, source if multiplied is None else multiplied.parent)
        return None if mesh is None else self._described(source, mesh, materials, visibility, multiplied)

    def describe_hair(
        self,
        source: bpy.types.Object,
        systems: list[HairSystem],
        multiplied: bpy.types.DepsgraphObjectInstance | None,
    ) -> InstanceDescription | None:
        """Describe the hair of an object's particle systems; None where it has no strands. As describe()."""
        materials = self._material_slots(source)
        hair = Hair(source, systems, self._uses_uv(materials))
        mesh = self._mesh_index(source, hair, materials, source if multiplied is None else multiplied.parent)
        return None if mesh is None else self._described(source, mesh, materials, visibility_of(source), multiplied)

    def convert(self, source: bpy.types.Object, description: InstanceDescription) -> InstanceDescription | None:
        """Describe a curve or the like with the mesh that Blender makes of it; None where that has no faces."""
        mesh = self._mesh_index(source, None, description.materials, source)
        if mesh is None:
            return None
        converted = description._replace(mesh=mesh)
        self.missing.note(converted)
        return converted

    def light(self, source: bpy.types.Object, matrix: np.ndarray, instancer: Instancer | None = None) -> Light | None:
        """A light object placed by a matrix (4, 4); None when it gives no light. instancer: what multiplies it."""
        if not np.isfinite(matrix).all():
            self._context.report.warn(f'Light "{source.name}": its matrix is not finite, so it is left out')
            return None
        light = export_light(source, matrix, self._context)
        if light is not None and not light.is_portal:
            light.linking = self._context.light_links.of(source) if instancer is None else instancer.linking
            light.light_group = self._light_group(source) or ("" if instancer is None else instancer.light_group)
        return light

    def add_owner(self, description: InstanceDescription, instancer: Instancer) -> None:
        """Record that an instancer brings a mesh that was described before."""
        self._meshes.add_owner(description.mesh, instancer.uid)

    def reads_instancer(self, materials: list[int]) -> bool:
        """Whether materials or rays read attributes that each instance may have of its own."""
        return len(self._instancer_names(materials)) > 0

    def attribute_values(
        self, source: bpy.types.Object, materials: list[int], multiplied: bpy.types.DepsgraphObjectInstance | None
    ) -> dict[str, tuple[float, ...]]:
        """Values of attributes that the object, what multiplies it or its instance there has as a whole."""
        values = self._shared_values(source, materials, multiplied)
        for name in self._instancer_names(materials) if multiplied is not None else ():
            value = self.instance_attributes.value(multiplied, name)
            if value is not None:
                values[name] = value
        return values

    def attribute_notes(
        self, source: bpy.types.Object, materials: list[int], multiplied: bpy.types.DepsgraphObjectInstance
    ) -> AttributeNotes:
        """Begin to note the attributes of the instances that an entry's instancer has of an object."""
        shared = self._shared_values(source, materials, multiplied)
        return AttributeNotes(self.instance_attributes, multiplied.parent, self._instancer_names(materials), shared)

    def _instancer_names(self, materials: list[int]) -> list[str]:
        """Attributes that materials or rays read and each instance may have of its own."""
        names, of_objects = self._wanted_attributes(materials)
        return [name for name in names if name.startswith("INSTANCER:")] if of_objects else []

    def _shared_values(
        self, source: bpy.types.Object, materials: list[int], multiplied: bpy.types.DepsgraphObjectInstance | None
    ) -> dict[str, tuple[float, ...]]:
        """Values of attributes that the object, or what multiplies it, has for all instances."""
        names, of_objects = self._wanted_attributes(materials)
        values: dict[str, tuple[float, ...]] = {}
        for name in names if of_objects else ():
            domain, _, path = name.partition(":")
            if domain not in _WHOLE:
                continue
            if name in COORDINATES:
                values[name] = (0.0, 0.0, 0.0)
                continue
            of_instancer = domain == "INSTANCER" and multiplied is not None
            owners = (multiplied.parent, source) if of_instancer else (source,)
            found = (attribute_of(owner, path) or attribute_of(owner.data, path) for owner in owners)
            value = next((value for value in found if value is not None), None)
            if value is not None:
                values[name] = value
        return values

    def _described(
        self,
        source: bpy.types.Object,
        mesh: int | None,
        materials: list[int],
        visibility: RayVisibility,
        multiplied: bpy.types.DepsgraphObjectInstance | None,
    ) -> InstanceDescription:
        context, name = self._context, source.name
        if multiplied is None:
            random = _random(name)
            visibility, holdout = context.masks.of(source, visibility, source.is_holdout)
        else:
            random, holdout = 0.0, False
        description = InstanceDescription(
            mesh,
            materials,
            name,
            source.pass_index,
            source.color[:],
            random,
            visibility,
            holdout,
            source.is_shadow_catcher,
            self.attribute_values(source, materials, multiplied) if self._wanted_attributes(materials)[1] else {},
            light_group_of(source) if context.has_light_groups else "",
            context.light_links.of(source),
            *_terminator_offsets(source),
        )
        if mesh is not None:
            self.missing.note(description)
        return description

    def _has_faces(self, source: bpy.types.Object, is_own: bool) -> bool:
        """Whether a mesh has faces to be rendered. is_own: it is the object's, none that nodes of geometry made."""
        if not has_no_faces(source.data):
            return True
        if is_own:
            self.faceless.note(source)
        return False

    def _mesh_index(
        self,
        source: bpy.types.Object,
        data: bpy.types.Mesh | RoundSource | GridSource | None,
        materials: list[int],
        owner: bpy.types.Object,
    ) -> int | None:
        """Index of an object's mesh with the attributes that its materials read; None of one without faces.

        data: None has Blender make a mesh of the object. owner: the object that brings it.
        """
        attributes, _ = self._wanted_attributes(materials)
        index = self._meshes.index(source, data, attributes, owner.original.session_uid)
        if index is not None and data is not None and not isinstance(data, bpy.types.Mesh | GridSource):
            self._materials.put_on_round_shapes(materials)
        return index

    def _material_slots(self, source: bpy.types.Object) -> list[int]:
        slots = [slot.material for slot in source.material_slots]
        made = list(source.data.materials)
        # Geometry nodes may give the evaluated data slots that the object does not have.
        slots += made[len(slots) :]
        override = self._context.material_override
        if override is not None:
            slots = [override]
        return [self._materials.index(material) for material in slots or [None]]

    def _wanted_attributes(self, materials: list[int]) -> tuple[set[str], bool]:
        """Names of the attributes that materials or rays read, and whether any is one of objects."""
        sampled = self._materials.sampled
        key = tuple(materials), sampled
        if key not in self._wanted:
            names = sampled.union(*(self._materials.attributes[material] for material in materials))
            self._wanted[key] = set(names), any(name.partition(":")[0] in _WHOLE for name in names)
        return self._wanted[key]

    def _uses_uv(self, materials: list[int]) -> bool:
        """Whether nodes of any of these materials may ask for the UV map in use."""
        graphs = (self._materials.materials[material].graph for material in materials)
        return any(node.kind in _USE_UV for graph in graphs for node in graph.nodes)

    def _light_group(self, source: bpy.types.Object) -> str:
        return light_group_of(source) if self._context.has_light_groups else ""


def _terminator_offsets(source: bpy.types.Object) -> tuple[float, float]:
    """Geometry Offset and Shading Offset of the shadow terminator; before Blender 5 properties of Cycles."""
    if hasattr(source, "shadow_terminator_shading_offset"):
        geometry, shading = source.shadow_terminator_geometry_offset, source.shadow_terminator_shading_offset
        return geometry if geometry < 1.0 else 1.0, shading if shading < 1.0 else 1.0
    cycles = getattr(source, "cycles", None)
    return (
        getattr(cycles, "shadow_terminator_geometry_offset", 0.0),
        getattr(cycles, "shadow_terminator_offset", 0.0),
    )


@functools.lru_cache(1 << 16)
def _random(name: str) -> float:
    """Random number in [0, 1] of an object that is no instance: Cycles' hash of its name."""
    number = 0
    for byte in name.encode():
        number = (37 * number + byte) & 0xFFFFFFFF
    return hashed(number)
