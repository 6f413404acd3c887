# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion: Blender's motion blur to a Shutter, and where things are in the frames around, for the pass Vector.

Times, steps and what does not move are as in Cycles, whose object properties say what is blurred, but for lights, which
Cycles leaves in the middle of their way.
"""

import math
from collections.abc import Iterator

import bpy
import numpy as np

from ....scene import CameraMovement, Deformation, Instance, Light, Mesh, Movement, Scene, Shutter
from ..camera.camera import camera_pose, export_camera
from ..camera.culling import Culling
from ..camera.eyes import Eye
from ..common.matrices import usable_matrices
from ..context import ExportContext
from ..geometry.meshes.meshes import read_shape, read_velocities
from ..geometry.meshes.rendered_meshes import rendered_mesh
from ..geometry.strands.particle_hair import hair_systems
from ..geometry.strands.round_meshes import ROUND_TYPES, Hair, RoundSource, round_shape_at, round_velocities
from ..instances.mesh_table import MeshTable
from ..instances.objects import ObjectExporter
from ..instances.placements import Identity, Placed, identity_of, identity_of_hair
from .edits import read_edits

MIDDLE = 0.5
_WITH_SHAPES = {"MESH", *ROUND_TYPES}
_CURVE_STEPS = 256
_MIDDLES = {"START": 0.5, "CENTER": 0.0, "END": -0.5}
"""Where the middle of the shutter's time is, in shutter times from the frame."""


def is_blurred(depsgraph: bpy.types.Depsgraph, engine: bpy.types.RenderEngine | None) -> bool:
    """Whether a render blurs what moves. Only an engine in a render may go to other frames."""
    render = depsgraph.scene_eval.render
    return (
        engine is not None
        and not engine.is_preview
        and render.use_motion_blur
        and getattr(depsgraph.view_layer_eval, "use_motion_blur", True)  # Blender 5
        and render.motion_blur_shutter > 0.0
    )


def wants_neighbors(depsgraph: bpy.types.Depsgraph, engine: bpy.types.RenderEngine | None) -> bool:
    """Whether a render has the pass Vector, which as in Cycles goes without motion blur."""
    return (
        engine is not None
        and not engine.is_preview
        and depsgraph.view_layer_eval.use_pass_vector
        and not is_blurred(depsgraph, engine)
    )


def shutter_curve(mapping: bpy.types.CurveMapping) -> np.ndarray:
    """(256,) float64 how far the shutter is open in each part of its time, 0 or more."""
    mapping.initialize()
    curve = mapping.curves[0]
    places = (np.arange(_CURVE_STEPS) + 0.5) / _CURVE_STEPS
    return np.array([max(mapping.evaluate(curve, place), 0.0) for place in places])


def rolling_duration(scene: bpy.types.Scene) -> float:
    """Return the part of the shutter's time in which each row is exposed; 1 without a rolling shutter."""
    cycles = getattr(scene, "cycles", None)
    if getattr(cycles, "rolling_shutter_type", "NONE") == "NONE":
        return 1.0
    return min(max(float(cycles.rolling_shutter_duration), 0.0), 1.0)


def step_times(steps: int) -> tuple[float, ...]:
    """Times of an object's keys, 0 to 1: those of fewer steps are among those of more."""
    count = 1 << steps
    return tuple(key / count for key in range(count + 1))


