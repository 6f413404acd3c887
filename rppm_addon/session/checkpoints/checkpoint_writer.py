# SPDX-License-Identifier: GPL-3.0-or-later
"""Stills that are kept while they are rendered, gone on with later, and rendered in parts."""

import itertools
import logging
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...pictures import PictureError, PictureName, Placement
from ...scene import cryptomatte
from ...scene.camera import Camera
from ...scene.errors import CheckpointError, SettingsError
from ...scene.scene import Scene
from ...scene.storage.fingerprint import AFTER_FILM, plain_settings, scene_digests

if TYPE_CHECKING:
    from .checkpoint_file import CheckpointSummary, StillRender
    from .continuation import Continuation, Pause

log = logging.getLogger(__name__)

MINUTES = 5.0
"""From one checkpoint to the next, unless --checkpoint-minutes says otherwise."""
_MOST_DIFFERENCES = 3


@dataclass
class CheckpointRequest:
    """Request of the command line for a still that is kept or rendered in part."""

    checkpoint: Path | None = None
    """Written now and then, and when the render ends or is stopped."""
    minutes: float = MINUTES
    resume: bool = False
    """Go on from the checkpoint."""
    part: Path | None = None
    """Written when the render ends or is stopped: what rppm merge takes."""
    sample_offset: int = 0
    """Iterations before the first of the part."""
    source: dict[str, object] = field(default_factory=dict)
    """Facts about the file that the scene comes from, as JSON has them."""

    def check(self) -> None:
        """Raise SettingsError or CheckpointError for what can be known before anything is rendered."""
        if self.checkpoint is None:
            if self.resume:
                raise SettingsError("--resume needs a checkpoint to go on from; name it with --checkpoint FILE.exr")
            return
        if self.checkpoint.exists() and not self.resume:
            raise CheckpointError(
                f"{self.checkpoint} is there already; go on from it with --resume, delete it, or name another"
            )


class CheckpointWriter:
    """Says where a render begins, and writes its checkpoints."""

    def __init__(self, request: CheckpointRequest) -> None:
        """Read the checkpoint to go on from, if it is there. Raises CheckpointError or SettingsError."""
        from .checkpoint_file import read_checkpoint

        request.check()
        self.request = request
        self.resumed_iterations = 0
        """Iterations that were in the film when this render began."""
        self._summary: CheckpointSummary | None = None
        self._begin: Pause | None = None
        if request.resume and request.checkpoint.exists():
            self._summary, self._begin = read_checkpoint(request.checkpoint)
        self._render: StillRender | None = None
        self._start = time.perf_counter()
        self._seconds_before = 0.0
        self.part_written = False
        self._last: Pause | None = None
        self._failure: PictureError | None = None

    @property
    def starts_over(self) -> bool:
        """Whether there was nothing to resume."""
        return self.request.resume and self._begin is None

    def begin(self, scene: Scene, iterations: int | None) -> "Continuation":
        """How to render the scene, to so many iterations in the film (None: until time is up).

        Raises CheckpointError when the checkpoint is of another scene, has other settings or more iterations, or for
        a part of a still whose rows are exposed one after the other: merging counts the iterations of whole parts.
        """
        from .continuation import Continuation

        if self.request.part is not None and scene.shutter is not None and scene.shutter.is_rolling:
            raise CheckpointError(
                "a still with Rolling Shutter cannot be rendered in parts, as each of its rows takes part in other "
                "samples; render it as a whole, or set Rolling Shutter to None"
            )
        self._render = still_render(scene, self.request.source)
        summary, sample_offset = self._summary, self.request.sample_offset
        if summary is not None:
            path = self.request.checkpoint
            refuse_differences(path, summary.render, self._render, "this render", "begin anew with another checkpoint")
            if summary.sample_offset != sample_offset:
                raise CheckpointError(
                    f"{path} begins with iteration {summary.sample_offset}, not {sample_offset}; go on with "
                    f"--samples-range {summary.sample_offset}:B, or begin anew with another checkpoint"
                )
            self.resumed_iterations = summary.iteration - summary.sample_offset
            if iterations is not None and self.resumed_iterations > iterations:
                raise CheckpointError(
                    f"{path} has {self.resumed_iterations} samples already; ask for as many or more than those, "
                    "or begin anew with another checkpoint"
                )
            self._seconds_before = summary.seconds
        begin, self._begin = self._begin, None  # arrays that nobody needs from here on
        self._start = time.perf_counter()
        return Continuation(sample_offset, begin, self._keep, 60.0 * self.request.minutes)

    def _keep(self, pause: "Pause") -> None:
        """Write the checkpoint; what fails is reported and tried again the next time: the render is worth more."""
        self._last = pause if self.request.part is not None else None
        self._failure = None
        if self.request.checkpoint is None:
            return
        try:
            self._write(self.request.checkpoint, pause)
        except PictureError as error:
            self._failure = error
            log.warning("the checkpoint could not be written: %s", error)

    def _write(self, path: Path, pause: "Pause") -> None:
        from .checkpoint_file import write_checkpoint

        write_checkpoint(path, self._render, pause, self._seconds_before + time.perf_counter() - self._start)

    def finish(self) -> None:
        """Write the part, if one was asked for and there is any of it. Raises PictureError, also for a checkpoint that
        could not be written."""
        if self._last is not None:
            self._write(self.request.part, self._last)
            self.part_written = True
        if self._failure is not None:
            raise self._failure


