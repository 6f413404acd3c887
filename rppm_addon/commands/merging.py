# SPDX-License-Identifier: GPL-3.0-or-later
"""rppm merge: the parts of a still, rendered by iterations on as many machines, become one picture."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from ..denoising.denoiser import Denoiser
from ..denoising.places import library_places
from ..integrator.film.film import exposed
from ..pictures import FilePicture, PictureName, refuse_spoiled, standard_view, write_multilayer_exr
from ..scene.common.working_space import space_of
from ..scene.errors import CheckpointError
from ..scene.storage.fingerprint import settings_of_plain
from ..session.checkpoints.checkpoint_file import CheckpointSummary, StillRender, read_checkpoint, read_summary
from ..session.checkpoints.checkpoint_writer import picture_of, pictures_of, refuse_differences
from ..session.checkpoints.continuation import Pause
from ..session.render.denoised_pictures import finished_frame
from ..session.render.frame_passes import frame_passes
from ..session.render.merged_passes import MergedPasses
from ..session.render.results import Frame
from .picture_files import write_png
from .picture_set import described, metadata_of, path_of_picture
from .recorder import picture_metadata, write_frame


@dataclass
class MergedStill:
    """The picture of all parts, and its report."""

    frame: Frame
    render: StillRender
    iterations: int
    photons: int
    seconds: float
    """Spent on all parts."""
    devices: list[str]
    radius_meters: float
    parts: list[tuple[int, int, str]]
    """First iteration, the one after the last, and file of each part, in their order."""
    warnings: list[str]

    def report(self) -> dict[str, object]:
        """Return the report of the merged picture for --json, in plain values only."""
        return {
            "iterations": self.iterations,
            "photons": self.photons,
            "seconds": self.seconds,
            "devices": self.devices,
            "settings": self.render.settings,
            "warnings": self.warnings,
            "parts": [{"first": first, "end": end, "file": file} for first, end, file in self.parts],
        }

    @property
    def metadata(self) -> dict[str, object]:
        """Metadata of the picture's EXR."""
        devices = ", ".join(self.devices)
        return picture_metadata(self.iterations, self.photons, self.seconds, devices, self.radius_meters)

    @property
    def name(self) -> PictureName:
        """Which of the render's pictures it is."""
        return picture_of(self.render.source)

    def write_exr(self, path: Path) -> None:
        """Write it alone. Raises PictureError."""
        settings = settings_of_plain(self.render.settings)
        write_frame(path, self.frame, settings, self.render.placement, self.metadata, self.render.attributes)

    def write_png(self, path: Path) -> None:
        """Write it as rppm render does. Raises PictureError or BlenderError."""
        if not self.render.source.get("blend"):
            space = space_of(self.render.attributes.get("colorInteropID", ""))
            write_png(path, standard_view(self.frame.combined, space))
            return
        from .blend_files.blend_file import BlendRequest, save_view

        request = BlendRequest.from_plain(self.render.source["blend"])
        if not request.path.is_file():
            raise CheckpointError(
                f"{path} would be shown as {request.path} says, which is not there; put it back, or write .exr"
            )
        save_view(request, self.frame.combined, path)


def write_stills(stills: Sequence[MergedStill], paths: Sequence[Path]) -> list[Path]:
    """Write the pictures of a render, one of each view layer and view, as rppm render does; returns the files.

    Raises PictureError or BlenderError.
    """
    written = []
    names = [still.name for still in stills]
    for path in paths:
        if path.suffix == ".exr" and len(stills) == 1:
            stills[0].write_exr(path)
            written.append(path)
        elif path.suffix == ".exr":
            _write_multilayer(stills, path)
            written.append(path)
        else:
            for still in reversed(stills):
                written.append(path_of_picture(path, still.name, names))
                still.write_png(written[-1])
    for still in stills:
        refuse_spoiled(paths[0], still.frame.combined)
    return written


def _write_multilayer(stills: Sequence[MergedStill], path: Path) -> None:
    metadata: dict[str, object] = {}
    attributes: dict[str, str] = {}
    for still in stills:
        metadata |= metadata_of(still.name, still.metadata)
        attributes |= still.render.attributes
    pictures = [
        FilePicture(
            still.name,
            still.frame.combined,
            still.frame.passes,
            settings_of_plain(still.render.settings).picture_passes,
        )
        for still in stills
    ]
    write_multilayer_exr(path, pictures, metadata, stills[0].render.placement, attributes)


