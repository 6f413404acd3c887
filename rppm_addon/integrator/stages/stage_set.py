# SPDX-License-Identifier: GPL-3.0-or-later
"""The stages of an iteration, with buffers for a resolution and a number of photons."""

import moderngl

from ...gl.context import Context
from ...gl.programs import ProgramLibrary
from ...scene.passes import passes_named
from ...scene.scene import Scene
from ..common.band import bands_of
from ..common.camera_view import is_rasterized
from ..density_estimation.caustic_radii import CausticRadii
from ..density_estimation.density_estimator import DensityEstimator
from ..device_scene.stage_context import StageContext
from .direct_light import DirectLight
from .film import Film
from .final_gather import FinalGather
from .gbuffer import GBuffer
from .importons import Importons
from .photons import Photons
from .primary_rays import PrimaryRays
from .shadow_catcher import ShadowCatcher


class StageSet:
    """One object a stage. Scenes that agree in what ``fits`` compares take over each other's buffers."""

    def __init__(self, context: Context, library: ProgramLibrary, scene: Scene) -> None:
        """Raises DeviceError when the device has no room for them."""
        settings = scene.settings
        width, height = scene.camera.resolution
        self._key = _sizes_and_kinds(scene)
        self.bands = bands_of(width, height)
        rows, pixels = self.bands[0].rows, self.bands[0].pixel_count
        self.photons = Photons(context, library, scene.photon_count, settings.photon_path_length)
        self.camera_hits = (
            GBuffer(context, library, width, rows) if is_rasterized(scene.camera) else PrimaryRays(context, library)
        )
        self.importons = Importons(context, library, pixels)
        self.density_estimator = DensityEstimator(context, library, width, rows)
        self.direct_light = DirectLight(context, library, pixels)
        self.final_gather = FinalGather(context, library, pixels)
        self.shadow_catcher = ShadowCatcher(context, library, pixels, scene)
        self.film = Film(context, library, width, height, pixels, passes_named(settings.passes))
        self.caustic_radii = CausticRadii(context, library, width * height)

    def fits(self, scene: Scene) -> bool:
        """Whether a scene can be rendered with these."""
        return self._key == _sizes_and_kinds(scene)

    def clear(self, context: StageContext) -> None:
        """Forget the band before."""
        with context.timers.stage("gbuffer"):
            self.importons.clear()
            self.density_estimator.sums.clear()
            if context.gathers:
                self.final_gather.clear()

    @property
    def scatter_blocks(self) -> dict[str, moderngl.Buffer]:
        """Storage blocks of other stages that importons read and write as they scatter."""
        return {
            "Camera": self.camera_hits.camera,
            "GatheringVertices": self.final_gather.vertices.buffer,
            "LitCatchers": self.shadow_catcher.lit.buffer,
            "RadiusFactors": self.caustic_radii.buffer,
        }

    @property
    def memory_bytes(self) -> dict[str, dict[str, int]]:
        """Bytes on the device by group and buffer."""
        return {
            "photon paths": self.photons.memory_bytes,
            "camera paths": {"visibility buffer": self.camera_hits.memory_bytes} | self.importons.memory_bytes,
            "direct light": self.direct_light.memory_bytes,
            "final gather": self.final_gather.memory_bytes,
            "shadow catcher": self.shadow_catcher.memory_bytes,
            "density estimation": self.density_estimator.memory_bytes,
            "passes": self.film.memory_bytes | self.caustic_radii.memory_bytes,
        }

    def release(self) -> None:
        """Give all buffers back."""
        for stage in (
            self.photons,
            self.camera_hits,
            self.importons,
            self.density_estimator,
            self.direct_light,
            self.final_gather,
            self.shadow_catcher,
            self.film,
            self.caustic_radii,
        ):
            stage.release()


def _sizes_and_kinds(scene: Scene) -> tuple:
    camera, settings = scene.camera, scene.settings
    catchers = any(instance.shadow_catcher for instance in scene.instances)
    sizes = camera.resolution, scene.photon_count, settings.photon_path_length
    return is_rasterized(camera), *sizes, settings.passes, catchers
