# SPDX-License-Identifier: GPL-3.0-or-later
"""Rasterization-based progressive photon mapping: a scene, its film, and the iterations in between."""

import time
from collections.abc import Iterator

import numpy as np

from ..gl.context.context import Context
from ..gl.context.timers import StageTimers
from ..gl.programs.programs import ProgramLibrary
from ..scene.common.garbage import collector_paused
from ..scene.scene import Scene
from ..scene.settings import DensityEstimation, FirstPhotonHits
from .acceleration.acceleration_structure import AccelerationStructure
from .algorithm import iterate, store_photons, trace_photons
from .common.iteration import LEARNING_ITERATIONS, Iteration, learns_after
from .common.require import require
from .common.viewport_demands import NO_DEMANDS, ViewportDemands
from .deep_cubemap.deep_cubemap import DeepCubemap
from .deep_cubemap.inspection import inspect_deep_cubemap
from .device_scene.device_scene import DeviceScene
from .film.film import Film
from .learning import Learning
from .memory import Memory, compute_memory
from .pilot_view import pilot_footprints
from .stage_set import StageSet
from .state import RenderState, read_state, restore_state


class ProgressivePhotonMapper:
    """One scene being rendered: ``iterate`` improves the film."""

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        self.context = context
        self._library = library
        self.timers = StageTimers(context)
        self.device_scene = DeviceScene(context, library, self.timers)
        self._stages: StageSet | None = None
        self._learning: Learning | None = None
        self.iteration = 0
        """The last that was run, counted from 1."""
        self._skipped = 0
        """So many iterations come before those of the film."""
        self._demands = NO_DEMANDS
        self.build_seconds = 0.0

    def build(self, scene: Scene) -> None:
        """Init(): take a scene, allocate its buffers and build the acceleration structure.

        Raises SettingsError, SceneError or DeviceError, each with its remedy.
        """
        self.device_scene.forget()
        self.update(scene)

    @collector_paused()
    def update(self, scene: Scene, center_tolerance: float = 0.0, demands: ViewportDemands = NO_DEMANDS) -> None:
        """Take another scene like build, but build only what has changed (DeviceScene.update).

        Nobody may change members of the scene before. Raises as build does.
        """
        start = time.perf_counter()
        scene = self.device_scene.acceleration.settled(scene)
        self._begin(scene, demands)
        if self._stages is None:  # before the scene, so that their programs are compiled meanwhile
            self._stages = StageSet(self.context, self._library, scene, demands)
        self.device_scene.update(scene, center_tolerance)
        if demands.traces_rays:
            self.device_scene.resolve.expect_rays(demands.casts_rays)
        context = self.device_scene.context
        self._learning = Learning(context, pilot_footprints(context, self.stages))
        self.build_seconds = time.perf_counter() - start

    def _begin(self, scene: Scene, demands: ViewportDemands = NO_DEMANDS) -> None:
        """Iterations begin anew with a scene."""
        scene.settings.validate()
        if self._stages is not None and not self._stages.fits(scene, demands):
            self._release_stages()
        self._demands = demands
        self.iteration = self._skipped = 0

    def link_programs(self, scene: Scene, demands: ViewportDemands = NO_DEMANDS) -> None:
        """Have those programs made, for the first run of which there is nothing to do yet, that pictures of this size,
        these settings and materials need, but for the materials' own; there is nothing to iterate then. Raises as build
        does."""
        scene = self.device_scene.acceleration.settled(scene)
        self._begin(scene, demands)
        self._stages = StageSet(self.context, self._library, scene, demands)
        self._release_stages()

    def iterate(self) -> None:
        """One iteration of Algorithm 1."""
        for _ in self.steps():
            pass

    def steps(self) -> Iterator[None]:
        """One iteration in steps, for whoever has something to do between them.

        An iteration that is not run to its end leaves the film unfinished: go on with update or build.
        """
        self.iteration += 1
        photons = self.learning.photon_counts.of(self.iteration)
        if self.iteration > 1 and learns_after(self.iteration - 1):
            self.learning.learn(self.device_scene.context, self.iteration - 1)
        seed, shadow_rays = self.scene.settings.seed, self._demands.shadow_rays
        weighs_noise = self.learning.weighs_noise and learns_after(self.iteration)
        iteration = Iteration(self.iteration, seed, photons, self._skipped, shadow_rays, weighs_noise)
        if self.device_scene.moves:
            self.device_scene.move_to(iteration)
            yield
        bands = self.device_scene.motion.iterations_of_bands(self.stages.bands, iteration)
        yield from iterate(self.device_scene.context, self.stages, self.learning, iteration, bands)
        self.context.refuse_lost_memory()

    def skip(self, iterations: int) -> Iterator[None]:
        """Begin after so many iterations, in steps, which are left out of the film: to be said before the first.

        Of these, only those are run that later ones learn from.
        """
        self._skipped = iterations
        while self.iteration < min(iterations, LEARNING_ITERATIONS):
            yield from self.steps()
        if iterations > LEARNING_ITERATIONS:
            self.learning.learn(self.device_scene.context, LEARNING_ITERATIONS)
            self.iteration = iterations

    def state(self) -> RenderState:
        """Return the state that later iterations depend on; to be called between iterations."""
        return read_state(self.stages, self.device_scene.lights, self.learning, self.iteration, self._skipped)

    def resume(self, state: RenderState) -> None:
        """Go on where a mapper was that took the same scene; to be said before the first iteration.

        Raises CheckpointError when the state is none of this scene.
        """
        restore_state(state, self.stages, self.device_scene.lights, self.learning)
        self._skipped, self.iteration = state.skipped, state.iteration

    @property
    def scene(self) -> Scene:
        """With a shutter, as it is at the iteration's moment."""
        return require(self.device_scene.scene)

    @property
    def stages(self) -> StageSet:
        """Stages of the iterations, once a scene was built."""
        return require(self._stages)

    @property
    def learning(self) -> Learning:
        """Learning of the iterations, once a scene was built."""
        return require(self._learning)

    @property
    def film(self) -> Film:
        """Running means of the iterations so far."""
        return self.stages.film

    @property
    def iterations_in_film(self) -> int:
        """Number of iterations in the film's mean."""
        return max(self.iteration - self._skipped, 0)

    def measure_noise(self) -> float:
        """Return the noise of the film's noisiest block (NoiseEstimate.measure); only with use_adaptive_sampling."""
        estimate, exposure = self.stages.noise_estimate, self.scene.exposure
        iteration = Iteration(self.iteration, self.scene.settings.seed, skipped=self._skipped)
        least = self.device_scene.motion.least_exposed(self.stages.bands, iteration)
        context, film = self.device_scene.context, self.film.radiance
        return estimate.measure(context, film, exposure, least.skipped, least.number)

    @property
    def splat_radii(self) -> tuple[float, float]:
        """r_max of the current iteration and the wide radius of global photons, meters."""
        radii = self.learning.radius_schedule.radii(max(self.iteration, 1)).splats
        return radii.narrow, radii.wide

    def photons_emitted(self, iterations: int) -> int:
        """In so many iterations that are in the film."""
        return self.learning.photon_counts.emitted(self._skipped, iterations)

    @property
    def source_watts(self) -> dict[str, float]:
        """Power by light source (Lights.source_watts)."""
        return self.device_scene.lights.source_watts

    @property
    def source_photons(self) -> dict[str, int]:
        """Photons of the current iteration by light source."""
        return self.device_scene.lights.source_photons

    @property
    def density_estimation(self) -> DensityEstimation:
        """The route that photons and importons find each other by."""
        return self.stages.density_estimator.route

    @property
    def first_photon_hits(self) -> FirstPhotonHits:
        """The route by which the last iteration's photons found their first hits."""
        return self.stages.photons.first_hits.route

    @property
    def triangle_count(self) -> int:
        """Triangles of the scene, instances counted each."""
        return self.device_scene.geometry.triangle_count

    @property
    def memory(self) -> Memory:
        """Bytes on the device by group of buffers; before the first iteration lists of photons are short."""
        groups = self.device_scene.memory_bytes | self.stages.memory_groups
        segments = self.scene.settings.photon_bounces + 1
        return compute_memory(groups, self.film.width * self.film.height, self.scene.photon_count, segments)

    @property
    def memory_bytes(self) -> dict[str, int]:
        """Bytes on the device by buffer."""
        memory = self.memory
        return {name: size for sizes in (*memory.working.values(), memory.ppm) for name, size in sizes.items()}

    def lengthen_lists(self) -> None:
        """Give the lists of photons to splat the length that the first iteration needs, which build cannot know."""
        context, iteration = self.device_scene.context, Iteration(1, self.scene.settings.seed, self.scene.photon_count)
        for _ in trace_photons(context, self.stages, iteration):
            pass
        store_photons(context, self.stages, self.learning, iteration)
        self.stages.density_estimator.prepare()

    def flux_balance(self) -> dict[str, float]:
        """Emitted, absorbed, deposited, escaped and lost flux of the last iteration, W (Photons.flux_balance)."""
        return self.stages.photons.flux_balance()

    def read_photons(self) -> np.ndarray:
        """(segments, photons) PHOTON records of the last iteration."""
        return self.stages.photons.read()

    @property
    def acceleration(self) -> AccelerationStructure:
        """Acceleration structure that the scene's rays are traced through."""
        return self.device_scene.acceleration.structure

    @property
    def deep_cubemap(self) -> DeepCubemap:
        """The scene's, where rays are traced through one. Raises TypeError where they are not."""
        if not isinstance(self.acceleration, DeepCubemap):
            raise TypeError("rays are not traced through a deep cubemap")
        return self.acceleration

    def build_deep_cubemap(self, scene: Scene) -> None:
        """Take a scene and build its deep cubemap, to be looked at: nothing can be rendered. Raises as build does."""
        scene = self.device_scene.acceleration.settled(scene)
        self._begin(scene)
        self.device_scene.upload_geometry(scene)

    def inspect_deep_cubemap(self) -> np.ndarray:
        """(height, width, 4) float32 of CUBEMAP_COSTS."""
        return inspect_deep_cubemap(self.context, self._library, self.deep_cubemap, self.scene.camera)

    def _release_stages(self) -> None:
        if self._stages is not None:
            self._stages.release()
            self._stages = None

    def release(self) -> None:
        """Give all buffers back."""
        self._release_stages()
        self.device_scene.release()
