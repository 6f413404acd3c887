# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects of which the camera sees the shadows only."""

from ...gl.buffers import GrowingBuffer
from ...gl.context import Context
from ...gl.programs import ProgramLibrary
from ...gl.records import Record
from ...scene.scene import Scene
from ..common.band import Band
from ..common.iteration import Iteration
from ..common.records import RAY
from ..device_scene.stage_context import StageContext
from ..lights.lights import LIGHT_PARAMETERS
from .importons import Importons

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
        """Bytes on the device by buffer."""
        return {buffer.name: buffer.size for buffer in (self._rays, self.lit)}

    def cast(self, context: StageContext, importons: Importons, band: Band, iteration: Iteration, segment: int) -> None:
        """Fill ``lit`` for the resolved vertices of the living camera paths, before they scatter on."""
        if not self.present:
            return
        with context.timers.stage("shadow catcher"):
            context.lights.use_maps()
            importons.living.run(
                self._program,
                {
                    **context.lights.buffers,
                    "Closures": importons.closures.buffer,
                    "Rays": importons.rays.buffer,
                    "ShadowRays": self._rays.buffer,
                },
                {**context.lights.parameters(iteration), "segment": segment, "first_pixel": band.first_pixel},
            )
            context.deep_cubemap.occluded(self._rays.buffer, self.lit.buffer, importons.living)

    def release(self) -> None:
        """Give the buffers back."""
        self._rays.release()
        self.lit.release()
