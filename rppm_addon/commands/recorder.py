# SPDX-License-Identifier: GPL-3.0-or-later
"""Follows one render: the clock, the limits asked for, snapshots, progress, and the files."""

import dataclasses
import enum
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from ..pictures import Placement, refuse_spoiled, standard_view, write_exr
from ..scene import RenderSettings, Scene
from ..scene.common.quantities import count_text
from ..session.checkpoints.checkpoint_writer import CheckpointWriter, attributes_of, placement_of
from ..session.render.observers import RenderObserver
from .picture_files import write_png
from .terminal.progress_bar import PartBar, ProgressBar
from .terminal.progress_line import ProgressLine

if TYPE_CHECKING:
    from ..session.render.results import Frame, Progress, RenderResult

_NO_ITERATION_LIMIT = 1 << 30
_LEAST_TIME_LIMIT = 1e-3


@dataclass
class RenderRequest:
    """Request of the command line for a render."""

    outputs: list[Path]
    """.exr and .png files to write."""
    settings: dict[str, object] = field(default_factory=dict)
    """Values by name of RenderSettings, over those of the scene."""
    seconds: float | None = None
    """Render so long, whatever the number of iterations."""
    snapshots: Sequence[float] = ()
    """Ascending seconds at which an EXR is written."""

    def snapshot_path(self, seconds: float) -> Path:
        """The file of a snapshot: the first output with the mark in its name."""
        return self.outputs[0].with_name(f"{self.outputs[0].stem}_{seconds:g}s.exr")


