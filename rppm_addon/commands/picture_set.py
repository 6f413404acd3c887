# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of one render of a .blend file: one of each view layer and view, which share the files."""

import dataclasses
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..pictures import FilePicture, PictureName, refuse_spoiled, write_multilayer_exr
from ..scene import Scene
from ..session.checkpoints.checkpoint_writer import CheckpointWriter, attributes_of, placement_of
from ..session.render.observers import RenderObserver
from .recorder import RenderRecorder, RenderRequest
from .terminal.progress_bar import PartBar, ProgressBar

if TYPE_CHECKING:
    from ..session.render.results import Frame, Progress, RenderResult

_UNFIT_FOR_FILES = re.compile(r"[^\w-]+")


def path_of_picture(path: Path, name: PictureName, names: Sequence[PictureName]) -> Path:
    """Where a picture goes that needs a file of its own: the first of ``names`` to the path itself, the others beside
    it, with the names of view layer and view."""
    if name == names[0]:
        return path
    text = "_".join(filter(None, (name.layer if len({other.layer for other in names}) > 1 else "", name.view)))
    return path.with_name(f"{path.stem}_{_UNFIT_FOR_FILES.sub('_', text)}{path.suffix}")


def described(name: PictureName) -> str:
    """A picture's name for users."""
    return " ".join(filter(None, (name.layer, name.view)))


class PictureSet(RenderObserver):
    """Has a recorder for each picture, and writes what they have recorded. Where there is one picture only, all is that
    recorder's."""

    def __init__(
        self, outputs: Sequence[Path], make: Callable[[PictureName, Sequence[PictureName]], RenderRecorder]
    ) -> None:
        """outputs: the files of all; make: of a picture's name, and the names of all, the recorder."""
        self.outputs = list(outputs)
        self.names: list[PictureName] = [PictureName()]
        """Names of the pictures that the render is to have, in their order; whoever starts the render sets them."""
        self.recorders: list[RenderRecorder] = []
        """Recorders of the pictures that have begun."""
        self.error: str | None = None
        self._make = make
        self._name = PictureName()

    @property
    def is_single(self) -> bool:
        """Whether there is one picture only."""
        return len(self.names) == 1

    @property
    def finished(self) -> list[tuple[PictureName, RenderRecorder]]:
        """The pictures that there are."""
        pairs = zip(self.names, self.recorders)
        return [(name, recorder) for name, recorder in pairs if recorder.result is not None]

    @property
    def stopped(self) -> bool:
        """Whether the render was ended early."""
        return len(self.finished) < len(self.names) or any(recorder.stopped for recorder in self.recorders)

    @property
    def has_samples(self) -> bool:
        """Whether there are some of any picture."""
        return any(recorder.has_samples for recorder in self.recorders)

    @property
    def scene_time(self) -> float:
        """When the first scene was there."""
        return self.recorders[0].scene_time if self.recorders else 0.0

    def on_picture(self, name: PictureName) -> None:
        """As RenderObserver has it."""
        self._name = name

    def on_scene(self, scene: Scene) -> bool:
        """As RenderObserver has it."""
        name = self.names[0] if self.is_single else self._name
        self.recorders.append(self._make(name, self.names))
        wanted = self._current.on_scene(scene)
        self.continuation = self._current.continuation
        return wanted

    @property
    def _current(self) -> RenderRecorder:
        return self.recorders[-1]

    def on_start(self, scene: Scene) -> None:
        """As RenderObserver has it."""
        self._current.on_start(scene)
        self.snapshots = self._current.snapshots

    def on_progress(self, progress: "Progress") -> None:
        """As RenderObserver has it."""
        self._current.on_progress(progress)

    def should_stop(self) -> bool:
        """As RenderObserver has it."""
        return bool(self.recorders) and self._current.should_stop()

    def on_snapshot(self, seconds: float, frame: "Frame", scene: Scene) -> None:
        """As RenderObserver has it."""
        self._current.on_snapshot(seconds, frame, scene)

    def on_finish(self, result: "RenderResult", scene: Scene) -> None:
        """As RenderObserver has it."""
        self._current.on_finish(result, scene)

    def on_error(self, text: str) -> None:
        """As RenderObserver has it."""
        self.error = self.error or text

    def write_files(self) -> None:
        """Write the files of a finished render but for the pictures by a view transform. Raises PictureError."""
        if self.is_single:
            self._current.write_files()
            return
        for path in self.outputs:
            if path.suffix == ".exr":
                self._write_exr(path)
        # The first one's files, whose names are known beforehand, are written last: they mean that all are there.
        for _, recorder in reversed(self.finished):
            recorder.write_part()

    def refuse_spoiled(self) -> None:
        """Raise SceneError where a picture, whose files are written, is not finite."""
        for _, recorder in self.finished:
            for path in self.outputs[:1]:
                refuse_spoiled(path, recorder.frame.combined)

    def _write_exr(self, path: Path) -> None:
        metadata: dict[str, object] = {}
        attributes: dict[str, str] = {}
        pictures = []
        for name, recorder in self.finished:
            scene, frame = recorder.finished_scene, recorder.frame
            pictures.append(FilePicture(name, frame.combined, frame.passes, scene.settings.picture_passes))
            metadata |= metadata_of(name, recorder.metadata)
            attributes |= attributes_of(scene, name.prefix)
        placement = placement_of(self.recorders[0].finished_scene.camera)
        write_multilayer_exr(path, pictures, metadata, placement, attributes)

    @property
    def pngs(self) -> list[tuple[Path, "Frame"]]:
        """The files and pictures by a view transform that are still to be written, in that order."""
        paths = [path for path in self.outputs if path.suffix == ".png"]
        return [
            (path_of_picture(path, name, self.names), recorder.frame)
            for name, recorder in reversed(self.finished)
            for path in paths
        ]

    @property
    def files(self) -> list[Path]:
        """Files that have been written."""
        if self.is_single:
            return self._current.files
        parts = [path for _, recorder in self.finished for path in recorder.parts_written]
        return [*(path for path in self.outputs if path.suffix == ".exr"), *(path for path, _ in self.pngs), *parts]

    @property
    def snapshots_missed(self) -> list[float]:
        """Marks before which a picture ended."""
        return [mark for _, recorder in self.finished for mark in recorder.snapshots_missed]

    def report(self) -> dict[str, object]:
        """Return the report of the render for --json, in plain values only."""
        if self.is_single:
            return self._current.report()
        pictures = [{"layer": name.layer, "view": name.view, **recorder.report()} for name, recorder in self.finished]
        return {"files": [str(path) for path in self.files], "pictures": pictures}

    def summary(self) -> str:
        """The closing line, or several."""
        if self.is_single:
            return self._current.summary()
        lines = [f"{described(name)}: {recorder.figures()}" for name, recorder in self.finished]
        return "\n".join([*lines, ", ".join(str(path) for path in self.files)])


