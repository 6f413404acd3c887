# SPDX-License-Identifier: GPL-3.0-or-later
"""Picture of a scene before its programs are compiled: plain surfaces under a light at the viewer's head."""

import functools
from collections.abc import Callable, Mapping

import moderngl
import numpy as np

from ...gl.buffer_sets import BufferSet, StorageBuffer
from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.program import Bindable
from ...gl.programs.programs import ProgramLibrary
from ...materials.placeholders.plain_surface import PlainSurface, plain_surface
from ...materials.tables import default_material
from ...scene.errors import DeviceError
from ...scene.meshes import Instance, RayVisibility
from ...scene.scene import Scene
from ...scene.storage.sharing import same_members
from ..acceleration.instances import InstancedMeshes
from ..common.band import MAX_RASTER_PIXELS
from ..common.camera_view import CAMERA_VIEW, camera_view
from ..common.instance_columns import InstanceColumns, column
from ..surfaces.geometry import Geometry

PLAIN_SURFACE = Record(
    "PlainSurface", color="vec3", metallic="float", emission="vec3", roughness="float", opacity="float"
)
StorageBlock("PlainSurfaces", "PlainSurface plain_surfaces[];")
StorageBlock("InstanceOpacities", "float instance_opacities[];")
"""Below 0 of what the camera does not see, 0 of a holdout."""
DRAWN_INSTANCE = Record(
    "DrawnInstance", row0="vec4", row1="vec4", row2="vec4", pivot="vec3", material="uint", number="uint"
)
StorageBlock("DrawnInstances", "DrawnInstance drawn_instances[];")
"""Instances that are not expanded, mesh by mesh: what places their vertices (BottomLevelInstance), the material of the
first slot, and the number among all instances."""
Record(
    "FirstLookParameters",
    sky="vec3",
    headlight="float",
    exposure="float",
    drawn="uint",
    first_instance="uint",
    instance_vertices="uint",
    first_vertex="uint",
)
"""The last three are of instances that are not expanded: the first drawn one of a mesh, and the number and the first of
the vertices of the mesh."""
_SOLID, _TRANSPARENT = 1, 2
Constants("FirstLookDrawn", DRAWN_SOLID=_SOLID, DRAWN_TRANSPARENT=_TRANSPARENT)

HEADLIGHT = 0.6
"""Radiance of a white diffuse surface that faces the viewer, whatever the exposure: nothing is known of the lights."""
_DARKEST_SKY, _BRIGHTEST_SKY = 0.05, 0.6
_MOST_TRIANGLES = 1 << 22
"""Triangles of instances that are not expanded, up to which these are drawn; more take seconds."""


