# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials as the resolve stage reads them."""

from ..gl.records import Record

MATERIAL = Record(
    "Material",
    absorption="vec3",
    program="uint",
    first_constant="uint",
    opaque_shadow="uint",
    depends_on_view="uint",
    unused="uint",
)
"""A material: absorption of its interior in 1/m, the program that evaluates its node graph, and where its constants
start in MaterialData; whether lamps shine through where it is transparent (0) or not (1); whether what it scatters
depends on where it is seen from (1)."""

IMAGE_ENTRY = Record("ImageEntry", first_texel="uint", width="uint", height="uint", format="uint")
"""Where an image's texels lie; format 0: one uint a texel, sRGB bytes; 1: the same, linear bytes;
2: two uints a texel, four linear half floats."""
