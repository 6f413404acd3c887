# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects of which the camera sees the shadows only."""

from ..gl.buffers import GrowingBuffer
from ..gl.context import Context
from ..gl.programs import ProgramLibrary
from ..gl.records import Record
from ..scene.scene import Scene
from .emission import LIGHT_PARAMETERS
from .importons import Importons
from .records import RAY
from .stages import Stages

Record("ShadowCatcherParameters", **LIGHT_PARAMETERS, segment="uint", first_pixel="uint")


class ShadowCatcher:
    """One shadow ray from each catcher that a camera path meets, to a light chosen by what it would give without
    shadows: ``lit`` is then 1 as often as the share of the light that arrives. Light that other surfaces send is left
    out. Without catchers nothing is run."""

    def __init__(self, context: Context, library: ProgramLibrary, pixels: int, scene: Scene) -> None:
        self.present = any(instance.shadow_catcher for instance in scene.instances)
        self._program = library.compute("shadow_catcher/cast.comp") if self.present else None
        self._rays = GrowingBuffer(context, "rays from shadow catchers", "lower the resolution")
        self.lit = GrowingBuffer(context, "lit shadow catchers", "lower the resolution")
        if self.present:
            self._rays.require(RAY.size * pixels)
            self.lit.require(4 * pixels)

    @property
    def memory_bytes(self) -> dict[str, int]:
        return {buffer.name: buffer.size for buffer in (self._rays, self.lit)}

    def run(self, stages: Stages, importons: Importons, first_pixel: int, iteration: int, segment: int) -> None:
        """Fill ``lit`` for the resolved vertices of the living camera paths, before they scatter on."""
        stages.emission.use_maps()
        importons.living.run(
            self._program,
            {
                **stages.emission.buffers,
                "Closures": importons.closures.buffer,
                "Rays": importons.rays.buffer,
                "ShadowRays": self._rays.buffer,
            },
            {
                **stages.emission.parameters(stages.settings.seed, iteration),
                "segment": segment,
                "first_pixel": first_pixel,
            },
        )
        stages.deep_cubemap.occluded(self._rays.buffer, self.lit.buffer, importons.living)

    def release(self) -> None:
        self._rays.release()
        self.lit.release()
