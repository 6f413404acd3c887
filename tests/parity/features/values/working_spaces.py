# SPDX-License-Identifier: GPL-3.0-or-later
"""Colors in working spaces other than Rec.709: where they enter, and where they become numbers.

Blender 5 has these spaces. Each row is one of those above it in another space.
"""

from collections.abc import Callable

import bpy

from ..rows import ROWS, Row, add

GROUP = "Working Space"
SHOWN = {
    "ACEScg": (
        "Image Texture: as it comes", "Image Texture: alpha PREMUL, both outputs", "Image Texture: float, sRGB",
        "Image Texture: color space ACEScg", "Colors: RGB to BW", "Colors: color as a number",
        "Blackbody: 800 to 9000 K", "Wavelength: 380 to 720 nm", "Color Attribute: named",
        "Attribute: Color of BYTE_COLOR by POINT",
        "Sky Texture: MULTIPLE_SCATTERING, sun", "Sky Texture: PREETHAM", "Point Light: temperature",
        "Principled: thin film",
    ),
    "Linear Rec.2020": (
        "Image Texture: as it comes", "Colors: RGB to BW", "Blackbody: 800 to 9000 K", "Wavelength: 380 to 720 nm",
        "Sky Texture: SINGLE_SCATTERING",
    ),
}  # fmt: skip
"""Rows that are shown in each space."""
DIFFERENT = {
    "Attribute: Color of BYTE_COLOR by POINT": {
        "reason": "as Blender's viewport has them; Cycles decodes those of corners alone to the working space",
        "mean": 0.12,
        "block": 0.15,
    }
}
"""Members of rows that differ."""


def _in_space(space: str, build: Callable[[], None]) -> Callable[[], None]:
    def built() -> None:
        build()
        bpy.ops.wm.set_working_color_space(working_space=space, convert_colors=False)

    return built


def _copies() -> list[Row]:
    by_id = {row.id: row for row in ROWS}
    return [
        Row(GROUP, f"{space}, {name}", _in_space(space, by_id[name].build), by_id[name].kind, **DIFFERENT.get(name, {}))
        for space, names in SHOWN.items()
        for name in names
    ]


if hasattr(bpy.data, "colorspace"):
    for _row in _copies():
        add(_row)
