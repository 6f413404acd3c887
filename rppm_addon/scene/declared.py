# SPDX-License-Identifier: GPL-3.0-or-later
"""What is said of a member of the scene where it is declared: its shape, type and range. gate.py holds scenes to it."""

import dataclasses
from dataclasses import dataclass
from typing import Any

_KEY = "declared"
FLOAT_MAX = 3.4028234663852886e38
"""The greatest number in single precision, in which scenes are rendered."""


@dataclass(frozen=True)
class Declared:
    """What a field's values are like, beside their type."""

    shape: tuple[int | str, ...] | None = None
    """Of arrays; a name is a number that is the same in all arrays of the record."""
    types: str = "fiu"
    """Of arrays: the kinds of their dtypes (numpy), or the name of the only one."""
    minimum: float | None = None
    maximum: float | None = None
    """Range, both ends included; None is no bound."""
    finite: bool = True
    """Whether what is no number is refused. Where not, the renderer leaves out what it spoils."""
    below: str = ""
    """Of indices: what they count, a name of ``shape`` or a list of the scene."""
    choices: tuple[str, ...] = ()
    """Of texts: all there are."""


_NOTHING = Declared()


def declared(*shape: int | str, **more: Any) -> dict[str, Declared]:
    """The metadata of a dataclass field of which more is said; ``shape`` and ``more`` as Declared's."""
    return {_KEY: Declared(shape or None, **more)}


def declared_of(field: dataclasses.Field) -> Declared:
    """What is said of a field."""
    return field.metadata.get(_KEY, _NOTHING)
