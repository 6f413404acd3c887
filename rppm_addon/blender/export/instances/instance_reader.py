# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances and lights of single objects: their meshes, materials and the values that nodes ask for."""

import functools
from collections.abc import Callable

import bpy
import numpy as np

from ....scene import Instance, Light, LightLinking, RayVisibility
from ..camera.culling import Culling
from ..common.hashing import hashed
from ..context import ExportContext
from ..geometry.meshes.attributes import INSTANCER_GENERATED, INSTANCER_UV, attribute_of
from ..geometry.meshes.rendered_meshes import is_gas_domain
from ..geometry.strands.round_meshes import RoundSource
from ..shading.lights.lights import export_light
from ..shading.nodes.materials import MaterialTable
from ..view_layer.layers import light_group_of
from ..view_layer.visibility import visibility_of
from .instance_attributes import InstanceAttributes
from .mesh_table import MeshTable

_USE_UV = {"tex_coord", "attribute", "normal_map", "tangent", "uvmap", "tex_image", "tex_image_tiles"}
_COORDINATES: dict[str, Callable[[bpy.types.DepsgraphObjectInstance], tuple[float, ...]]] = {
    INSTANCER_GENERATED: lambda multiplied: tuple(0.5 * value - 0.5 for value in multiplied.orco),
    INSTANCER_UV: lambda multiplied: (*multiplied.uv, 0.0),
}
"""Functions that return the coordinates of an instance on the object that multiplies it, by attribute name, as in
Cycles. An object that stands for itself has zeros."""
_WHOLE = {"OBJECT", "INSTANCER"}
"""Domains of attributes that objects have as a whole."""