class MotionExporter:
    """Goes to the frames around that of a render and back, and notes what is where."""

    def __init__(
        self,
        depsgraph: bpy.types.Depsgraph,
        engine: bpy.types.RenderEngine,
        context: ExportContext,
        neighbors: bool = False,
    ) -> None:
        """neighbors: the frames before and after are the keys of all objects, blurred or not."""
        self._neighbors = neighbors
        self._depsgraph = depsgraph
        self._engine = engine
        self._eye = Eye(engine)
        self._context = context
        self._flags: dict[tuple[int, int], tuple[int, bool]] = {}
        self._matrices: dict[Identity, dict[float, np.ndarray]] = {}
        self._shapes: dict[int, dict[float, tuple[np.ndarray, np.ndarray] | None]] = {}
        self._cameras: dict[float, tuple[np.ndarray, tuple[float, ...]]] = {}
        self._steps_of_shapes: dict[int, int] = {}
        self._with_velocities: set[int] = set()
        self._table: MeshTable | None = None
        """Table of the meshes at the middle of the shutter's time."""

    def run(self, scene: Scene, objects: ObjectExporter, placed: Placed) -> Placed:
        """Give a scene its shutter, and what moves the places of the middle of the shutter's time.

        placed: what the frame itself has, with identities. Returns what is to be seen.
        """
        source = self._depsgraph.scene_eval
        # As scenes count them: Blender applies time remapping to a frame that is set.
        frame, render = source.frame_current + source.frame_subframe, source.render
        length = 2.0 if self._neighbors else render.motion_blur_shutter
        seconds = length * render.fps_base / render.fps
        middle = frame if self._neighbors else frame + _MIDDLES[render.motion_blur_position] * length
        curve = shutter_curve(render.motion_blur_shutter_curve)
        camera = self._eye.camera_of(source).original  # markers may switch to another one in between
        times = self._all_times()
        try:
            if middle != frame:
                placed = self._go_to_middle(middle, scene, objects, camera)
            meshes, self._table = list(objects.meshes.meshes), objects.meshes
            bases = {placed.identities[id(instance)]: instance.mesh for instance in placed.instances}
            self._follow_velocities(bases, meshes, seconds)
            changed: set[int] = set()
            for time in times:
                self._context.report.progress("Exporting what moves")
                self._go_to(middle + (time - MIDDLE) * length)
                changed |= read_edits(self._depsgraph).shapes
                self._look_around(time, bases, meshes, changed)
                self._look_from(time, camera)
        finally:
            self._go_to(frame)
            self._context.read_from(self._depsgraph)
        if self._neighbors:
            scene.neighbors = self._shutter(scene, placed, meshes, curve) or Shutter(curve)
            return placed
        self._keep_lasting(placed)
        scene.shutter = self._shutter(scene, placed, meshes, curve)
        return placed

    def _go_to(self, frame: float) -> None:
        whole = math.floor(frame)
        self._engine.frame_set(whole, frame - whole)

    def _go_to_middle(self, middle: float, scene: Scene, objects: ObjectExporter, camera: bpy.types.Object) -> Placed:
        """Materials and images stay those of the frame."""
        self._go_to(middle)
        images = self._context.images
        of_frame = images.frame
        self._context.read_from(self._depsgraph)
        images.frame = of_frame
        objects.meshes.forget(read_edits(self._depsgraph).shapes)
        source = self._depsgraph.scene_eval
        scene.camera = export_camera(source, self._depsgraph, camera, self._eye, self._context.report)
        self._context.culling = Culling(source, scene.camera)
        return objects.export(self._depsgraph, identify=True)

    def _all_times(self) -> list[float]:
        """When anything has a key, but for the middle."""
        steps = {self._flags_of(block)[0] for block in self._depsgraph.ids if isinstance(block, bpy.types.Object)}
        return sorted({time for count in steps - {0} for time in step_times(count)} - {MIDDLE})

    def _look_around(self, time: float, bases: dict[Identity, int], meshes: list[Mesh], changed: set[int]) -> None:
        """Note where everything is, and the shape of what has changed."""
        for identity, instance, data, steps, deforms in self._instances():
            if steps == 0 or time not in step_times(steps):
                continue
            matrix = np.array(instance.matrix_world, np.float64)
            if np.isfinite(matrix).all():
                self._matrices.setdefault(identity, {})[time] = matrix
            place = bases.get(identity)
            if place is None or not deforms or data is None or place in self._with_velocities:
                continue
            if meshes[place].volume is not None:  # a box around the gas of a domain
                continue
            if time not in self._shapes.get(place, {}) and changed & set(identity[:2]):
                self._shapes.setdefault(place, {})[time] = self._shape(instance, data, place, meshes[place])
                self._steps_of_shapes[place] = steps

    def _follow_velocities(self, bases: dict[Identity, int], meshes: list[Mesh], seconds: float) -> None:
        """Meshes that say how fast their vertices are go straight on: their faces may be others at other times."""
        known: set[int] = set()
        for identity, instance, data, steps, deforms in self._instances():
            place = bases.get(identity)
            if place is None or place in known or data is None:
                continue
            known.add(place)
            velocities = self._velocities(instance, data, place) if steps and deforms else None
            if velocities is not None:
                mesh, way = meshes[place], velocities * np.float32(0.5 * seconds)
                self._shapes[place] = {
                    0.0: (mesh.positions - way, mesh.corner_normals),
                    1.0: (mesh.positions + way, mesh.corner_normals),
                }
                self._steps_of_shapes[place] = 1
                self._with_velocities.add(place)

    def _shape(
        self,
        instance: bpy.types.DepsgraphObjectInstance,
        data: bpy.types.Mesh | RoundSource,
        place: int,
        middle: Mesh,
    ) -> tuple[np.ndarray, np.ndarray] | None:
        if isinstance(data, bpy.types.Mesh):
            with rendered_mesh(_holder(instance), data, self._context.base_meshes) as mesh:
                return None if mesh is None else _shape(mesh, middle)
        return round_shape_at(data, self._context.curves, middle, self._table.rings.get(place))

    def _velocities(
        self, instance: bpy.types.DepsgraphObjectInstance, data: bpy.types.Mesh | RoundSource, place: int
    ) -> np.ndarray | None:
        """(vertices, 3) float32 meters a second, if there are any."""
        if isinstance(data, bpy.types.Mesh):
            with rendered_mesh(_holder(instance), data, self._context.base_meshes) as mesh:
                return None if mesh is None else read_velocities(mesh)
        return round_velocities(data, self._table.rings.get(place))

    def _instances(
        self,
    ) -> Iterator[tuple[Identity, bpy.types.DepsgraphObjectInstance, bpy.types.Mesh | RoundSource | None, int, bool]]:
        """All that there is now, each with what its mesh is made of, if it has one, and what _flags_for gives; valid
        until the next one only."""
        may_have_hair = self._context.may_have_hair
        for instance in self._depsgraph.object_instances:
            source = instance.object
            owner = instance.parent if instance.is_instance else source
            identity = identity_of(instance, source.original, owner.original)
            data = source.data if source.type in _WITH_SHAPES else None
            yield identity, instance, data, *self._flags_for(identity, source, owner)
            if may_have_hair and source.type == "MESH" and len(source.particle_systems):
                systems = list(hair_systems(source, self._context.is_render))
                if systems:
                    identity = identity_of_hair(identity, source.original)
                    hair = Hair(source, systems, False)
                    yield identity, instance, hair, *self._flags_for(identity, source, owner)

    def _flags_for(self, identity: Identity, source: bpy.types.Object, owner: bpy.types.Object) -> tuple[int, bool]:
        """Steps and whether shapes are blurred, by what the object and what multiplies it say."""
        key = identity[:2]
        if key not in self._flags:
            steps, deforms = self._flags_of(source)
            if len(identity) > 1:
                of_owner, owner_deforms = self._flags_of(owner)
                steps = max(steps, of_owner) if steps and of_owner else 0
                deforms = deforms and owner_deforms
            self._flags[key] = steps, deforms
        return self._flags[key]

    def _flags_of(self, source: bpy.types.Object) -> tuple[int, bool]:
        return (1, True) if self._neighbors else _flags_of(source)

    def _steps(self, identity: Identity) -> int:
        """Return the motion steps of something that there was at the middle of the shutter's time."""
        return self._flags[identity[:2]][0]

    def _look_from(self, time: float, camera: bpy.types.Object) -> None:
        evaluated = camera.evaluated_get(self._depsgraph)
        steps, _ = self._flags_of(evaluated)
        if steps and time in step_times(steps):
            pose = camera_pose(evaluated, self._depsgraph.scene_eval.render, self._eye)
            if pose is not None:
                self._cameras[time] = pose

    def _keep_lasting(self, placed: Placed) -> None:
        """Particles that come or go while the shutter is open are not seen."""

        def lasts(instance: Instance) -> bool:
            identity = placed.identities[id(instance)]
            steps = self._steps(identity)
            if instance.particle is None or steps == 0:
                return True
            return self._matrices.get(identity, {}).keys() >= set(step_times(steps)) - {MIDDLE}

        placed.instances = [instance for instance in placed.instances if lasts(instance)]

    def _shutter(self, scene: Scene, placed: Placed, meshes: list[Mesh], curve: np.ndarray) -> Shutter | None:
        shutter = Shutter(
            curve,
            list(self._movements(placed.instances, placed.identities)),
            list(self._movements(placed.lights, placed.identities)),
            list(self._deformations(meshes)),
            self._camera_movement(scene),
            rolling_duration(self._depsgraph.scene_eval),
        )
        flows = any(mesh.volume is not None and mesh.volume.motion is not None for mesh in meshes)
        still = not (shutter.instances or shutter.lights or shutter.meshes or shutter.camera or flows)
        return None if still else shutter

    def _movements(self, members: list[Instance] | list[Light], identities: dict[int, Identity]) -> Iterator[Movement]:
        for index, member in enumerate(members):
            identity = identities[id(member)]
            keys = self._matrices.get(identity)
            if keys is None:
                continue
            times = step_times(self._steps(identity))
            # What is not there at some time stays where it is in the middle.
            raw = np.stack([keys.get(time, member.matrix) if time != MIDDLE else member.matrix for time in times])
            matrices, usable = usable_matrices(raw)
            matrices[~usable] = raw[~usable]  # without extent at times
            if (matrices != matrices[0]).any():
                yield Movement(index, np.array(times), matrices)

    def _deformations(self, meshes: list[Mesh]) -> Iterator[Deformation]:
        for place, shapes in self._shapes.items():
            mesh = meshes[place]
            if any(shape is None for shape in shapes.values()):
                self._context.report.warn(
                    f'Object "{mesh.name}": the pass Vector has nothing of how it bends, for its vertices or faces are '
                    "others in the frame before or after"
                    if self._neighbors
                    else f'Object "{mesh.name}": its shape is not blurred, for its vertices or faces are others while '
                    "the shutter is open; switch off Deformation in its Motion Blur settings if that is meant"
                )
                continue
            times = step_times(self._steps_of_shapes[place])
            middle = (mesh.positions, mesh.corner_normals)
            positions, normals = (np.stack([shapes.get(time, middle)[part] for time in times]) for part in (0, 1))
            if (positions != positions[0]).any() or (normals != normals[0]).any():
                yield Deformation(place, np.array(times), positions, normals)

    def _camera_movement(self, scene: Scene) -> CameraMovement | None:
        if not self._cameras:
            return None
        poses = {**self._cameras, MIDDLE: (scene.camera.matrix, scene.camera.window)}
        times = sorted(poses)
        matrices, windows = (np.array([poses[time][part] for time in times], np.float64) for part in (0, 1))
        if (matrices == matrices[0]).all() and (windows == windows[0]).all():
            return None
        return CameraMovement(np.array(times), matrices, windows)


def _flags_of(source: bpy.types.Object) -> tuple[int, bool]:
    """Steps, 0 for an object that is not blurred, and whether its shape is; defaults where Cycles is not enabled."""
    cycles = getattr(source, "cycles", None)
    if cycles is None:
        return 1, True
    return (cycles.motion_steps if cycles.use_motion_blur else 0), cycles.use_deform_motion


def _holder(instance: bpy.types.DepsgraphObjectInstance) -> bpy.types.Object:
    """The evaluated object that an instance shows: it lives as long as the depsgraph is as it is."""
    return instance.instance_object if instance.is_instance else instance.object


def _shape(mesh: bpy.types.Mesh, middle: Mesh) -> tuple[np.ndarray, np.ndarray] | None:
    """Positions and corner normals of a mesh at another time; None if it is another mesh."""
    positions, corner_vertices, corner_normals = read_shape(mesh, middle)
    same = len(positions) == len(middle.positions) and np.array_equal(corner_vertices, middle.corner_vertices)
    return (positions, corner_normals) if same and np.isfinite(positions).all() else None
