# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects of a depsgraph, instances included: meshes, placements and lights."""

from collections.abc import Callable
from dataclasses import dataclass, field

import bpy
import numpy as np

from ...scene import Instance, Light, RayVisibility
from .attributes import GENERATED, ISLAND, TANGENT, attribute_of, title_of
from .context import ExportContext
from .hashing import hashed
from .lights import export_light
from .materials import MaterialTable
from .matrices import usable_matrices
from .mesh_table import MeshTable
from .particles import particle_of
from .visibility import visibility_of

CONVERTED_TYPES = {"CURVE", "FONT", "META", "SURFACE"}
"""Object types that are rendered as the mesh that Blender makes of them."""
UNSUPPORTED_TYPES = {"CURVES": "hair curves", "POINTCLOUD": "point clouds", "VOLUME": "volumes"}


class ObjectExporter:
    """Reads a depsgraph's objects; meshes and materials that it knows are not exported again."""

    def __init__(self, context: ExportContext) -> None:
        self.materials = MaterialTable(context)
        self.meshes = MeshTable(context.report)
        self._context = context
        self._report = context.report
        self._frame = 0.0

    def export(
        self,
        depsgraph: bpy.types.Depsgraph,
        shown: Callable[[bpy.types.Object], bool] | None = None,
        unchanged: dict[int, Instance] | None = None,
        identify: bool = False,
    ) -> "Placed":
        """All instances and lights.

        shown: which of the original objects are to be seen, all if None. unchanged: by session_uid, the instances of
        objects that stand for themselves and are as they were. identify: tell by what they are known at other times.
        Raises ExportStopped when the user wants no more.
        """
        self._frame = depsgraph.scene_eval.frame_current_final
        self.meshes.begin_pass()
        with self._report.about("objects"):
            placed = _Pass(self, depsgraph, shown, unchanged or {}, identify).run()
        self.meshes.end_pass()
        return placed

    def instance(self, source: bpy.types.Object) -> Instance | None:
        """The instance of a mesh object that stands for itself alone; None when it is not to be rendered."""
        visibility = visibility_of(source)
        if source.type != "MESH" or not visibility:
            return None
        matrices, usable = usable_matrices(np.array(source.matrix_world, np.float64)[None])
        shading = self._shading(source, visibility)
        index = self._mesh_index(source, source.data, shading, source.original.session_uid)
        return _instance(index, source, matrices[0], shading) if usable[0] and index is not None else None

    def light(self, source: bpy.types.Object, matrix: np.ndarray) -> Light | None:
        """A light object placed by a matrix (4, 4); None when it gives no light."""
        if not np.isfinite(matrix).all():
            self._report.warn(f'Light "{source.name}": its matrix is not finite, so it is left out')
            return None
        return export_light(source, matrix, self._context)

    def _shading(
        self,
        source: bpy.types.Object,
        visibility: RayVisibility,
        instance: bpy.types.DepsgraphObjectInstance | None = None,
    ) -> dict[str, object]:
        """Materials of an instance and what their nodes may ask about it: members of scene.Instance.

        instance: None for an object that stands for itself.
        """
        materials = self._material_slots(source)
        multiplied = instance is not None and instance.is_instance
        members: dict[str, object] = {
            "materials": materials,
            "color": tuple(source.color),
            "random": (instance.random_id & 0xFFFFFFFF) / 0xFFFFFFFF if multiplied else _random(source),
            "particle": particle_of(instance, self._frame) if multiplied else None,
            "visibility": visibility,
            "holdout": source.is_holdout,
            "shadow_catcher": source.is_shadow_catcher,
        }
        instancer = instance.parent if multiplied else None
        values: dict[str, tuple[float, ...]] = {}
        for name in self._attributes_of(materials):
            domain, _, path = name.partition(":")
            if domain in {"OBJECT", "INSTANCER"}:
                owners = (instancer, source) if domain == "INSTANCER" else (source,)
                found = (attribute_of(owner, path) or attribute_of(owner and owner.data, path) for owner in owners)
                value = next((value for value in found if value is not None), None)
                if value is not None:
                    values[name] = value
        return members | {"attributes": values}

    def _attributes_of(self, materials: list[int]) -> set[str]:
        """Names of the attributes that materials read."""
        return {name for material in materials for name in self.materials.attributes[material]}

    def _mesh_index(
        self, source: bpy.types.Object, mesh: bpy.types.Mesh | None, shading: dict[str, object], owner: int
    ) -> int | None:
        return self.meshes.index(source, mesh, self._attributes_of(shading["materials"]), owner)

    def _material_slots(self, source: bpy.types.Object) -> list[int]:
        slots = [slot.material for slot in source.material_slots]
        made = list(source.data.materials)
        # Geometry nodes may give the evaluated data slots that the object does not have.
        slots += made[len(slots) :]
        return [self.materials.index(material) for material in slots or [None]]


