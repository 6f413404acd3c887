# SPDX-License-Identifier: GPL-3.0-or-later
"""References that the pictures are compared with: long runs of two independent methods, and how well these agree.

Each method renders twice with different seeds. The difference of its two halves tells its noise; the reference is the
mean of both methods, weighted by the inverse of their noise. Where methods differ by more than their noise, one of
them is wrong: the report shows it.
"""

import dataclasses
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .description import Scene
from .environments import OUT, run_job
from .files import PeersError, SceneFiles
from .jobs import DEPTH, Answer, Job
from .methods import METHODS, OWN, REFERENCES, Method
from .metrics import relative_mse

_SEEDS = (1001, 1002)
"""Not those of the pictures that are compared."""


_OPTIONS: dict[str, dict[str, object]] = {OWN: {"photon_path_length": DEPTH, "camera_path_length": DEPTH}}
"""Where a method's best settings end paths earlier than the others' do."""


@dataclass
class Agreement:
    """How well the two methods of a reference agree."""

    methods: list[str]
    noise: list[float]
    """Relative mean square error that each has by its noise."""
    weights: list[float]
    difference: float
    """Relative mean square difference of the two; the sum of the noise where they agree."""
    mean_ratio: float
    """Mean radiance of the first over that of the second."""
    seconds: float
    """Time that each method rendered, seconds."""

    @property
    def floor(self) -> float:
        """The error that the reference has by its noise: errors near it say nothing."""
        return sum(weight**2 * noise for weight, noise in zip(self.weights, self.noise))


@dataclass
class Reference:
    """Reference pictures that a scene's pictures are compared with; (H, W, 3) each."""

    pixels: np.ndarray
    without_caustics: np.ndarray | None
    agreement: Agreement


def combine(halves: dict[str, tuple[np.ndarray, np.ndarray]], seconds: float) -> tuple[np.ndarray, Agreement]:
    """The weighted mean of two methods, of which each gave two pictures in these seconds together."""
    names = list(halves)
    means = [0.5 * (first + second) for first, second in halves.values()]
    # The mean of two pictures has half of the variance of one, their difference twice.
    noise = [0.25 * relative_mse(first, second) for first, second in halves.values()]
    inverse = [1.0 / max(value, 1e-12) for value in noise]
    weights = [value / sum(inverse) for value in inverse]
    pixels = sum(weight * mean for weight, mean in zip(weights, means))
    ratio = float(means[0].mean(dtype=np.float64) / means[1].mean(dtype=np.float64))
    difference = relative_mse(means[0], means[1])
    return pixels.astype(np.float32), Agreement(names, noise, weights, difference, ratio, seconds)


def _read(path: Path) -> Reference:
    with np.load(path) as arrays:
        return Reference(arrays["pixels"], arrays.get("without"), Agreement(**json.loads(str(arrays["agreement"]))))


class ReferenceStore:
    """Renders references once and keeps them in out/peers/references/."""

    def __init__(self, files: SceneFiles, resolution: int, seconds: float) -> None:
        """seconds: for each of the two methods, at least."""
        self._files = files
        self._resolution = resolution
        self._seconds = seconds

    def get(self, scene: Scene) -> Reference:
        """The reference of a scene. Raises PeersError."""
        stem = f"{scene.name}_{scene.fingerprint}_{self._resolution}"
        kept = [_read(path) for path in sorted((OUT / "references").glob(f"{stem}_*s/reference.npz"))]
        kept = [reference for reference in kept if reference.agreement.seconds >= self._seconds]
        if kept:
            return min(kept, key=lambda reference: reference.agreement.floor)
        folder = OUT / "references" / f"{stem}_{self._seconds:g}s"
        self._make(scene, folder)
        return _read(folder / "reference.npz")

    def _make(self, scene: Scene, folder: Path) -> None:
        halves = {}
        for name in REFERENCES[scene.name]:
            half = 0.5 * self._seconds
            pictures = [self._render(scene, METHODS[name], folder / f"{name}_{seed}", half, seed) for seed in _SEEDS]
            halves[name] = tuple(pictures)
        pixels, agreement = combine(halves, self._seconds)
        arrays = {"pixels": pixels, "agreement": np.array(json.dumps(dataclasses.asdict(agreement)))}
        if scene.caustic:
            without = Method("without", "", "cycles", {"no_caustics": True})
            arrays["without"] = self._render(scene, without, folder / "without", 0.25 * self._seconds, _SEEDS[0])
        np.savez(folder / "reference.npz", **arrays)

    def _render(self, scene: Scene, method: Method, folder: Path, seconds: float, seed: int) -> np.ndarray:
        answer_file = folder / "answer.json"
        if not answer_file.exists():
            source = self._files.of(method.adapter, scene.name)
            options = method.options | _OPTIONS.get(method.name, {})
            job = Job(scene.name, str(folder), source, options, [seconds], [], self._resolution, seed)
            answer = run_job(method.adapter, job)
            if answer.error or not answer.pictures:
                raise PeersError(f"no reference of {scene.name} by {method.name or 'Cycles'}: {answer.error}")
        return Answer.read(answer_file).pictures[-1].load()
