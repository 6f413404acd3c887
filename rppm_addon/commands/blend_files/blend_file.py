# SPDX-License-Identifier: GPL-3.0-or-later
"""Rendering and exporting .blend files with the bpy module, by the engine that Blender users have."""

import contextlib
import os
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType
from typing import Any, TextIO

import numpy as np

from ...pictures import PictureError, PictureName
from ...scene import Scene
from ...scene.errors import RppmError, SceneError, SettingsError
from ...session.render.observers import RenderObserver, observing
from ..picture_set import PictureSet
from .data_paths import set_data_path
from .fluid_domains import gas_left_out, note_fluid_domains
from .freestyle import add_strokes
from .post_processing import leave_post_processing_out

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
    view_layers: list[str] = field(default_factory=list)
    """Names; none are those that are in use."""
    scene: str = ""
    """Its name; empty is the one that the file was saved with open."""

    def as_plain(self) -> dict[str, Any]:
        """The request as JSON has it, for whoever is to open the same picture's scene later."""
        return {
            "path": str(self.path.resolve()),
            "frame": self.frame,
            "resolution": self.resolution and list(self.resolution),
            "values": [list(value) for value in self.values],
            "view_layers": list(self.view_layers),
            "scene": self.scene,
        }

    @classmethod
    def from_plain(cls, plain: dict[str, Any]) -> "BlendRequest":
        """The request that as_plain gave."""
        return cls(
            Path(plain["path"]),
            plain["frame"],
            plain["resolution"] and tuple(plain["resolution"]),
            [tuple(value) for value in plain["values"]],
            list(plain["view_layers"]),
            plain.get("scene", ""),  # parts of older versions have none
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
            note_fluid_domains(self._bpy, frame)
            scene.frame_set(frame)
        self.report.frame = frame

    def render(self, pictures: PictureSet) -> None:
        """Render with the engine RPPM. Raises RppmError when there is an error, or no picture."""
        pictures.names = _picture_names(self._bpy.context.scene)
        _render(self._bpy, self._request, pictures, self.report)
        if pictures.error is not None:
            raise BlenderError(pictures.error)
        if not pictures.finished:
            raise BlenderError(f"{self._request.path}: the engine gave no picture; run again with --debug to see why")

    def write(self, pictures: PictureSet) -> None:
        """Write what has been rendered: the recorders EXR, Blender PNG. Raises RppmError."""
        add_strokes(self._bpy, pictures)
        pictures.write_files()
        for path, frame in pictures.pngs:
            if pictures.is_single:
                _save_png(self._bpy, path)
            else:
                _save_picture(self._bpy, path, frame.combined)
        pictures.refuse_spoiled()


@contextlib.contextmanager
def opened_blend_file(request: BlendRequest, show_output: bool = False) -> Iterator[BlendFile]:
    """The file, open and set up as the request says. Raises RppmError."""
    with _opened(request, show_output) as (bpy, report, output):
        yield BlendFile(bpy, request, report, output)


def render_blend_file(request: BlendRequest, pictures: PictureSet, show_output: bool = False) -> BlenderReport:
    """Render a frame of a .blend and write its pictures. Raises RppmError."""
    with opened_blend_file(request, show_output) as file:
        file.render(pictures)
        file.write(pictures)
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
    """The scene that a render of the .blend would be given, of the first of its view layers. Raises RppmError."""
    if len(request.view_layers) > 1:
        raise SettingsError("a scene is of one view layer; name one --view-layer only")
    taker = _SceneTaker()
    with _opened(request, show_output) as (bpy, report, _):
        _leave_one_picture(bpy.context.scene)
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
        from ... import register, unregister

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
        with gas_left_out(bpy):
            bpy.ops.wm.open_mainfile(filepath=str(path.resolve()), load_ui=False, use_scripts=False)
    except RuntimeError as error:
        raise SceneError(f"{path} cannot be opened by Blender {bpy.app.version_string}: {_one_line(error)}") from error


def _prepare(bpy: ModuleType, request: BlendRequest) -> None:
    if request.scene:
        _choose_scene(bpy, request.scene)
    scene = bpy.context.scene
    note_fluid_domains(bpy, scene.frame_current if request.frame is None else request.frame)
    if request.frame is not None:
        scene.frame_set(request.frame)
    if request.resolution is not None:
        scene.render.resolution_x, scene.render.resolution_y = request.resolution
        scene.render.resolution_percentage = 100
    scene.render.engine = ENGINE
    scene.render.use_single_layer = False
    _choose_layers(scene, request.view_layers)
    for path, value in request.values:
        set_data_path((scene, bpy.data), path, value)


def _choose_scene(bpy: ModuleType, name: str) -> None:
    """Make it the one that is open. Raises SettingsError."""
    scene = bpy.data.scenes.get(name)
    if scene is None:
        known = ", ".join(scene.name for scene in bpy.data.scenes)
        raise SettingsError(f'there is no scene "{name}"; there are {known}')
    bpy.context.window_manager.windows[0].scene = scene


def _choose_layers(scene: Any, names: Sequence[str]) -> None:
    """Have the named view layers rendered, or else those in use, or else the first. Raises SettingsError."""
    known = [layer.name for layer in scene.view_layers]
    for name in names:
        if name not in known:
            raise SettingsError(f'there is no view layer "{name}"; there are {", ".join(known)}')
    used = list(names) or [layer.name for layer in scene.view_layers if layer.use] or known[:1]
    for layer in scene.view_layers:
        layer.use = layer.name in used


def _leave_one_picture(scene: Any) -> None:
    """Have the first of the chosen view layers rendered, as one view."""
    scene.render.use_multiview = False
    _choose_layers(scene, [next(layer.name for layer in scene.view_layers if layer.use)])


def _picture_names(scene: Any) -> list[PictureName]:
    """Return the names of the pictures that Blender renders, in its order; a single picture needs no name."""
    render = scene.render
    views = [""]
    if render.use_multiview:
        both_eyes = render.views_format == "STEREO_3D"
        views = [view.name for view in render.views if view.use and (not both_eyes or view.name in _EYES)]
    names = [PictureName(layer.name, view) for layer in scene.view_layers if layer.use for view in views]
    return names if len(names) > 1 else [PictureName()]


_EYES = {"left", "right"}
"""The views of Stereo 3D."""


def _render(bpy: ModuleType, request: BlendRequest, observer: PictureSet | _SceneTaker, report: BlenderReport) -> None:
    scene = bpy.context.scene
    if scene.camera is None:
        raise SceneError(
            f'{request.path}: scene "{scene.name}" has no camera; add one in Blender and make it the active camera, '
            "or name one: --set 'camera=objects[\"Camera\"]'"
        )
    leave_post_processing_out(scene, warn=isinstance(observer, PictureSet))
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
    _save_image(bpy, path, bpy.data.images["Render Result"])


def _save_picture(bpy: ModuleType, path: Path, combined: np.ndarray) -> None:
    """The same of one of several pictures (height, width, 4), of which Blender saves the first only."""
    height, width = combined.shape[:2]
    image = bpy.data.images.new("RPPM", width, height, alpha=True, float_buffer=True)
    try:
        image.colorspace_settings.name = "Linear Rec.709"
        image.alpha_mode = "PREMUL"
        image.pixels.foreach_set(np.ascontiguousarray(combined, np.float32).reshape(-1))
        _save_image(bpy, path, image)
    finally:
        bpy.data.images.remove(image)


def _save_image(bpy: ModuleType, path: Path, image: Any) -> None:
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
            image.save_render(str(temporary), scene=scene)
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

        _leave_one_picture(scene)
        leave_post_processing_out(scene, warn=False)
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
        with os.fdopen(os.dup(saved), "w", encoding=sys.stdout.encoding, errors="backslashreplace") as output:
            yield output
    finally:
        sys.stdout.flush()
        os.dup2(saved, 1)
        os.close(saved)


def _one_line(error: Exception) -> str:
    return " ".join(str(error).removeprefix("Error: ").split())
