# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes of renders whose depsgraph lives on from one to the next (Blender's persistent data)."""

import dataclasses
from collections.abc import Callable

import bpy

from ....scene import Scene
from ..camera.camera import export_camera
from ..camera.eyes import Eye
from ..common.report import Report
from .stamps import export_stamps
from .sync import SceneSync


class FrameExporter:
    """Belongs to one render engine, which Blender keeps as long as the depsgraph."""

    def __init__(self) -> None:
        self._sync: SceneSync | None = None
        self._layer: tuple[int, str] | None = None
        self._render: tuple[Callable[[], bool], Callable[[str], None]] | None = None
        """should_stop and show of the render that is exported."""

    def export(
        self, depsgraph: bpy.types.Depsgraph, should_stop: Callable[[], bool], show: Callable[[str], None], eye: Eye
    ) -> Scene:
        """Return the scene for a render of the depsgraph, as export_scene gives it; only what has changed since the
        previous render is read. Raises the errors of export_scene.

        show: takes what is being exported. eye: of the view that is rendered.
        """
        # Blender makes a new depsgraph for another layer, but may report as little of it as of one that has changed.
        layer = depsgraph.scene.session_uid, depsgraph.view_layer_eval.name
        sync = self._sync if layer == self._layer else None
        # Changes that an export which failed has not taken in are reported once only.
        self._sync, self._layer = None, layer
        self._render = should_stop, show
        try:
            scene = self._exported(depsgraph, sync or SceneSync(viewport=False, make_report=self._new_report), eye)
        finally:
            self._render = None  # it may hold the engine, which holds this
        return scene

    def _exported(self, depsgraph: bpy.types.Depsgraph, sync: SceneSync, eye: Eye) -> Scene:
        report = self._new_report()
        report.progress("Exporting the scene")
        camera = export_camera(depsgraph.scene_eval, depsgraph, eye=eye, report=report)
        scene = sync.update(depsgraph, camera)
        self._sync = sync
        warnings = [*report.warnings, *scene.warnings] if report.warnings else scene.warnings
        return dataclasses.replace(scene, stamps=export_stamps(depsgraph.scene_eval), warnings=warnings)

    def _new_report(self) -> Report:
        return Report(lambda: self._render[0](), lambda text: self._render[1](text))
