# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of an animation that could not be rendered: the others go on, and no wrong picture stays.

Blender ends an animation when an engine reports an error, and saves a black picture when it does not. So such a frame
is reported as a warning, and its file is removed again: whoever looks for frames that are missing finds it. In the
background Blender then ends with another status than 0.
"""

import contextlib
import logging
from pathlib import Path

import bpy
from bpy.app.handlers import persistent

from .. import background

logger = logging.getLogger(__name__)

_Identity = tuple[int, int, int, int] | None
_broken: tuple[int, int, _Identity] | None = None
"""session_uid of the scene, frame, and what its file was before, of the last one."""


def report(engine: bpy.types.RenderEngine, depsgraph: bpy.types.Depsgraph, text: str) -> None:
    """Tell that the frame that an animation is at has no picture, and why."""
    global _broken
    scene = depsgraph.scene
    _broken = scene.session_uid, scene.frame_current, _identity(_path(scene))
    background.lose_frame()
    engine.report({"WARNING"}, f"Frame {scene.frame_current} has no picture: {text}")
    # Blender crashes when it is to save layers of which it was given none.
    layer = depsgraph.view_layer_eval.name
    engine.end_result(engine.begin_result(0, 0, engine.resolution_x, engine.resolution_y, layer=layer))


@persistent
def _on_write(scene: bpy.types.Scene, *_: object) -> None:
    if _broken is None or _broken[:2] != (scene.session_uid, scene.frame_current) or scene.render.is_movie_format:
        return
    path = _path(scene)
    with contextlib.suppress(OSError):
        if _identity(path) != _broken[2]:  # else the file is none that was written now
            path.unlink()
            logger.warning("frame %d has no picture: %s is removed", scene.frame_current, path)


def _path(scene: bpy.types.Scene) -> Path:
    return Path(bpy.path.abspath(scene.render.frame_path(frame=scene.frame_current)))


def _identity(path: Path) -> _Identity:
    """Another one once a file was written, whatever clocks say: those of servers differ, and some are set back."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns


def register() -> None:
    """Add what follows broken frames."""
    bpy.app.handlers.render_write.append(_on_write)


def unregister() -> None:
    """Take out what follows broken frames."""
    bpy.app.handlers.render_write.remove(_on_write)