class InstanceReader:
    """Makes instances and lights of objects; meshes and materials that it knows are not exported again."""

    def __init__(self, context: ExportContext) -> None:
        self.materials = MaterialTable(context)
        self.meshes = MeshTable(context)
        self.report = context.report
        self._context = context
        self._wants: dict[tuple[tuple[int, ...], frozenset[str]], tuple[set[str], bool]] = {}
        self.instance_attributes = InstanceAttributes()

    def begin_pass(self) -> None:
        """Materials may ask for other attributes than before, and these may have changed."""
        self._wants = {}
        self.instance_attributes.forget()

    def instance(self, source: bpy.types.Object, matrix: np.ndarray, before: Instance | None) -> Instance | None:
        """The instance of an object that stands for itself alone; None when it is not to be rendered.

        before: the one that it had, if it was moved at most.
        """
        visibility = visibility_of(source)
        if source.type != "MESH" or not visibility or is_gas_domain(source):
            return None
        if before is not None and self.meshes.knows(before.mesh):
            return self._moved(source, matrix, visibility, before)
        shading = self.shading(source, visibility)
        index = self.mesh_index(source, source.data, shading, source.original.session_uid)
        return None if index is None else shaded_instance(index, source, matrix, shading)

    def _moved(
        self, source: bpy.types.Object, matrix: np.ndarray, visibility: RayVisibility, before: Instance
    ) -> Instance:
        """Return the instance of an object that at most was moved, with the mesh and the materials that it had before.

        The rest is read again, as it may be animated without Blender naming the object as changed.
        """
        name, materials = source.name, before.materials
        visibility, holdout = self.masked(source, visibility, source.is_holdout)
        return Instance(
            before.mesh,
            matrix,
            materials,
            name,
            source.pass_index,
            tuple(source.color),
            _random(name),
            None,
            visibility,
            holdout,
            source.is_shadow_catcher,
            self.attribute_values(source, materials, None) if self.wanted_attributes(materials)[1] else {},
            self.light_group(source, source),
            self.linking(source),
            *_terminator_offsets(source),
        )

    def light(
        self, source: bpy.types.Object, matrix: np.ndarray, instancer: bpy.types.Object | None = None
    ) -> Light | None:
        """A light object placed by a matrix (4, 4); None when it gives no light. instancer: what multiplies it."""
        if not np.isfinite(matrix).all():
            self.report.warn(f'Light "{source.name}": its matrix is not finite, so it is left out')
            return None
        light = export_light(source, matrix, self._context)
        if light is not None and not light.is_portal:
            owner = instancer or source
            light.linking, light.light_group = self.linking(owner), self.light_group(source, owner)
        return light

    def shading(
        self,
        source: bpy.types.Object,
        visibility: RayVisibility,
        multiplied: bpy.types.DepsgraphObjectInstance | None = None,
    ) -> dict[str, object]:
        """Materials of an instance and what their nodes may ask about it: members of scene.Instance.

        multiplied: the instance of an object that another one multiplies.
        """
        instancer = None if multiplied is None else multiplied.parent
        owner = instancer or source
        materials = self._material_slots(source)
        geometry_offset, shading_offset = _terminator_offsets(source)
        visibility, holdout = self.masked(owner, visibility, owner.is_holdout)
        return {
            "materials": materials,
            "color": tuple(source.color),
            "random": 0.0 if instancer is not None else _random(source.name),
            "visibility": visibility,
            "holdout": holdout,
            "shadow_catcher": source.is_shadow_catcher or owner.is_shadow_catcher,
            "attributes": self.attribute_values(source, materials, multiplied),
            "light_group": self.light_group(source, owner),
            "linking": self.linking(owner),
            "terminator_geometry_offset": geometry_offset,
            "terminator_shading_offset": shading_offset,
        }

    def light_group(self, source: bpy.types.Object, owner: bpy.types.Object) -> str:
        """Return the light group of an object, or else that of the object that multiplies it."""
        return (light_group_of(source) or light_group_of(owner)) if self._context.has_light_groups else ""

    def linking(self, owner: bpy.types.Object) -> LightLinking | None:
        """The light linking of what an object brings, itself or what it multiplies."""
        return self._context.light_links.of(owner)

    @property
    def use_surfaces(self) -> bool:
        """Whether the view layer has anything but lights."""
        return self._context.use_surfaces

    @property
    def shows_strands(self) -> bool:
        """Whether the view layer has hair."""
        return self._context.curves.shown

    @property
    def may_have_hair(self) -> bool:
        """Whether any object may have particle systems with hair to be rendered."""
        return self._context.may_have_hair

    @property
    def is_render(self) -> bool:
        """Whether Blender evaluated what renders show, and not viewports."""
        return self._context.is_render

    def uses_uv(self, materials: list[int]) -> bool:
        """Whether nodes of any of these materials may ask for the UV map in use."""
        graphs = (self.materials.materials[material].graph for material in materials)
        return any(node.kind in _USE_UV for graph in graphs for node in graph.nodes)

    @property
    def culling(self) -> Culling:
        """Culling, which tells the objects that are left out."""
        return self._context.culling

    def masked(self, owner: bpy.types.Object, visibility: RayVisibility, holdout: bool) -> tuple[RayVisibility, bool]:
        """Visibility and holdout in the view layer (LayerMasks.of)."""
        return self._context.masks.of(owner, visibility, holdout)

    def attribute_values(
        self, source: bpy.types.Object, materials: list[int], multiplied: bpy.types.DepsgraphObjectInstance | None
    ) -> dict[str, tuple[float, ...]]:
        """Values of attributes that the object, what multiplies it or its instance there has as a whole."""
        names, of_objects = self.wanted_attributes(materials)
        values: dict[str, tuple[float, ...]] = {}
        for name in names if of_objects else ():
            domain, _, path = name.partition(":")
            if domain not in _WHOLE:
                continue
            if name in _COORDINATES:
                values[name] = _COORDINATES[name](multiplied) if multiplied is not None else (0.0, 0.0, 0.0)
                continue
            of_instance = domain == "INSTANCER" and multiplied is not None
            value = self.instance_attributes.value(multiplied, path) if of_instance else None
            if value is None:
                owners = (multiplied.parent, source) if of_instance else (source,)
                found = (attribute_of(owner, path) or attribute_of(owner.data, path) for owner in owners)
                value = next((value for value in found if value is not None), None)
            if value is not None:
                values[name] = value
        return values

    def wanted_attributes(self, materials: list[int]) -> tuple[set[str], bool]:
        """Names of the attributes that materials or rays read, and whether any is one of objects."""
        sampled = self.materials.sampled
        key = tuple(materials), sampled
        if key not in self._wants:
            names = sampled.union(*(self.materials.attributes[material] for material in materials))
            self._wants[key] = set(names), any(name.partition(":")[0] in _WHOLE for name in names)
        return self._wants[key]

    def mesh_index(
        self,
        source: bpy.types.Object,
        mesh: bpy.types.Mesh | RoundSource | None,
        shading: dict[str, object],
        owner: int,
    ) -> int | None:
        """Index of an object's mesh with the attributes that its materials read; None of one without faces.

        mesh: None has Blender make one of the object. owner: the session_uid of what brings it.
        """
        return self.meshes.index(source, mesh, self.wanted_attributes(shading["materials"])[0], owner)

    def _material_slots(self, source: bpy.types.Object) -> list[int]:
        slots = [slot.material for slot in source.material_slots]
        made = list(source.data.materials)
        # Geometry nodes may give the evaluated data slots that the object does not have.
        slots += made[len(slots) :]
        override = self._context.material_override
        if override is not None:
            slots = [override]
        return [self.materials.index(material) for material in slots or [None]]


def shaded_instance(mesh: int, source: bpy.types.Object, matrix: np.ndarray, shading: dict[str, object]) -> Instance:
    """An instance of a mesh with what InstanceReader.shading gives."""
    return Instance(mesh, matrix, object_name=source.name, object_index=source.pass_index, **shading)


def _terminator_offsets(source: bpy.types.Object) -> tuple[float, float]:
    """Geometry Offset and Shading Offset of the shadow terminator; before Blender 5 properties of Cycles."""
    if hasattr(source, "shadow_terminator_shading_offset"):
        geometry, shading = source.shadow_terminator_geometry_offset, source.shadow_terminator_shading_offset
        return min(geometry, 1.0), min(shading, 1.0)
    cycles = getattr(source, "cycles", None)
    return (
        getattr(cycles, "shadow_terminator_geometry_offset", 0.0),
        getattr(cycles, "shadow_terminator_offset", 0.0),
    )


@functools.lru_cache(1 << 16)
def _random(name: str) -> float:
    """From 0 to 1, for an object that is no instance: Cycles' hash of its name."""
    number = 0
    for byte in name.encode():
        number = (37 * number + byte) & 0xFFFFFFFF
    return hashed(number)
