# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps in the 3D viewport, and what they measure: pixels on the screen, gaps between timers, time in the engine."""

import importlib
import time
import types
import zlib

import bpy
import gpu
import numpy as np
from mathutils import Quaternion, Vector
from window_steps import area, override, region, window

PATCH = (160, 90)
"""Pixels in the middle of the viewport that are watched."""
FULL_FRAME_ZOOM = 50.0 * (2.0 - 2.0**0.5)
"""view_camera_zoom at which the camera's frame is as large as the region."""
ONE_COLOR = 2.0
"""Standard deviation of pixels, 0 to 255, below which there is no picture yet."""
GAP_SECONDS = 0.004
"""How soon the timer that measures gaps asks to be called again."""


def space() -> bpy.types.SpaceView3D:
    return area("VIEW_3D").spaces.active


def plain_viewport() -> None:
    """Nothing but the scene: no overlays, no gizmos, no headers."""
    view = space()
    view.overlay.show_overlays = False
    for name in ("show_gizmo", "show_region_header", "show_region_tool_header", "show_region_toolbar"):
        setattr(view, name, False)


def camera_view() -> list[int]:
    """Look through the camera, its frame filling the region, which is the picture's size from now on; returns that."""
    view = space().region_3d
    view.view_perspective = "CAMERA"
    view.view_camera_zoom, view.view_camera_offset = FULL_FRAME_ZOOM, (0.0, 0.0)
    render = window().scene.render
    render.resolution_x, render.resolution_y = region("VIEW_3D").width, region("VIEW_3D").height
    return [render.resolution_x, render.resolution_y]


def free_view() -> None:
    """Look from where the camera is, without it; turning about a point just ahead, the view stays inside the room."""
    camera = window().scene.camera.matrix_world
    view = space().region_3d
    view.view_perspective, view.view_distance = "PERSP", 0.3
    view.view_rotation = camera.to_quaternion()
    view.view_location = camera @ Vector((0.0, 0.0, -view.view_distance))


def viewports() -> list[bpy.types.Area]:
    """From left to right."""
    return sorted((area for area in window().screen.areas if area.type == "VIEW_3D"), key=lambda area: area.x)


def halve_viewport() -> None:
    """Two viewports side by side that look alike, both rendered."""
    with override():
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.5)
    for half in viewports():
        half.spaces.active.shading.type = "RENDERED"


def viewport_rectangles() -> list[list[int]]:
    """x, y, width, height of each viewport on the screen, y from the top."""
    regions = [next(r for r in area.regions if r.type == "WINDOW") for area in viewports()]
    return [[r.x, window().height - r.y - r.height, r.width, r.height] for r in regions]


def copy_view(source: int, target: int) -> None:
    """Let a viewport look as another one does."""
    one, other = (viewports()[index].spaces.active.region_3d for index in (source, target))
    other.view_perspective = one.view_perspective
    other.view_rotation, other.view_location = one.view_rotation, one.view_location
    other.view_distance = one.view_distance


def turn_viewport(index: int, degrees: float) -> None:
    """Orbit one of the viewports about the vertical axis."""
    view = viewports()[index].spaces.active.region_3d
    view.view_rotation = Quaternion((0.0, 0.0, 1.0), np.radians(degrees)) @ view.view_rotation


def local_view(index: int, names: list[str]) -> None:
    """Select these objects, and enter or leave local view in one of the viewports."""
    for thing in window().view_layer.objects:
        thing.select_set(thing.name in names)
    found = viewports()[index]
    main = next(r for r in found.regions if r.type == "WINDOW")
    with bpy.context.temp_override(window=window(), area=found, region=main):
        bpy.ops.view3d.localview(frame_selected=False)


def show_only(names: list[str]) -> None:
    """Hide all other objects in viewports."""
    for thing in bpy.data.objects:
        thing.hide_viewport = thing.name not in names


def shading(kind: str) -> None:
    space().shading.type = kind


