# SPDX-License-Identifier: GPL-3.0-or-later
"""The viewports that are open in Blender, by their engines."""

import threading

import bpy
from bpy.app.handlers import persistent

from ..app_handlers import add_handlers, remove_handlers
from . import kept_exports, studio_lights
from .viewport import Viewport

POLL_SECONDS = 1.0 / 30.0
"""Time between two requests for the newest frames."""

_viewports: dict[int, Viewport] = {}
"""Open viewports by the engine's address: workers must not hold engines, which Blender frees at any time."""


def of_engine(engine: bpy.types.RenderEngine) -> Viewport:
    """Return the viewport that an engine draws; open it if there is none."""
    if not bpy.app.timers.is_registered(_poll):
        bpy.app.timers.register(_poll, first_interval=POLL_SECONDS)
    key = engine.as_pointer()
    if not is_open(engine):
        close(key)  # one of a freed engine that lay where this one lies
        _viewports[key] = Viewport(engine)
    return _viewports[key]


def is_open(engine: bpy.types.RenderEngine) -> bool:
    """Return whether an engine draws a viewport that is open."""
    viewport = _viewports.get(engine.as_pointer())
    return viewport is not None and viewport.engine is engine


def close(key: int) -> None:
    """Close the viewport of an engine that is being freed."""
    viewport = _viewports.pop(key, None)
    if viewport is not None:
        viewport.close()


def _close_freed() -> None:
    for key in [key for key, viewport in _viewports.items() if not viewport.is_open]:
        close(key)


def close_all() -> None:
    """Close all viewports and request no more redraws."""
    for key in list(_viewports):
        close(key)
    if bpy.app.timers.is_registered(_poll):
        bpy.app.timers.unregister(_poll)


def _poll() -> float | None:
    lit_anew = studio_lights.load_wanted()
    _close_freed()
    for viewport in list(_viewports.values()):
        viewport.poll()
        if lit_anew:
            viewport.engine.tag_redraw()
    return POLL_SECONDS if _viewports else None


@persistent
def _on_load(*_: object) -> None:
    """Close the viewports of the previous file."""
    close_all()
    kept_exports.forget()


@persistent
def _on_undo(*_: object) -> None:
    """Forget exports: data-blocks may lie where others lay."""
    _close_freed()
    kept_exports.forget()


@persistent
def _on_evaluated(_: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Note what has changed, so that changes made in Solid are seen in Rendered."""
    if threading.current_thread() is threading.main_thread():  # renders evaluate depsgraphs of their own
        _close_freed()
        kept_exports.note(depsgraph)


_HANDLERS = (
    (bpy.app.handlers.load_pre, _on_load),
    (bpy.app.handlers.undo_post, _on_undo),
    (bpy.app.handlers.redo_post, _on_undo),
    (bpy.app.handlers.depsgraph_update_post, _on_evaluated),
    (bpy.app.handlers.frame_change_post, _on_evaluated),
)


def register() -> None:
    """Have viewports close with their file."""
    add_handlers(_HANDLERS)


def unregister() -> None:
    """Close all viewports."""
    remove_handlers(_HANDLERS)
    close_all()
    kept_exports.forget()
    studio_lights.forget()
