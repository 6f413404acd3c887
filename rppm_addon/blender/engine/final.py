# SPDX-License-Identifier: GPL-3.0-or-later
"""A final render: export, render, and show the picture as it grows."""

import logging
import re
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...pictures import PictureError, PictureName
from ...scene import Scene, cryptomatte
from ...scene.common.quantities import clock_text, count_text, noise_text
from ...scene.errors import RppmError, SceneError, unforeseen
from ...scene.passes import COMBINED
from ...session.checkpoints.checkpoint_writer import CheckpointWriter, continued_still
from ...session.render.observers import RenderObserver, current_observer
from ...session.render.render_job import RenderJob
from ...session.transport.sessions import SessionKind
from .. import background
from ..export import ExportStopped, Eye, FrameExporter, export_scene, is_blurred, views_of, wants_neighbors
from ..export.camera.camera import frame_size
from ..render_client import renderer_process, renderer_thread
from ..reports import final_report, record, record_error
from ..warning_groups import lines_of
from . import broken_frames
from .frame_reuse import reuse_previous_frame

if TYPE_CHECKING:
    from ...session.checkpoints.continuation import Continuation
    from ...session.render.results import Frame, Progress, RenderResult, RenderStatistics

logger = logging.getLogger(__name__)

PICTURE_SECONDS = 1.0
"""Least time between two pictures shown; the first one comes after the first iteration."""
PICTURE_SHARE = 0.2
"""Most of the time that showing pictures may take."""
MEGABYTE = 1 << 20
WARNINGS_SHOWN = 8
"""Lines of warnings that are reported; the log has all warnings."""


def render_final(engine: bpy.types.RenderEngine, depsgraph: bpy.types.Depsgraph) -> None:
    """Render the depsgraph's view layer into the engine's result, in each of its views.

    Errors end in the engine's error text and report; nothing is raised.
    """
    observer = current_observer()
    try:
        layer = depsgraph.view_layer_eval.name
        views = views_of(engine, layer)
        for number, view in enumerate(views):
            if view:
                engine.active_view_set(view)
            _render(engine, depsgraph, observer, _View(PictureName(layer, view), number, len(views)))
    except ExportStopped:
        logger.info("the render was stopped during the export")
    except RppmError as error:
        _fail(engine, depsgraph, observer, str(error))
    except Exception as error:
        logger.exception("RPPM failed")
        _fail(engine, depsgraph, observer, unforeseen(error, "please report the system console's text"))


@dataclass(frozen=True)
class _View:
    """One of the views of a view layer."""

    name: PictureName
    number: int = 0
    count: int = 1


def _render(
    engine: bpy.types.RenderEngine, depsgraph: bpy.types.Depsgraph, observer: RenderObserver, view: _View
) -> None:
    observer.on_picture(view.name)
    scene = _export(engine, depsgraph, observer)
    warned = list(scene.warnings)
    report_warnings(engine, warned)
    if not observer.on_scene(scene):
        return
    engine.update_stats("", "Preparing the graphics device")
    # Whoever follows the render, as the rppm program does, keeps it as it likes.
    checkpoint = checkpoint_of(engine, depsgraph, view.name.view) if type(observer) is RenderObserver else None
    job = _FinalJob(engine, scene, depsgraph, observer, checkpoint, view)
    try:
        result = render_scene(engine, scene, job)
        job.finish_keeping()
        job.show(result.frame)
    except BaseException:
        job.end(cancel=True)
        raise
    job.end(cancel=False)
    if not engine.is_preview:
        _stamp(engine, scene, view.name, result.statistics)
    report_late_warnings(engine, result, scene, warned)
    if result.statistics.iterations and not engine.is_preview:
        record(depsgraph.scene.session_uid, final_report(result.statistics, scene))
    observer.on_finish(result, scene)


def _stamp(engine: bpy.types.RenderEngine, scene: Scene, name: PictureName, statistics: "RenderStatistics") -> None:
    """Tell files of the picture what Blender does not know of it."""
    fields = cryptomatte.metadata(scene, name.prefix)
    fields |= {
        f"rppm.{name.joined}.samples": str(statistics.iterations),
        f"rppm.{name.joined}.photons": str(statistics.photons),
        f"rppm.{name.joined}.seconds": f"{statistics.seconds:.3f}",
        f"rppm.{name.joined}.device": statistics.device,
    }
    result = engine.get_result()
    for field, value in fields.items():
        result.stamp_data_add_field(field=field, value=value)


