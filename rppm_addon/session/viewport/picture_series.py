# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of a viewport's scene at one resolution, and how far they are."""

import time

from ...integrator.progressive import ProgressivePhotonMapper
from ...scene.scene import Scene
from ..limits.noise_threshold import NoiseThreshold
from ..render.results import PhotonStatistics, Progress
from ..transport.sessions import CompilationProgress, SessionStatus


class PictureSeries:
    """A series of pictures of one scene at one resolution: each has more iterations than the one before."""

    def __init__(
        self, mapper: ProgressivePhotonMapper, scene: Scene, generation: int, level: float, began: float
    ) -> None:
        """Begin with a mapper that has the scene.

        Args:
            mapper: its iterations are those of the series.
            scene: scene at full resolution, with stand-ins for materials.
            generation: generation of the scene.
            level: fraction of the full side length, above 0 to 1.
            began: time.perf_counter() before the mapper received the scene.
        """
        self.mapper = mapper
        self.scene = scene
        self.generation = generation
        self._level = level
        self.began = began
        self._built = time.perf_counter()
        self._noise = NoiseThreshold(scene.settings)

    @property
    def is_complete(self) -> bool:
        """Whether the last iteration is done, by the settings' number or by the noise."""
        return self.mapper.iteration >= self.scene.settings.iterations or self._noise.is_reached

    @property
    def progress(self) -> float:
        """Fraction of the settings' iterations done, 0 to 1."""
        return self.mapper.iteration / self.scene.settings.iterations

    def measure_noise(self) -> None:
        """Measure the noise after an iteration where the threshold needs it."""
        if self._noise.is_due(self.mapper.iteration):
            self._noise.add(self.mapper.iteration, self.mapper.measure_noise())

    def status(self, now: float, memory_bytes: int, stood_in_for: int) -> SessionStatus:
        """Return the status after an iteration.

        Args:
            now: time.perf_counter() at its end.
            memory_bytes: bytes on the device.
            stood_in_for: number of programs in whose place stand-ins are rendered.
        """
        mapper, noise = self.mapper, self._noise
        return SessionStatus(
            self.generation,
            CompilationProgress(stood_in_for=stood_in_for),
            Progress(
                mapper.iteration,
                self.scene.settings.iterations,
                now - self.began,
                mapper.photons_emitted(mapper.iteration),
                noise=noise.noise,
                noise_threshold=noise.threshold,
                memory_bytes=memory_bytes,
                build_seconds=self._built - self.began,
            ),
            PhotonStatistics.of(mapper),
            mapper.scene.warnings,
            settled=self._level == 1.0 and self.is_complete and not stood_in_for,
        )
