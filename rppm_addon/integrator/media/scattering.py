# SPDX-License-Identifier: GPL-3.0-or-later
"""Scattering of photons by media, on their way between surfaces."""

from ...gl.buffer_sets import ComputeShader
from ...gl.buffers.records import Record
from ..common.stage import Stage
from ..common.stage_sizes import StageSizes
from ..device_scene.stage_context import StageContext
from ..photons.photons import Photons
from .beams import PhotonBeams

Record(
    "ScatterInMediaParameters",
    segment="uint",
    least_free_path="float",
    beam_probability="float",
    longest_beam="float",
    has_falloff="uint",
)

_LONGEST_BEAM = 40.0
"""Largest length of a beam over Media.reach. In thin fog of the world photons fly far."""


class MediumScattering(Stage):
    """Stores photons where media scatter them, and sends them on from there.

    A photon path has one vertex in a segment: in a medium, or at the surface at the end of its ray.
    """

    memory_group = "media"
    _scatter = ComputeShader("media/scattering/scatter_photons.comp")

    @classmethod
    def is_needed(cls, sizes: StageSizes) -> bool:
        """Stage.is_needed: where materials or the world have a volume."""
        return sizes.features.has_media

    def scatter_photons(
        self, context: StageContext, photons: Photons, beams: PhotonBeams, reach: float, segment: int
    ) -> None:
        """Scatter some of the photons whose rays have been traced, and store their beams; surfaces are to scatter the
        other photons. reach: Media.reach."""
        if not (self.is_on and context.materials.media.scatter):
            return
        with context.timers.stage("photon scattering in media"):
            beams.beams.extend_items(photons.slots)
            photons.active.run(
                self._scatter,
                {**context.blocks, **photons.blocks, **beams.blocks},
                {
                    "segment": segment,
                    "least_free_path": beams.least_free_path,
                    "beam_probability": beams.probability(photons.photon_count),
                    "longest_beam": _LONGEST_BEAM * reach,
                    "has_falloff": context.lights.has_falloff,
                },
            )
