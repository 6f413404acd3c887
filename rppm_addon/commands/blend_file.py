# SPDX-License-Identifier: GPL-3.0-or-later
"""Rendering and exporting .blend files with the bpy module, by the engine that Blender users have."""

import contextlib
import os
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType
from typing import Any, TextIO

import numpy as np

from ..pictures import PictureError
from ..scene import Scene
from ..scene.errors import RppmError, SceneError
from ..session.observers import RenderObserver, observing
from .data_paths import set_data_path
from .recorder import RenderRecorder

ENGINE = "RPPM"


class BlenderError(RppmError):
    """Blender is missing, or would not do what it was asked."""


@dataclass
class BlendRequest:
    """Which picture of a .blend file is wanted."""

    path: Path
    frame: int | None = None
    """Frame number; None is the one that the file was saved at."""
    resolution: tuple[int, int] | None = None
    values: list[tuple[str, str]] = field(default_factory=list)
    """Data paths and what to set them to."""

    def as_plain(self) -> dict[str, Any]:
        """The request as JSON has it, for whoever is to open the same picture's scene later."""
        return {
            "path": str(self.path.resolve()),
            "frame": self.frame,
            "resolution": self.resolution and list(self.resolution),
            "values": [list(value) for value in self.values],
        }

    @classmethod
    def from_plain(cls, plain: dict[str, Any]) -> "BlendRequest":
        """The request that as_plain gave."""
        return cls(
            Path(plain["path"]),
            plain["frame"],
            plain["resolution"] and tuple(plain["resolution"]),
            [tuple(value) for value in plain["values"]],
        )


@dataclass
class BlenderReport:
    """The frame, and Blender's own share of the time, which the render's clock leaves out."""

    version: str = ""
    frame: int = 0
    start_seconds: float = 0.0
    """Loading the bpy module and the add-on."""
    load_seconds: float = 0.0
    """Opening the file."""
    export_seconds: float = 0.0
    """Evaluating the scene and exporting it."""


class BlendFile:
    """An open .blend file, to be rendered."""

    def __init__(self, bpy: ModuleType, request: BlendRequest, report: BlenderReport, output: TextIO) -> None:
        self._bpy = bpy
        self._request = request
        self.report = report
        self.output = output
        """Standard output, where Blender's own words do not go."""

    def set_frame(self, frame: int) -> None:
        """Go to a frame."""
        scene = self._bpy.context.scene
        if scene.frame_current != frame:
            scene.frame_set(frame)
        self.report.frame = frame

    def render(self, recorder: RenderRecorder) -> None:
        """Render with the engine RPPM. Raises RppmError when the recorder gets no result."""
        _render(self._bpy, self._request, recorder, self.report)
        if recorder.error is not None:
            raise BlenderError(recorder.error)
        if recorder.result is None:
            raise BlenderError(f"{self._request.path}: the engine gave no picture; run again with --debug to see why")

    def write(self, recorder: RenderRecorder) -> None:
        """Write what has been rendered: the recorder EXR, Blender PNG. Raises RppmError."""
        recorder.write_files()
        for path in recorder.request.outputs:
            if path.suffix == ".png":
                _save_png(self._bpy, path)


@contextlib.contextmanager
def opened_blend_file(request: BlendRequest, show_output: bool = False) -> Iterator[BlendFile]:
    """The file, open and set up as the request says. Raises RppmError."""
    with _opened(request, show_output) as (bpy, report, output):
        yield BlendFile(bpy, request, report, output)


def render_blend_file(request: BlendRequest, recorder: RenderRecorder, show_output: bool = False) -> BlenderReport:
    """Render one picture of a .blend and write it. Raises RppmError."""
    with opened_blend_file(request, show_output) as file:
        file.render(recorder)
        file.write(recorder)
    return file.report


class _SceneTaker(RenderObserver):
    """Takes the exported scene and ends the render there."""

    scene: Scene | None = None
    scene_time = 0.0
    error: str | None = None

    def on_scene(self, scene: Scene) -> bool:
        self.scene, self.scene_time = scene, time.perf_counter()
        return False

    def on_error(self, text: str) -> None:
        self.error = text


def export_blend_file(request: BlendRequest, show_output: bool = False) -> Scene:
    """The scene that a render of the .blend would be given. Raises RppmError."""
    taker = _SceneTaker()
    with _opened(request, show_output) as (bpy, report, _):
        _render(bpy, request, taker, report)
    if taker.error is not None:
        raise BlenderError(taker.error)
    if taker.scene is None:
        raise BlenderError(f"{request.path}: nothing was exported; run again with --debug to see why")
    return taker.scene


@contextlib.contextmanager
def _opened(request: BlendRequest, show_output: bool) -> Iterator[tuple]:
    """bpy with the engine registered and the file open and set up; yields bpy, the report, and standard output."""
    if not request.path.is_file():
        raise SceneError(f"{request.path} does not exist; give the path of a .blend file")
    start = time.perf_counter()
    with _quiet_output(show_output) as output:
        try:
            import bpy
        except ImportError as error:
            raise BlenderError(
                f"the bpy module could not be loaded ({error}); install it with make setup or pip install bpy==5.0.1, "
                "or export the scene where Blender is and render the .npz"
            ) from error
        from .. import register, unregister

        register()
        try:
            report = BlenderReport(bpy.app.version_string, start_seconds=time.perf_counter() - start)
            _open(bpy, request.path)
            report.load_seconds = time.perf_counter() - start - report.start_seconds
            _prepare(bpy, request)
            report.frame = bpy.context.scene.frame_current
            yield bpy, report, output
        finally:
            unregister()  # an engine still registered at exit crashes or hangs Blender


