# SPDX-License-Identifier: GPL-3.0-or-later
"""Importons: where camera paths take photons."""

import enum

from ....gl.buffers.constants import Constants
from ....gl.buffers.records import Record
from ....gl.buffers.storage_blocks import StorageBlock

IMPORTON = Record(
    "Importon",
    position="vec3",
    radius="float",
    direction="vec3",
    geometric_normal="uint",
    diffuse="vec3",
    diffuse_normal="uint",
    translucent="vec3",
    diffuse_roughness="uint",
    lobe_weight="vec3",
    lobe_kind="uint",
    lobe_f0="vec3",
    lobe_alpha="float",
    lobe_ior="float",
    lobe_normal="uint",
    lobe_anisotropy="uint",
    next="uint",
    gathers="uint",
    shading_normal="uint",
    minimum_radius="float",
    history="uint",
)
"""A camera path vertex where radiance is estimated; radius 0 marks none. Photons that know their footprint count within
a radius of their own between ``minimum_radius`` and ``radius``. The weights already hold
the path's throughput, diffuse and translucent also 1 / pi. ``direction`` points back to the viewer;
``next`` links lists of the splat cubemap; ``gathers`` is a GatherFlag. ``history`` is the
PathHistory of the path as it came, and above as it goes on, which stays when it ends; in the upper bits its depth
(Depths) as it came."""
StorageBlock("Importons", "Importon importons[];")


class GatherFlag(enum.IntFlag):
    """Flags of the photons that an importon gathers; without the first flag it takes all photons."""

    ORIGIN = 1
    """The importon is the origin of its path's final gather, and leaves indirect photons to the ray."""
    HIT = 2
    """The importon is at the end of the ray of a final gather, and its light counts at the origin of that ray."""


IMPORTON_MEDIUM_SHIFT = 2
"""Above the flags, the number of vertices in media of the importon's path, in five bits."""
Constants("ImportonMedia", IMPORTON_MEDIUM_SHIFT=IMPORTON_MEDIUM_SHIFT)
PHOTON_FACTOR_SHIFT = 8
"""Above the flags, what global photons are multiplied by; 0 is 1."""
Constants("PhotonFactor", PHOTON_FACTOR_SHIFT=PHOTON_FACTOR_SHIFT)
Constants("GatherFlags", FINAL_GATHER=GatherFlag)