Identity = tuple[int, ...]
"""By what an instance or a light is known at other times: the session_uid of its object, or those of what multiplies
the object and of the object, and Blender's persistent_id."""


def identity_of(
    instance: bpy.types.DepsgraphObjectInstance, source: bpy.types.Object, owner: bpy.types.Object
) -> Identity:
    """source: the original object; owner: what multiplies it, or itself."""
    if not instance.is_instance:
        return (owner.session_uid,)
    return (owner.session_uid, source.session_uid, *instance.persistent_id)


@dataclass
class Placed:
    """What a pass over a depsgraph found."""

    instances: list[Instance] = field(default_factory=list)
    lights: list[Light] = field(default_factory=list)
    alone: dict[int, int] = field(default_factory=dict)
    """By session_uid, the index of the only instance of each mesh object that multiplies nothing."""
    lights_alone: dict[int, int] = field(default_factory=dict)
    """By session_uid, the index of the only light of each light object."""
    identities: dict[int, Identity] = field(default_factory=dict)
    """Of instances and lights by their id(), if asked for."""


class _Pass:
    """One pass over the instances of a depsgraph."""

    def __init__(
        self,
        exporter: ObjectExporter,
        depsgraph: bpy.types.Depsgraph,
        shown: Callable[[bpy.types.Object], bool] | None,
        unchanged: dict[int, Instance],
        identify: bool,
    ) -> None:
        self._identify = identify
        self._identity: Identity = ()
        """Of what is being placed."""
        self._exporter = exporter
        self._report = exporter._report
        self._depsgraph = depsgraph
        self._shown = shown
        self._unchanged = unchanged
        self._placed: list[tuple[Instance, np.ndarray, int]] = []
        self._unconverted: list[tuple[bpy.types.Object, np.ndarray, dict[str, object], Identity]] = []
        self._converted: set[tuple[int, bytes]] = set()
        self._missing: dict[tuple[str, str, str], dict[str, None]] = {}
        """By names of material, node and attribute, the objects that do not have it."""
        self._multiple: set[int] = set()
        """Objects that are multiplied or multiply others."""
        self._result = Placed()

    def run(self) -> Placed:
        for number, instance in enumerate(self._depsgraph.object_instances):
            if number % 256 == 0:
                self._report.progress(f"Exporting objects ({number})")
            # Only valid inside the loop: Blender reuses the memory for the next instance.
            source = instance.object
            stands_for = (instance.parent if instance.is_instance else source).original
            if instance.is_instance:
                self._multiple |= {source.original.session_uid, stands_for.session_uid}
            if not instance.show_self or not (self._shown is None or self._shown(stands_for)):
                continue
            if self._identify:
                self._identity = identity_of(instance, source.original, stands_for)
            kept = None if instance.is_instance else self._unchanged.get(stands_for.session_uid)
            if kept is not None:
                self._exporter.meshes.keep(kept.mesh)
                self._note_missing(kept)
                self._result.identities[id(kept)] = self._identity
                self._placed.append((kept, kept.matrix, stands_for.session_uid))
            else:
                matrix = np.array(instance.matrix_world, np.float64)
                self._export_instance(instance, source, stands_for, matrix)
        self._convert()
        self._keep_usable()
        self._tell_missing()
        return self._result

    def _export_instance(
        self,
        instance: bpy.types.DepsgraphObjectInstance,
        source: bpy.types.Object,
        owner: bpy.types.Object,
        matrix: np.ndarray,
    ) -> None:
        if source.type == "LIGHT":
            light = self._exporter.light(source, matrix)
            if light is not None:
                self._result.lights_alone[source.original.session_uid] = len(self._result.lights)
                self._result.lights.append(light)
                self._result.identities[id(light)] = self._identity
            return
        if source.type in UNSUPPORTED_TYPES:
            what = UNSUPPORTED_TYPES[source.type]
            self._report.warn(f'Object "{source.name}": {what} are not rendered yet; it is left out')
            return
        if source.type not in CONVERTED_TYPES and source.type != "MESH":
            return
        visibility = visibility_of(source)
        if not visibility:
            return
        if source.type == "MESH" and len(source.data.polygons) == 0:
            return  # and its materials are not needed
        shading = self._exporter._shading(source, visibility, instance)
        if source.type != "MESH":
            self._unconverted.append((source.original, matrix, shading, self._identity))
            return
        original = source.original
        if original.type in CONVERTED_TYPES:
            self._converted.add((original.as_pointer(), matrix.tobytes()))
        self._place(source, source.data, matrix, shading, owner.session_uid)

    def _place(
        self,
        source: bpy.types.Object,
        mesh: bpy.types.Mesh | None,
        matrix: np.ndarray,
        shading: dict[str, object],
        owner: int,
    ) -> None:
        index = self._exporter._mesh_index(source, mesh, shading, owner)
        if index is not None:
            instance = _instance(index, source, matrix, shading)
            self._note_missing(instance)
            self._result.identities[id(instance)] = self._identity
            uid = source.original.session_uid
            self._placed.append((instance, matrix, uid if mesh is not None else 0))

    def _note_missing(self, instance: Instance) -> None:
        """Attributes that the materials of an instance read and that it does not have."""
        materials, mesh = self._exporter.materials, self._exporter.meshes.meshes[instance.mesh]
        known = {GENERATED, ISLAND, TANGENT, *mesh.attributes, *instance.attributes}
        asked = [(slot, materials.attributes[material]) for slot, material in enumerate(instance.materials)]
        if all(attributes.keys() <= known for _, attributes in asked):
            return
        slots = np.flatnonzero(np.bincount(np.minimum(mesh.triangle_slots, len(asked) - 1)))
        for slot, attributes in asked:
            for attribute in attributes.keys() - known if slot in slots else ():
                material = materials.materials[instance.materials[slot]].name
                objects = self._missing.setdefault((material, attributes[attribute], attribute), {})
                objects[instance.object_name] = None

    def _tell_missing(self) -> None:
        for (material, node, attribute), objects in sorted(self._missing.items()):
            first = next(iter(objects))
            lack = f'object "{first}" lacks' if len(objects) == 1 else f'{len(objects)} objects lack, such as "{first}"'
            self._report.warn(
                f'Material "{material}": node "{node}" reads {title_of(attribute)}, which {lack}; it counts as 0'
            )

    def _convert(self) -> None:
        """Place the curves, texts, surfaces and metaballs whose mesh did not come as an instance.

        Blender shows the mesh of such an object as an instance beside it, but not where particles
        or faces multiply the object.
        """
        for original, matrix, shading, identity in self._unconverted:
            self._identity = identity
            if (original.as_pointer(), matrix.tobytes()) in self._converted:
                continue
            source = original.evaluated_get(self._depsgraph)
            self._place(source, None, matrix, shading, original.session_uid)

    def _keep_usable(self) -> None:
        self._result.lights_alone = _without(self._result.lights_alone, self._multiple)
        if not self._placed:
            return
        matrices, usable = usable_matrices(np.stack([matrix for _, matrix, _ in self._placed]))
        lost: dict[str, int] = {}
        for (instance, _, uid), matrix, good in zip(self._placed, matrices, usable, strict=True):
            if good:
                if instance.matrix is not matrix and not np.array_equal(instance.matrix, matrix):
                    instance.matrix = matrix
                self._result.alone[uid] = len(self._result.instances)
                self._result.instances.append(instance)
            else:
                lost[instance.object_name] = lost.get(instance.object_name, 0) + 1
        self._result.alone = _without(self._result.alone, self._multiple | {0})
        for name, count in lost.items():
            self._report.warn(
                f'Object "{name}": {count} placements have no extent (scale 0) or are not finite and were left out; '
                "give them a scale"
            )


def _without(places: dict[int, int], keys: set[int]) -> dict[int, int]:
    return {key: place for key, place in places.items() if key not in keys}


def _instance(mesh: int, source: bpy.types.Object, matrix: np.ndarray, shading: dict[str, object]) -> Instance:
    return Instance(mesh, matrix, object_name=source.name, object_index=source.pass_index, **shading)


def _random(source: bpy.types.Object) -> float:
    """From 0 to 1, for an object that is no instance: Cycles' hash of its name."""
    number = 0
    for byte in source.name.encode():
        number = (37 * number + byte) & 0xFFFFFFFF
    return hashed(number)
