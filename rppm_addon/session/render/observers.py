# SPDX-License-Identifier: GPL-3.0-or-later
"""How code outside Blender's engine follows a render that Blender started.

bpy.ops.render.render() takes no callbacks and gives nothing back. Whoever calls it sets an
observer first; the engine asks for it and reports what happens, in this order:

    observer = current_observer()            # a RenderObserver that does nothing when none is set
    observer.on_picture(name)                # of which view layer and view it is
    if not observer.on_scene(scene):         # the scene is exported; no Renderer has been made
        return                               # the observer wanted the scene only
    observer.on_start(scene)                 # immediately before Renderer.render(scene, ...)
    renderer.render(scene, on_progress=...,  # calls observer.on_progress(progress)
        should_stop=...,                     # true as well when observer.should_stop() is true
        snapshots=observer.snapshots,        # read after on_start, as is observer.continuation
        on_snapshot=...)                     # calls observer.on_snapshot(seconds, frame, scene)
    observer.on_finish(result, scene)        # also after a stopped render
    observer.on_error(text)                  # wherever the engine reports an error to Blender

on_scene and on_start may change scene.settings.
"""

import contextlib
import contextvars
from collections.abc import Iterator
from typing import TYPE_CHECKING

from ...pictures import PictureName
from ...scene import Scene

if TYPE_CHECKING:
    from ..checkpoints.continuation import Continuation
    from .results import Frame, Progress, RenderResult


class RenderObserver:
    """Is notified of what happens to a render. This one ignores it all; subclasses override."""

    snapshots: tuple[float, ...] = ()
    """Ascending seconds since on_start at which on_snapshot wants a frame."""

    continuation: "Continuation | None" = None
    """Where the render begins and who receives its state; in the background only (RenderJob.continuation)."""

    def on_picture(self, name: PictureName) -> None:
        """Take note of the view layer and view that follow. A render may have several, one after the other."""

    def on_scene(self, scene: Scene) -> bool:
        """The scene is complete and no renderer has been made for it yet.

        Returns whether it is to be rendered; False ends the render here, without an error.
        """
        return True

    def on_start(self, scene: Scene) -> None:
        """The renderer exists and is about to be given the scene."""

    def on_progress(self, progress: "Progress") -> None:
        """An iteration is done; iteration 0 is the structure's build."""

    def should_stop(self) -> bool:
        """Whether the render is to end early with what it has."""
        return False

    def on_snapshot(self, seconds: float, frame: "Frame", scene: Scene) -> None:
        """Take the picture at a mark of ``snapshots``."""

    def on_finish(self, result: "RenderResult", scene: Scene) -> None:
        """The render has ended, as planned or stopped."""

    def on_error(self, text: str) -> None:
        """The engine reported an error; there is no result."""


_IGNORE = RenderObserver()
_observer: contextvars.ContextVar[RenderObserver] = contextvars.ContextVar("rppm_render_observer", default=_IGNORE)


def current_observer() -> RenderObserver:
    """The observer set by observing(), or one that ignores everything."""
    return _observer.get()


@contextlib.contextmanager
def observing(observer: RenderObserver) -> Iterator[RenderObserver]:
    """Make ``observer`` the one that renders started inside the with block report to."""
    token = _observer.set(observer)
    try:
        yield observer
    finally:
        _observer.reset(token)
