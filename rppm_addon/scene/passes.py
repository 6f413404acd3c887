# SPDX-License-Identifier: GPL-3.0-or-later
"""The pass table: every render pass beside Combined, declared once.

From it follow the film's buffers, what ``shaders/film/passes.comp`` writes, checkpoints, merging, EXR layers, what
Blender registers and shows in its panels and menus, and the names that the command line takes.

To add a pass, declare it here and write its value with one line of ``shaders/film/passes.comp``.
"""

import enum
from collections.abc import Sequence
from dataclasses import dataclass

from .errors import SettingsError

NOTHING_HIT = 1e10
"""Depth where nothing is hit, as Cycles writes it."""


class Accumulation(enum.Enum):
    """What becomes of the values that iterations find for a pixel."""

    MEAN = 0
    """Their mean, with 0 from iterations that see the background."""
    FIRST = 1
    """The first surface's that an iteration finds: means of positions or indices stand for nothing. As in Cycles."""
    INSPECTION = 2
    """None do: it is computed once, from the deep cubemap and not from iterations."""


class PassKind(enum.Enum):
    """What channels mean, as Blender's RenderEngine.register_pass has it."""

    VALUE = "VALUE"
    VECTOR = "VECTOR"
    COLOR = "COLOR"


@dataclass(frozen=True)
class RenderPass:
    """One render pass."""

    name: str
    """As Blender and Cycles spell it; also the layer's name in EXR files."""
    channels: str
    """A letter each: Z, XYZ, RGB ..."""
    kind: PassKind
    accumulation: Accumulation
    switch: str = ""
    """The property of Blender's view layers that turns it on; "" where Blender has none and the add-on adds one."""
    nothing: float = 0.0
    """Its value where nothing is seen."""
    description: str = ""
    """The tooltip of a switch that the add-on adds."""

    @property
    def identifier(self) -> str:
        """The name as an identifier: ``deep_cubemap``."""
        return self.name.lower().replace(" ", "_")

    @property
    def layers(self) -> tuple[str, ...]:
        """Names of its channels in EXR files."""
        return tuple(f"{self.name}.{channel}" for channel in self.channels)

    @property
    def own_switch(self) -> str:
        """The property that the add-on adds to view layers, where Blender has none."""
        return "" if self.switch else f"use_pass_{self.identifier}"


PASSES = (
    RenderPass("Depth", "Z", PassKind.VALUE, Accumulation.FIRST, "use_pass_z", NOTHING_HIT),
    RenderPass("Normal", "XYZ", PassKind.VECTOR, Accumulation.MEAN, "use_pass_normal"),
    RenderPass("Position", "XYZ", PassKind.VECTOR, Accumulation.FIRST, "use_pass_position"),
    RenderPass("UV", "UVA", PassKind.VECTOR, Accumulation.MEAN, "use_pass_uv"),
    RenderPass(
        "Deep Cubemap",
        "XYZ",
        PassKind.VECTOR,
        Accumulation.INSPECTION,
        description=(
            "A pass that shows what the camera's rays cost: cells looked at, triangles tested, and entries "
            "listed in the cell that is hit, as X, Y and Z"
        ),
    ),
)
FILM_PASSES = tuple(entry for entry in PASSES if entry.accumulation is not Accumulation.INSPECTION)
"""Those that iterations find."""
DEEP_CUBEMAP = next(entry for entry in PASSES if entry.name == "Deep Cubemap")
COMBINED = "Combined"


def passes_named(names: Sequence[str]) -> tuple[RenderPass, ...]:
    """The passes of these names in the table's order. Raises SettingsError for a name that is none."""
    known = {entry.name for entry in PASSES}
    for name in names:
        if name not in known:
            raise SettingsError(f"there is no pass {name}; the passes are {', '.join(sorted(known))}")
    return tuple(entry for entry in PASSES if entry.name in names)
