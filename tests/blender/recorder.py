# SPDX-License-Identifier: GPL-3.0-or-later
"""An observer that keeps all that it is told of renders."""

import bpy

from rppm_addon.session.render.observers import RenderObserver, observing


class Recorder(RenderObserver):
    """Keeps all that it is told; ``renders``: whether a render goes on after the export."""

    def __init__(self, renders=True, snapshots=()):
        self.renders, self.snapshots = renders, snapshots
        self.calls, self.pictures, self.scenes, self.errors = [], [], [], []
        self.iterations, self.frames, self.result = [], [], None

    def on_picture(self, name):
        self.pictures.append(name)

    def on_scene(self, scene):
        self.calls.append("scene")
        self.scenes.append(scene)
        return self.renders

    def on_start(self, scene):
        self.calls.append("start")

    def on_progress(self, progress):
        self.iterations.append(progress.iteration)

    def on_snapshot(self, seconds, frame, scene):
        self.frames.append(frame)

    def on_finish(self, result, scene):
        self.calls.append("finish")
        self.frames.append(result.frame)
        self.result = result

    def on_error(self, text):
        self.calls.append("error")
        self.errors.append(text)


def record(recorder=None, **arguments):
    """Render by Blender's operator, with its arguments; returns the recorder of the render."""
    recorder = recorder or Recorder()
    with observing(recorder):
        bpy.ops.render.render(**arguments)
    return recorder