def continued_still(path: Path, scene: Scene) -> tuple[CheckpointWriter, "Continuation"]:
    """Go on with the still that a checkpoint keeps, for whoever has a single file for it, and keep it there.

    What is there of another scene or with other settings is set aside, under another name, and the scene says so.
    """
    request = CheckpointRequest(path, resume=True)
    try:
        keeper = CheckpointWriter(request)
        return keeper, keeper.begin(scene, scene.settings.iterations)
    except CheckpointError as error:
        aside = _free_name(path)
        try:
            path.replace(aside)
        except OSError as failure:
            raise CheckpointError(f"{error}; and it cannot be renamed ({failure}): choose another file") from failure
        scene.warn(f"the render begins anew, and the checkpoint of before is now {aside.name}: {error}")
        keeper = CheckpointWriter(request)
        return keeper, keeper.begin(scene, scene.settings.iterations)


def _free_name(path: Path) -> Path:
    """A name beside a file that no other has: NAME_before, NAME_before2, ..."""
    numbers = itertools.chain([""], map(str, itertools.count(2)))
    names = (path.with_name(f"{path.stem}_before{number}{path.suffix}") for number in numbers)
    return next(name for name in names if not name.exists())


def still_render(scene: Scene, source: Mapping[str, object]) -> "StillRender":
    """Return the description that distinguishes the render of a scene from other renders."""
    from .checkpoint_file import StillRender

    return StillRender(
        scene_digests(scene),
        plain_settings(scene.settings),
        float(scene.exposure),
        placement_of(scene.camera),
        dict(source),
        attributes_of(scene, picture_of(source).prefix),
    )


def picture_of(source: Mapping[str, Any]) -> PictureName:
    """Which picture of a render with several a still is, by what is known of the file that its scene comes from."""
    return PictureName(*source.get("picture", ()))


def pictures_of(source: Mapping[str, Any]) -> list[PictureName]:
    """All pictures of such a render."""
    return [PictureName(*name) for name in source.get("pictures", ())]


def attributes_of(scene: Scene, prefix: str = "") -> dict[str, str]:
    """Text attributes of the EXR of a scene's picture, which others know by their names.

    prefix: what comes before the names of passes in the file.
    """
    space = {"colorInteropID": scene.color_space.interop_id}
    return {**space, **scene.stamps, **cryptomatte.metadata(scene, prefix)}


def placement_of(camera: Camera) -> Placement:
    """Where the camera's region lies in its frame."""
    x, y, _, _ = camera.region
    return Placement(camera.width, camera.height, x, y)


def refuse_differences(path: Path, mine: "StillRender", other: "StillRender", others_name: str, remedy: str) -> None:
    """Raise CheckpointError, saying what differs, unless the checkpoint ``path`` is of the same still."""
    members = _differing(mine.scene, other.scene)
    if members:
        names = ", ".join(name.replace("_", " ") for name in members)
        raise CheckpointError(f"{path} is of another scene than {others_name} (other {names}); {remedy}")
    settings = [name for name in _differing(mine.settings, other.settings) if name not in AFTER_FILM]
    if settings:
        differences = [f"{name} {mine.settings.get(name)} instead of {other.settings.get(name)}" for name in settings]
        more = f" and {len(differences) - _MOST_DIFFERENCES} more" if len(differences) > _MOST_DIFFERENCES else ""
        raise CheckpointError(
            f"{path} has other settings than {others_name} ({', '.join(differences[:_MOST_DIFFERENCES])}{more}); "
            f"ask for the same, or {remedy}"
        )


def _differing(mine: Mapping[str, object], other: Mapping[str, object]) -> Sequence[str]:
    return [name for name in {**other, **mine} if mine.get(name) != other.get(name)]
