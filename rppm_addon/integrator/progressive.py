# SPDX-License-Identifier: GPL-3.0-or-later
"""Rasterization-based progressive photon mapping: the paper's Algorithm 1."""

import contextlib
import itertools
import logging
import math
import time
from collections.abc import Iterator

import numpy as np

from ..gl.context import Context
from ..gl.programs import ProgramLibrary
from ..gl.timers import StageTimers
from ..materials.tables import MaterialTables
from ..scene.errors import CheckpointError
from ..scene.garbage import collector_paused
from ..scene.moving_scene import MovingScene
from ..scene.passes import passes_named
from ..scene.scene import Scene
from ..scene.settings import DensityEstimation, FirstPhotonHits
from ..scene.settings import DirectLight as DirectLightMode
from .bands import bands_of
from .bandwidth import (
    EXPECTED_BY_RAY,
    EXPECTED_PHOTONS,
    fitted_wide_radius,
    most_radius_factor,
    photons_found,
    photons_found_by_ray,
    radius_by_ray,
    radius_in_pixels,
    radius_limits,
    shrinkage,
    wide_radius,
    widest_radius,
)
from .camera_view import camera_view, is_rasterized
from .caustic_radii import CausticRadii
from .changes import Changes, changes_between, snapshot
from .deep_cubemap import DeepCubemap
from .density_estimator import DensityEstimator
from .direct_light import DirectLight
from .emission import Emission
from .film import Film
from .final_gather import FinalGather
from .gbuffer import GBuffer, filter_offsets
from .geometry import Geometry
from .guide import LEARNING_ITERATIONS, learns_after
from .importons import Importons
from .inspection import inspect_deep_cubemap
from .memory import Memory, reckon_memory
from .overview import FEWEST_HITS, at_pixels, overview_sizes, overviews
from .photon_counts import PhotonCounts, later_photons
from .photons import Photons
from .placement import cubemap_centres, radius_about
from .primary_rays import PrimaryRays
from .resolve import Resolve
from .shadow_catcher import ShadowCatcher
from .shutter import moment, swept_bounds
from .splat_sums import radiance_quantum
from .stages import Stages
from .state import RenderState
from .stored_photons import CameraRaster, SplatRadii, StoredPhotons, TakingImportons

log = logging.getLogger(__name__)

_MOST_CORE_TRIANGLES = 64
CORNER_RADII = 2.0
"""A gathering ray of at most so many wide radii ends in a corner."""
_NOWHERE = (np.full(3, np.inf), np.full(3, -np.inf))


