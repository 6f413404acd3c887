# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of measurements, as JSON keeps them."""

import dataclasses
import json
import math
from dataclasses import dataclass, field
from pathlib import Path

from .references import Agreement

_SLACK = 1.15
"""A first picture that comes so much later than asked for still counts as in time."""


@dataclass
class Point:
    """A picture's place on the curve of error against seconds."""

    mark: float
    seconds: float
    samples: float
    relative_mse: float
    flip: float
    mean_ratio: float
    caustic_ratio: float | None
    """None where the scene is not about caustics."""
    file: str
    """From the checkout's folder."""


@dataclass
class Curve:
    """One method on one scene."""

    method: str
    label: str
    version: str
    first_picture_seconds: float
    peak_bytes: int
    points: list[Point]
    error: str = ""

    def at(self, seconds: float) -> float | None:
        """Relative mean square error after these seconds; None while there is no picture.

        A picture that is late counts for what it was on its way: between two, the error goes straight in logarithms.
        """
        points = self.points
        if not points or seconds * _SLACK < points[0].seconds:
            return None
        for before, after in zip(points, points[1:]):
            if before.seconds <= seconds < after.seconds:
                share = math.log(seconds / before.seconds) / math.log(after.seconds / before.seconds)
                start, end = math.log(max(before.relative_mse, 1e-12)), math.log(max(after.relative_mse, 1e-12))
                return math.exp(start + share * (end - start))
        return points[0].relative_mse if seconds < points[0].seconds else points[-1].relative_mse

    def point(self, mark: float) -> Point | None:
        """The picture asked for at a mark."""
        return next((point for point in self.points if point.mark == mark), None)


@dataclass
class SceneResult:
    """All methods on one scene."""

    name: str
    title: str
    triangles: int
    lights: int
    agreement: Agreement
    exposure: float
    reference_file: str
    """.npy, (H, W, 3); from the checkout's folder."""
    curves: list[Curve] = field(default_factory=list)


@dataclass
class Results:
    """A whole comparison."""

    machine: dict[str, object]
    seconds: list[float]
    resolution: int
    scenes: list[SceneResult] = field(default_factory=list)

    def write(self, path: Path) -> None:
        path.write_text(json.dumps(dataclasses.asdict(self), indent=1) + "\n", encoding="utf-8")

    @classmethod
    def read(cls, path: Path) -> "Results":
        plain = json.loads(path.read_text(encoding="utf-8"))
        for scene in plain["scenes"]:
            scene["agreement"] = Agreement(**scene["agreement"])
            for curve in scene["curves"]:
                curve["points"] = [Point(**point) for point in curve["points"]]
            scene["curves"] = [Curve(**curve) for curve in scene["curves"]]
        plain["scenes"] = [SceneResult(**scene) for scene in plain["scenes"]]
        return cls(**plain)
