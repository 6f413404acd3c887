# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials as the resolve stage reads them."""

import enum

from ..gl.buffers.constants import Constants
from ..gl.buffers.records import Record
from ..gl.buffers.storage_blocks import StorageBlock

MATERIAL = Record(
    "Material",
    program="uint",
    first_constant="uint",
    opaque_shadow="uint",
    passes_shadow_rays="uint",
    depends_on_view="uint",
    pass_index="uint",
    medium="uint",
    bounds_volume="uint",
)
"""A material: the program that evaluates its node graph, and where its constants start in MaterialData; whether lights
shine through where it is transparent (0) or not (1), and whether shadow rays find that light (1) or photons alone do
(0); whether what it scatters depends on where it is seen from (1); its index for compositors; and the number of the
medium inside, from 1 on, 0 where there is none; and whether its surface only bounds a volume (1), so that all light
passes it."""
MEDIUM = Record(
    "Medium",
    absorption="vec3",
    first_function="uint",
    scattering="vec3",
    function_count="uint",
    emission="vec3",
    channels="uint",
    to_grid0="vec4",
    to_grid1="vec4",
    to_grid2="vec4",
    voxels="uvec3",
    first_word="uint",
    material_medium="uint",
    medium_bits="uint",
    light_group="uint",
    bounds_volume="uint",
)
"""A participating medium: its absorption and scattering coefficients, 1/m, the radiance that it emits by length,
W/(m^3 sr), and the place of its phase functions in PhaseFunctions. Where these vary, they are scales of channels of a
grid of ``voxels`` (0 without one): the channels of the three (bricks.py), a byte each from the lowest; the rows of the
matrix from the world to the grid, in which voxel i reaches from i to i + 1; and where its table of bricks begins in
MediumVoxels. ``material_medium`` is not of this medium: item n has that of material n, as the record Material; programs
with many storage blocks then need no block Materials. ``bounds_volume`` is material n's as well. ``medium_bits`` is the
number of bits that a medium's number takes in a path's flags, the same in every item. ``light_group`` is the number of
the group of what it emits, plus one; 0 for none."""
StorageBlock("Media", "Medium media[];")


class PhaseFunctionKind(enum.IntEnum):
    """Phase functions, by the names of Blender's Volume Scatter node."""

    HENYEY_GREENSTEIN = 0
    """Parameter: the anisotropy g."""
    FOURNIER_FORAND = 1
    """Parameters: the refractive index n, the exponent nu, and the factor of the term by cos^2 (Fournier and Jonasz
    1999)."""
    DRAINE = 2
    """Parameters: the anisotropy g, and alpha (Draine 2003)."""
    RAYLEIGH = 3
    """No parameter."""


PHASE_FUNCTION = Record("PhaseFunction", scattering="vec3", kind="uint", parameters="vec4")
"""A part of a medium's scattering: its scattering coefficient, 1/m, and the phase function by which it scatters."""
Constants("PhaseFunctionKinds", PHASE=PhaseFunctionKind)
MEDIA_BITS = 20
"""Bits that paths have for the numbers of the media that they are in (shaders/materials/medium.glsl)."""
MAX_MEDIA = (1 << MEDIA_BITS // 2) - 1
"""Media of a scene: paths can be in two at once, and in more where there are fewer."""
Constants("Media", MEDIA_BITS=MEDIA_BITS, FIRST_MEDIUM=32 - MEDIA_BITS, MEDIA_UNKNOWN=(1 << 32) - 1)
StorageBlock("Materials", "Material materials[];")

IMAGE_ENTRY = Record("ImageEntry", first_texel="uint", width="uint", height="uint", format="uint")
"""Where an image's texels lie, and their TexelFormat."""


class TexelFormat(enum.IntEnum):
    """How an image's texels are encoded: BYTES are one uint a texel, HALF, the later ones, two."""

    SRGB_BYTES = 0
    BYTES = 1
    HALF = 2
    SRGB_HALF = 3


Constants("TexelFormats", FORMAT=TexelFormat)
