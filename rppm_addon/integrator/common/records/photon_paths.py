# SPDX-License-Identifier: GPL-3.0-or-later
"""Photon paths, and the flags of photons."""

import enum

from ....gl.buffers.constants import Constants
from ....gl.buffers.records import Record
from ....gl.buffers.storage_blocks import StorageBlock
from ....scene.settings import CausticKind

PHOTON_PATH = Record(
    "PhotonPath",
    flux="vec3",
    flags="uint",
    depth="uint",
    escaped="float",
    deposited="float",
    bounce_counts="uint",
)
"""Flux that a photon path carries along its current ray, zero once the path has ended, and its flags
(PhotonFlag) with the volumes it is in (materials/medium.glsl); its ``depth`` (Depths); and of its flux, W summed over
the channels, what left the scene and what it still carried to the vertex at which a limit cut it off. ``bounce_counts``
tell how often lobes of each type have scattered it since the surface that its light lit first
(shaders/common/bounce_counts.glsl); they are 0 where nobody asks. Their fourth count is
of vertices in media, with FIRST_MEDIUM_LIT and HIDDEN_FROM_MEDIA."""
StorageBlock("PhotonPaths", "PhotonPath photon_paths[];")
StorageBlock("Emitted", "PhotonPath emitted[];")
"""Paths as they left their lights."""
PHOTON_ORIGIN = Record("PhotonOrigin", radiance="float", max_bounces="uint", light_group="uint")
"""The radiance of the world where a photon comes from, W/(m^2 sr), the largest channel; 0 for photons of other lights.
And the light's ``max_bounces``: how often what it lights may have scattered on the way to the camera; and the number of
its ``light_group``, where these have passes."""
StorageBlock("PhotonOrigins", "PhotonOrigin photon_origins[];")
DEPTH_BITS = 11
"""Bits of the number of bounces in a depth, and of that of transparent surfaces above it."""
Constants("Depths", DEPTH_BITS=DEPTH_BITS)
CAUSTIC_SHIFT = 2 * DEPTH_BITS
"""Place of the CausticKind in the depth of a photon and of its path, above both numbers."""
Constants("CausticKinds", CAUSTIC=CausticKind, CAUSTIC_SHIFT=CAUSTIC_SHIFT)


class PhotonFlag(enum.IntFlag):
    """Flags of photons and of their paths, which have the low ten bits (materials/medium.glsl)."""

    ACTIVE = 1
    STORED = 2
    ESCAPED = 4
    AFTER_ROUGH_BOUNCE = 8
    """A diffuse or rough surface has scattered the path before."""
    INDIRECT = 16
    """A surface that stores photons has scattered the path."""
    DIRECT = 32
    """Nothing has scattered it, but for objects that cast no shadow."""
    NOT_DIFFUSE = 64
    """While it is direct: from a light that diffuse events do not see."""
    NOT_GLOSSY = 128
    NOT_TRANSMITTED = 256
    CASTS_SHADOWS = 512
    """Nothing but transparency lies between it and its light, which is not the world."""


class PhotonHistory(enum.IntFlag):
    """Further flags, in a photon where its path has NOT_GLOSSY and NOT_TRANSMITTED, which stored photons do not need;
    in a path PHOTON_HISTORY_SHIFT bits lower, where a photon has ACTIVE and STORED."""

    SCATTERED_BY_LOBE = 128
    """A lobe that is not diffuse was the last to scatter the path."""
    CAUSTIC = 256
    """A diffuse surface has scattered what had come by such a lobe."""


Constants("PhotonFlags", PHOTON=PhotonFlag)
Constants("PhotonHistory", PHOTON=PhotonHistory, PHOTON_HISTORY_SHIFT=7)
PHOTON_FLAG_BITS = 10
"""Number of flag bits in a photon's ``flags`` word; its other bits are those of a float."""
Constants("PhotonFootprints", PHOTON_FLAG_MASK=(1 << PHOTON_FLAG_BITS) - 1)
SCATTERED_IN_MEDIUM = 1 << PHOTON_FLAG_BITS + 1
"""Flag of a photon path in a segment in which a medium has scattered it, so that no surface does."""
FIRST_MEDIUM_LIT = 1 << 30
"""Flag above the count of vertices in media: light came to the first of them straight or by specular surfaces."""
HIDDEN_FROM_MEDIA = 1 << 29
"""Flag above that count: from a light of which media scatter nothing until something else has."""
Constants(
    "MediumScattering",
    PATH_SCATTERED_IN_MEDIUM=SCATTERED_IN_MEDIUM,
    FIRST_MEDIUM_LIT=FIRST_MEDIUM_LIT,
    MEDIUM_COUNT_SHIFT=24,
    HIDDEN_FROM_MEDIA=HIDDEN_FROM_MEDIA,
)
Constants("Dispersion", PATH_DISPERSED=1 << PHOTON_FLAG_BITS)
"""A flag of the camera's and the photons' paths alike, above their own: their light has but one wavelength."""
