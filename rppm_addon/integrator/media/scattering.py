# SPDX-License-Identifier: GPL-3.0-or-later
"""Scattering of photons and of camera paths by media, on their way between surfaces."""

from ...gl.buffer_sets import ComputeShader, StorageBuffer
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...scene.settings import DirectLight
from ..camera_paths.importons import Importons
from ..common.band import Band
from ..common.stage import Stage
from ..common.stage_sizes import StageSizes, band_pixels
from ..device_scene.stage_context import StageContext
from ..photons.photons import Photons
from .beams import PhotonBeams
from .photon_map import MediumPhotonMap

Record(
    "ScatterInMediaParameters",
    segment="uint",
    least_free_path="float",
    beam_probability="float",
    longest_beam="float",
    has_falloff="uint",
)
Record(
    "ScatterCameraPathsParameters", segment="uint", first_pixel="uint", most_vertices="uint", least_free_path="float"
)
MEDIUM_VERTEX = Record(
    "MediumVertex",
    position="vec3",
    far="float",
    direction="vec3",
    phase_pdf="float",
    throughput="vec3",
    near_normal="uint",
    thickness="vec3",
    far_normal="uint",
    near_loss="float",
    far_loss="float",
    near_height="float",
    far_height="float",
)
"""The ray of a camera path in media, in the current segment, and its vertex there. ``far`` is the length of the ray,
meters, and ``thickness`` the optical thickness of the media along it. ``near_loss`` and ``far_loss`` are the fractions
of the media's scattering that end at the surfaces where the ray begins and ends, whose geometric normals are
``near_normal`` and ``far_normal``; 0 where there is none. Where media do not end at the surface where the ray begins,
as at glass that overlaps milk, the near surface is the one where they did; ``near_height`` and ``far_height`` are the
heights of both ends of the ray above its plane, meters. Where media scatter the path (CameraPath.medium_passing), it
goes on from ``position`` by ``direction`` and ``throughput``; ``phase_pdf`` is that of the direction for MIS with the
environment, 1/sr."""
StorageBlock("MediumVertices", "MediumVertex medium_vertices[];")

_MOST_VERTICES, _MOST_VERTICES_IN_GRIDS = 31, 8
"""Vertices of a camera path in media, behind which it takes photons; and where there are grids, in which rays cost
more."""

_LONGEST_BEAM = 40.0
"""Largest length of a beam over Media.reach. In thin fog of the world photons fly far."""


class MediumScattering(Stage):
    """Stores photons where media scatter them, and sends them on from there; and scatters camera paths.

    A path has one vertex in a segment: in a medium, or at the surface at the end of its ray.
    """

    memory_group = "media"
    remedy = "lower the resolution"
    _vertices = StorageBuffer("vertices of camera paths in media", MEDIUM_VERTEX, band_pixels, block="MediumVertices")
    _scatter_camera_paths = ComputeShader("media/scattering/scatter_camera_paths.comp")
    _leave_vertices = ComputeShader("media/scattering/leave_vertices.comp")
    _scatter = ComputeShader("media/scattering/scatter_photons.comp")

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._takes_emission_by_photons = sizes.features.has_emissive_media
        self._most_vertices = _MOST_VERTICES_IN_GRIDS if sizes.features.has_heterogeneous_media else _MOST_VERTICES

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

    def scatter_camera_paths(
        self,
        context: StageContext,
        importons: Importons,
        beams: PhotonBeams,
        photon_map: MediumPhotonMap,
        band: Band,
        segment: int,
    ) -> None:
        """Choose which of the camera paths whose hits are resolved are scattered by dense media before they come to
        them. Where media emit light, none are: photons alone bring that light to media."""
        if not (self.is_on and context.materials.media.scatter):
            return
        by_rays = context.gathers and context.settings.direct_light is DirectLight.RAYS
        by_photons = photon_map.is_lit_by_specular_surfaces or self._takes_emission_by_photons
        scatters = by_rays and not by_photons
        with context.timers.stage("camera scattering in media"):
            importons.active.run(
                self._scatter_camera_paths,
                {**context.blocks, **importons.blocks, **self.blocks},
                {
                    "segment": segment,
                    "first_pixel": band.first_pixel,
                    "most_vertices": self._most_vertices if scatters else 0,
                    "least_free_path": beams.least_free_path,
                },
            )

    def leave_vertices(self, context: StageContext, importons: Importons) -> None:
        """Send on from their vertices in media the camera paths that were scattered there."""
        if not (self.is_on and context.materials.media.scatter):
            return
        with context.timers.stage("camera scattering in media"):
            importons.active.run(self._leave_vertices, {**context.blocks, **importons.blocks, **self.blocks})
