# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects of a depsgraph, instances included: meshes, placements and lights."""

import bpy
import numpy as np

from ...scene import Instance, Mesh, RayVisibility, Scene
from .attributes import add_attributes, attribute_of
from .hashing import hashed
from .images import ImageTable
from .lights import export_light
from .materials import MaterialTable
from .matrices import usable_matrices
from .meshes import export_mesh
from .particles import particle_of
from .report import Report
from .visibility import visibility_of

CONVERTED_TYPES = {"CURVE", "FONT", "META", "SURFACE"}
"""Object types that are rendered as the mesh that Blender makes of them."""
UNSUPPORTED_TYPES = {"CURVES": "hair curves", "POINTCLOUD": "point clouds", "VOLUME": "volumes"}


class ObjectExporter:
    """Fills a scene's meshes, instances, materials and lights from a depsgraph."""

    def __init__(self, scene: Scene, report: Report, images: ImageTable) -> None:
        self._scene = scene
        self._report = report
        self._images = images
        self._materials = MaterialTable(report, images)
        self._meshes: dict[int, int | None] = {}
        self._placed: list[tuple[Instance, np.ndarray]] = []
        self._unconverted: list[tuple[bpy.types.Object, np.ndarray, dict[str, object]]] = []
        self._frame = 0.0
        self._converted: set[tuple[int, bytes]] = set()

    def export(self, depsgraph: bpy.types.Depsgraph) -> None:
        """Read all instances; raises ExportStopped when the user wants no more."""
        self._frame = depsgraph.scene_eval.frame_current_final
        for number, instance in enumerate(depsgraph.object_instances):
            if number % 256 == 0:
                self._report.progress(f"Exporting objects ({number})")
            # Only valid inside the loop: Blender reuses the memory for the next instance.
            if instance.show_self:
                self._export_instance(instance, instance.object, np.array(instance.matrix_world, np.float64))
        self._convert(depsgraph)
        self._keep_usable()
        self._scene.materials = self._materials.materials

    def _export_instance(
        self, instance: bpy.types.DepsgraphObjectInstance, source: bpy.types.Object, matrix: np.ndarray
    ) -> None:
        if source.type == "LIGHT":
            if not np.isfinite(matrix).all():
                self._report.warn(f'Light "{source.name}": its matrix is not finite, so it is left out')
                return
            light = export_light(source, matrix, self._report, self._images)
            if light is not None:
                self._scene.lights.append(light)
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
        if source.type != "MESH":
            self._unconverted.append((source.original, matrix, self._shading(instance, source, visibility)))
            return
        if len(source.data.polygons) == 0:
            return  # and its materials are not needed
        original = source.original
        if original.type in CONVERTED_TYPES:
            self._converted.add((original.as_pointer(), matrix.tobytes()))
        self._place(source, source.data, matrix, self._shading(instance, source, visibility))

    def _shading(
        self, instance: bpy.types.DepsgraphObjectInstance, source: bpy.types.Object, visibility: RayVisibility
    ) -> dict[str, object]:
        """Materials of an instance and what their nodes may ask about it: members of scene.Instance."""
        materials = self._material_slots(source)
        members: dict[str, object] = {
            "materials": materials,
            "color": tuple(source.color),
            "random": _random(instance, source),
            "particle": particle_of(instance, self._frame),
            "visibility": visibility,
            "holdout": source.is_holdout,
            "shadow_catcher": source.is_shadow_catcher,
        }
        instancer = instance.parent if instance.is_instance else None
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
        return {name for material in materials for name in self._materials.attributes[material]}

    def _place(
        self, source: bpy.types.Object, mesh: bpy.types.Mesh | None, matrix: np.ndarray, shading: dict[str, object]
    ) -> None:
        index = self._mesh_index(source, mesh, self._attributes_of(shading["materials"]))
        if index is not None:
            instance = Instance(index, matrix, object_name=source.name, object_index=source.pass_index, **shading)
            self._placed.append((instance, matrix))

    def _convert(self, depsgraph: bpy.types.Depsgraph) -> None:
        """Place the curves, texts, surfaces and metaballs whose mesh did not come as an instance.

        Blender shows the mesh of such an object as an instance beside it, but not where particles
        or faces multiply the object.
        """
        for original, matrix, shading in self._unconverted:
            if (original.as_pointer(), matrix.tobytes()) in self._converted:
                continue
            source = original.evaluated_get(depsgraph)
            self._place(source, None, matrix, shading)

    def _mesh_index(self, source: bpy.types.Object, mesh: bpy.types.Mesh | None, attributes: set[str]) -> int | None:
        """Index of a mesh, exported now if it is new, with the named attributes; None when it has no triangles.

        mesh: None lets Blender make one of the object.
        """
        # Evaluated data is shared exactly when it is the same block of memory: session_uid is also
        # shared by copies that different modifiers made different.
        key = (source if mesh is None else mesh).as_pointer()
        if key not in self._meshes:
            self._report.progress(f"Exporting {source.name}")
            if mesh is None:
                exported = self._read_converted(source, attributes)
            else:
                exported = export_mesh(mesh, source.name, self._report)
            self._meshes[key] = None if exported is None else len(self._scene.meshes)
            if exported is not None:
                self._scene.meshes.append(exported)
        index = self._meshes[key]
        if index is not None and mesh is not None:
            add_attributes(self._scene.meshes[index], mesh, attributes)
        return index

    def _read_converted(self, source: bpy.types.Object, attributes: set[str]) -> Mesh | None:
        try:
            mesh = source.to_mesh()
        except RuntimeError:  # an object without geometry
            return None
        try:
            exported = None if mesh is None else export_mesh(mesh, source.name, self._report)
            if exported is not None:
                add_attributes(exported, mesh, attributes)
            return exported
        finally:
            source.to_mesh_clear()

    def _material_slots(self, source: bpy.types.Object) -> list[int]:
        slots = [slot.material for slot in source.material_slots]
        made = list(source.data.materials)
        # Geometry nodes may give the evaluated data slots that the object does not have.
        slots += made[len(slots) :]
        return [self._materials.index(material) for material in slots or [None]]

    def _keep_usable(self) -> None:
        if not self._placed:
            return
        matrices, usable = usable_matrices(np.stack([matrix for _, matrix in self._placed]))
        lost: dict[str, int] = {}
        for (instance, _), matrix, good in zip(self._placed, matrices, usable, strict=True):
            if good:
                instance.matrix = matrix
                self._scene.instances.append(instance)
            else:
                lost[instance.object_name] = lost.get(instance.object_name, 0) + 1
        for name, count in lost.items():
            self._report.warn(
                f'Object "{name}": {count} placements have no extent (scale 0) or are not finite and were left out; '
                "give them a scale"
            )


def _random(instance: bpy.types.DepsgraphObjectInstance, source: bpy.types.Object) -> float:
    """From 0 to 1: Blender's number of an instance; of an object, which has none there, Cycles' hash of its name."""
    if instance.is_instance:
        return (instance.random_id & 0xFFFFFFFF) / 0xFFFFFFFF
    number = 0
    for byte in source.name.encode():
        number = (37 * number + byte) & 0xFFFFFFFF
    return hashed(number)
