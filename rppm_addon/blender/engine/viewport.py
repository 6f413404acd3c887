# SPDX-License-Identifier: GPL-3.0-or-later
"""The rendered viewport: hands changes to the renderer process and draws the newest frame; it never waits."""

import logging
import math
import threading
import time
from dataclasses import replace

import bpy
from bpy.app.handlers import persistent

from ...scene import Camera, RenderSettings, Scene
from ...scene.common.quantities import noise_text, rate_text
from ...scene.errors import RppmError, unforeseen
from ...scene.storage.sharing import share
from ...session.transport.client import ProcessState
from ...session.transport.sessions import SessionKind, SessionStatus
from .. import panels, reports
from ..export import ExportProgress, SceneSync, export_exposure, export_settings, export_view
from ..export.shading.lights.view_lighting import relit, view_lighting
from ..export.view_layer.layers import world_of
from ..panels.base import length_text, letters_across
from ..render_client.renderer_process import failure, renderer_process
from . import kept_exports, studio_lights
from .frame_texture import FrameTexture

logger = logging.getLogger(__name__)

POLL_SECONDS = 1.0 / 30.0
"""How often the newest frames are asked for."""
READ_OUT_SECONDS = 1.0
"""Between two drawings of the panels' read-outs, which take Blender's time as well."""
SLICE_SECONDS = 0.03
"""Length of each slice of an export that would take long, in seconds; Blender goes on between them."""
PROGRESS_SECONDS = 0.25
"""Between two drawings of how far an export is."""
NAVIGATION_SECONDS = 0.4
"""Changes that follow each other faster are one movement."""


