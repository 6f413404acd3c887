# SPDX-License-Identifier: GPL-3.0-or-later
"""Closures: scattering and emission of a surface at a hit."""

import enum

from ....gl.buffers.constants import Constants
from ....gl.buffers.records import Record
from ....gl.buffers.storage_blocks import StorageBlock

MICROFACET_LOBE = Record(
    "MicrofacetLobe",
    weight="vec3",
    kind="uint",
    f0="vec3",
    alpha="float",
    tint="vec3",
    ior="float",
    normal="uint",
    anisotropy="uint",
)
"""A GGX, sheen, toon or hair lobe as seen from the side of the arriving path. ``ior`` is the index behind the surface
over the index before it; f0 is the reflectance at normal incidence, or GLASS: the tint of what passes
(weight is then the tint of what is reflected), or SHEEN: the two coefficients of its transformation.
``alpha`` is the geometric mean of both axes', ``anisotropy`` their direction and ratio
(common/bsdf/ggx.glsl), ``normal`` octahedral. What they are of hair says common/bsdf/hair.glsl."""


class MicrofacetKind(enum.IntEnum):
    """Kinds of GGX, sheen, toon and hair lobes."""

    NONE = 0
    MIRROR = 1
    """Reflects all; a black tint stands for the model of Ashikhmin and Shirley, which programs know where
    ASHIKHMIN_LOBES is defined."""
    METAL = 2
    """Schlick's Fresnel from f0 to white; tint is of the edge at 82 degrees."""
    DIELECTRIC = 3
    """Reflection of a dielectric, f0 tinted."""
    GLASS = 4
    """Reflects and refracts; tint is of the reflectance at normal incidence."""
    REFRACTION = 5
    """Refracts only, without Fresnel's loss."""
    COATED_GLASS = 6
    """Glass under a thin film; the tint is what the film is (common/bsdf/film_lobes.glsl, for METAL and DIELECTRIC as
    well), which programs know where THIN_FILM_LOBES is defined."""
    SHEET = 7
    """Passes all through a sheet without thickness: a mirror's light, on the other side."""
    SHEEN = 8
    """f0.xy are the coefficients of sheen_pdf."""
    VELVET = 9
    """f0.x is sigma."""
    TOON = 10
    """f0 is the shape of a cone about the normal (common/bsdf/toon.glsl)."""
    GLOSSY_TOON = 11
    """About the mirrored direction."""
    HAIR_REFLECTION = 12
    """Lobe of fibers, as are the kinds that follow: programs know them where HAIR_LOBES is defined."""
    HAIR_TRANSMISSION = 13
    HAIR_CHIANG = 14
    HAIR_HUANG = 15


Constants("MicrofacetKinds", LOBE=MicrofacetKind)
Constants("HairLobes", HAIR_ON_STRAND=1)
"""In ``anisotropy`` of principled hair: the lowest bit, which is no part of an angle."""


class ClosureFlag(enum.IntFlag):
    """Flags of a closure."""

    BACKFACING = 1
    """The ray came to the back of the surface."""
    SHADOWLESS = 2
    """The surface stops no shadow rays."""
    CATCHES_SHADOWS = 4
    """The surface is a shadow catcher."""
    KEEPS_LIGHT = 8
    """Photons light the surface, but it sends none on."""
    CROWDED = 16
    """One part of the closure, chosen by chance, stands for others."""
    ABSENT = 32
    """The path passes straight through, as if the surface were not there."""
    DISPERSES = 64
    """The indices of the refracting lobes are those of the path's wavelength."""
    SUBSURFACE = 128
    """Some of the diffuse part goes below the surface."""
    UNSEEN = 1 << 16
    """The object is hidden from a camera path, which does not enter its volume either."""


LOBE_COUNT_SHIFT = 8
"""Place of the number of lobes among the bits of a closure's flags."""
Constants("ClosureFlags", CLOSURE=ClosureFlag, LOBE_COUNT_SHIFT=LOBE_COUNT_SHIFT)
CLOSURE_LOBE = Record(
    "ClosureLobe",
    weight="vec3",
    kind="uint",
    f0="vec3",
    alpha="float",
    ior="float",
    normal="uint",
    anisotropy="uint",
)
"""A MicrofacetLobe as closures keep it: the kind comes with the tint."""
CLOSURE_LOBES = 3
Constants("ClosureLobes", signed=True, CLOSURE_LOBES=CLOSURE_LOBES)
CLOSURE = Record(
    "Closure",
    position="vec3",
    triangle="uint",
    diffuse="vec3",
    flags="uint",
    emission="vec3",
    geometric_normal="uint",
    transparent="vec3",
    shading_normal="uint",
    translucent="vec3",
    diffuse_normal="uint",
    distance="float",
    material="uint",
    diffuse_roughness="uint",
    ray_offset="float",
    lobes=(CLOSURE_LOBE, CLOSURE_LOBES),
)
"""BSDF, emission and geometry at a hit, all that later stages read about it. Normals face the arriving
path; bit 0 of ``flags`` is ClosureFlag.BACKFACING, the upper half is the holdout. The diffuse roughness comes with
the albedo that its interreflection takes (common/bsdf/diffuse.glsl). ``ray_offset``: how far along the geometric normal
rays begin, meters (common/geometry.glsl)."""
StorageBlock("Closures", "Closure closures[];")
StorageBlock("ExitClosures", "Closure exit_closures[];")
"""Closures at the exits of subsurface walks, and for other camera paths at their hits."""
TERMINATOR_SHIFT, TERMINATOR_STEPS = 10, 63
"""Bit position in a closure's flags, and number of steps, of the shading offset of the shadow terminator."""
Constants(
    "Terminators",
    TERMINATOR_SHIFT=TERMINATOR_SHIFT,
    TERMINATOR_STEPS=TERMINATOR_STEPS,
)