def _open(bpy: ModuleType, path: Path) -> None:
    try:
        bpy.ops.wm.open_mainfile(filepath=str(path.resolve()), load_ui=False, use_scripts=False)
    except RuntimeError as error:
        raise SceneError(f"{path} cannot be opened by Blender {bpy.app.version_string}: {_one_line(error)}") from error


def _prepare(bpy: ModuleType, request: BlendRequest) -> None:
    scene = bpy.context.scene
    if request.frame is not None:
        scene.frame_set(request.frame)
    if request.resolution is not None:
        scene.render.resolution_x, scene.render.resolution_y = request.resolution
        scene.render.resolution_percentage = 100
    scene.render.engine = ENGINE
    scene.render.use_compositing = False  # a compositor may write files of its own and hide the render
    scene.render.use_sequencer = False
    scene.render.use_multiview = False
    used = [layer for layer in scene.view_layers if layer.use] or list(scene.view_layers)
    for layer in scene.view_layers:
        layer.use = layer == used[0]
    for path, value in request.values:
        set_data_path((scene, bpy.data), path, value)


def _render(
    bpy: ModuleType, request: BlendRequest, observer: RenderRecorder | _SceneTaker, report: BlenderReport
) -> None:
    scene = bpy.context.scene
    if scene.camera is None:
        raise SceneError(
            f'{request.path}: scene "{scene.name}" has no camera; add one in Blender and make it the active camera, '
            "or name one: --set 'camera=objects[\"Camera\"]'"
        )
    start = time.perf_counter()
    with observing(observer):
        try:
            bpy.ops.render.render()
        except RuntimeError as error:
            if observer.error is None:
                raise BlenderError(f"{request.path}: {_one_line(error)}") from error
    if observer.scene_time:
        report.export_seconds = observer.scene_time - start


def _save_png(bpy: ModuleType, path: Path) -> None:
    """Save the picture through the scene's own view transform, as Blender's render window shows it."""
    scene = bpy.context.scene
    image_settings = scene.render.image_settings
    if hasattr(image_settings, "media_type"):  # Blender 5.0 and later
        image_settings.media_type = "IMAGE"
    image_settings.file_format = "PNG"
    image_settings.color_mode = "RGBA" if scene.render.film_transparent else "RGB"
    image_settings.color_depth = "8"
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=f".{path.stem}.", dir=path.parent) as folder:
            temporary = Path(folder) / "picture.png"
            bpy.data.images["Render Result"].save_render(str(temporary), scene=scene)
            temporary.replace(path)
    except (OSError, RuntimeError) as error:
        raise PictureError(f"{path} cannot be written ({_one_line(error)}); choose another place with -o") from error


def save_view(request: BlendRequest, combined: np.ndarray, path: Path) -> None:
    """Save a picture as PNG by the scene's view transform, as a render of the .blend would.

    ``combined`` (H, W, 4) is Frame.combined. Raises RppmError, also when the file is not where it was.
    """
    with _opened(request, show_output=False) as (bpy, _, _):
        scene = bpy.context.scene

        class Shown(bpy.types.RenderEngine):  # type: ignore[name-defined]
            """Has the picture already: Blender's own way from a render's result to a file is the one to go."""

            bl_idname = "RPPM_SHOWN"
            bl_label = "RPPM (a picture that is there)"

            def render(self, depsgraph: object) -> None:
                result = self.begin_result(0, 0, combined.shape[1], combined.shape[0])
                pixels = np.ascontiguousarray(combined, np.float32)
                result.layers[0].passes["Combined"].rect.foreach_set(pixels.reshape(-1))
                self.end_result(result)

        _remove_contents(scene)  # nothing of it is looked at: nothing is to be evaluated
        bpy.utils.register_class(Shown)
        try:
            scene.render.engine = Shown.bl_idname
            bpy.ops.render.render()
            _save_png(bpy, path)
        finally:
            scene.render.engine = ENGINE
            bpy.utils.unregister_class(Shown)


def _remove_contents(scene: Any) -> None:
    """Leave an opened scene nothing but its camera."""
    collection, camera = scene.collection, scene.camera
    for child in list(collection.children):
        collection.children.unlink(child)
    for linked in list(collection.objects):
        collection.objects.unlink(linked)
    collection.objects.link(camera)


@contextlib.contextmanager
def _quiet_output(show: bool) -> Iterator[TextIO]:
    """Keep what Blender itself prints, below Python, off the terminal; yields what still leads there."""
    if show:
        yield sys.stdout
        return
    sys.stdout.flush()
    saved, nothing = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nothing, 1)
    os.close(nothing)
    try:
        with os.fdopen(os.dup(saved), "w", encoding=sys.stdout.encoding) as output:
            yield output
    finally:
        sys.stdout.flush()
        os.dup2(saved, 1)
        os.close(saved)


def _one_line(error: Exception) -> str:
    return " ".join(str(error).removeprefix("Error: ").split())
