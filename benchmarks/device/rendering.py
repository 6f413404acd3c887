# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene's photon mapper under the benchmark's clock: seconds of iterations by stage."""

import dataclasses
import math
from dataclasses import dataclass

import numpy as np

from rppm_addon.commands.saved_scene import camera_at_resolution
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import DensityEstimation, RenderSettings

from ..machine import Clock
from .scenes import Subject

STAGES = {
    "photon paths": (
        "emission",
        "first photon hits",
        "photon tracing",
        "photon resolve",
        "photon scattering",
        "photon list",
    ),  # fmt: skip
    "camera's first hits": ("gbuffer",),
    "camera paths": ("camera tracing", "camera resolve", "camera scattering"),
    "direct light": ("direct light",),
    "direct splatting": ("direct splatting",),
    "indirect splatting": ("indirect splatting",),
    "film": ("film",),
}
"""Timers of the photon mapper by stage of the paper's Fig. 3 (direct light is in its place of shadow maps)."""
OTHER = "other"
"""Name of the time that an iteration takes beside its timers."""

_PATH_LENGTHS = {
    "bathroom": (4, 4),
    "fireplace_room": (5, 5),
    "pool": (4, 4),
    "sponza_dabrovic": (3, 3),
    "diamond_ring": (3, 3),
    "glass_caustics": (5, 5),
}
"""Photon and camera path lengths of the paper's Fig. 7, for the scenes that resemble its own."""
_OTHER_PATH_LENGTHS = (4, 4)


@dataclass(frozen=True)
class Scale:
    """How much is measured on a kind of device."""

    pixels: int
    photons: int
    """Where neither is what changes; the paper has 1 megapixel and 262144 photons."""
    iterations: int
    """Iterations of the figure that follows a render."""
    repetitions: int
    """Iterations that a point's times are the mean of, after one that is not counted."""
    path_lengths: tuple[int, ...]
    batches: tuple[int, ...]
    sizes: tuple[tuple[int, int], ...]
    seeds: int
    seed_iterations: int
    """Independent renders for a variance, and the iterations of each."""
    reference_iterations: int
    """Iterations of the picture that errors are measured against, four times as many as of the longest render."""


HARDWARE = Scale(
    pixels=1 << 20,
    photons=1 << 18,
    iterations=480,
    repetitions=30,
    path_lengths=(1, 2, 3, 4, 5, 6),
    batches=tuple(1 << power for power in range(12, 21)),
    sizes=((480, 270), (960, 540), (1280, 720), (1920, 1080), (2560, 1440), (3840, 2160)),
    seeds=16,
    seed_iterations=32,
    reference_iterations=1024,
)
SOFTWARE = Scale(
    pixels=1 << 15,
    photons=1 << 15,
    iterations=48,
    repetitions=3,
    path_lengths=(1, 2, 3, 4, 5, 6),
    batches=tuple(1 << power for power in range(12, 18)),
    sizes=((120, 68), (240, 135), (480, 270), (960, 540)),
    seeds=8,
    seed_iterations=8,
    reference_iterations=96,
)
QUICK = Scale(
    pixels=1 << 11,
    photons=1 << 11,
    iterations=6,
    repetitions=2,
    path_lengths=(1, 2, 4),
    batches=(1 << 10, 1 << 11, 1 << 12),
    sizes=((32, 18), (64, 36), (128, 72)),
    seeds=6,
    seed_iterations=2,
    reference_iterations=16,
)


def scale_of(clock: Clock, quick: bool) -> Scale:
    return QUICK if quick else SOFTWARE if clock.is_software else HARDWARE


class Rendering:
    """A photon mapper of a scene, with settings and frame of one's own."""

    def __init__(self, subject: Subject, clock: Clock, scale: Scale) -> None:
        self._clock = clock
        self._camera = dataclasses.replace(subject.scene.camera, crop=None)
        photon_length, camera_length = _PATH_LENGTHS.get(subject.name, _OTHER_PATH_LENGTHS)
        self._settings = RenderSettings(
            photons=scale.photons,
            photon_path_length=photon_length,
            camera_path_length=camera_length,
            use_final_gather=False,  # the paper's estimate
            density_estimation=DensityEstimation.RASTERIZED,
        )
        self._scene = subject.scene
        proportion = self._camera.width / self._camera.height
        width = max(1, round(math.sqrt(scale.pixels * proportion)))
        self.size = width, max(1, round(width / proportion))
        self.mapper = ProgressivePhotonMapper(subject.context, subject.library)
        self.mapper.timers.begin(clock.now)

    def __enter__(self) -> "Rendering":
        return self

    def __exit__(self, *_: object) -> None:
        self.mapper.release()

    @property
    def description(self) -> dict[str, object]:
        """Frame, photons and path lengths where a figure does not say otherwise, for its JSON."""
        return {
            "size": list(self.size),
            "photons": self._settings.photons,
            "photon_path_length": self._settings.photon_path_length,
            "camera_path_length": self._settings.camera_path_length,
        }

    def start(self, size: tuple[int, int] | None = None, **settings: object) -> None:
        """Begin a render anew, at another frame size or with other settings than those described."""
        camera = camera_at_resolution(self._camera, *(size or self.size))
        changed = dataclasses.replace(self._settings, **settings)
        self.mapper.build(dataclasses.replace(self._scene, camera=camera, settings=changed))

    def iterate(self) -> dict[str, float]:
        """One iteration: seconds by STAGES and OTHER, whose sum is the iteration's time."""
        timers = self.mapper.timers
        timers.reset()
        total = self._clock.once(self.mapper.iterate)
        timed = timers.seconds
        seconds = {stage: sum(timed.pop(name, 0.0) for name in names) for stage, names in STAGES.items()} | timed
        return seconds | {OTHER: max(0.0, total - sum(seconds.values()))}

    def mean_iteration(self, repetitions: int) -> dict[str, float]:
        """Mean of iterations as iterate() gives them."""
        return mean_seconds([self.iterate() for _ in range(repetitions)])


def mean_seconds(iterations: list[dict[str, float]]) -> dict[str, float]:
    """Means by stage."""
    return {stage: float(np.mean([seconds[stage] for seconds in iterations])) for stage in iterations[0]}
