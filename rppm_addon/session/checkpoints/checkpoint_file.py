# SPDX-License-Identifier: GPL-3.0-or-later
"""Checkpoints of stills in OpenEXR files: the picture so far, and beside it all that it takes to go on bit for bit.

The first part of a file is the film as any viewer shows it (before exposure), with the numbers of iterations that each
pixel's passes are of and the factor of its radius; the second has what the guide of the photons learned; a third, while
photons are chosen by their noise, what was found without them last. Numbers are
JSON in the attribute ``rppm.checkpoint``. After the EXR's own end come a mark and the SHA-256 of all before it, so
that a file that was cut short or damaged is known before it is parsed: OpenEXR reads pixels that are damaged without
an error.
"""

import contextlib
import dataclasses
import hashlib
import json
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from ...integrator.common.photon_counts import NoiseVariances, PhotonCounts
from ...integrator.state import RenderState
from ...pictures import Placement, renamed_when_whole
from ...scene.common.declared import declared
from ...scene.common.whole_files import is_no_file
from ...scene.errors import CheckpointError
from ...scene.passes import RenderPass
from ...scene.storage.fingerprint import settings_of_plain
from ...scene.storage.validation import check_record
from .continuation import Pause

if TYPE_CHECKING:
    import OpenEXR

FORMAT = 8
_ATTRIBUTE = "rppm.checkpoint"
_MARK = b"RPPM-SHA-256"
_TRAILER = len(_MARK) + 32
_FILM, _GUIDE, _REST = "film", "guide", "rest"
_COUNTS = ("Pass Counts.X", "Pass Counts.Y")
_HALF = ("Half.R", "Half.G", "Half.B")
_BLOCK = 1 << 20
_MAX_REASON = 200
"""Characters of an error of OpenEXR or JSON that a message quotes."""


@dataclass
class StillRender:
    """Identity of a still in plain values, by which renders of other stills are refused."""

    scene: dict[str, str]
    """Digests by member of the scene (scene_digests)."""
    settings: dict[str, Any]
    """Settings that the picture depends on (plain_settings)."""
    exposure: float = field(metadata=declared(minimum=0.0))
    placement: Placement
    source: dict[str, Any] = field(default_factory=dict)
    """Facts that the command line knows about the file that the scene came from."""
    attributes: dict[str, str] = field(default_factory=dict)
    """Text attributes of the picture's EXR."""


@dataclass
class CheckpointSummary:
    """Contents of a checkpoint without its arrays."""

    render: StillRender
    sample_offset: int
    iteration: int
    photon_counts: PhotonCounts
    photon_noise: NoiseVariances
    wide_radius: float
    global_photons_found: float | None
    device: str
    radius_meters: float
    seconds: float
    """Spent on it, in all processes that went on with it."""

    @property
    def photons(self) -> int:
        """Emitted in the iterations that are in the film."""
        return self.photon_counts.emitted(self.sample_offset, self.iteration - self.sample_offset)


def write_checkpoint(path: str | Path, render: StillRender, pause: Pause, seconds: float) -> None:
    """Write a checkpoint; a reader never sees half of it. Raises PictureError when it cannot be written."""
    import OpenEXR  # late: the file format is not needed to import the engine

    state, rendered_passes = pause.state, settings_of_plain(render.settings).rendered_passes
    summary = CheckpointSummary(
        render,
        state.skipped,
        state.iteration,
        state.photon_counts,
        state.photon_noise,
        state.wide_radius,
        state.global_photons_found,
        pause.device,
        pause.radius_meters,
        seconds,
    )
    height, width = state.radiance.shape[:2]
    common = {**render.placement.windows(width, height), "type": OpenEXR.scanlineimage}
    film = {
        **common,
        "compression": OpenEXR.RLE_COMPRESSION,
        _ATTRIBUTE: json.dumps({"format": FORMAT, **dataclasses.asdict(summary)}),
    }
    guide = {
        **common,
        "compression": OpenEXR.ZIPS_COMPRESSION,
        "dataWindow": ((0, 0), (len(state.tallies) - 1, 0)),
    }
    parts = [
        OpenEXR.Part(film, _film_channels(state, pause.inspections, rendered_passes), _FILM),
        OpenEXR.Part(guide, _guide_channels(state), _GUIDE),
    ]
    if state.rest is not None:
        rows, columns = state.rest.shape
        rest = {**guide, "dataWindow": ((0, 0), (columns - 1, rows - 1))}
        parts.append(OpenEXR.Part(rest, {_REST: state.rest}, _REST))
    with renamed_when_whole(path) as temporary:
        OpenEXR.File(parts).write(temporary)
        with Path(temporary).open("r+b") as file:
            digest = _digest(file, os.fstat(file.fileno()).st_size)
            file.write(_MARK + digest)
            file.flush()
            os.fsync(file.fileno())