class RenderRecorder(RenderObserver):
    """Applies a request to a render, and keeps its result and report.

    The clock of --seconds and --snapshots starts with on_scene, so that making the renderer,
    loading programs and building the structure count.
    """

    def __init__(
        self,
        request: RenderRequest,
        bar: ProgressBar | PartBar,
        should_stop: Callable[[], bool],
        write_png_file: bool,
        keeper: CheckpointWriter | None = None,
    ) -> None:
        self.request = request
        self.result: RenderResult | None = None
        self.error: str | None = None
        self.scene_time = 0.0
        """time.perf_counter() at which the scene was there; 0 before."""
        self.renderer_seconds = 0.0
        """Seconds from the scene to the renderer, part of ``seconds``."""
        self.seconds = 0.0
        """Seconds from the scene to the result."""
        self.snapshots_written: list[dict[str, object]] = []
        self.scene: Scene | None = None
        self._line = ProgressLine(bar)
        self._should_stop = should_stop
        self._write_png_file = write_png_file
        self._keeper = keeper

    @property
    def has_samples(self) -> bool:
        """Whether the render has completed an iteration."""
        return self._line.has_samples

    def on_scene(self, scene: Scene) -> bool:
        """As RenderObserver has it."""
        self.scene_time = time.perf_counter()
        self.scene = scene
        if "passes" not in self.request.settings:
            passes = dict.fromkeys((*RenderSettings.passes, *scene.settings.passes))
            scene.settings = scene.settings.with_values(passes=tuple(passes))
        scene.settings = apply_settings(scene.settings, self.request.settings)
        if self._keeper is not None:
            iterations = None if self.request.seconds is not None else scene.settings.iterations
            self.continuation = self._keeper.begin(scene, iterations)
        self._line.show_step("preparing the device")
        return True

    def on_start(self, scene: Scene) -> None:
        """As RenderObserver has it."""
        self.renderer_seconds = time.perf_counter() - self.scene_time
        self.snapshots = tuple(max(mark - self.renderer_seconds, 0.0) for mark in self.request.snapshots)
        if self.request.seconds is not None:
            limit = max(self.request.seconds - self.renderer_seconds, _LEAST_TIME_LIMIT)
            scene.settings = dataclasses.replace(scene.settings, time_limit=limit, iterations=_NO_ITERATION_LIMIT)
        self._line.show_step("loading programs, building the structure")

    def on_progress(self, progress: "Progress") -> None:
        """As RenderObserver has it."""
        self._line.show(progress, time.perf_counter() - self.scene_time, self.request.seconds)

    def should_stop(self) -> bool:
        """As RenderObserver has it."""
        return self._should_stop()

    def on_snapshot(self, seconds: float, frame: "Frame", scene: Scene) -> None:
        """As RenderObserver has it."""
        mark = self.request.snapshots[len(self.snapshots_written)]
        path = self.request.snapshot_path(mark)
        progress = self._line.progress
        entry: dict[str, object] = {
            "mark": mark,
            "seconds": time.perf_counter() - self.scene_time,
            "iterations": progress.iteration if progress else 0,
            "photons": progress.photons if progress else 0,
            "file": str(path),
        }
        metadata = {key: entry[key] for key in ("seconds", "iterations", "photons")}
        write_frame(path, frame, scene.settings, placement_of(scene.camera), metadata, attributes_of(scene))
        self.snapshots_written.append(entry)

    def on_finish(self, result: "RenderResult", scene: Scene) -> None:
        """As RenderObserver has it."""
        self.seconds = time.perf_counter() - self.scene_time
        self.result = result

    def on_error(self, text: str) -> None:
        """As RenderObserver has it."""
        self.error = text

    def write_files(self) -> None:
        """Write the outputs of a finished render, or its part. Raises PictureError."""
        result, scene = self.result, self.scene
        for path in self.request.outputs:
            if path.suffix == ".exr":
                place, attributes = placement_of(scene.camera), attributes_of(scene)
                write_frame(path, result.frame, scene.settings, place, self.metadata, attributes)
            elif self._write_png_file:
                write_png(path, standard_view(result.frame.combined, scene.color_space))
        self.write_part()

    def write_part(self) -> None:
        """Write the part of a finished render that is one. Raises PictureError."""
        if self._keeper is not None:
            self._keeper.finish()

    def refuse_spoiled(self) -> None:
        """Raise SceneError where the picture, whose files are written, is not finite."""
        for path in self.files[:1]:
            refuse_spoiled(path, self.result.frame.combined)

    @property
    def finished_scene(self) -> Scene:
        """Scene of a finished render."""
        return self.scene

    @property
    def frame(self) -> "Frame":
        """Frame of a finished render."""
        return self.result.frame

    @property
    def stopped(self) -> bool:
        """Whether a finished render was ended early."""
        return self.result.stopped

    @property
    def metadata(self) -> dict[str, object]:
        """Metadata of the EXR of a finished render."""
        statistics = self.result.statistics
        return picture_metadata(
            statistics.iterations,
            statistics.photons,
            self.seconds,
            statistics.device,
            statistics.photon_statistics.radius_meters,
        )

    def report(self) -> dict[str, object]:
        """Return the report of the render for --json, in plain values only."""
        scene, result = self.scene, self.result
        return {
            "files": [str(path) for path in self.files],
            "resolution": list(scene.camera.resolution),
            "interrupted": self._should_stop(),
            "resumed_iterations": self._keeper.resumed_iterations if self._keeper else 0,
            "seconds": self.seconds,
            "renderer_seconds": self.renderer_seconds,
            "settings": {
                name: value.name if isinstance(value, enum.Enum) else value
                for name, value in dataclasses.asdict(scene.settings).items()
            },
            "statistics": result.statistics.as_dict(),
            "snapshots": self.snapshots_written,
            "snapshots_missed": list(self.snapshots_missed),
            "scene_warnings": list(scene.warnings),
        }

    @property
    def snapshots_missed(self) -> Sequence[float]:
        """Marks before which the render ended."""
        return self.request.snapshots[len(self.snapshots_written) :]

    def summary(self) -> str:
        """The closing line."""
        return f"{self.figures()}: {', '.join(str(path) for path in self.files)}"

    def figures(self) -> str:
        """Return the samples, photons, seconds, resolution and device of a finished render in one line."""
        statistics = self.result.statistics
        width, height = self.scene.camera.resolution
        return (
            f"{statistics.iterations} samples, {count_text(statistics.photons)} photons in {self.seconds:.1f} s "
            f"at {width}x{height} on {statistics.device}"
        )

    @property
    def files(self) -> list[Path]:
        """Files that have been written."""
        return [*self.request.outputs, *self.parts_written]

    @property
    def parts_written(self) -> list[Path]:
        """The part, if there is one."""
        return [self._keeper.request.part] if self._keeper and self._keeper.part_written else []


def apply_settings(settings: RenderSettings, values: Mapping[str, object]) -> RenderSettings:
    """Settings with values, which may be text, over them. Raises SettingsError."""
    settings = settings.with_properties(values)
    settings.validate()
    return settings


def picture_metadata(
    iterations: int, photons: int, seconds: float, device: str, radius_meters: float
) -> dict[str, object]:
    """Metadata of the EXR of a whole picture."""
    return {
        "iterations": iterations,
        "photons": photons,
        "seconds": f"{seconds:.3f}",
        "device": device,
        "radius_meters": f"{radius_meters:.6g}",
    }


def write_frame(
    path: Path,
    frame: "Frame",
    settings: RenderSettings,
    placement: Placement,
    metadata: Mapping[str, object],
    attributes: Mapping[str, str],
) -> None:
    """Write a frame's picture and passes as EXR; ``attributes``: attributes_of its scene. Raises PictureError."""
    write_exr(path, frame.combined, frame.passes, metadata, placement, attributes, settings.picture_passes)
