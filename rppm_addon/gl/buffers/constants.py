# SPDX-License-Identifier: GPL-3.0-or-later
"""Constants shared by CPU and GPU: declared once in Python, included by shaders by name."""

import enum
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

_Declared = int | float | Sequence[int] | Sequence[float] | Sequence[str] | Mapping[str, int] | type[enum.Enum]


class Constants:
    """Named constants of GLSL, e.g. ``Constants("Passes", PASS_COUNT=3)`` for ``#include <Passes>``.

    Values are whole numbers, floats, lists of one of them, or what is enumerated: of ``PHOTON=PhotonFlag``, and of a
    mapping, each member becomes a constant ``PHOTON_<MEMBER>``, and of ``WRAP=("CLIP", "REPEAT")`` each name an int
    ``WRAP_<NAME>``, its place, as node kinds pass their options. Other whole numbers are uint, or int where ``signed``
    says so. Declaring two different sets of one name raises ValueError.
    """

    registry: ClassVar[dict[str, "Constants"]] = {}

    def __init__(self, name: str, /, *, signed: bool = False, **values: _Declared) -> None:
        self.name = name
        self.groups: list[tuple[str, ...]] = []
        """Its constants, as shaders spell them; those of an enumeration together."""
        whole = "int" if signed else "uint"
        declarations = []
        for key, value in values.items():
            numbers = _numbers(value)
            entries = {key: value} if numbers is None else {f"{key}_{name}": number for name, number in numbers.items()}
            kind = "int" if isinstance(value, tuple) else whole
            declarations += [_declaration(entry, number, kind) for entry, number in entries.items()]
            self.groups.append(tuple(entries))
        self._declarations = " ".join(declarations)
        existing = self.registry.setdefault(name, self)
        if existing._declarations != self._declarations:
            raise ValueError(f"constants {name} are declared twice with different values")

    def glsl(self) -> str:
        """Their declarations in GLSL, on one line so that line numbers stay those of the file."""
        return self._declarations


def _numbers(value: Any) -> dict[str, int] | None:
    """Return the numbers of an enum, a mapping or a tuple of names, by name; None for plain values."""
    if isinstance(value, type) and issubclass(value, enum.Enum):
        return {str(member.name): int(member.value) for member in value}  # but for those of several bits, such as ALL
    if isinstance(value, Mapping):
        return dict(value)
    if isinstance(value, tuple) and all(isinstance(name, str) for name in value):
        return {name.upper(): place for place, name in enumerate(value)}
    return None


def _declaration(name: str, value: Any, whole: str) -> str:
    if isinstance(value, int | float):
        return f"const {_kind(value, whole)} {name} = {_literal(value, whole)};"
    kind = _kind(value[0], whole)
    literals = ", ".join(_literal(element, whole) for element in value)
    return f"const {kind} {name}[{len(value)}] = {kind}[]({literals});"


def _kind(value: int | float, whole: str) -> str:
    return "float" if isinstance(value, float) else whole


def _literal(value: int | float, whole: str) -> str:
    if isinstance(value, float):
        return repr(value)
    return f"{int(value)}u" if whole == "uint" else str(int(value))
