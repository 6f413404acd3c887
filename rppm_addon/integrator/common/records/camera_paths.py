# SPDX-License-Identifier: GPL-3.0-or-later
"""Camera paths, and the history of their scattering."""

import enum

from ....gl.buffers.constants import Constants
from ....gl.buffers.records import Record
from ....gl.buffers.storage_blocks import StorageBlock


class Scatter(enum.IntEnum):
    """Kinds of scattering at a surface that Cycles distinguishes, in the order of their passes (scene/passes.py)."""

    NONE = 0
    DIFFUSE = 1
    GLOSSY = 2
    TRANSMISSION = 3


class PathHistory(enum.IntFlag):
    """Flags of a camera path's history for the passes of light. They stand above the Scatter of its first surface that
    is not transparent."""

    AGAIN = 4
    """More than one surface has scattered the path, or a medium has."""
    DIFFUSE = 8
    """The last scattering was diffuse."""
    CAUSTIC = 16
    """A lobe that is not diffuse has scattered the path after a diffuse one: Cycles ends it there where Caustics are
    off."""


class CameraPathFlag(enum.IntFlag):
    """Flags of a camera path. DIFFUSE, TRANSMITTED and SINGULAR describe the last event that was not transparent."""

    CAMERA_TRANSPARENT = 1
    """The path has met nothing but transparent surfaces since the camera."""
    SURFACE_FOUND = 2
    """The path has reached its first surface, and the passes have it."""
    FINAL_GATHER = 4
    """The path's ray is of a final gather, or follows one: it has left a surface by a lobe that stores photons."""
    DIFFUSE = 8
    """The event was diffuse."""
    TRANSMITTED = 16
    """The event was a transmission."""
    SINGULAR = 32
    """The event had a single direction."""
    CAUSTIC = 64
    """Since the ray of its final gather left, a specular lobe has scattered the path, or a transparent surface that
    stops shadow rays has weakened it."""
    SECONDARY_GATHER = 128
    """The path of a final gather has left a second surface by a lobe that stores photons."""
    DENOISING_DATA_FOUND = 256
    """The passes of denoisers have the path's surface."""
    LIGHTS_FOUND = 512
    """A shadow ray has looked for the light objects and emissive triangles that the path leads to."""
    SEEN_THROUGH = 2048
    """Since the event, the path has crossed only surfaces that stop no shadow rays from there."""


Constants("CameraPathFlags", PATH=CameraPathFlag)
Constants("ClearGlass", PATH_BEHIND_CLEAR_GLASS=CameraPathFlag.SECONDARY_GATHER)
"""A flag of paths that have passed clear glass in a transparent film, as long as they are not those of a final
gather."""
Constants("PathHistory", SCATTER=Scatter, HISTORY=PathHistory)
CAMERA_PATH = Record(
    "CameraPath",
    throughput="vec3",
    scatter_pdf="float",
    total_length="float",
    straight_length="float",
    primary_radius="float",
    flags="uint",
    depth="uint",
    lit_normal="uint",
    lit_from="uint",
    photon_radius="float",
    arrived_counts="uint",
    bounce_counts="uint",
    least_pdf="float",
    medium_passing="float",
)
"""A camera path between two segments: ``total_length`` is the sum of the segments in Eq. 4, with the way to
the clip start, ``straight_length`` of those that led straight through surfaces since the last event of another kind,
``primary_radius`` the radius of a pixel's cone at distance 1, or of its beam of parallel rays, from the primary hit on
that of the disk of Eq. 3 in iteration 1, likewise at distance 1, ``scatter_pdf`` that of the scattered direction in
1/sr where shadow rays sample the same light, else 0; ``depth`` counts bounces and transparent surfaces (Depths);
``lit_normal`` and ``lit_from`` hold how shadow rays chose their light (camera_paths/importons/scatter_point.glsl);
``photon_radius`` is the radius of the disk, meters, in which photons count at the vertex where the last ray of the
path's final gather left: photons bring some of the light there that this ray brings, too. ``arrived_counts`` are the
bounces by type (shaders/common/bounce_counts.glsl) of the path as it came to its vertex, and ``bounce_counts`` those of
the path as it goes on from there; both are 0 where nobody asks. The fourth count of ``bounce_counts`` is of vertices in
media. ``medium_passing`` is the probability with which media leave the path to the surface at the end of its ray, 1
where they do not scatter it, or SCATTERED_BY_MEDIUM where they have. ``least_pdf`` is the least of the pdfs by
which lobes and media have scattered the path, 1/sr, where Filter Glossy asks."""
LIT_FROM_BITS = 1 << 8
"""First bit of ``lit_from`` behind those of a light set and its flags."""
Constants(
    "RayPortalPaths",
    LIT_FROM_BITS=LIT_FROM_BITS,
    BEHIND_RAY_PORTAL=LIT_FROM_BITS,
    ONE_RAY_PORTAL=LIT_FROM_BITS << 1,
)
"""In ``lit_from``: the flag of paths that have passed a ray portal since the ray of their final gather left, and the
number of ray portals that they have passed, above it."""
SCATTERED_BY_MEDIUM = -1.0
Constants("CameraPathsInMedia", SCATTERED_BY_MEDIUM=SCATTERED_BY_MEDIUM)
StorageBlock("CameraPaths", "CameraPath camera_paths[];")
StorageBlock("Radiances", "vec4 radiances[];")
"""Radiance of the pixels of a band, W/(m^2 sr), and alpha."""