def read_summary(path: str | Path) -> CheckpointSummary:
    """A checkpoint's summary. Raises CheckpointError when it is none or damaged."""
    with _opened(path, header_only=True) as (_, summary):
        return summary


def read_checkpoint(path: str | Path) -> tuple[CheckpointSummary, Pause]:
    """A checkpoint as it was written. Raises CheckpointError when it is none or damaged."""
    with _opened(path, header_only=False) as (file, summary):
        film, guide = (_pixels(file, part) for part in range(2))
        rest = _pixels(file, 2)[_REST] if len(file.parts) > 2 else None

        def layer(*names: str) -> np.ndarray:
            planes = [film[name][::-1] for name in names]
            return np.stack(planes, axis=-1) if len(planes) > 1 else planes[0].copy()

        def pairs(*names: str) -> np.ndarray:
            return np.stack([guide[name].reshape(-1) for name in names], axis=-1)

        passes = settings_of_plain(summary.render.settings).rendered_passes
        state = RenderState(
            summary.sample_offset,
            summary.iteration,
            summary.photon_counts,
            summary.photon_noise,
            summary.wide_radius,
            summary.global_photons_found,
            layer(*"RGBA"),
            {entry.name: layer(*entry.layers) for entry in passes if entry.is_accumulated},
            layer(*_COUNTS) if _COUNTS[0] in film else np.zeros((0, 0, 2), np.uint32),
            layer("Radius Factor.V"),
            pairs("left", "contributed"),
            pairs("learned.left", "learned.contributed") if "learned.left" in guide else None,
            rest,
            layer(*_HALF) if _HALF[0] in film else None,
        )
        _check_state(state, summary.render.placement)
        inspections = {entry.name: layer(*entry.layers) for entry in passes if not entry.is_accumulated}
        return summary, Pause(state, summary.device, summary.radius_meters, inspections)


def _pixels(file: "OpenEXR.File", part: int) -> dict[str, np.ndarray]:
    return {name: channel.pixels for name, channel in file.channels(part).items()}


def _film_channels(
    state: RenderState, inspections: Mapping[str, np.ndarray], entries: Sequence[RenderPass]
) -> dict[str, np.ndarray]:
    channels = {name: state.radiance[..., index] for index, name in enumerate("RGBA")}
    channels["Radius Factor.V"] = state.radius_factors
    passes = {**state.passes, **inspections}
    for entry in entries:
        values = np.atleast_3d(passes[entry.name])
        channels |= {name: values[..., index] for index, name in enumerate(entry.layers)}
    if state.pass_counts.size:
        channels |= {name: state.pass_counts[..., index] for index, name in enumerate(_COUNTS)}
    if state.half is not None:
        channels |= {name: state.half[..., index] for index, name in enumerate(_HALF)}
    return {name: np.ascontiguousarray(array[::-1]) for name, array in channels.items()}


def _guide_channels(state: RenderState) -> dict[str, np.ndarray]:
    tallies = {"left": state.tallies[:, 0], "contributed": state.tallies[:, 1]}
    if state.learned is not None:
        tallies |= {"learned.left": state.learned[:, 0], "learned.contributed": state.learned[:, 1]}
    return {name: np.ascontiguousarray(array[None]) for name, array in tallies.items()}


