# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials as the resolve stage reads them."""

import enum

from ..gl.constants import Constants
from ..gl.records import Record
from ..gl.storage_blocks import StorageBlock

MATERIAL = Record(
    "Material",
    absorption="vec3",
    program="uint",
    first_constant="uint",
    opaque_shadow="uint",
    passes_shadow_rays="uint",
    depends_on_view="uint",
    pass_index="uint",
    medium="uint",
    material_of_medium="uint",
    unused0="uint",
)
"""A material: absorption of its interior in 1/m, the program that evaluates its node graph, and where its constants
start in MaterialData; whether lights shine through where it is transparent (0) or not (1), and whether shadow rays find
that light (1) or photons alone do (0); whether what it scatters
depends on where it is seen from (1); its index for compositors; and the number of its interior among those that absorb,
from 1 on, 0 where it does not. ``material_of_medium`` is not of this material: item n - 1 has that of medium n."""
MOST_MEDIA = 1023
"""Interiors that absorb; paths have ten bits for the number of one (shaders/materials/medium.glsl)."""
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