class FirstLook(BufferSet):
    """Draws scenes with one small program."""

    _surfaces = StorageBuffer("plain surfaces", PLAIN_SURFACE, block="PlainSurfaces")
    _opacities = StorageBuffer("opacities of instances", "float", block="InstanceOpacities")
    _drawn_instances = StorageBuffer("drawn instances", DRAWN_INSTANCE, block="DrawnInstances")
    _camera = StorageBuffer("camera of the first look", CAMERA_VIEW, 1, block="Camera")

    def __init__(
        self,
        context: Context,
        library: ProgramLibrary,
        geometry: Geometry,
        displaced: Callable[[Scene], Scene] = lambda scene: scene,
        centered: Callable[[Scene], Scene] = lambda scene: scene,
        instanced: Callable[[Scene, InstanceColumns], np.ndarray | None] = lambda _scene, _columns: None,
    ) -> None:
        """geometry: that of the mapper that renders the scenes later, which then has it on the device already;
        displaced: gives a scene with the meshes that the mapper has in place of its own, as far as that is known;
        centered: gives a scene with the places that the mapper has; instanced: which of a scene's instances are not
        expanded, as instanced_members says."""
        super().__init__(context, library)
        self._context = context
        self._library = library
        self._draw = library.draw("viewport/first_look/first_look.vert", "viewport/first_look/first_look.frag")
        self._geometry = geometry
        self._displaced, self._centered, self._instanced = displaced, centered, instanced
        self._shown: Scene | None = None
        self._uploaded: int | None = None
        """Version of the instances whose records are on the device."""
        self._blends = False
        """Whether something is neither opaque nor a hole."""
        self._sky = np.zeros(3)

    def shows_parts_of(self, scene: Scene) -> bool:
        """Whether a scene can be drawn with what the one before has on the device."""
        return self._has_parts_of(self._centered(scene))

    def _has_parts_of(self, scene: Scene) -> bool:
        before = self._shown
        return (
            before is not None
            and same_members(scene.meshes, before.meshes)
            and same_members(scene.instances, before.instances)
            and same_members(scene.materials, before.materials)
        )

    def draw(self, scene: Scene) -> np.ndarray:
        """(height, width, 4) float32 scene-linear Rec.709, premultiplied alpha, row 0 at the bottom.

        A lens is a pinhole. Raises DeviceError when the device cannot hold the scene or draw so many pixels, and
        SceneError for a camera that sees nothing.
        """
        width, height = scene.camera.resolution
        if max(width, height) > MAX_RASTER_PIXELS:
            raise DeviceError(f"{width} x {height} pixels are more than devices draw; make the viewport smaller")
        scene = self.take(scene)
        self._camera.upload(camera_view(scene.camera, 0, height, (0.0, 0.0)))
        gl = self._context.moderngl
        color, depth = gl.texture((width, height), 4, dtype="f4"), gl.depth_texture((width, height))
        framebuffer = gl.framebuffer([color], depth)
        try:
            framebuffer.clear(*self._background(scene), depth=1.0)
            self._draw_surfaces(framebuffer, scene, self._camera.buffer, _SOLID)
            if self._blends:
                self._draw_surfaces(framebuffer, scene, self._camera.buffer, _TRANSPARENT)
            pixels = np.frombuffer(framebuffer.read(components=4, dtype="f4"), np.float32)
            return pixels.reshape(height, width, 4).copy()
        finally:
            for resource in (framebuffer, color, depth):
                resource.release()

    def rasterize(self, framebuffer: moderngl.Framebuffer, scene: Scene, camera: moderngl.Buffer) -> None:
        """The nearest surfaces of a scene that take() returned, transparent ones too.

        framebuffer: of three float textures: color, premultiplied; normal and view depth, meters; numbers of instance
        and material, 0 where there is no surface (shaders/viewport/first_look/first_look.frag).
        camera: CAMERA_VIEW.
        """
        framebuffer.clear(0.0, 0.0, 0.0, 0.0, depth=1.0)
        self._draw_surfaces(framebuffer, scene, camera, _SOLID | _TRANSPARENT)

    def _background(self, scene: Scene) -> tuple[float, ...]:
        opaque = not scene.settings.film_transparent
        return (*(scene.exposure * self._sky if opaque else np.zeros(3)), float(opaque))

    def _draw_surfaces(
        self, framebuffer: moderngl.Framebuffer, scene: Scene, camera: moderngl.Buffer, drawn: int
    ) -> None:
        brightest = max(float(self._sky.max()), 1e-9)
        sky = self._sky * (np.clip(brightest * scene.exposure, _DARKEST_SKY, _BRIGHTEST_SKY) / brightest)
        if not sky.any():
            sky = np.full(3, _DARKEST_SKY)
        parameters = {"sky": sky, "headlight": HEADLIGHT, "exposure": scene.exposure, "drawn": drawn}
        blended = drawn == _TRANSPARENT
        framebuffer.depth_mask = not blended  # what is transparent hides nothing
        self._context.moderngl.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        state = moderngl.DEPTH_TEST | (moderngl.BLEND if blended else moderngl.NOTHING)
        blocks = {**self._geometry.blocks, **self.blocks, "Camera": camera}
        unused = dict.fromkeys(("first_instance", "instance_vertices", "first_vertex"), 0)
        self._draw.draw(framebuffer, 3 * self._geometry.triangle_count, blocks, {**parameters, **unused}, state=state)
        self._draw_instances(framebuffer, blocks, parameters, state)
        framebuffer.depth_mask = True

    def _draw_instances(
        self,
        framebuffer: moderngl.Framebuffer,
        blocks: Mapping[str, Bindable],
        parameters: dict[str, object],
        state: int,
    ) -> None:
        """Draw the instances that are not expanded, unless their triangles are too many."""
        instanced = self._geometry.instanced
        if instanced is None or instanced.placed_triangle_count > _MOST_TRIANGLES:
            return
        if instanced.version != self._uploaded:
            self._upload_instances(instanced)
        program = self._library.draw("viewport/first_look/instances.vert", "viewport/first_look/first_look.frag")
        inputs = {**blocks, "DrawnInstances": self._drawn_instances.buffer}
        counts = np.bincount(instanced.which, minlength=len(instanced.meshes))
        firsts = np.cumsum(counts) - counts
        for number, mesh in enumerate(instanced.meshes):
            of_mesh = {
                "first_instance": int(firsts[number]),
                "instance_vertices": 3 * mesh.triangle_count,
                "first_vertex": 3 * int(instanced.mesh_first_triangles[number]),
            }
            vertices = 3 * mesh.triangle_count * int(counts[number])
            program.draw(framebuffer, vertices, inputs, {**parameters, **of_mesh}, state=state)

    def _upload_instances(self, instanced: InstancedMeshes) -> None:
        """Have the DRAWN_INSTANCE records of instances, mesh by mesh."""
        self._uploaded = None  # should it fail
        order = np.argsort(instanced.which, kind="stable")
        records = DRAWN_INSTANCE.zeros(len(order))
        for name in ("row0", "row1", "row2", "pivot"):
            records[name] = instanced.entries[name][order]
        records["material"], records["number"] = instanced.first_materials[order], instanced.placements[order]
        self._drawn_instances.upload(records)
        self._uploaded = instanced.version

    def take(self, scene: Scene) -> Scene:
        """Upload what is not the very object of the scene before; returns the scene to be drawn, which is centered."""
        scene = self._centered(scene)
        if not self._has_parts_of(scene):
            self._shown = None
            displaced = self._displaced(scene)
            instanced = functools.partial(self._instanced, displaced)
            self._geometry.build(displaced, len(scene.materials), instanced=instanced)
            surfaces = [plain_surface(owner.graph, scene.images) for owner in (*scene.materials, default_material())]
            opacities = _opacities(self._geometry.placements.instances)
            self._surfaces.upload(_records(surfaces))
            self._opacities.upload(opacities if len(opacities) else np.zeros(1, np.float32))
            self._blends = any(surface.opacity < 1.0 for surface in surfaces)
        self._sky = np.maximum(scene.world.radiance, 0.0).astype(np.float64)
        if scene.world.graph is not None:
            self._sky = self._sky * plain_surface(scene.world.graph, scene.images).emission
        self._shown = scene
        return scene


def _opacities(instances: list[Instance]) -> np.ndarray:
    """(n,) float32 of the block InstanceOpacities."""
    is_seen = column(instances, "visibility", np.int64) & int(RayVisibility.CAMERA) != 0
    is_seen &= ~column(instances, "shadow_catcher", bool)
    return np.where(is_seen, ~column(instances, "holdout", bool), -1.0).astype(np.float32)


def _records(surfaces: list[PlainSurface]) -> np.ndarray:
    records = PLAIN_SURFACE.zeros(len(surfaces))
    for name in ("color", "metallic", "emission", "roughness", "opacity"):
        records[name] = [getattr(surface, name) for surface in surfaces]
    return records
