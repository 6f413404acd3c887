# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of the comparison: a row is a feature in a scene of its own."""

import enum
from collections.abc import Callable
from dataclasses import dataclass, field

import bpy

from ..net import Net, diffuse, material
from . import stage


class Kind(enum.Enum):
    """How a row is rendered and judged."""

    VALUES = "values"
    """Emission seen through pixel centers: no noise, so pixels are compared one by one."""
    LIGHT = "light"
    """Light transport: means and blocks are compared beyond their noise."""


@dataclass(frozen=True)
class Row:
    """A feature and how to show it."""

    group: str
    name: str
    build: Callable[[], None]
    """Makes the Blender scene from nothing."""
    kind: Kind = Kind.LIGHT
    reason: str = ""
    """Why the row cannot reach the target, for approximations."""
    mean: float = 0.01
    """Largest difference of the means, as a share; above the target only with a reason."""
    block: float = 0.03
    """Largest difference of a block's mean, likewise."""
    settings: dict = field(default_factory=dict)
    """Settings of RPPM, in place of the usual ones."""
    effort: int = 1
    """How many times the usual iterations and samples it takes to tell anything."""
    warns: bool = False
    """Whether RPPM tells the user about what it does not render."""

    @property
    def id(self) -> str:
        return f"{self.group}: {self.name}"


ROWS: list[Row] = []


def add(row: Row) -> None:
    """Put a row on the list."""
    assert row.id not in {known.id for known in ROWS}, f"two rows are named {row.id}"
    assert row.reason or (row.mean <= 0.01 and row.block <= 0.03), f"{row.id} differs without a reason"
    ROWS.append(row)


def value(
    group: str,
    name: str,
    give: Callable[[Net], bpy.types.NodeSocket],
    scale: float = 1.0,
    offset: float = 0.0,
    prepare: Callable[[], None] | None = None,
    **members: object,
) -> None:
    """A row that shows a value by emission of value * scale + offset, which must not be negative anywhere."""

    def build() -> None:
        stage.empty()
        surface, net = material()
        stage.set_up(surface)
        if prepare is not None:
            prepare()
        shown = give(net)
        net.output(net.emission(net.scaled(shown, scale, offset) if (scale, offset) != (1.0, 0.0) else shown))

    add(Row(group, name, build, Kind.VALUES, **members))


def ground_material() -> bpy.types.Material:
    """Return the material of the ground below the lit objects."""
    return diffuse("Ground", (0.5, 0.45, 0.4))


def lit(
    group: str,
    name: str,
    give: Callable[[Net], bpy.types.NodeSocket],
    prepare: Callable[[], None] | None = None,
    world: float = 0.25,
    on_ground: bool = False,
    **members: object,
) -> None:
    """A row of a surface shader under an area light and a weak world, on the ball or on both objects."""

    def build() -> None:
        stage.empty()
        surface, net = material()
        plain = ground_material()
        stage.set_up(surface, world, None if on_ground else plain)
        stage.area_light()
        if prepare is not None:
            prepare()
        net.output(give(net))

    add(Row(group, name, build, Kind.LIGHT, **members))
