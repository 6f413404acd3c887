# SPDX-License-Identifier: GPL-3.0-or-later
"""Rendering a saved scene, without Blender."""

import dataclasses
from pathlib import Path

from ..scene import Camera, load_scene
from .recorder import RenderRecorder


def render_saved_scene(path: Path, recorder: RenderRecorder, resolution: tuple[int, int] | None) -> None:
    """Render a .npz; the recorder writes the files. Raises RppmError."""
    from ..session.render.renderer import Renderer

    scene = load_scene(path)
    if resolution is not None:
        scene.camera = camera_at_resolution(scene.camera, *resolution)
    recorder.on_scene(scene)
    with Renderer(times_stages=True) as renderer:
        recorder.on_start(scene)
        result = renderer.render(
            scene,
            on_progress=lambda progress, _: recorder.on_progress(progress),
            should_stop=recorder.should_stop,
            snapshots=recorder.snapshots,
            on_snapshot=lambda seconds, frame: recorder.on_snapshot(seconds, frame, scene),
            continuation=recorder.continuation,
        )
        recorder.on_finish(result, scene)
    recorder.write_files()
    recorder.refuse_spoiled()


def camera_at_resolution(camera: Camera, width: int, height: int) -> Camera:
    """The camera with other pixels of the same shape.

    Where the frame's proportions change, its longer side keeps what it sees, as Blender's
    automatic sensor fit does; a panorama fills any frame. A crop keeps its fraction of the frame.
    """
    left, right, bottom, top = camera.window
    window, panorama = camera.window, camera.panorama
    if panorama is None:
        half_width, half_height = _fitted((0.5 * (right - left), 0.5 * (top - bottom)), camera, width, height)
        x, y = 0.5 * (left + right), 0.5 * (bottom + top)
        window = x - half_width, x + half_width, y - half_height, y + half_height
    else:
        panorama = dataclasses.replace(panorama, sensor=_fitted(panorama.sensor, camera, width, height))
    crop = camera.crop
    if crop is not None:
        x_min, x_max = round(crop[0] * width / camera.width), round(crop[2] * width / camera.width)
        y_min, y_max = round(crop[1] * height / camera.height), round(crop[3] * height / camera.height)
        x_min, y_min = min(x_min, width - 1), min(y_min, height - 1)
        crop = (x_min, y_min, max(x_max, x_min + 1), max(y_max, y_min + 1))
    return dataclasses.replace(
        camera,
        window=window,
        width=width,
        height=height,
        crop=crop,
        panorama=panorama,
    )


def _fitted(size: tuple[float, float], camera: Camera, width: int, height: int) -> tuple[float, float]:
    """Width and height of what a camera's frame covers, for other pixels of the same shape."""
    pixel_aspect = (size[0] / camera.width) / (size[1] / camera.height)
    proportion = width * pixel_aspect / height
    return max(size) * min(1.0, proportion), max(size) / max(1.0, proportion)