def merge_stills(paths: Sequence[Path], incomplete: bool) -> list[MergedStill]:
    """merge_parts for each picture of a render that has several. The parts of the first one lead to those of the
    others, which lie beside them."""
    found: dict[PictureName, dict[Path, None]] = {}
    for path in paths:
        source = read_summary(path).render.source
        own, names = picture_of(source), pictures_of(source)
        found.setdefault(own, {})[path] = None
        for other in names[1:] if names and own == names[0] else ():
            beside = path_of_picture(path, other, names)
            if beside.is_file():
                found.setdefault(other, {})[beside] = None
            elif not incomplete:
                raise CheckpointError(
                    f"{beside}, the part of {described(other)}, is not there; put it beside {path}, or merge what "
                    "there is with --incomplete"
                )
    return [merge_parts(list(parts), incomplete) for parts in found.values()]


def merge_parts(paths: Sequence[Path], incomplete: bool) -> MergedStill:
    """The mean of all iterations of the parts, each part one file, denoised where their settings say so.

    incomplete: iterations may be missing. Raises CheckpointError when a file is no part, when parts are of different
    stills or have iterations in common, and when iterations are missing.
    """
    found = sorted(
        ((read_summary(path), path) for path in paths), key=lambda part: (part[0].sample_offset, part[0].iteration)
    )
    _check(found, incomplete)
    radiance: Any = 0.0
    settings = settings_of_plain(found[0][0].render.settings)
    passes = MergedPasses(settings.rendered_passes)
    inspections: dict[str, np.ndarray] = {}
    for summary, pause in _read_parts(found):
        state = pause.state
        radiance = radiance + state.radiance.astype(np.float64) * (summary.iteration - summary.sample_offset)
        passes.add(state.passes, state.pass_counts, summary.iteration - summary.sample_offset)
        inspections = inspections or pause.inspections
    summaries = [summary for summary, _ in found]
    iterations = sum(summary.iteration - summary.sample_offset for summary in summaries)
    render = summaries[0].render
    combined = exposed((radiance / iterations).astype(np.float32), render.exposure)
    warnings = list[str]()
    accumulated = frame_passes(passes.result(), settings.rendered_passes, render.exposure)
    merged = Frame(combined, {**accumulated, **inspections})
    frame = finished_frame(merged, settings, Denoiser(library_places()), warnings)
    return MergedStill(
        frame,
        render,
        iterations,
        sum(summary.photons for summary in summaries),
        sum(summary.seconds for summary in summaries),
        sorted({summary.device for summary in summaries}),
        summaries[-1].radius_meters,
        [(summary.sample_offset, summary.iteration, str(path)) for summary, path in found],
        warnings,
    )


def _read_parts(found: Sequence[tuple[CheckpointSummary, Path]]) -> Iterator[tuple[CheckpointSummary, Pause]]:
    """One after the other, so that no more than one is in memory."""
    for summary, path in found:
        again, pause = read_checkpoint(path)
        if again != summary:
            raise CheckpointError(f"{path} was written anew while it was merged; merge again")
        yield summary, pause


def _check(found: Sequence[tuple[CheckpointSummary, Path]], incomplete: bool) -> None:
    (first, first_path), *others = found
    for summary, path in others:
        refuse_differences(path, summary.render, first.render, str(first_path), "leave it out")
    for (before, before_path), (after, after_path) in pairwise(found):
        if after.sample_offset < before.iteration:
            end = min(before.iteration, after.iteration)
            raise CheckpointError(
                f"{before_path} and {after_path} both have the samples {after.sample_offset}:{end}; "
                "leave one of them out"
            )
    ends = [0, *(summary.iteration for summary, _ in found)]
    gaps = [f"{end}:{summary.sample_offset}" for end, (summary, _) in zip(ends, found) if summary.sample_offset > end]
    if gaps and not incomplete:
        ranges = " and ".join(gaps)
        raise CheckpointError(
            f"the samples {ranges} are in no part; render them with rppm render --samples-range {gaps[0]}, "
            "or merge what there is with --incomplete"
        )
