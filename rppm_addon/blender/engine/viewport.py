# SPDX-License-Identifier: GPL-3.0-or-later
"""A rendered viewport: sends changes to the renderer process and draws the newest frame, without waiting for it."""

import logging
import time
from dataclasses import replace

import bpy

from ...scene import Camera, RenderSettings, Scene
from ...scene.errors import RppmError, unforeseen
from ...scene.storage.sharing import share
from ...session.transport.sessions import SessionKind
from ..export import export_exposure, export_settings, export_view
from ..export.shading.lights.view_lighting import relit, view_lighting
from ..export.view_layer.layers import world_of
from ..render_client.renderer_process import renderer_process
from . import studio_lights
from .frame_texture import FrameTexture
from .viewport_export import ViewportExport, is_playing
from .viewport_status import ViewportStatus

logger = logging.getLogger(__name__)

EXPORT_REDRAW_SECONDS = 0.25
"""Time between two drawings of the progress of an export."""
NAVIGATION_SECONDS = 0.4
"""Longest time between two changes of one movement."""


class Viewport:
    """One viewport in Rendered mode."""

    def __init__(self, engine: bpy.types.RenderEngine) -> None:
        self.engine = engine
        self._export = ViewportExport()
        self._session = renderer_process().open(SessionKind.VIEWPORT)
        self._texture = FrameTexture()
        self._status = ViewportStatus(engine)
        self._scene: Scene | None = None
        """Scene that the session shows; None before the first."""
        self._generation = 0
        """Generation of the scene."""
        self._changed_at = 0.0
        self._regions: dict[int, tuple[float, float, float, float]] = {}
        """Part of the region that a generation's frames cover: x, y, width, height, 0 to 1."""
        self._drawn_state: tuple = ()
        """State of the renderer process at the last drawing."""
        self._export_drawn_at = 0.0
        self._error = ""
        """Reason why the scene cannot be exported; empty if it can."""

    def update(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """Export what the depsgraph has changed."""
        try:
            is_complete = self._export.advance(context, depsgraph)
        except RppmError as error:
            self._fail(str(error))
            return
        except Exception as error:
            logger.exception("the viewport's export failed")
            self._fail(unforeseen(error, "see the system console"))
            return
        if not is_complete:
            self.engine.tag_update()
            return
        self._error = ""
        scene = _lit(context, depsgraph, self._export.scene)
        self._show(context, replace(scene, settings=_settings(context, depsgraph)))

    def draw(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """Draw the newest frame, and send the view if it has changed."""
        is_first_export = self._export.progress is not None and self._scene is None
        if self._export.scene is not None and not is_first_export and not self._error:
            try:
                self._send_view(context, depsgraph)
            except RppmError as error:
                self.engine.update_stats("", str(error))
        self._draw_frame(context.region)
        status = self._session.status
        self._status.show(context, status, self._error, self._export.progress)
        if self._scene is not None:
            self._status.report(context, status, self._scene)
        self._session.pause(context.scene.rppm.preview_pause)
        self._drawn_state = self._state()

    def _draw_frame(self, region: bpy.types.Region) -> None:
        frame = self._session.newest()
        if frame is None:
            return
        x, y, width, height = self._regions.get(frame.generation, (0.0, 0.0, 1.0, 1.0))
        self._texture.draw(frame, x * region.width, y * region.height, width * region.width, height * region.height)
        for old in [generation for generation in self._regions if generation < frame.generation]:
            del self._regions[old]

    def _send_view(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """Send changes for which Blender calls no update: the view, and settings of RPPM."""
        settings = _settings(context, depsgraph)
        settings.validate()
        exposure = export_exposure(depsgraph.scene_eval)
        members = {"camera": export_view(context, depsgraph), "settings": settings, "exposure": exposure}
        self._show(context, replace(_lit(context, depsgraph, self._export.scene), **members))

    def _show(self, context: bpy.types.Context, scene: Scene) -> None:
        """Send a scene to the session unless it is the one that is shown."""
        playing = is_playing(context)
        if not playing:
            scene = _frame_by_frame(scene)
        if self._scene is not None:
            scene = share(self._scene, scene)
            if scene is self._scene:
                return
        now = time.monotonic()
        navigating = playing or now - self._changed_at < NAVIGATION_SECONDS
        self._changed_at = now
        self._scene = scene
        self._generation += 1
        self._regions[self._generation] = _region_of(scene.camera)
        self._session.show(scene, self._generation, navigating)

    def _fail(self, text: str) -> None:
        if text != self._error:
            logger.warning("%s", text)
        self._error = text

    def _state(self) -> tuple:
        """Return the state of the renderer process that a drawing depends on."""
        process, status, frame = renderer_process(), self._session.status, self._session.newest()
        sequence = None if frame is None else frame.sequence
        return process.state, status.generation, status.compilation, status.iteration, status.error, sequence

    def poll(self) -> None:
        """Have Blender continue an export, or redraw the viewport when there is something new."""
        if self._export.progress is not None:
            self.engine.tag_update()  # Blender calls update() again, with a depsgraph that is up to date
            now = time.monotonic()
            if now - self._export_drawn_at >= EXPORT_REDRAW_SECONDS:
                self._export_drawn_at = now
                self.engine.tag_redraw()
        elif self._state() != self._drawn_state:
            self.engine.tag_redraw()

    @property
    def is_open(self) -> bool:
        """True until Blender frees the engine that draws the viewport."""
        try:
            _ = self.engine.is_preview  # any property of a freed one raises; its __del__ is not called while it is held
        except ReferenceError:
            return False
        return True

    def close(self) -> None:
        """End the session, and keep the export for another viewport."""
        self._session.close()
        self._export.keep()


def _settings(context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> RenderSettings:
    """Return the settings of the viewport, with the pass that it shows."""
    shown = context.space_data.shading.rppm.render_pass
    return export_settings(depsgraph.scene_eval, viewport=True, shown_pass=shown)


def _lit(context: bpy.types.Context, depsgraph: bpy.types.Depsgraph, scene: Scene) -> Scene:
    """Return a scene in the light that the shading popover asks for."""
    lighting = view_lighting(context.space_data.shading, world_of(depsgraph))
    return relit(scene, lighting, studio_lights.picture(lighting.path))


def _frame_by_frame(scene: Scene) -> Scene:
    """Return a scene whose every iteration is shown: N_ipf is for playback (paper section 5.4)."""
    if scene.settings.iterations_per_frame == 1:
        return scene
    return replace(scene, settings=replace(scene.settings, iterations_per_frame=1))


def _region_of(camera: Camera) -> tuple[float, float, float, float]:
    x_min, y_min, x_max, y_max = camera.region
    width, height = camera.width, camera.height
    return x_min / width, y_min / height, (x_max - x_min) / width, (y_max - y_min) / height