def metadata_of(name: PictureName, metadata: Mapping[str, object]) -> dict[str, object]:
    """Metadata of a picture in a file that has several."""
    return {f"{name.joined}.{key}": value for key, value in metadata.items()}


def recorded_pictures(
    request: RenderRequest,
    bar: ProgressBar | PartBar,
    should_stop: Callable[[], bool],
    keeper: CheckpointWriter | None = None,
) -> PictureSet:
    """The pictures of a frame of a .blend file. keeper: of the first one; the others have their own, beside it."""

    def make(name: PictureName, names: Sequence[PictureName]) -> RenderRecorder:
        if len(names) == 1:
            return RenderRecorder(request, bar, should_stop, write_png_file=False, keeper=keeper)
        part_bar = PartBar(bar, names.index(name), len(names), described(name))
        outputs = [path_of_picture(path, name, names) for path in request.outputs]
        own = dataclasses.replace(request, outputs=outputs)
        kept = None if keeper is None else _keeper_of(keeper, name, names)
        return RenderRecorder(own, part_bar, should_stop, write_png_file=False, keeper=kept)

    return PictureSet(request.outputs, make)


def _keeper_of(keeper: CheckpointWriter, name: PictureName, names: Sequence[PictureName]) -> CheckpointWriter:
    """The keeper of one of several pictures. Raises as CheckpointWriter."""
    request = keeper.request
    which = {"picture": list(dataclasses.astuple(name)), "pictures": [list(dataclasses.astuple(n)) for n in names]}
    if name == names[0]:
        request.source.update(which)
        return keeper
    checkpoint, part = (path and path_of_picture(path, name, names) for path in (request.checkpoint, request.part))
    source = {**request.source, **which}
    return CheckpointWriter(dataclasses.replace(request, checkpoint=checkpoint, part=part, source=source))