def _digest(file: BinaryIO, size: int) -> bytes:
    """SHA-256 of the next ``size`` bytes."""
    digest = hashlib.sha256()
    while size > 0:
        block = file.read(min(size, _BLOCK))
        if not block:
            raise OSError("the file became shorter while it was read")
        digest.update(block)
        size -= len(block)
    return digest.digest()


def _check_whole(path: str | Path) -> None:
    if is_no_file(Path(path)):
        raise CheckpointError(f"{path} is no file; name a checkpoint that rppm render wrote")
    with Path(path).open("rb") as file:
        size = os.fstat(file.fileno()).st_size
        file.seek(max(size - _TRAILER, 0))
        trailer = file.read()
        if not trailer.startswith(_MARK):
            raise CheckpointError(
                f"{path} is no checkpoint, or was cut short; name one that rppm render wrote, or begin anew without it"
            )
        file.seek(0)
        if _digest(file, size - _TRAILER) != trailer[len(_MARK) :]:
            raise CheckpointError(
                f"{path} is damaged: its bytes are not those that were written; begin anew without it"
            )


@contextlib.contextmanager
def _opened(path: str | Path, header_only: bool) -> Iterator[tuple["OpenEXR.File", CheckpointSummary]]:
    """The file, found whole, and its summary; what goes wrong while it is read becomes CheckpointError."""
    import OpenEXR

    try:
        _check_whole(path)
        with OpenEXR.File(str(path), separate_channels=True, header_only=header_only) as file:
            document = json.loads(file.header()[_ATTRIBUTE])
            if document.pop("format") != FORMAT:
                raise CheckpointError(f"{path} was written by another version of RPPM; begin anew without it")
            render = document.pop("render")
            placement = Placement(**render.pop("placement"))
            counts = PhotonCounts(tuple(document.pop("photon_counts")["numbers"]))
            noise = NoiseVariances(**document.pop("photon_noise"))
            still = StillRender(placement=placement, **render)
            summary = CheckpointSummary(still, photon_counts=counts, photon_noise=noise, **document)
            _check(summary)
            yield file, summary
    except FileNotFoundError as error:
        raise CheckpointError(f"{path} does not exist; name a checkpoint that rppm render wrote") from error
    except CheckpointError:
        raise
    except Exception as error:  # whatever OpenEXR, json and numpy say to what is damaged or forged
        reason = " ".join(str(error).split())[:_MAX_REASON]
        raise CheckpointError(f"{path} cannot be read as a checkpoint ({reason}); begin anew without it") from error


def _check(summary: CheckpointSummary) -> None:
    """Raise SceneError, SettingsError or ValueError for numbers that no render has."""
    check_record(summary, CheckpointSummary, finite=True)
    settings_of_plain(summary.render.settings).validate()
    if not 0 <= summary.sample_offset < summary.iteration:
        raise ValueError(f"iterations from {summary.sample_offset} to {summary.iteration}")
    if not summary.photon_counts.numbers:
        raise ValueError("no numbers of photons")


def _check_state(state: RenderState, placement: Placement) -> None:
    """Raise ValueError for arrays that do not fit each other."""
    height, width = state.radiance.shape[:2]
    if placement.x + width > placement.width or placement.y + height > placement.height:
        raise ValueError(f"{width} x {height} pixels at {placement.x}, {placement.y} of the frame")
    optional = [part for part in (state.half, state.rest) if part is not None]
    films = [state.radiance, *state.passes.values(), state.radius_factors, *optional]
    counts = [state.pass_counts, state.tallies, *([] if state.learned is None else [state.learned])]
    for arrays, dtype in ((films, np.float32), (counts, np.uint32)):
        for array in arrays:
            if array.dtype != dtype:
                raise ValueError(f"pixels of {array.dtype} in place of {np.dtype(dtype)}")