def _export(engine: bpy.types.RenderEngine, depsgraph: bpy.types.Depsgraph, observer: RenderObserver) -> Scene:
    if engine.is_preview:
        return export_scene(depsgraph, engine, observer.should_stop)
    _check_size(engine, depsgraph.scene.render)
    looks_around = is_blurred(depsgraph, engine) or wants_neighbors(depsgraph, engine)
    if not depsgraph.scene.render.use_persistent_data or looks_around:
        # Going to other frames, such a render takes in changes that Blender would report to the next one.
        engine.exporter = None
        return reuse_previous_frame(export_scene(depsgraph, engine, observer.should_stop))
    # Blender keeps engine and depsgraph, and tells what has changed.
    if getattr(engine, "exporter", None) is None:
        engine.exporter = FrameExporter()
    return reuse_previous_frame(
        engine.exporter.export(
            depsgraph,
            lambda: engine.test_break() or observer.should_stop(),
            lambda text: engine.update_stats("", text),
            Eye(engine),
        )
    )


def checkpoint_of(engine: bpy.types.RenderEngine, depsgraph: bpy.types.Depsgraph, view: str = "") -> Path | None:
    """Where a final render is to be kept: in a place for the frame's number (#), which animations need, and a file for
    each view layer and view."""
    stored = getattr(depsgraph.scene, "rppm", None)
    text = "" if stored is None or engine.is_preview else bpy.path.abspath(stored.checkpoint_path)
    if not text or (engine.is_animation and "#" not in Path(text).name):
        return None
    frame = depsgraph.scene.frame_current
    path = Path(text)
    name = re.sub("#+", lambda place: f"{frame:0{len(place[0])}d}", path.name.removesuffix(".exr"))
    if sum(layer.use for layer in depsgraph.scene.view_layers) > 1:
        name += f"_{bpy.path.clean_name(depsgraph.view_layer_eval.name)}"
    if view:
        name += f"_{bpy.path.clean_name(view)}"
    return path.with_name(f"{name}.exr")


def _check_size(engine: bpy.types.RenderEngine, render: bpy.types.RenderSettings) -> None:
    """Raise SceneError where a script has changed the resolution of frames that Blender has laid out already."""
    wanted, laid_out = frame_size(render), (engine.resolution_x, engine.resolution_y)
    if wanted != laid_out:
        raise SceneError(
            f"the resolution has changed to {wanted[0]} x {wanted[1]} while Blender renders pictures of "
            f"{laid_out[0]} x {laid_out[1]}; change it before the render begins, or render such frames one at a time"
        )


def render_scene(engine: bpy.types.RenderEngine, scene: Scene, job: RenderJob) -> "RenderResult":
    """Have the scene rendered where this Blender renders. Raises the errors of scene/errors.py."""
    if renderer_process.is_used():
        kind = SessionKind.PREVIEW if engine.is_preview else SessionKind.FINAL
        return renderer_process.render(scene, job, kind)
    return renderer_thread.render(scene, job)


def _fail(engine: bpy.types.RenderEngine, depsgraph: bpy.types.Depsgraph, observer: RenderObserver, text: str) -> None:
    engine.error_set(text)
    if engine.is_animation:
        broken_frames.report(engine, depsgraph, text)
    else:
        background.lose_frame()
        engine.report({"ERROR"}, text)
    if not engine.is_preview:
        record_error(depsgraph.scene.session_uid, text)
    observer.on_error(text)


def report_warnings(engine: bpy.types.RenderEngine, warnings: list[str]) -> None:
    """Show the user the first of them, those that say the same of several things in one line."""
    lines = lines_of(warnings)
    for line in lines[:WARNINGS_SHOWN]:
        engine.report({"WARNING"}, line)
    more = len(lines) - WARNINGS_SHOWN
    if more > 0:
        engine.report({"WARNING"}, f"{more} more warnings of this kind are in the log")


def report_late_warnings(
    engine: bpy.types.RenderEngine, result: "RenderResult", scene: Scene, warned: list[str]
) -> None:
    """Show the warnings of a render, but for those in ``warned``, which the user has seen.

    The statistics repeat the warnings of the scene.
    """
    found = dict.fromkeys((*result.statistics.warnings, *scene.warnings))
    report_warnings(engine, [text for text in found if text not in warned])


