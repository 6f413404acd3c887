# SPDX-License-Identifier: GPL-3.0-or-later
"""The stages of an iteration, with buffers for a resolution and a number of photons."""

from collections.abc import Iterable

from ..gl.buffer_sets import BufferSet, Part, sum_by_name
from ..gl.context.context import Context
from ..gl.programs.program import Bindable
from ..gl.programs.programs import ProgramLibrary
from ..scene.scene import Scene
from ..scene.settings import FirstCameraHits
from .camera_paths.camera_hits import CameraHits
from .camera_paths.coverage import Coverage
from .camera_paths.final_gather import FinalGather
from .camera_paths.gbuffer import GBuffer
from .camera_paths.importons import Importons
from .camera_paths.primary_rays import PrimaryRays
from .camera_paths.subsurface import Subsurface
from .camera_paths.texel_hits import TexelHits
from .common.band import Band
from .common.iteration import Iteration
from .common.stage import Stage
from .common.stage_sizes import StageSizes
from .common.viewport_demands import NO_DEMANDS, ViewportDemands
from .density_estimation.caustic_radii import CausticRadii
from .density_estimation.density_estimator import DensityEstimator
from .density_estimation.radii import Radii
from .device_scene.stage_context import StageContext
from .direct_light.direct_light import DirectLight
from .direct_light.shadow_catcher import ShadowCatcher
from .film.ambient_occlusion import AmbientOcclusion
from .film.events import BandEvents, Listeners
from .film.film import Film
from .film.light_groups import LightGroups
from .film.light_passes import LightPasses
from .film.noise_estimate import NoiseEstimate
from .film.photon_noise import PhotonNoise
from .media.beams import PhotonBeams
from .media.media import Media
from .media.photon_map import MediumPhotonMap
from .media.scattering import MediumScattering
from .photons.photons import Photons


def _camera_hits(sizes: StageSizes, is_software: bool) -> type[CameraHits]:
    """Return the class of the stage that finds the camera's first hits. Software drivers take longer to draw all
    triangles than to trace a ray for each pixel (docs/benchmarks/moves.md)."""
    if sizes.has_texels:
        return TexelHits
    drawn = FirstCameraHits.RASTERIZED, *(() if is_software else (FirstCameraHits.AUTOMATIC,))
    return GBuffer if sizes.first_camera_hits in drawn else PrimaryRays


class StageSet(BufferSet):
    """One object a stage. Scenes that agree in what ``fits`` compares take over each other's buffers."""

    remedy = "lower the resolution or the photons per iteration"
    photons = Part(Photons)
    importons = Part(Importons)
    density_estimator = Part(DensityEstimator)
    direct_light = Part(DirectLight)
    final_gather = Part(FinalGather)
    shadow_catcher = Part(ShadowCatcher)
    subsurface = Part(Subsurface)
    media = Part(Media)
    medium_scattering = Part(MediumScattering)
    photon_beams = Part(PhotonBeams)
    medium_photons = Part(MediumPhotonMap)
    film = Part(Film)
    light_passes = Part(LightPasses)
    light_groups = Part(LightGroups)
    ambient_occlusion = Part(AmbientOcclusion)
    caustic_radii = Part(CausticRadii)
    noise_estimate = Part(NoiseEstimate)
    photon_noise = Part(PhotonNoise)

    def __init__(
        self, context: Context, library: ProgramLibrary, scene: Scene, demands: ViewportDemands = NO_DEMANDS
    ) -> None:
        """Raises DeviceError when the device has no room for them."""
        self._sizes = StageSizes.of(scene, demands)
        self.refuse_large(context, self._sizes)
        with library.defining(self._sizes.features.defines):
            super().__init__(context, library, self._sizes)
            self.camera_hits: CameraHits = self.own(
                _camera_hits(self._sizes, context.is_software)(context, library, self._sizes)
            )
        self.direct_light.lent_closures = self.photons.closures  # those of photons rest while camera paths are traced
        self.coverage = Coverage(library)
        listeners = (
            *(self.photon_noise, self.film, self.noise_estimate),
            *(self.light_passes, self.light_groups, self.ambient_occlusion),
        )
        self.listeners = Listeners(stage for stage in listeners if stage.is_on)
        """Called for the events of a band, in this order."""
        self.bands = self._sizes.bands

    def fits(self, scene: Scene, demands: ViewportDemands = NO_DEMANDS) -> bool:
        """Whether a scene can be rendered with these."""
        return self._sizes == StageSizes.of(scene, demands)

    def clear(self, context: StageContext) -> None:
        """Forget the band before."""
        with context.timers.stage("gbuffer"):
            self.importons.clear()
            self.density_estimator.sums.clear()
            self.light_passes.clear()
            self.light_groups.clear()
            if context.gathers:
                self.final_gather.clear()

    def blocks_of(self, band: Band) -> dict[str, Bindable]:
        """Storage blocks of the stages that are declared once (BufferSet.blocks), with those of a band."""
        return {
            **self.blocks,
            **self.camera_hits.blocks,
            **self.film.blocks_of(band),
            "RadiusFactors": self.caustic_radii.factors(band),
        }

    def events_of(self, context: StageContext, iteration: Iteration, band: Band, radii: Radii) -> BandEvents:
        """Return the events of a band, with which listeners are called."""
        sums = self.density_estimator.sums
        return BandEvents(context, iteration, band, radii, self.importons, self.direct_light, self.final_gather, sums)

    @property
    def memory_groups(self) -> dict[str, dict[str, int]]:
        """Bytes on the device by group and buffer."""
        stages = [stage for stage, _ in self._owned if isinstance(stage, Stage)]
        return _by_group((stage.memory_group, stage.memory_bytes) for stage in stages)


def expected_groups(sizes: StageSizes) -> dict[str, dict[str, int]]:
    """StageSet.memory_groups as far as it follows from the sizes, before anything is allocated."""
    kinds = [*StageSet.part_kinds(), CameraHits]
    return _by_group((kind.memory_group, kind.expected_bytes(sizes)) for kind in kinds if issubclass(kind, Stage))


def _by_group(parts: Iterable[tuple[str, dict[str, int]]]) -> dict[str, dict[str, int]]:
    groups: dict[str, list[dict[str, int]]] = {}
    for group, sizes in parts:
        groups.setdefault(group, []).append(sizes)
    return {group: sum_by_name(sizes) for group, sizes in groups.items()}