class Viewport:
    """One viewport in Rendered mode."""

    def __init__(self, engine: bpy.types.RenderEngine) -> None:
        self.engine = engine
        self._sync = SceneSync()
        self._depsgraph_key: tuple | None = None
        """Key of the exported depsgraph (kept_exports.key_of); None before the first export."""
        self._extent: tuple = ()
        """Local view and local collections, which decide what is shown and change without Blender telling."""
        self._scene: Scene | None = None
        self._session = renderer_process().open(SessionKind.VIEWPORT)
        self._texture = FrameTexture()
        self._exporting: ExportProgress | None = None
        """How far an export in slices is; None when there is none."""
        self._progress_shown_at = 0.0
        self._generation = 0
        self._changed_at = 0.0
        self._seen: tuple = ()
        self._error = ""
        self._error_shown: str | None = None
        """Error that panels were told; None makes them forget the error of the previous viewport."""
        self._recorded: SessionStatus | None = None
        self._read_out_at = 0.0
        self._regions: dict[int, tuple[float, float, float, float]] = {}
        """By generation, the part of the region that its frames cover: x, y, width, height, 0 to 1."""

    def update(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """Take what the depsgraph says has changed."""
        space = context.space_data

        def shown(source: bpy.types.Object) -> bool:
            return source.visible_in_viewport_get(space)

        try:
            camera = export_view(context, depsgraph)
            self._take_kept(depsgraph)
            extent = space.local_view is not None, space.use_local_collections
            if extent != self._extent:
                self._extent = extent
                self._sync.relist()
            seconds = math.inf if _is_playing(context) and self._sync.scene is not None else SLICE_SECONDS
            self._exporting = self._sync.advance(depsgraph, camera, shown, seconds)
            if self._exporting is not None:
                self.engine.tag_update()
                poll_soon()
                return
        except RppmError as error:
            self._exporting = None
            self._fail(str(error))
            return
        except Exception as error:
            self._exporting = None
            logger.exception("the viewport's export failed")
            self._fail(unforeseen(error, "see the system console"))
            return
        self._error = ""
        scene = self._sync.scene
        self._show(context, replace(_lit(context, depsgraph, scene), settings=_settings(context, depsgraph)))

    def _take_kept(self, depsgraph: bpy.types.Depsgraph) -> None:
        """Go on from what another viewport of the depsgraph has exported."""
        key = kept_exports.key_of(depsgraph)
        if key == self._depsgraph_key:
            return
        self._keep_export()
        self._depsgraph_key, self._extent = key, ()
        self._sync = kept_exports.take(depsgraph) or SceneSync()

    def draw(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """Draw the newest frame, and follow the view."""
        is_up_to_date = self._exporting is None or self._scene is not None
        if self._sync.scene is not None and is_up_to_date and not self._error:
            try:
                self._follow(context, depsgraph)
            except RppmError as error:
                self.engine.update_stats("", str(error))
        frame = self._session.newest()
        if frame is not None:
            x, y, width, height = self._regions.get(frame.generation, (0.0, 0.0, 1.0, 1.0))
            region = context.region
            place = x * region.width, y * region.height, width * region.width, height * region.height
            self._texture.draw(frame, *place)
            self._forget_regions(frame.generation)
        self._tell(context)
        self._session.pause(context.scene.rppm.preview_pause)
        self._seen = self._state()

    def _follow(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """Take what Blender calls no update: the view, and changed settings of ours."""
        settings = _settings(context, depsgraph)
        settings.validate()
        exposure = export_exposure(depsgraph.scene_eval)
        members = {"camera": export_view(context, depsgraph), "settings": settings, "exposure": exposure}
        self._show(context, replace(_lit(context, depsgraph, self._sync.scene), **members))

    def _show(self, context: bpy.types.Context, scene: Scene) -> None:
        playing = _is_playing(context)
        if not playing:
            scene = _picture_by_picture(scene)
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
        poll_soon()

    def _forget_regions(self, generation: int) -> None:
        for old in [key for key in self._regions if key < generation]:
            del self._regions[old]

    def _tell(self, context: bpy.types.Context) -> None:
        process = renderer_process()
        status = self._session.status
        starting = process.state is ProcessState.STARTING
        error = self._error or ("" if starting else failure() or status.error)
        if process.state is ProcessState.FAILED:
            text = "The renderer has stopped: Restart is in the header"
        elif error:
            text = error
        elif self._exporting is not None:
            progress = self._exporting
            text = f"Exporting {progress.objects} of {progress.of}" if progress.of else "Exporting"
        elif starting:
            text = "Starting the renderer"
        elif not status.iterations and status.programs_started:
            text = f"Compiling {status.programs_started} of {status.programs}: {status.program}"
        elif not status.iterations:
            text = "Compiling shaders and building the scene"
        else:
            radius = length_text(context.scene, status.radius_meters)
            letters = letters_across(context)
            text = status_text(status, context.scene.rppm.preview_pause, radius, letters)
        self.engine.update_stats("", text)
        if error != self._error_shown:
            self._error_shown = error
            reports.record_viewport_error(context.scene.session_uid, error)
            panels.redraw()
        self._record(context, status)

    def _record(self, context: bpy.types.Context, status: SessionStatus) -> None:
        """For the panels' read-outs, once for each iteration."""
        if self._scene is None or status.iteration == 0 or status == self._recorded:
            return
        self._recorded = status
        reports.record(context.scene.session_uid, reports.viewport_report(status, self._scene))
        now = time.monotonic()
        if status.settled or now - self._read_out_at >= READ_OUT_SECONDS:
            self._read_out_at = now
            panels.redraw()

    def _fail(self, text: str) -> None:
        if text != self._error:
            logger.warning("%s", text)
        self._error = text

    def _state(self) -> tuple:
        """Return the state of the renderer process that a drawing depends on."""
        process, status, frame = renderer_process(), self._session.status, self._session.newest()
        shown = None if frame is None else frame.sequence
        return process.state, status.generation, status.programs_started, status.iteration, status.error, shown

    def poll(self) -> None:
        """Ask for a redraw when there is something new."""
        if self._exporting is not None:
            self.engine.tag_update()  # Blender calls update() again, with a depsgraph that is up to date
            now = time.monotonic()
            if now - self._progress_shown_at >= PROGRESS_SECONDS:
                self._progress_shown_at = now
                self.engine.tag_redraw()
        elif self._state() != self._seen:
            self.engine.tag_redraw()

    @property
    def is_open(self) -> bool:
        """Whether Blender has not freed the engine."""
        try:
            _ = self.engine.is_preview  # any property tells; its __del__ is not called while it is held here
        except ReferenceError:
            return False
        return True

    def close(self) -> None:
        """Render this no more."""
        self._session.close()
        self._keep_export()

    def _keep_export(self) -> None:
        if self._depsgraph_key is not None:
            kept_exports.keep(self._depsgraph_key, self._sync)


def _is_playing(context: bpy.types.Context) -> bool:
    return context.screen is not None and context.screen.is_animation_playing


def _settings(context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> RenderSettings:
    """Return the settings of the viewport, with the pass that it shows."""
    shown = context.space_data.shading.rppm.render_pass
    return export_settings(depsgraph.scene_eval, viewport=True, shown_pass=shown)


def _lit(context: bpy.types.Context, depsgraph: bpy.types.Depsgraph, scene: Scene) -> Scene:
    """A scene in the light that the shading popover asks for."""
    lighting = view_lighting(context.space_data.shading, world_of(depsgraph))
    return relit(scene, lighting, studio_lights.picture(lighting.path))


def _picture_by_picture(scene: Scene) -> Scene:
    """N_ipf is for playback (paper section 5.4); at rest each iteration is shown."""
    if scene.settings.iterations_per_frame == 1:
        return scene
    return replace(scene, settings=replace(scene.settings, iterations_per_frame=1))


def _region_of(camera: Camera) -> tuple[float, float, float, float]:
    x_min, y_min, x_max, y_max = camera.region
    width, height = camera.width, camera.height
    return x_min / width, y_min / height, (x_max - x_min) / width, (y_max - y_min) / height


def status_text(status: SessionStatus, paused: bool, radius: str, letters: int) -> str:
    """One line over the viewport, of which that is left out for which ``letters`` are too few.

    radius: that of the sample, with its unit.
    """
    if paused or status.settled:
        state = "Paused" if paused else "Finished"
    else:
        state = f"{rate_text(status.photons_per_second)} photons/s"
    noise = [f"Noise {noise_text(status.noise, status.noise_threshold)}"] if status.noise > 0.0 else []
    parts = [f"Sample {status.iteration}/{status.iterations}", state, *noise, f"Radius {radius}"]
    if status.programs_stood_in_for:
        parts.insert(1, f"Materials to compile: {status.programs_stood_in_for}")
    while len(parts) > 1 and len(" | ".join(parts)) > letters:
        parts.pop()
    return " | ".join(parts)


_viewports: dict[int, Viewport] = {}
"""By the engine's address: workers must not hang on an engine, which Blender makes and frees as it likes."""


def of_engine(engine: bpy.types.RenderEngine) -> Viewport:
    """The viewport that an engine draws."""
    key = engine.as_pointer()
    if key in _viewports and _viewports[key].engine is not engine:
        close(key)  # freed, and another one lies where it was
    if key not in _viewports:
        _viewports[key] = Viewport(engine)
    return _viewports[key]


def close(key: int) -> None:
    """Forget the viewport of an engine that is being freed."""
    viewport = _viewports.pop(key, None)
    if viewport is not None:
        viewport.close()


def _close_freed() -> None:
    for key in [key for key, viewport in _viewports.items() if not viewport.is_open]:
        close(key)


def close_all() -> None:
    """Forget all viewports; nothing asks for redraws any more."""
    for key in list(_viewports):
        close(key)
    if bpy.app.timers.is_registered(_poll):
        bpy.app.timers.unregister(_poll)


@persistent
def _on_load(*_: object) -> None:
    """The viewports of the file before are gone."""
    close_all()
    kept_exports.forget()


@persistent
def _on_undo(*_: object) -> None:
    """Blocks may lie where others lay."""
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
    """Have viewports end with their file."""
    for handlers, handler in _HANDLERS:
        handlers.append(handler)


def unregister() -> None:
    """End all viewports."""
    for handlers, handler in _HANDLERS:
        handlers.remove(handler)
    close_all()
    kept_exports.forget()
    studio_lights.forget()


def poll_soon() -> None:
    """See to it that new frames are drawn."""
    if not bpy.app.timers.is_registered(_poll):
        bpy.app.timers.register(_poll, first_interval=POLL_SECONDS)


def _poll() -> float | None:
    lit_anew = studio_lights.load_wanted()
    _close_freed()
    for viewport in list(_viewports.values()):
        viewport.poll()
        if lit_anew:
            viewport.engine.tag_redraw()
    return POLL_SECONDS if _viewports else None
