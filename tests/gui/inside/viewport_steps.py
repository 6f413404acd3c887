# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps in the 3D viewport, and what they measure: pixels on the screen, gaps between timers, time in the engine."""

import time
import zlib

import bpy
import gpu
import numpy as np
from mathutils import Quaternion
from window_steps import area, override, region, window

PATCH = (160, 90)
"""Pixels in the middle of the viewport that are watched."""
FULL_FRAME_ZOOM = 50.0 * (2.0 - 2.0**0.5)
"""view_camera_zoom at which the camera's frame is as large as the region."""
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
    """Look through the camera, its frame filling the region; sets the picture's size to the region's, and returns it."""
    view = space().region_3d
    view.view_perspective = "CAMERA"
    view.view_camera_zoom, view.view_camera_offset = FULL_FRAME_ZOOM, (0.0, 0.0)
    render = window().scene.render
    render.resolution_x, render.resolution_y = region("VIEW_3D").width, region("VIEW_3D").height
    return [render.resolution_x, render.resolution_y]


def free_view() -> None:
    """Look from where the camera is, without it."""
    camera = window().scene.camera
    view = space().region_3d
    view.view_perspective = "PERSP"
    view.view_distance = 5.0
    view.view_rotation = camera.matrix_world.to_quaternion()
    view.view_location = camera.matrix_world @ (camera.location * 0.0 + _ahead(view.view_distance))


def _ahead(distance: float):
    from mathutils import Vector

    return Vector((0.0, 0.0, -distance))


def shading(kind: str) -> None:
    space().shading.type = kind


def turn(degrees: float) -> None:
    """Orbit about the vertical axis."""
    view = space().region_3d
    view.view_rotation = Quaternion((0.0, 0.0, 1.0), np.radians(degrees)) @ view.view_rotation


def move_object(name: str, offset: list[float]) -> None:
    found = bpy.data.objects[name]
    found.location = [a + b for a, b in zip(found.location, offset, strict=True)]


def paint(material: str, color: list[float]) -> None:
    """Give all shader nodes of a material that have a colour this one."""
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


def playing() -> bool:
    return window().screen.is_animation_playing


# Pixels on the screen.

_drawn: list[tuple[float, int, float]] = []
_watcher = None


def watch() -> None:
    """From now on note what the window shows in the viewport's middle, each time it is drawn."""
    global _watcher
    _drawn.clear()
    if _watcher is None:
        # The only callback that runs when the window's own buffer is complete; the mouse must be over the viewport.
        _watcher = bpy.types.WindowManager.draw_cursor_add(_note, (), "VIEW_3D", "WINDOW")


def _note(*_: object) -> None:
    found = region("VIEW_3D")
    corner = found.x + (found.width - PATCH[0]) // 2, found.y + (found.height - PATCH[1]) // 2
    buffer = gpu.state.active_framebuffer_get().read_color(*corner, *PATCH, 3, 0, "UBYTE")
    pixels = np.array(buffer, np.uint8)
    _drawn.append((time.perf_counter(), zlib.crc32(pixels.tobytes()), float(pixels.mean())))


def seen() -> dict:
    """What was noted since watch(): times, checksums and mean values (0 to 255); and the time now."""
    times, sums, means = zip(*_drawn) if _drawn else ((), (), ())
    return {"times": times, "sums": sums, "means": means, "now": time.perf_counter()}


def changed() -> float | None:
    """When the watched pixels first were not what they were at first; None while they are the same."""
    for when, value, _ in _drawn:
        if value != _drawn[0][1]:
            return when
    return None


def redraw() -> None:
    region("VIEW_3D").tag_redraw()


# Gaps between timers.

_ticks: list[float] = []
_ticking = False


def tick() -> None:
    """From now on note when a timer of the window is called."""
    global _ticking
    _ticks.clear()
    if not _ticking:
        _ticking = True
        bpy.app.timers.register(_tick, persistent=True)


def _tick() -> float:
    _ticks.append(time.perf_counter())
    return GAP_SECONDS


def gaps() -> list[float]:
    """Milliseconds between the calls since tick()."""
    return [1000.0 * (after - before) for before, after in zip(_ticks, _ticks[1:])]


# Time in the engine.

_calls: dict[str, list[float]] = {"view_update": [], "view_draw": []}


def time_engine() -> None:
    """From now on note how long the engine's functions for viewports take."""
    engine = bpy.types.RenderEngine.bl_rna_get_subclass_py("RppmRenderEngine")
    for name, calls in _calls.items():
        calls.clear()
        original = getattr(engine, name)
        if not hasattr(original, "timed"):
            setattr(engine, name, _timed(original, calls))


def _timed(function, calls: list[float]):
    def timed(self, context, depsgraph):
        started = time.perf_counter()
        try:
            return function(self, context, depsgraph)
        finally:
            calls.append(1000.0 * (time.perf_counter() - started))

    timed.timed = True
    return timed


def engine_times() -> dict[str, list[float]]:
    """Milliseconds of each call since time_engine()."""
    return {name: list(calls) for name, calls in _calls.items()}
