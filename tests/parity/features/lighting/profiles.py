# SPDX-License-Identifier: GPL-3.0-or-later
"""IES profiles: their values by direction, and lights that have them."""

import bpy
import numpy as np

from ..rows import value
from ..values.image_textures import folder
from .lights import WHITE, light_with_nodes, lights

GROUP = "IES Texture"


def profile(kind: int, around: np.ndarray, down: np.ndarray, tilt: str = "TILT=NONE") -> str:
    """The text of a profile of a photometric type with uneven intensities of some 1000 candela."""
    random = np.random.default_rng(len(around) + 10 * len(down)).random((len(around), len(down)))
    candela = (400.0 + 1200.0 * random).round(1)
    if kind == 1 and around[-1] == 360.0:
        candela[-1] = candela[0]
    luminaire = f"1 1000 1.5 {len(down)} {len(around)} {kind} 2 0.1 0.2 0.0\n1.0 0.9, 40"
    head = f"IESNA:LM-63-1995\n[TEST] parity\n{tilt}\n{luminaire}\n"
    rows = "\n".join(" ".join(map(str, row)) for row in (down, around, *candela))
    return f"{head}{rows}\n"


def even(first: float, last: float, count: int) -> np.ndarray:
    return np.linspace(first, last, count).round(3)


PROFILES = {
    "all around": profile(1, even(0, 360, 13), even(0, 180, 10)),
    "half": profile(1, even(0, 180, 7), even(0, 180, 7)),
    "quarter, downwards": profile(1, even(0, 90, 4), even(0, 90, 6)),
    "the same all around": profile(1, np.array([0.0]), even(0, 180, 19)),
    "from 90 to 270 degrees": profile(1, even(90, 270, 7), even(90, 180, 7)),
    "uneven steps": profile(1, np.array([0.0, 20.0, 90.0]), np.array([0.0, 5.0, 30.0, 70.0, 75.0, 110.0, 180.0])),
    "without 360 degrees": profile(1, even(0, 315, 8), even(0, 180, 7)),
    "a part": profile(1, even(0, 300, 7), even(10, 150, 6)),
    "type B": profile(2, even(0, 90, 5), even(-90, 90, 7)),
    "type B, a quarter": profile(2, even(0, 90, 5), even(0, 90, 4)),
    "type A": profile(3, even(-90, 90, 7), even(-90, 90, 7)),
    "type A, half": profile(3, even(0, 90, 5), even(-90, 90, 7)),
    "with tilt": profile(1, even(0, 360, 9), even(0, 180, 7), "TILT=INCLUDE\n1\n3\n0 45 90\n1.0 0.9 0.8"),
}


def _profile_node(net, text: str, scale: float | None = None, strength: float = 0.01, file: bool = False):
    """The output of an IES texture; ``scale``: of the object's coordinates, None is what it takes by itself."""
    inputs = {"Strength": strength}
    if scale is not None:
        inputs["Vector"] = net.out(
            "VectorMath", inputs={0: net.out("TexCoord", "Object"), 1: (scale,) * 3}, operation="MULTIPLY"
        )
    if file:
        path = folder() / "profile.ies"
        path.write_bytes(text.replace("\n", "\r\n").encode())
        return net.out("TexIES", 0, inputs, mode="EXTERNAL", filepath=str(path))
    stored = bpy.data.texts.new("Profile")
    stored.write(text)
    return net.out("TexIES", 0, inputs, ies=stored)


def _shown(text: str, *arguments, **members):
    return lambda net: _profile_node(net, text, *arguments, **members)


for _name, _text in PROFILES.items():
    value(GROUP, _name, _shown(_text, 1.0))
    value(GROUP, f"{_name}, upside down", _shown(_text, -1.0))
value(GROUP, "without coordinates", _shown(PROFILES["all around"]))
value(GROUP, "a file", _shown(PROFILES["all around"], 1.0, file=True))
value(GROUP, "no profile", _shown("nothing", 1.0), warns=True)

for _kind, _properties in {
    "POINT": {"shadow_soft_size": 0.1}, "SPOT": {"shadow_soft_size": 0.0, "spot_size": 1.5}, "AREA": {"size": 0.5},
}.items():  # fmt: skip
    lights(
        GROUP,
        f"{_kind.lower()} light",
        light_with_nodes(_kind, lambda net: (WHITE, _profile_node(net, PROFILES["half"])), **_properties),
        effort=2,
    )
