# SPDX-License-Identifier: GPL-3.0-or-later
"""Constants shared by CPU and GPU: declared once in Python, included by shaders by name."""

from collections.abc import Sequence
from typing import ClassVar


class Constants:
    """Named constants of GLSL, e.g. ``Constants("Passes", PASS_COUNT=3)`` for ``#include <Passes>``.

    Values are whole numbers (uint), floats, or sequences of one of them. Declaring two different sets of one name
    raises ValueError.
    """

    registry: ClassVar[dict[str, "Constants"]] = {}

    def __init__(self, name: str, **values: int | float | Sequence[int] | Sequence[float]) -> None:
        self.name = name
        self.values = values
        existing = self.registry.setdefault(name, self)
        if existing.values != values:
            raise ValueError(f"constants {name} are declared twice with different values")

    def glsl(self) -> str:
        """Their declarations in GLSL, on one line so that line numbers stay those of the file."""
        return " ".join(_declaration(name, value) for name, value in self.values.items())


def _declaration(name: str, value: int | float | Sequence[int] | Sequence[float]) -> str:
    if isinstance(value, int | float):
        return f"const {_kind(value)} {name} = {_literal(value)};"
    kind = _kind(value[0])
    return f"const {kind} {name}[{len(value)}] = {kind}[]({', '.join(map(_literal, value))});"


def _kind(value: int | float) -> str:
    return "float" if isinstance(value, float) else "uint"


def _literal(value: int | float) -> str:
    return repr(value) if isinstance(value, float) else f"{value}u"