class _FinalJob(RenderJob):
    """Shows a render in the engine's result and tells the observer."""

    def __init__(
        self,
        engine: bpy.types.RenderEngine,
        scene: Scene,
        source: bpy.types.Depsgraph,
        observer: RenderObserver,
        checkpoint: Path | None,
        view: _View,
    ) -> None:
        """source: what the scene was exported from; checkpoint: where the user wants the render to be kept."""
        self._engine = engine
        self._scene = scene
        self._view = view
        self._names = ", ".join(filter(None, (source.scene.name, view.name.layer, view.name.view)))
        self._observer = observer
        self.checkpoint = checkpoint
        self._keeper: CheckpointWriter | None = None
        self._peak_bytes = 0
        self._result = None
        self._shown_at = -1e9
        self._showing_seconds = 0.0

    @property
    def snapshots(self) -> tuple[float, ...]:
        return self._observer.snapshots

    @property
    def continuation(self) -> "Continuation | None":
        if self._observer.continuation is not None or self.checkpoint is None:
            return self._observer.continuation
        self._keeper, continuation = continued_still(self.checkpoint, self._scene)
        return continuation

    def should_stop(self) -> bool:
        return self._engine.test_break() or self._observer.should_stop()

    def on_start(self) -> None:
        self._observer.on_start(self._scene)

    def on_progress(self, progress: "Progress") -> bool:
        self._observer.on_progress(progress)
        self._engine.update_progress((self._view.number + progress.fraction) / self._view.count)
        self._peak_bytes = max(self._peak_bytes, progress.memory_bytes)
        used, peak = progress.memory_bytes / MEGABYTE, self._peak_bytes / MEGABYTE
        self._engine.update_memory_stats(memory_used=used, memory_peak=peak)
        text = status_text(progress, self._scene)
        remaining = progress.remaining_seconds
        if bpy.app.background:  # farm managers read it, as they read Cycles'
            left = "" if remaining is None else f"Remaining:{clock_text(remaining, with_hours=True)} | "
            text = f"{left}Mem:{used:.2f}M, Peak:{peak:.2f}M | {self._names} | {text}"
        elif remaining is not None:
            text += f" | Remaining {clock_text(remaining)}"
        self._engine.update_stats("", text)
        if progress.iteration in (0, progress.iterations):
            return False  # nothing to see yet, or shown at the end
        waited = time.monotonic() - self._shown_at
        due = waited >= max(PICTURE_SECONDS, self._showing_seconds / PICTURE_SHARE)
        first = progress.iteration == 1
        return first or (due and progress.iteration % self._scene.settings.iterations_per_frame == 0)

    def on_frame(self, progress: "Progress", frame: "Frame") -> None:
        self.show(frame)

    def on_snapshot(self, seconds: float, frame: "Frame") -> None:
        self._observer.on_snapshot(seconds, frame, self._scene)

    def show(self, frame: "Frame") -> None:
        """Put a picture into the engine's result."""
        started = time.monotonic()
        if self._result is None:
            width, height = self._scene.camera.resolution
            self._result = self._engine.begin_result(
                0, 0, width, height, layer=self._view.name.layer, view=self._view.name.view
            )
        pictures = {COMBINED: frame.combined, **frame.passes}
        for render_pass in self._result.layers[0].passes:
            picture = pictures.get(render_pass.name)
            if picture is not None:
                # Blender takes a flat array of single precision only.
                render_pass.rect.foreach_set(np.ascontiguousarray(picture, np.float32).reshape(-1))
        self._engine.update_result(self._result)
        self._shown_at = time.monotonic()
        self._showing_seconds = self._shown_at - started

    def finish_keeping(self) -> None:
        """The render has ended: what of its checkpoint failed becomes a warning of the scene's."""
        if self._keeper is not None:
            try:
                self._keeper.finish()
            except PictureError as error:
                self._scene.warn(str(error))

    def end(self, cancel: bool) -> None:
        """Hand the result back to Blender."""
        if self._result is not None:
            self._engine.end_result(self._result, cancel=cancel)
            self._result = None


def status_text(progress: "Progress", scene: Scene) -> str:
    """One line on how far the render is; farm managers read its ``Sample n/m``."""
    if progress.iteration == 0:
        return f"Sample 0/{progress.iterations} | Building the deep cubemap of {scene.triangle_count} triangles"
    text = f"Sample {progress.iteration}/{progress.iterations} | {count_text(progress.photons)} photons"
    if progress.noise > 0.0:
        text += f" | Noise {noise_text(progress.noise, progress.noise_threshold)}"
    return text
