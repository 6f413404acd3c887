# SPDX-License-Identifier: GPL-3.0-or-later
"""Records shared by CPU and GPU: declared once, used as NumPy dtype and as GLSL struct.

Layout rules: std430 (OpenGL 4.3 core, section 7.6.2.2). Records hold no arrays and no nested
records, so the members also lie at their std430 offsets in a std140 uniform block.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

KINDS = {
    # kind: (NumPy element, shape, alignment, size)
    "float": ("<f4", (), 4, 4),
    "int": ("<i4", (), 4, 4),
    "uint": ("<u4", (), 4, 4),
    "vec2": ("<f4", (2,), 8, 8),
    "vec3": ("<f4", (3,), 16, 12),
    "vec4": ("<f4", (4,), 16, 16),
    "ivec2": ("<i4", (2,), 8, 8),
    "ivec3": ("<i4", (3,), 16, 12),
    "ivec4": ("<i4", (4,), 16, 16),
    "uvec2": ("<u4", (2,), 8, 8),
    "uvec3": ("<u4", (3,), 16, 12),
    "uvec4": ("<u4", (4,), 16, 16),
    "mat4": ("<f4", (4, 4), 16, 64),
}


@dataclass(frozen=True)
class _Member:
    name: str
    kind: str
    offset: int


class Record:
    """A struct of named members, e.g. ``Record("Ray", origin="vec3", source_triangle="uint")``.

    ``dtype`` is the NumPy structured dtype and ``size`` the array stride in bytes. A mat4 member
    takes matrices as NumPy stores them (row-major): GLSL's column-major read is undone by
    ``pack`` and must be undone by whoever fills the dtype by hand. Declaring two different
    records of one name raises ValueError.
    """

    registry: ClassVar[dict[str, "Record"]] = {}

    def __init__(self, name: str, **members: str) -> None:
        self.name = name
        self.members: list[_Member] = []
        offset = 0
        alignment = 4
        for member, kind in members.items():
            _, _, align, size = KINDS[kind]
            offset = -(-offset // align) * align
            self.members.append(_Member(member, kind, offset))
            offset += size
            alignment = max(alignment, align)
        self.size = -(-offset // alignment) * alignment
        self._names = frozenset(members)
        self.dtype = np.dtype(
            {
                "names": [m.name for m in self.members],
                "formats": [np.dtype((KINDS[m.kind][0], KINDS[m.kind][1])) for m in self.members],
                "offsets": [m.offset for m in self.members],
                "itemsize": self.size,
            }
        )
        existing = self.registry.setdefault(name, self)
        if existing.dtype != self.dtype:
            raise ValueError(f"record {name} is declared twice with different members")

    def glsl(self) -> str:
        """The struct declaration in GLSL, on one line so that line numbers stay those of the file."""
        members = " ".join(f"{m.kind} {m.name};" for m in self.members)
        return f"struct {self.name} {{ {members} }};"

    def offset(self, name: str) -> int:
        """Bytes before a member."""
        fields = self.dtype.fields
        assert fields is not None
        return fields[name][1]

    def zeros(self, count: int) -> np.ndarray:
        """(count,) array of zeroed records."""
        return np.zeros(count, self.dtype)

    def pack(self, values: dict) -> bytes:
        """One record from member values; raises KeyError when members are missing or unknown."""
        if values.keys() != self._names:
            missing, unknown = sorted(self._names - values.keys()), sorted(values.keys() - self._names)
            raise KeyError(f"{self.name}: missing {missing}, unknown {unknown}")
        record = np.zeros((), self.dtype)
        for member in self.members:
            value = values[member.name]
            record[member.name] = np.asarray(value).T if member.kind == "mat4" else value
        return record.tobytes()


def stride(item: Record | str) -> int:
    """Bytes from one item of an array to the next: of a record, or of a kind such as "vec4" (std430)."""
    if isinstance(item, Record):
        return item.size
    _, _, alignment, size = KINDS[item]
    return -(-size // alignment) * alignment
