# SPDX-License-Identifier: GPL-3.0-or-later
"""Declarations of the shape, type and range of a scene's members, against which scene/storage/validation.py checks."""

import dataclasses
from dataclasses import dataclass
from typing import Any

_KEY = "declared"
FLOAT_MAX = 3.4028234663852886e38
"""The greatest number in single precision, in which scenes are rendered."""


@dataclass(frozen=True)
class Declared:
    """Constraints on the values of a field, beside their type."""

    shape: tuple[int | str, ...] | None = None
    """Shape of arrays; a name stands for a number that is the same in all arrays of the record."""
    types: str = "fiu"
    """Kinds of dtypes (numpy) that arrays may have, or the name of the only dtype."""
    minimum: float | None = None
    maximum: float | None = None
    """Range, both ends included; None is no bound."""
    finite: bool = True
    """Whether what is no number is refused. Where not, the renderer leaves out what it spoils."""
    below: str = ""
    """Name of what indices count: one of ``shape``, or a list of the scene."""
    choices: tuple[str, ...] = ()
    """All values that texts may have."""


_NOTHING = Declared()


def declared(*shape: int | str, **more: Any) -> dict[str, Declared]:
    """The metadata of a dataclass field of which more is said; ``shape`` and ``more`` as Declared's."""
    return {_KEY: Declared(shape or None, **more)}


def declared_of(field: dataclasses.Field) -> Declared:
    """Return the declaration of a field; the default one where it has none."""
    return field.metadata.get(_KEY, _NOTHING)
