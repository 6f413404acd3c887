# SPDX-License-Identifier: GPL-3.0-or-later
"""TraceImportons: camera paths through specular surfaces, and the importons they leave."""

import moderngl
import numpy as np

from ..gl.buffers import GrowingBuffer
from ..gl.context import Context
from ..gl.programs import ProgramLibrary
from ..gl.records import Record
from ..scene.settings import DirectLight
from .emission import LIGHT_PARAMETERS
from .living_paths import LivingPaths
from .records import CAMERA_PATH, CLOSURE, HIT, IMPORTON, RAY
from .stages import Stages

Record(
    "ScatterImportonsParameters",
    **LIGHT_PARAMETERS,
    segment="uint",
    last_segment="uint",
    first_pixel="uint",
    film_transparent="uint",
    next_event="uint",
    final_gather="uint",
    specular_alpha="float",
    radius_scale="float",
    shrinkage="float",
    radius_minimum="float",
    radius_maximum="float",
    radius_by_ray="float",
    most_radius_factor="float",
    gathers_again_below="float",
    photon_flux="float",
)


class Importons:
    """Camera paths of one band and the importon that each leaves in the current segment."""

    def __init__(self, context: Context, library: ProgramLibrary, pixels: int) -> None:
        self._scatter = library.compute("importons/scatter.comp")
        remedy = "lower the resolution"
        self.rays = GrowingBuffer(context, "camera rays", remedy)
        self.hits = GrowingBuffer(context, "camera hits", remedy)
        self.paths = GrowingBuffer(context, "camera paths", remedy)
        self.closures = GrowingBuffer(context, "camera closures", remedy)
        self.importons = GrowingBuffer(context, "importons", remedy)
        self.radiances = GrowingBuffer(context, "band radiance", remedy)
        self.living = LivingPaths(context, library, "living camera paths", remedy)
        self.living.require(pixels, to_keep=True)
        for buffer, size in (
            (self.rays, RAY.size),
            (self.hits, HIT.size),
            (self.paths, CAMERA_PATH.size),
            (self.closures, CLOSURE.size),
            (self.importons, IMPORTON.size),
            (self.radiances, 16),
        ):
            buffer.require(size * pixels)
        self._opaque = np.tile(np.array([0, 0, 0, 1], np.float32), (pixels, 1)).tobytes()

    @property
    def memory_bytes(self) -> dict[str, int]:
        buffers = (self.rays, self.hits, self.paths, self.closures, self.importons, self.radiances)
        return {buffer.name: buffer.size for buffer in buffers} | self.living.memory_bytes

    def begin(self) -> None:
        """Forget the radiance of the band before."""
        self.radiances.buffer.write(self._opaque)

    def trace(self, stages: Stages) -> None:
        """Find what the rays of the segment hit."""
        stages.deep_cubemap.trace(self.rays.buffer, self.hits.buffer, self.living)

    def resolve(self, stages: Stages, iteration: int, segment: int) -> None:
        """Hits to closures."""
        stages.resolve.run(
            self.rays.buffer,
            self.hits.buffer,
            self.closures.buffer,
            self.living,
            iteration,
            segment,
            camera_paths=self.paths.buffer,
        )

    def scatter(
        self,
        stages: Stages,
        camera: moderngl.Buffer,
        first_pixel: int,
        iteration: int,
        segment: int,
        radius_scale: float,
        shrinkage: float,
        limits: tuple[float, float],
        radius_by_ray: float,
        most_radius_factor: float,
        gathers_again_below: float,
        radius_factors: moderngl.Buffer,
        vertices: moderngl.Buffer,
        lit_catchers: moderngl.Buffer,
    ) -> None:
        """Collect emission, leave importons, and set off the specular rays of the next segment."""
        settings = stages.settings
        stages.emission.use_maps()
        self.living.run(
            self._scatter,
            {
                **stages.emission.tree_buffers,
                "Closures": self.closures.buffer,
                "Rays": self.rays.buffer,
                "CameraPaths": self.paths.buffer,
                "Importons": self.importons.buffer,
                "Radiances": self.radiances.buffer,
                "Camera": camera,
                "Materials": stages.materials.buffers["Materials"],
                "GatheringVertices": vertices,
                "LitCatchers": lit_catchers,
                "RadiusFactors": radius_factors,
            },
            {
                **stages.emission.parameters(settings.seed, iteration),
                "segment": segment,
                "last_segment": segment == settings.camera_path_length - 1,
                "first_pixel": first_pixel,
                "film_transparent": settings.film_transparent,
                "next_event": settings.direct_light is DirectLight.RAYS,
                "final_gather": settings.use_final_gather,
                "specular_alpha": settings.specular_roughness**2,
                "radius_scale": radius_scale,
                "shrinkage": shrinkage,
                "radius_minimum": limits[0],
                "radius_maximum": limits[1],
                "radius_by_ray": radius_by_ray,
                "most_radius_factor": most_radius_factor,
                "gathers_again_below": gathers_again_below,
                "photon_flux": stages.emission.photon_flux,
            },
        )

    def footprints(self, count: int) -> np.ndarray:
        """(count,) radii of the importons just left, metres; 0 where there is none."""
        return self.importons.read(IMPORTON.dtype, count)["radius"]

    def release(self) -> None:
        for buffer in (self.rays, self.hits, self.paths, self.closures, self.importons, self.radiances, self.living):
            buffer.release()
