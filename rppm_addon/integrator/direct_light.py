# SPDX-License-Identifier: GPL-3.0-or-later
"""Light straight from the sources, by next-event rays from the camera paths' vertices."""

import moderngl

from ..gl.buffers import GrowingBuffer
from ..gl.context import Context
from ..gl.programs import ProgramLibrary
from ..gl.records import Record
from .emission import LIGHT_PARAMETERS
from .importons import Importons
from .living_paths import LivingPaths
from .records import RAY
from .stages import Stages

Record(
    "DirectLightParameters",
    **LIGHT_PARAMETERS,
    segment="uint",
    first_pixel="uint",
    last_segment="uint",
    specular_alpha="float",
    final_gather="uint",
    gathers_again_below="float",
)


class DirectLight:
    """One sampled light and one shadow ray for every camera path and segment."""

    def __init__(self, context: Context, library: ProgramLibrary, pixels: int) -> None:
        self._sample = library.compute("direct_light/sample.comp")
        self._add = library.compute("direct_light/add.comp")
        self._rays = GrowingBuffer(context, "shadow rays")
        self._contributions = GrowingBuffer(context, "direct light")
        self._visibility = GrowingBuffer(context, "visibility")
        self._triangles = GrowingBuffer(context, "triangles of sampled lights")
        self._living_rays = LivingPaths(context, library, "living shadow rays", "lower the resolution")
        self._living_rays.require(pixels)
        self._rays.require(RAY.size * pixels)
        self._contributions.require(16 * pixels)
        self._visibility.require(4 * pixels)
        self._triangles.require(4 * pixels)

    @property
    def _buffers(self) -> tuple[GrowingBuffer, ...]:
        return self._rays, self._contributions, self._visibility, self._triangles

    @property
    def memory_bytes(self) -> dict[str, int]:
        return {buffer.name: buffer.size for buffer in self._buffers} | self._living_rays.memory_bytes

    def run(
        self,
        stages: Stages,
        importons: Importons,
        first_pixel: int,
        iteration: int,
        segment: int,
        gathers_again_below: float,
        found_radiances: moderngl.Buffer,
    ) -> None:
        """Add the direct light of the resolved vertices of the living camera paths to the band's radiance, or to what
        their gathering rays found.

        To be called before the paths scatter on.
        """
        parameters = stages.emission.parameters(stages.settings.seed, iteration)
        stages.emission.use_maps()
        importons.living.run(
            self._sample,
            {
                **stages.emission.tree_buffers,
                "Closures": importons.closures.buffer,
                "Rays": importons.rays.buffer,
                "CameraPaths": importons.paths.buffer,
                "ShadowRays": self._rays.buffer,
                "Contributions": self._contributions.buffer,
                "LightTriangles": self._triangles.buffer,
                "Materials": stages.materials.buffers["Materials"],
            },
            {
                **parameters,
                "segment": segment,
                "last_segment": segment == stages.settings.camera_path_length - 1,
                "first_pixel": first_pixel,
                "specular_alpha": stages.settings.specular_roughness**2,
                "final_gather": stages.settings.use_final_gather,
                "gathers_again_below": gathers_again_below,
            },
        )
        living = self._living_rays
        living.take(importons.living, self._rays.buffer)
        stages.emission.emitters.tint_contributions(
            stages.resolve, self._rays.buffer, self._triangles.buffer, self._contributions.buffer, living, iteration
        )
        stages.deep_cubemap.occluded(self._rays.buffer, self._visibility.buffer, living)
        living.run(
            self._add,
            {
                "Visibility": self._visibility.buffer,
                "Contributions": self._contributions.buffer,
                "FoundRadiances": found_radiances,
                "Radiances": importons.radiances.buffer,
            },
        )

    def release(self) -> None:
        for buffer in (*self._buffers, self._living_rays):
            buffer.release()