def turn(degrees: float) -> None:
    """Orbit about the vertical axis."""
    view = space().region_3d
    view.view_rotation = Quaternion((0.0, 0.0, 1.0), np.radians(degrees)) @ view.view_rotation


def edit_mesh(name: str) -> None:
    """Raise the first vertex of a mesh object, and forget no other."""
    mesh = bpy.data.objects[name].data
    mesh.vertices[0].co.z += 0.1
    mesh.update()


def move_object(name: str, offset: list[float]) -> None:
    found = bpy.data.objects[name]
    found.location = [a + b for a, b in zip(found.location, offset, strict=True)]


def paint(material: str, color: list[float]) -> None:
    """Give all shader nodes of a material that have a color this one."""
    for node in bpy.data.materials[material].node_tree.nodes:
        for name in ("Base Color", "Color"):
            if name in node.inputs:
                node.inputs[name].default_value = color


def animate(name: str, offset: list[float], frames: int) -> None:
    """Keyframes that move an object by ``offset``."""
    found = bpy.data.objects[name]
    found.keyframe_insert("location", frame=1)
    move_object(name, offset)
    found.keyframe_insert("location", frame=1 + frames)
    window().scene.frame_set(1)


def play() -> None:
    """Start or stop playback."""
    with override():
        bpy.ops.screen.animation_play()


def set_frame(frame: int) -> None:
    window().scene.frame_set(frame)


def playing() -> bool:
    return window().screen.is_animation_playing


# Pixels on the screen.

_drawn: list[tuple[float, int, float, float]] = []
_watching: object = None
"""The callback's handle."""


def watch() -> None:
    """From now on note what the window shows in the viewport's middle, each time it is drawn."""
    global _watching
    _drawn.clear()
    if _watching is None:
        # The only callback that runs when the window's own buffer is complete; the mouse must be over the viewport.
        _watching = bpy.types.WindowManager.draw_cursor_add(_note, (), "VIEW_3D", "WINDOW")


def watch_no_more() -> None:
    """Note nothing any more."""
    global _watching
    if _watching is not None:
        bpy.types.WindowManager.draw_cursor_remove(_watching)
        _watching = None
    _drawn.clear()


@bpy.app.handlers.persistent
def _on_load(*_: object) -> None:
    """Loading a file takes cursors' callbacks away."""
    global _watching
    _watching = None


bpy.app.handlers.load_post.append(_on_load)


def _note(*_: object) -> None:
    found = region("VIEW_3D")
    corner = found.x + (found.width - PATCH[0]) // 2, found.y + (found.height - PATCH[1]) // 2
    buffer = gpu.state.active_framebuffer_get().read_color(*corner, *PATCH, 3, 0, "UBYTE")
    pixels = np.array(buffer, np.uint8)
    _drawn.append((time.perf_counter(), zlib.crc32(pixels.tobytes()), float(pixels.mean()), float(pixels.std())))


def seen() -> dict:
    """Return the notes since watch(): times, checksums and mean values (0 to 255); and the time now."""
    times, sums, means, _ = zip(*_drawn) if _drawn else ((), (), (), ())
    return {"times": times, "sums": sums, "means": means, "now": time.perf_counter()}


def drawn() -> bool:
    """Whether the window was drawn since watch(); asks for it."""
    region("VIEW_3D").tag_redraw()
    return bool(_drawn)


def changed() -> float | None:
    """When the watched pixels first were others than at first, and not of one color; None while they are not."""
    for when, value, _, spread in _drawn:
        if value != _drawn[0][1] and spread > ONE_COLOR:
            return when
    return None


# Gaps between timers.

_ticks: list[tuple[float, float]] = []
_ticking = False


def tick() -> None:
    """From now on note when a timer of the window is called."""
    global _ticking
    _ticks.clear()
    if not _ticking:
        _ticking = True
        bpy.app.timers.register(_tick, persistent=True)


