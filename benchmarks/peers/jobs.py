# SPDX-License-Identifier: GPL-3.0-or-later
"""Jobs that an adapter is given and its answers, as JSON and .npy files. NumPy only."""

import argparse
import dataclasses
import json
import resource
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from .description import Scene
from .scenes import make_scene

DEPTH = 16
"""Segments of a path, for renderers that limit them: twice what RPPM's photons and camera paths have each."""


@dataclass
class Job:
    """One scene by one method of one renderer, in a process of its own."""

    scene: str
    """Name of a scene of scenes.py; empty for a file whose settings both renderers take as they are."""
    folder: str
    """Where pictures and answer go."""
    source: str = ""
    """The file of the scene, for renderers that read one."""
    options: dict[str, object] = field(default_factory=dict)
    """Options that make the method, in the adapter's words."""
    seconds: list[float] = field(default_factory=list)
    """Ascending times of rendering after which pictures are wanted."""
    samples: list[int] = field(default_factory=list)
    """In place of times: numbers of samples a pixel, or of iterations."""
    resolution: int = 256
    """Width and height in pixels, where the scene has a name."""
    seed: int = 1
    launched: float = 0.0
    """time.time() as the process was started."""

    def write(self, path: Path) -> None:
        path.write_text(json.dumps(dataclasses.asdict(self), indent=2), encoding="utf-8")

    @classmethod
    def read(cls, path: Path) -> "Job":
        return cls(**json.loads(path.read_text(encoding="utf-8")))


@dataclass
class Picture:
    """One picture of a method."""

    mark: float
    """The seconds or samples asked for."""
    seconds: float
    """Time that it took, from the scene in the renderer's format to the picture."""
    samples: float
    """A pixel, or iterations; 0 where the renderer does not tell."""
    file: str
    """.npy, (H, W, 3) float32 scene-linear Rec.709, the top row first."""

    def load(self) -> np.ndarray:
        return np.load(self.file)


@dataclass
class Answer:
    """Outcome of a job."""

    version: str = ""
    first_picture_seconds: float = 0.0
    """From the start of the process to a first, rough picture: loading, compiling, building, rendering."""
    peak_bytes: int = 0
    """The most memory of the process."""
    pictures: list[Picture] = field(default_factory=list)
    error: str = ""

    def write(self, path: Path) -> None:
        path.write_text(json.dumps(dataclasses.asdict(self), indent=2), encoding="utf-8")

    @classmethod
    def read(cls, path: Path) -> "Answer":
        plain = json.loads(path.read_text(encoding="utf-8"))
        plain["pictures"] = [Picture(**picture) for picture in plain["pictures"]]
        return cls(**plain)


class Recorder:
    """Keeps an adapter's pictures and times."""

    def __init__(self, job: Job, version: str) -> None:
        self.job = job
        self.answer = Answer(version)

    def first_picture(self) -> None:
        """The first picture is there."""
        self.answer.first_picture_seconds = time.time() - self.job.launched

    def keep(self, mark: float, seconds: float, samples: float, pixels: np.ndarray) -> None:
        """Save a picture: (H, W, 3 or 4), the top row first."""
        path = Path(self.job.folder) / f"picture_{mark:g}.npy"
        np.save(path, np.ascontiguousarray(pixels[..., :3], np.float32))
        self.answer.pictures.append(Picture(mark, seconds, samples, str(path)))


def run_adapter(version: Callable[[], str], render: Callable[[Job, Scene | None, Recorder], None]) -> int:
    """The program of an adapter: its argument is the file of a job, beside which the answer is written."""
    parser = argparse.ArgumentParser()
    parser.add_argument("job", type=Path)
    path = parser.parse_args().job
    job = Job.read(path)
    recorder = Recorder(job, version())
    render(job, make_scene(job.scene) if job.scene else None, recorder)
    scale = 1 if sys.platform == "darwin" else 1024
    recorder.answer.peak_bytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * scale
    recorder.answer.write(path.with_name("answer.json"))
    return 0
