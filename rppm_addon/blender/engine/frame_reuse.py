# SPDX-License-Identifier: GPL-3.0-or-later
"""Data that one final render leaves for the next: the frames of an animation have most of their scene in common.

It is kept until another file is loaded, since without a window renders are all that Blender does. With a window, a user
goes on working and wants the memory: there it is kept to the end of the animation only, or with Blender's Persistent
Data, which asks for just that.
"""

import bpy
from bpy.app.handlers import persistent

from ...scene import Scene
from ...scene.storage.sharing import share
from ..app_handlers import add_handlers, remove_handlers
from ..render_client import renderer_process, renderer_thread

_last: Scene | None = None


def reuse_previous_frame(scene: Scene) -> Scene:
    """A scene that is about to be rendered, with the very members of the one before where they are equal.

    The renderer then knows what it need not upload again.
    """
    global _last
    _last = share(_last, scene, compare_large=True)
    return _last


def forget() -> None:
    """Give it all back."""
    global _last
    _last = None
    renderer_process.forget()
    renderer_thread.forget()


@persistent
def _on_end(scene: bpy.types.Scene, *_: object) -> None:
    """A still or an animation is complete or cancelled."""
    if renderer_process.is_used() and not scene.render.use_persistent_data:
        forget()


@persistent
def _on_baked(*_: object) -> None:
    """A bake is complete or cancelled. Blender tells of the object."""
    _on_end(bpy.context.scene)


@persistent
def _on_load(*_: object) -> None:
    forget()


_HANDLERS = (
    (bpy.app.handlers.render_complete, _on_end),
    (bpy.app.handlers.render_cancel, _on_end),
    (bpy.app.handlers.object_bake_complete, _on_baked),
    (bpy.app.handlers.object_bake_cancel, _on_baked),
    (bpy.app.handlers.load_post, _on_load),
)


def register() -> None:
    """Have what is kept be given back in time."""
    add_handlers(_HANDLERS)


def unregister() -> None:
    """Give it all back."""
    remove_handlers(_HANDLERS)
    forget()
