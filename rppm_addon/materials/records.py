# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials as the resolve stage reads them."""

from ..gl.records import Record

NO_IMAGE = 0xFFFFFFFF

MATERIAL = Record(
    "Material", absorption="vec3", first_lobe="uint", lobe_count="uint", emitted="float", unused0="uint", unused1="uint"
)
"""A material: absorption of its interior in 1/m, its range of lobes, and the radiance that it emits
(mean of the channels)."""

MATERIAL_LOBE = Record(
    "MaterialLobe",
    color="vec3",
    kind="uint",
    specular_tint="vec3",
    color_image="uint",
    emission="vec3",
    weight="float",
    roughness="float",
    ior="float",
    metallic="float",
    specular_level="float",
    transmission="float",
    alpha="float",
    multiscatter="uint",
    unused="uint",
)
"""scene.Lobe for the GPU; the kinds are scene.LobeKind."""

IMAGE_ENTRY = Record("ImageEntry", first_texel="uint", width="uint", height="uint", format="uint")
"""Where an image's texels lie; format 0: one uint a texel, sRGB bytes; 1: the same, linear bytes;
2: two uints a texel, four linear half floats."""