def _tick() -> float:
    _ticks.append((time.perf_counter(), time.thread_time()))
    return GAP_SECONDS


def gaps() -> list[float]:
    """Milliseconds between the calls since tick()."""
    return [1000.0 * (after - before) for (before, _), (after, _) in zip(_ticks, _ticks[1:])]


def busy_gaps() -> list[float]:
    """Milliseconds of the processor that Blender's own thread took between them, however busy the machine is."""
    return [1000.0 * (after - before) for (_, before), (_, after) in zip(_ticks, _ticks[1:])]


# Time in the engine.

_calls: dict[str, list[tuple[float, float]]] = {"view_update": [], "view_draw": []}


def time_engine(name: str = "RPPM") -> None:
    """From now on note how long an engine's functions for viewports take."""
    engine = next(c for c in bpy.types.RenderEngine.__subclasses__() if getattr(c, "bl_idname", "") == name)
    for function, calls in _calls.items():
        calls.clear()
        original = getattr(engine, function)
        if not hasattr(original, "timed"):
            setattr(engine, function, _timed(original, calls))


def _timed(function, calls: list[tuple[float, float]]):
    def timed(self, context, depsgraph):
        started, busy = time.perf_counter(), time.thread_time()
        try:
            return function(self, context, depsgraph)
        finally:
            calls.append((1000.0 * (time.perf_counter() - started), 1000.0 * (time.thread_time() - busy)))

    timed.timed = True
    return timed


def engine_times() -> dict[str, list[float]]:
    """Milliseconds of each call since time_engine()."""
    return {name: [wall for wall, _ in calls] for name, calls in _calls.items()}


def engine_busy() -> dict[str, list[float]]:
    """Milliseconds of the processor that the calls since time_engine() took in Blender's own thread."""
    return {name: [busy for _, busy in calls] for name, calls in _calls.items()}


# The extension's modules.


def _module(name: str) -> types.ModuleType:
    """Return a module of the extension, by its name in rppm_addon.blender."""
    engine = next(c for c in bpy.types.RenderEngine.__subclasses__() if getattr(c, "bl_idname", "") == "RPPM")
    return importlib.import_module(f"{engine.__module__.rsplit('.', 2)[0]}.{name}")


# Samples that a viewport shows.

_samples: list[tuple[float, int]] = []


def count_samples() -> None:
    """From now on note how many samples the pictures have that a viewport of RPPM draws."""
    module = _module("engine.viewport")
    draw = module.Viewport.draw
    _samples.clear()

    def counted(self, *arguments):
        draw(self, *arguments)
        _samples.append((time.perf_counter(), self._session.status.iteration))

    module.Viewport.draw = counted


def sampled() -> float | None:
    """When a viewport first showed samples, since count_samples(); None while it shows none."""
    return next((when for when, samples in _samples if samples > 0), None)


# Exports in slices.

_slices: list[list[int] | None] = []


def count_slices() -> None:
    """From now on note each slice of a viewport's export."""
    module = _module("export.updates.sync")
    advance = module.SceneSync.advance
    _slices.clear()

    def counted(self, *arguments):
        progress = advance(self, *arguments)
        _slices.append(None if progress is None else [progress.objects, progress.of])
        return progress

    module.SceneSync.advance = counted


_exported: list[str] = []


def count_meshes() -> None:
    """From now on note whose mesh is exported."""
    module = _module("export.instances.mesh_table")
    export_mesh = module.export_mesh

    def counted(mesh, name, *arguments):
        exported = export_mesh(mesh, name, *arguments)
        _exported.append(name)
        return exported

    module.export_mesh = counted


def exported_meshes() -> list[str]:
    """Names of objects, in their order, since this was asked last."""
    names = _exported.copy()
    _exported.clear()
    return names


def slices() -> list[list[int] | None]:
    """Since count_slices(), how many instances of how many each slice had come to; None for what ends an export."""
    return list(_slices)
