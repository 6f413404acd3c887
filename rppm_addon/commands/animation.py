# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders frames of a .blend file one after the other: Blender, the renderer and its programs are started once."""

import dataclasses
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..pictures import PictureError
from ..scene.errors import RppmError
from .blend_files.blend_file import BlendFile, BlendRequest, opened_blend_file
from .options.frame_numbers import path_of_frame
from .picture_files import is_whole
from .picture_set import recorded_pictures
from .recorder import RenderRequest
from .terminal.interruption import Interruption
from .terminal.progress_bar import PartBar, ProgressBar
from .terminal.texts import printable


@dataclass
class AnimationRequest:
    """Request of the command line for an animation."""

    blend: BlendRequest
    render: RenderRequest
    """Request for each frame; its outputs have a place for the frame number."""
    frames: Sequence[int]
    resume: bool = False
    """Leave out frames whose files are all there and whole."""

    def outputs(self, frame: int) -> list[Path]:
        """The files of a frame."""
        return [path_of_frame(path, frame) for path in self.render.outputs]


class Animation:
    """Renders the frames of a request and keeps what is worth reporting.

    A frame that cannot be rendered is reported and skipped; files that cannot be written end it all. On an interruption
    the frame under way is dropped, so that every file holds a whole frame.
    """

    def __init__(
        self,
        request: AnimationRequest,
        bar: ProgressBar,
        interruption: Interruption,
        write_report: Callable[[dict[str, object]], None],
    ) -> None:
        """write_report is given the report after each frame."""
        self._request = request
        self._bar = bar
        self._interruption = interruption
        self._write_report = write_report
        self._report: dict[str, Any] = {"scene": str(request.blend.path), "frames": []}
        self.failed: list[int] = []
        self.rendered: list[int] = []

    def run(self, show_output: bool) -> None:
        """Render. Raises PictureError, or any RppmError before the first frame."""
        request = self._request
        there = set()
        if request.resume:
            there = {frame for frame in request.frames if all(map(is_whole, request.outputs(frame)))}
            for frame in sorted(there):
                self._tell(frame, {"skipped": True, "files": [str(path) for path in request.outputs(frame)]})
            if there:
                print(f"{len(there)} of {len(request.frames)} frames are there already")
        frames = [frame for frame in request.frames if frame not in there]
        if not frames:
            return
        blend = dataclasses.replace(request.blend, frame=frames[0])
        with opened_blend_file(blend, show_output) as file:
            opened = file.report
            self._report["blender"] = {
                "version": opened.version,
                "start_seconds": opened.start_seconds,
                "load_seconds": opened.load_seconds,
            }
            for place, frame in enumerate(frames):
                if self._interruption.asked:
                    return
                bar = PartBar(self._bar, place, len(frames), f"frame {frame} ({place + 1} of {len(frames)})")
                self._render(file, frame, bar)

    def _render(self, file: BlendFile, frame: int, bar: PartBar) -> None:
        request = dataclasses.replace(self._request.render, outputs=self._request.outputs(frame))
        pictures = recorded_pictures(request, bar, lambda: self._interruption.asked)
        try:
            file.set_frame(frame)
            file.render(pictures)
            if pictures.stopped:
                return
            file.write(pictures)
        except PictureError:
            raise
        except RppmError as error:
            if self._interruption.asked:  # there was no picture yet
                return
            self._bar.clear()
            sys.stderr.write(f"rppm: frame {frame}: {printable(' '.join(str(error).split()))}\n")
            self.failed.append(frame)
            self._tell(frame, {"error": str(error)})
            return
        self.rendered.append(frame)
        self._tell(frame, {"export_seconds": file.report.export_seconds, **pictures.report()})
        self._bar.clear()
        file.output.write(f"Frame {frame}: {pictures.summary()}\n")
        file.output.flush()

    def _tell(self, frame: int, what: dict[str, object]) -> None:
        self._report["frames"].append({"frame": frame, **what})
        self._write_report(self._report)
