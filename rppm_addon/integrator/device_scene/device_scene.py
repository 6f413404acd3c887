# SPDX-License-Identifier: GPL-3.0-or-later
"""Init of Algorithm 1: a scene on the device, built anew where it has changed or moves."""

import contextlib
import functools
import itertools
from collections.abc import Iterator

import numpy as np

from ...gl.context.context import Context
from ...gl.context.timers import StageTimers
from ...gl.programs.bindings import ITERATION
from ...gl.programs.program import Bindable
from ...gl.programs.programs import ProgramLibrary
from ...materials.tables import MaterialTables
from ...scene.meshes import Instance, Mesh
from ...scene.scene import Scene
from ...scene.settings import AccelerationStructure
from ..common.iteration import Iteration
from ..common.require import require
from ..lights.lights import Lights
from ..surfaces.bodies import warn_of_open_bodies
from ..surfaces.displacement import Displacement
from ..surfaces.geometry import Geometry
from ..surfaces.resolve import Resolve
from .acceleration import Acceleration
from .centering import Centering
from .changes import Changes, changes_between, snapshot
from .iteration_parameters import IterationBlock
from .shutter import SceneMotion
from .stage_context import StageContext


class DeviceScene:
    """Parts of a scene that lie on the device: geometry, materials, lights and the acceleration structure."""

    def __init__(self, context: Context, library: ProgramLibrary, timers: StageTimers) -> None:
        self._timers = timers
        self._library = library
        self.geometry = Geometry(context, library)
        self.materials = MaterialTables(context, library)
        self.displacement = Displacement(context, library)
        self.lights = Lights(context, library)
        self.acceleration = Acceleration(context, library)
        self.resolve = Resolve(context, library)
        self.iteration_block = IterationBlock(context, library)
        self.centering = Centering()
        self.scene: Scene | None = None
        """Centered and displaced; with a shutter, as it is at the iteration's moment."""
        self._uploaded_scene: Scene | None = None
        """Snapshot of the scene on the device; None if there is no scene to compare a change with."""
        self._warnings: dict[str, list[str]] = {"device": context.information.warnings}
        """Warnings by part, collected when the part was built. They hold for later scenes as well."""
        self._motion = SceneMotion()
        self._checked_bodies: dict[int, tuple[Mesh, bool]] = {}

    @property
    def moves(self) -> bool:
        """Whether iterations have moments of their own (move_to)."""
        return self._motion.moves

    @property
    def motion(self) -> SceneMotion:
        """Motion of the scene while its shutter is open."""
        return self._motion

    @property
    def context(self) -> StageContext:
        """For stages, at the moment that the scene was last moved to."""
        return StageContext(
            require(self.scene),
            self.geometry,
            self.materials,
            self.lights,
            self.acceleration.structure,
            self.acceleration.center,
            self.resolve,
            self._timers,
            self.iteration_block,
            self._blocks,
        )

    @property
    def _blocks(self) -> dict[str, Bindable]:
        """Storage blocks and textures of the scene, each declared by its owner."""
        return {
            **self.geometry.blocks,
            **self.materials.blocks,
            **self.resolve.blocks,
            **self.lights.blocks,
            **self.acceleration.structure.traversal_buffers,
            ITERATION: self.iteration_block.buffer,
        }

    def forget(self) -> None:
        """Have the next update build everything."""
        self._uploaded_scene = None
        self.geometry.forget()

    def update(self, scene: Scene, center_tolerance: float = 0.0) -> None:
        """Take a scene; build only what rests on members that are not the very objects of the scene before.

        center_tolerance: how far from where the deep cubemap's center should be it may stay, in radii of the scene,
        which changes no picture. Raises SceneError or DeviceError; what is built then is built anew the next time.
        """
        if scene.instance_arrays:
            raise ValueError("the scene has arrays of instances; give Scene.expanded() to the integrator")
        scene = self.centering.centered(scene)
        before = self._uploaded_scene
        changes = changes_between(before, scene)
        self._library.graph_defines = scene.color_space.defines
        self._take(scene)
        self._build_materials(changes)
        with self._collect_warnings("displacement") if changes.materials else contextlib.nullcontext():
            displaced = self.displacement.displaced(scene, self.materials, changes.materials)
        self._warnings["dicing"] = self.displacement.warnings
        if displaced is not scene:
            displaced.warnings = scene.warnings  # not those that were collected meanwhile
            scene = displaced
            changes = changes_between(before, scene)
            self._take(scene)
        if changes.geometry or changes.materials:
            self._library.pacing.forget()
        changes.geometry |= self._motion.take(scene)
        self._build_parts(changes, scene.photon_count)
        self._build_acceleration(scene, changes, center_tolerance)
        for text in itertools.chain(*self._warnings.values()):
            scene.warn(text)
        self._uploaded_scene = snapshot(scene)

    def upload_geometry(self, scene: Scene) -> None:
        """Take a scene and build the deep cubemap that rays need, to be looked at: nothing can be rendered. Raises as
        update does."""
        scene = self.centering.centered(scene)
        self._library.graph_defines = scene.color_space.defines
        self._take(scene)
        self.materials.build(scene)
        scene = self.displacement.displaced(scene, self.materials, True)
        self._take(scene)
        instanced = functools.partial(self.acceleration.instanced_members, scene)
        self.geometry.build(scene, self.materials.default_material, instanced=instanced)
        self.acceleration.build(scene, self.geometry, AccelerationStructure.DEEP_CUBEMAP)

    def move_to(self, iteration: Iteration) -> None:
        """Take the scene as it is at the iteration's moment, and build anew what rests on what has moved.

        The deep cubemap's center stays: it changes no picture, and a camera that moves alone costs nothing.
        """
        time = self._motion.time_of(iteration)
        self.scene = self._motion.scene_at(time)
        changes = changes_between(self._uploaded_scene, self.scene)
        self._uploaded_scene = None
        with self._timers.stage("motion"):
            self._build_materials(changes)
            self._build_parts(changes, iteration.photon_count, keep_learned=True)
            self.materials.media.advect(time)
        self._build_acceleration(self._motion.scene, changes, center_tolerance=np.inf)
        self._uploaded_scene = snapshot(self.scene)

    def _take(self, scene: Scene) -> None:
        self._uploaded_scene = None
        self.scene = scene

    def _build_materials(self, changes: Changes) -> None:
        scene = require(self.scene)
        self.materials.follow(scene)
        if changes.materials:
            with self._collect_warnings("materials"):
                self.materials.build(scene)
            self.lights.emitters.meshes.forget()

    def _build_parts(self, changes: Changes, photons: int, keep_learned: bool = False) -> None:
        """Build all that rests on the scene's members that have changed, except for materials, displacement and the
        acceleration structure.

        photons: number of photons of the iteration. keep_learned: go on with what was learned of the lights.
        """
        scene = require(self.scene)
        if changes.geometry or changes.materials:
            changes.geometry |= self.materials.place_media(scene)
        instanced = functools.partial(self.acceleration.instanced_members, self._motion.scene)
        if not changes.geometry and (changes.materials or changes.levels):
            changes.geometry = not self.geometry.would_place(scene, instanced, self.materials.any_passes_shadow_rays)
        if changes.geometry:
            self.geometry.build(
                scene,
                self.materials.default_material,
                self._motion.swept,
                self.materials.media.places.slots,
                instanced,
                self.materials.any_passes_shadow_rays,
            )
        if changes.geometry or changes.materials:
            with self._collect_warnings("resolve"):
                self.resolve.build(scene, self.geometry, self.materials)
            with self._collect_warnings("media"):
                self._bake_media(scene)
            if not keep_learned:  # within an open shutter no mesh gets holes
                with self._collect_warnings("bodies"):
                    self._warn_of_media(scene)
        self.resolve.set_view(scene)
        if changes.geometry or changes.materials or changes.lights:
            self.materials.media.list_emissive(scene, *self._placed_and_bounds)
            with self._collect_warnings("lights"):
                self.lights.build(
                    scene,
                    self.geometry,
                    self.materials,
                    self.resolve,
                    photons,
                    not changes.world,
                    not changes.light_objects,
                    keep_learned,
                )
        elif not keep_learned:
            self.lights.begin(photons)

    def _bake_media(self, scene: Scene) -> None:
        blocks = {**self.geometry.blocks, **self.resolve.blocks}
        self.materials.bake_media(scene, *self._placed_and_bounds, blocks)

    @property
    def _placed_and_bounds(self) -> tuple[list[Instance], tuple[np.ndarray, np.ndarray]]:
        """The instances that have triangles, and the bounds of the scene, low and high, (3,) each."""
        geometry = self.geometry
        return geometry.placements.instances, (geometry.bounds_low, geometry.bounds_high)

    def _warn_of_media(self, scene: Scene) -> None:
        """Warn of media of which it is not clear where they are, or what shines on them."""
        if not self.materials.media.materials:
            return
        warn_of_open_bodies(scene, self.materials.media.materials, self._checked_bodies)
        self._warn_of_linked_media(scene)

    def _warn_of_linked_media(self, scene: Scene) -> None:
        media = self.materials.media
        linked = [
            instance.object_name
            for instance in scene.instances
            if instance.linking is not None
            and instance.linking.receiver_light_set
            and not media.materials.isdisjoint(instance.materials)
        ]
        if linked and media.scatter:
            names = ", ".join(sorted(set(linked)))
            scene.warn(f"Light Linking of volumes ({names}): lights shine on them as on objects without Light Linking")

    @contextlib.contextmanager
    def _collect_warnings(self, part: str) -> Iterator[None]:
        """Keep what is said while a part is built."""
        scene = require(self.scene)
        before, scene.warnings = scene.warnings, []
        try:
            yield
            self._warnings[part] = scene.warnings
        finally:
            scene.warnings = before

    def _build_acceleration(self, scene: Scene, changes: Changes, center_tolerance: float) -> None:
        with self._timers.stage("acceleration structure"):
            self.acceleration.update(scene, self.geometry, changes, center_tolerance)
        self.resolve.set_accelerator(self.acceleration.structure)

    @property
    def memory_bytes(self) -> dict[str, dict[str, int]]:
        """Bytes on the device by group and buffer."""
        return {
            "scene": self.geometry.memory_bytes | self.materials.memory_bytes | self.lights.memory_bytes,
            "acceleration structure": self.acceleration.memory_bytes,
            "resolve": self.resolve.memory_bytes,
            "iteration": self.iteration_block.memory_bytes,
        }

    def release(self) -> None:
        """Give all buffers back."""
        for part in (self.geometry, self.materials, self.lights, self.acceleration, self.resolve, self.iteration_block):
            part.release()