class ProgressivePhotonMapper:
    """One scene being rendered: ``iterate`` improves the film."""

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        self.context = context
        self._library = library
        self.timers = StageTimers(context)
        self._geometry = Geometry(context, library)
        self._materials = MaterialTables(context, library)
        self._emission = Emission(context, library)
        # Where no unit rasterizes that takes two to three times as long, and trying it most of the first build.
        self._deep_cubemap = DeepCubemap(context, library, rasterize=False if context.is_software else None)
        self._resolve = Resolve(context, library)
        self.iteration = 0
        """The last that was run, counted from 1."""
        self._left_out = 0
        """So many iterations come before those of the film."""
        self.build_seconds = 0.0
        self.scene: Scene | None = None
        """With a shutter, as it is at the iteration's moment."""
        self._given: Scene | None = None
        """The scene, its shutter included."""
        self._built: Scene | None = None
        """What stands on the device; None is nothing that a change could be told from."""
        self._warnings: dict[str, list[str]] = {}
        """What was said when a part was built, which holds for scenes after it as well."""
        self._moving: MovingScene | None = None
        self._swept = _NOWHERE
        """What things move through while the shutter is open (swept_bounds)."""
        self._wanted_centre = np.full(3, np.nan)
        self._views: list = []
        self._views_are_for: tuple | None = None
        self._wide_radius = 0.0
        self._photon_counts = PhotonCounts(0, 0)
        self._diffused_photons_found: float | None = None
        """What photons_found, or photons_found_by_ray, says of the last iteration, if they were counted."""

    def build(self, scene: Scene) -> None:
        """Init(): take a scene, allocate its buffers and build the deep cubemap.

        Raises SettingsError, SceneError or DeviceError, each with its remedy.
        """
        self._built = None
        self.update(scene)

    @collector_paused()
    def update(self, scene: Scene, stray: float = 0.0) -> None:
        """Take another scene like build, but build only what rests on members that are not the very objects of the
        scene before; so nobody may change those.

        stray: how far from where the deep cubemap's centre should be it may stay, in radii of the scene, which changes
        no picture. Raises as build does; what is built then is built anew the next time.
        """
        start = time.perf_counter()
        scene.settings.validate()
        changes = changes_between(self._built, scene)
        self._built = None
        self._restart(scene)
        self._moving = MovingScene(scene) if scene.shutter is not None else None
        swept = swept_bounds(scene) if scene.shutter is not None else _NOWHERE
        changes.geometry |= not np.array_equal(swept, self._swept)
        self._swept = swept
        self._build_parts(changes)
        wanted = next(cubemap_centres(scene, self._geometry))
        strayed = not np.linalg.norm(wanted - self._wanted_centre) <= stray * self._geometry.radius
        if changes.geometry or changes.cubemap or strayed:
            self._build_deep_cubemap()
        for text in itertools.chain(*self._warnings.values()):
            scene.warn(text)
        self._open_views()
        self._built = snapshot(scene)
        self.build_seconds = time.perf_counter() - start

    def _build_parts(self, changes: Changes, keep_learned: bool = False) -> None:
        """What rests on the scene's members that have changed, but for the deep cubemap.

        keep_learned: go on with what was learned of the lights.
        """
        scene = self.scene
        self._materials.follow(scene)
        if changes.materials:
            with self._hearing("materials"):
                self._materials.build(scene)
        if changes.geometry:
            self._geometry.build(scene, self._materials.default_material, self._swept)
        if changes.geometry or changes.materials:
            with self._hearing("resolve"):
                self._resolve.build(scene, self._geometry, self._materials)
        self._resolve.look_from(scene.camera, scene.settings.seed)
        if changes.geometry or changes.materials or changes.lights:
            if self._views:
                self._photons.first_hits.forget()
            with self._hearing("emission"):
                self._emission.build(
                    scene,
                    self._geometry,
                    self._materials,
                    self._resolve,
                    self._photon_count,
                    not changes.world,
                    not changes.lamps,
                    keep_learned,
                )
        elif not keep_learned:
            self._emission.begin(self._photon_count)

    def _move(self) -> None:
        """Take the scene as it is at the iteration's moment, and build anew what rests on what has moved.

        The deep cubemap's centre stays: it changes no picture, and a camera that moves alone costs nothing.
        """
        given = self._given
        self.scene = self._moving.at(given.shutter.time_of(moment(self.iteration, given.settings.seed)))
        changes = changes_between(self._built, self.scene)
        self._built = None
        with self.timers.stage("motion"):
            self._build_parts(changes, keep_learned=True)
        if changes.geometry:
            self._build_deep_cubemap()
        self._built = snapshot(self.scene)

    @contextlib.contextmanager
    def _hearing(self, part: str) -> Iterator[None]:
        """Keep what is said while a part is built."""
        before, self.scene.warnings = self.scene.warnings, []
        try:
            yield
            self._warnings[part] = self.scene.warnings
        finally:
            self.scene.warnings = before

    def _open_views(self) -> None:
        """What the camera's side of an iteration needs, for the scene's camera and settings."""
        camera, settings = self.scene.camera, self.scene.settings
        if not self._views:
            self._make_views()
        self._stages = Stages(
            settings, self._geometry, self._materials, self._emission, self._deep_cubemap, self._resolve, self.timers
        )
        self._radius_scale = radius_in_pixels(settings, camera)
        self._most_radius_factor = most_radius_factor(settings)
        footprints = self._first_footprints()
        self._leaves_importon = footprints > 0
        self._limits = radius_limits(settings, footprints, self._geometry.radius)
        self._widest_radius = widest_radius(footprints, self._geometry.bounds_low, self._geometry.bounds_high)

    def _make_views(self) -> None:
        camera, settings = self.scene.camera, self.scene.settings
        width, height = camera.resolution
        self._bands = bands_of(width, height)
        rows = self._bands[0][1]
        self._photons = Photons(self.context, self._library, self.scene.photon_count, settings.photon_path_length)
        self._gbuffer = (
            GBuffer(self.context, self._library, width, rows)
            if is_rasterized(camera)
            else PrimaryRays(self.context, self._library)
        )
        self._importons = Importons(self.context, self._library, width * rows)
        self._density_estimator = DensityEstimator(self.context, self._library, width, rows)
        self._direct_light = DirectLight(self.context, self._library, width * rows)
        self._final_gather = FinalGather(self.context, self._library, width * rows)
        self._shadow_catcher = ShadowCatcher(self.context, self._library, width * rows, self.scene)
        self.film = Film(self.context, self._library, width, height, passes_named(settings.passes))
        self._caustic_radii = CausticRadii(self.context, self._library, width * height)
        self._views = [
            self._photons,
            self._gbuffer,
            self._importons,
            self._density_estimator,
            self._direct_light,
            self._final_gather,
            self._shadow_catcher,
            self.film,
            self._caustic_radii,
        ]
        self._views_are_for = _views_for(self.scene)

    def _restart(self, scene: Scene) -> None:
        """Forget the picture: iterations begin anew with a scene."""
        if self._views_are_for != _views_for(scene):
            self._release_views()
        self.iteration = self._left_out = 0
        self._diffused_photons_found = None
        self._wide_radius = 0.0
        self._photon_counts = PhotonCounts(scene.photon_count, scene.photon_count)
        self.scene = self._given = scene

    def _build_deep_cubemap(self) -> None:
        """Where few triangles touch the centre: those are tested by every ray that passes it."""
        centres = list(cubemap_centres(self._given, self._geometry))
        self._wanted_centre = centres[0]
        with self.timers.stage("deep cubemap"):
            for centre in centres:
                self.centre = centre
                self._deep_cubemap.build(
                    self._geometry.triangles.buffer,
                    self._geometry.triangle_count,
                    centre,
                    radius_about(centre, self._geometry),
                    self.scene.settings.cubemap_resolution,
                )
                if self._deep_cubemap.counts["core"] <= _MOST_CORE_TRIANGLES:
                    return

    def iterate(self) -> None:
        """One iteration of Algorithm 1."""
        for _ in self.steps():
            pass

    def steps(self) -> Iterator[None]:
        """One iteration in steps, for whoever has something to do between them.

        An iteration that is not run to its end leaves the film unfinished: go on with update or build.
        """
        self.iteration += 1
        if self.iteration > 1 and learns_after(self.iteration - 1):
            with self.timers.stage("learning"):
                self._learn()
        if self._moving is not None:
            self._move()
            yield
        self._trace_photons()
        diffused_photons: list[np.ndarray] = []
        yield
        for first_row, rows in self._bands:
            self._direct_camera_hits(first_row, rows)
            yield
            for segment in range(self.scene.settings.camera_path_length):
                if segment > 0 and not self._any_path_lives():
                    break
                self._trace_importons(segment)
                yield
                self._catch_shadows(segment)
                self._add_direct_light(segment)
                yield
                self._scatter_importons(
                    self.iteration, segment, self._shrinkage, self._limits, self._most_radius_factor
                )
                # Photons are projected onto the camera's view only where it is a raster.
                if segment == 0 and self._gbuffer.rasterizes:
                    self._direct_splatting()
                else:
                    self._indirect_splatting(segment)
                yield
            if self._enters_film:
                if self._gathers:
                    self._share_gathered_light()
                self._update_film()
            if self._density_estimator.sums.counting:
                diffused_photons.append(self._density_estimator.sums.photons_taken(self._count)[:, 0])
                self._narrow_caustic_radii()
        if self.iteration <= LEARNING_ITERATIONS:
            with self.timers.stage("learning"):
                self._tally(diffused_photons)
        yield

    def leave_out(self, iterations: int) -> Iterator[None]:
        """Begin after so many iterations, in steps, which are left out of the film: to be said before the first.

        Of these, only those are run that later ones learn from.
        """
        self._left_out = iterations
        while self.iteration < min(iterations, LEARNING_ITERATIONS):
            yield from self.steps()
        if iterations > LEARNING_ITERATIONS:
            self.iteration = LEARNING_ITERATIONS + 1
            self._learn()
            self.iteration = iterations

    @property
    def iterations_in_film(self) -> int:
        return max(self.iteration - self._left_out, 0)

    @property
    def _enters_film(self) -> bool:
        return self.iteration > self._left_out

    def state(self) -> RenderState:
        """What iterations to come rest on; to be asked for between iterations."""
        return RenderState(
            left_out=self._left_out,
            iteration=self.iteration,
            photon_counts=self._photon_counts,
            wide_radius=self._wide_radius,
            diffused_photons_found=self._diffused_photons_found,
            radiance=self.film.read_radiance(),
            passes=self.film.read_passes(),
            pass_counts=self.film.read_pass_counts(),
            radius_factors=self._caustic_radii.read().reshape(self.film.height, self.film.width),
            tallies=self._emission.guide.read_tallies(),
            learnt=self._emission.guide.learnt,
        )

    def resume(self, state: RenderState) -> None:
        """Go on where a mapper was that took the same scene; to be said before the first iteration.

        Raises CheckpointError when the state is none of this scene.
        """
        shape = (self.film.height, self.film.width)
        if state.radiance.shape[:2] != shape:
            raise CheckpointError(
                f"the checkpoint has {state.radiance.shape[1]}x{state.radiance.shape[0]} pixels, "
                f"not {shape[1]}x{shape[0]}; begin anew"
            )
        try:
            self._emission.restore(state.tallies, state.learnt, state.photon_counts.later)
        except ValueError as error:
            raise CheckpointError(f"the checkpoint is none of this scene's: {error}; begin anew") from error
        try:
            self.film.restore(state.radiance, state.passes, state.pass_counts)
        except KeyError as error:
            raise CheckpointError(f"the checkpoint has no pass {error}; begin anew") from error
        self._caustic_radii.restore(state.radius_factors)
        self._left_out, self.iteration = state.left_out, state.iteration
        self._photon_counts = state.photon_counts
        self._wide_radius, self._diffused_photons_found = state.wide_radius, state.diffused_photons_found

    @property
    def _gathers(self) -> bool:
        return self.scene.settings.use_final_gather and self.scene.settings.camera_path_length > 1

    @property
    def _expected(self) -> int:
        return EXPECTED_BY_RAY if self._gathers else EXPECTED_PHOTONS

    @property
    def splat_radii(self) -> tuple[float, float]:
        """r_max of the current iteration and the wide radius of diffused photons, metres."""
        return self._limits[1] * self._shrinkage, self._wide_radius * self._shrinkage

    @property
    def _photon_count(self) -> int:
        """Photons of the current iteration."""
        return self._photon_counts.of(self.iteration)

    def photons_emitted(self, iterations: int) -> int:
        """In so many iterations that are in the film."""
        return self._photon_counts.emitted(self._left_out, iterations)

    @property
    def source_watts(self) -> dict[str, float]:
        """Power by light source (Emission.source_watts)."""
        return self._emission.source_watts

    @property
    def source_photons(self) -> dict[str, int]:
        """Photons of the current iteration by light source."""
        return self._emission.source_photons

    @property
    def density_estimation(self) -> DensityEstimation:
        """The route that photons and importons find each other by."""
        return self._density_estimator.route

    @property
    def first_photon_hits(self) -> FirstPhotonHits:
        """The route by which the last iteration's photons found their first hits."""
        return self._photons.first_hits.route

    @property
    def triangle_count(self) -> int:
        return self._geometry.triangle_count

    @property
    def memory(self) -> Memory:
        """Bytes on the device by group of buffers; before the first iteration lists of photons are short."""
        groups = {
            "scene": self._geometry.memory_bytes | self._materials.memory_bytes | self._emission.memory_bytes,
            "deep cubemap": self._deep_cubemap.memory_bytes,
            "photon paths": self._photons.memory_bytes,
            "resolve": self._resolve.memory_bytes,
            "camera paths": {"visibility buffer": self._gbuffer.memory_bytes} | self._importons.memory_bytes,
            "direct light": self._direct_light.memory_bytes,
            "final gather": self._final_gather.memory_bytes,
            "shadow catcher": self._shadow_catcher.memory_bytes,
            "density estimation": self._density_estimator.memory_bytes,
            "passes": self.film.memory_bytes | self._caustic_radii.memory_bytes,
        }
        segments = self.scene.settings.photon_path_length
        return reckon_memory(groups, self.film.width * self.film.height, self.scene.photon_count, segments)

    @property
    def memory_bytes(self) -> dict[str, int]:
        """Bytes on the device by buffer."""
        memory = self.memory
        return {name: size for sizes in (*memory.working.values(), memory.ppm) for name, size in sizes.items()}

    def lengthen_lists(self) -> None:
        """Give the lists of photons to splat the length that the first iteration needs, which build cannot know."""
        self.iteration = 1
        self._trace_photons()
        self._density_estimator.prepare()
        self.iteration = 0

    def flux_balance(self) -> dict[str, float]:
        """Emitted, absorbed, deposited, escaped and lost flux of the last iteration, W (Photons.flux_balance)."""
        return self._photons.flux_balance()

    @property
    def deep_cubemap(self) -> DeepCubemap:
        return self._deep_cubemap

    def build_deep_cubemap(self, scene: Scene) -> None:
        """Take a scene and build what rays need, to be looked at: nothing can be rendered. Raises as build does."""
        scene.settings.validate()
        self._built = None
        self._restart(scene)
        self._materials.build(scene)
        self._geometry.build(scene, self._materials.default_material)
        self._build_deep_cubemap()

    def inspect_deep_cubemap(self) -> np.ndarray:
        """(height, width, 4) float32 of CUBEMAP_COSTS."""
        return inspect_deep_cubemap(self.context, self._library, self._deep_cubemap, self.scene.camera)

    def read_photons(self) -> np.ndarray:
        """(segments, photons) PHOTON records of the last iteration."""
        return self._photons.read()

    @property
    def _gathers_again_below(self) -> float:
        """Metres; a gathering ray shorter than this does not end the search."""
        return CORNER_RADII * self._wide_radius * self._shrinkage

    @property
    def _shrinkage(self) -> float:
        return shrinkage(max(self.iteration, 1), self.scene.settings.alpha)

    def _first_footprints(self) -> np.ndarray:
        """(rows, columns) Eq. 3 radii of the camera's first hits, metres; 0 where there is no importon."""
        for columns, rows in overview_sizes(self.film.width, self.film.height):
            footprints = []
            for view in overviews(self.scene.camera, columns, rows, self._bands[0][1]):
                self._begin_band(view, 0, 0)
                self._importons.resolve(self._stages, 0, 0)
                self._scatter_importons(0, 0, 1.0, (0.0, 1e30), 1.0)
                footprints.append(self._importons.footprints(self._count))
            look = np.concatenate(footprints).reshape(rows, columns)
            if np.count_nonzero(look) >= FEWEST_HITS:
                break
        return look

    def _trace_photons(self) -> None:
        """DirectPhotonHits and TracePhotons."""
        self._photons.run(self._stages, self.iteration, self._photon_count)
        # With next-event rays direct photons would count direct light twice.
        settings, estimator = self.scene.settings, self._density_estimator
        indirect_only = settings.direct_light is DirectLightMode.RAYS
        listed = estimator.photon_list
        with self.timers.stage("photon list"):
            listed.collect(
                self._photons.photons.buffer, self._photons.photon_count * self._photons.segments, indirect_only
            )
        if self.iteration == 1:
            by_photons = listed.count - listed.diffused_count if self._gathers else listed.count
            self._count_photons(by_photons, listed.count)
            spread = wide_radius(
                listed.diffused_count, self._expected, self._geometry.bounds_low, self._geometry.bounds_high
            )
            self._wide_radius = min(spread, self._widest_radius)
        radii = SplatRadii(*self.splat_radii, self._most_radius_factor)
        estimator.sums.count_in(
            radiance_quantum(self._emission.photon_flux, max(radii.caustic, radii.wide)),
            self._roulette_seed() if settings.use_splat_roulette else 0,
            learns_after(self.iteration),
        )
        bounds = self._geometry.bounds_low, self._geometry.bounds_high
        photons = StoredPhotons(
            self._photons.photons.buffer,
            listed.buffer,
            listed.count,
            listed.count - listed.diffused_count,
            listed.diffused_count,
            self._photons.world_radiances.buffer,
            self._photon_count,
            self._emission.photon_flux,
            radii,
            float(np.max(np.abs(bounds))),
        )
        estimator.begin(settings.density_estimation, photons)

    def _count_photons(self, by_photons: int, listed: int) -> None:
        """Set how many photons later iterations have, by what the first one stored."""
        if self.scene.settings.photons == 0:
            first, pixels = self._photon_counts.first, self.film.width * self.film.height
            self._photon_counts = PhotonCounts(first, later_photons(first, pixels, by_photons, listed))

    def _tally(self, diffused_photons: list[np.ndarray]) -> None:
        """Of what use the iteration's photons were, and how many diffused ones pixels found, (pixels,) by band."""
        self._emission.tally(self._photons.photons.buffer, self._photons.segments)
        self._diffused_photons_found = None
        if diffused_photons:
            counts = np.concatenate(diffused_photons)
            counts = counts[at_pixels(self._leaves_importon, self.film.width, self.film.height)]
            self._diffused_photons_found = photons_found_by_ray(counts) if self._gathers else photons_found(counts)

    def _learn(self) -> None:
        """From the iterations before: where photons are of use, and how many diffused ones pixels find."""
        gain = self._emission.learn(self._photon_count)
        shrunk = self._wide_radius * shrinkage(self.iteration - 1, self.scene.settings.alpha)
        # Few photons make bold promises: the radius is at most halved before they are kept.
        fitted = fitted_wide_radius(shrunk, self._expected, self._diffused_photons_found) / math.sqrt(min(gain, 4.0))
        self._wide_radius = min(fitted, self._widest_radius)
        self._diffused_photons_found = None

    def _roulette_seed(self) -> int:
        """Odd, so never 0, and another one for each iteration and seed."""
        return (2 * (self.iteration + 0x9E3779B1 * self.scene.settings.seed) + 1) % (1 << 32)

    def _begin_band(self, view: np.ndarray, first_row: int, iteration: int) -> None:
        self._count = int(view["width"][0] * view["height"][0])
        self._rows = int(view["height"][0])
        self._first_pixel = first_row * self.film.width
        self._importons.living.fill(self._count)
        self._gbuffer.run(self._stages, self._importons, view, self._first_pixel, iteration)

    def _direct_camera_hits(self, first_row: int, rows: int) -> None:
        """DirectCameraHits of a band of rows."""
        offset = filter_offsets(self.iteration, self.scene.settings.filter_width, self.scene.settings.seed)
        view = camera_view(self.scene.camera, first_row, rows, offset)
        with self.timers.stage("gbuffer"):
            self._importons.begin()
            self._density_estimator.sums.begin()
            if self._gathers:
                self._final_gather.begin()
            self._begin_band(view, first_row, self.iteration)

    def _any_path_lives(self) -> bool:
        """List the camera paths that go on; False where it is known that there are none."""
        with self.timers.stage("camera tracing"):
            self._importons.living.keep(self._importons.rays.buffer)
        return not self._importons.living.known_empty

    def _trace_importons(self, segment: int) -> None:
        if segment > 0:
            with self.timers.stage("camera tracing"):
                self._importons.trace(self._stages)
        with self.timers.stage("camera resolve"):
            self._importons.resolve(self._stages, self.iteration, segment)
        if self._enters_film:
            self.film.add_passes(
                self._gbuffer.camera,
                self._geometry,
                self._importons,
                self._first_pixel,
                self.iterations_in_film,
                segment,
            )

    def _scatter_importons(
        self, iteration: int, segment: int, shrink: float, limits: tuple[float, float], most_radius_factor: float
    ) -> None:
        with self.timers.stage("camera scattering"):
            self._importons.scatter(
                self._stages,
                self._gbuffer.camera,
                self._first_pixel,
                iteration,
                segment,
                self._radius_scale,
                shrink,
                limits,
                radius_by_ray(limits[1], self._wide_radius) * shrink,
                most_radius_factor,
                self._gathers_again_below,
                self._caustic_radii.buffer,
                self._final_gather.vertices.buffer,
                self._shadow_catcher.lit.buffer,
            )

    def _add_direct_light(self, segment: int) -> None:
        if self.scene.settings.direct_light is not DirectLightMode.RAYS or not self._enters_film:
            return
        with self.timers.stage("direct light"):
            self._direct_light.run(
                self._stages,
                self._importons,
                self._first_pixel,
                self.iteration,
                segment,
                self._gathers_again_below,
                self._final_gather.radiances.buffer,
            )

    def _catch_shadows(self, segment: int) -> None:
        if self._shadow_catcher.present:
            with self.timers.stage("shadow catcher"):
                self._shadow_catcher.run(self._stages, self._importons, self._first_pixel, self.iteration, segment)

    def _taking_importons(self, segment: int, raster: CameraRaster | None = None) -> TakingImportons:
        """Those of a segment, from which the gathering ray is the next."""
        return TakingImportons(
            self._importons.importons.buffer,
            self._importons.living,
            gathers=segment == 0 and self._gathers,
            by_ray=segment > 0 and self._gathers,
            most_scattered=max(self.scene.settings.camera_path_length - segment - 2, 0),
            raster=raster,
            centre=self.centre,
        )

    def _direct_splatting(self) -> None:
        raster = CameraRaster(self._gbuffer.camera, self.film.width, self._rows)
        with self.timers.stage("direct splatting"):
            self._density_estimator.estimate(self._taking_importons(0, raster))

    def _indirect_splatting(self, segment: int) -> None:
        with self.timers.stage("indirect splatting"):
            self._density_estimator.estimate(self._taking_importons(segment))

    def _narrow_caustic_radii(self) -> None:
        """Where the band's pixels took many photons."""
        with self.timers.stage("learning"):
            self._caustic_radii.narrow(
                self._density_estimator.sums,
                self._count,
                self._first_pixel,
                self.iteration,
                self._most_radius_factor,
                self._shrinkage,
                self._photon_counts.of(self.iteration + 1) / self._photon_count,
            )

    def _share_gathered_light(self) -> None:
        """What the gathering rays found, to the pixels that they left from and to those around."""
        with self.timers.stage("final gather"):
            self._final_gather.run(
                self._density_estimator.sums,
                self._importons.radiances.buffer,
                self._count,
                self.film.width,
                self._first_pixel,
                self._radius_scale / math.sqrt(math.pi) * self._shrinkage,
                self.scene.settings.seed,
                self.iteration,
            )

    def _update_film(self) -> None:
        """UpdatePPMParams; the radii follow from the iteration's number (Eq. 2)."""
        with self.timers.stage("film"):
            self.film.add(
                self._importons.radiances.buffer,
                self._density_estimator.sums,
                self._count,
                self._first_pixel,
                self.iterations_in_film,
            )

    def _release_views(self) -> None:
        for view in self._views:
            view.release()
        self._views = []
        self._views_are_for = None

    def release(self) -> None:
        """Give all buffers back."""
        self._release_views()
        for part in (self._geometry, self._materials, self._emission, self._deep_cubemap, self._resolve):
            part.release()


def _views_for(scene: Scene) -> tuple:
    """What the sizes and kinds of the camera's side depend on: scenes that agree in it take over the buffers."""
    camera, settings = scene.camera, scene.settings
    catchers = any(instance.shadow_catcher for instance in scene.instances)
    sizes = camera.resolution, scene.photon_count, settings.photon_path_length
    return is_rasterized(camera), *sizes, settings.passes, catchers
