# SPDX-License-Identifier: GPL-3.0-or-later
"""Records shared by CPU and GPU: declared once, used as NumPy dtype and as GLSL struct.

Layout rules: std430 (OpenGL 4.3 core, section 7.6.2.2). Records without arrays of others have the members at their
std430 offsets in a std140 uniform block as well.
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
    """A key of KINDS, or another record's name."""
    offset: int
    count: int = 0
    """Length of an array of records; 0 for other members."""


def _format(member: _Member) -> np.dtype:
    if member.count:
        part: np.dtype = Record.registry[member.kind].dtype
        return np.dtype((part, (member.count,)))
    element, shape, _, _ = KINDS[member.kind]
    return np.dtype((element, shape))


class Record:
    """A struct of named members, e.g. ``Record("Ray", origin="vec3", source_triangle="uint")``.

    ``lobes=(CLOSURE_LOBE, 3)`` is an array of another record, which shaders index by what they compute.
    ``dtype`` is the NumPy structured dtype and ``size`` the array stride in bytes. A mat4 member
    takes matrices as NumPy stores them (row-major): GLSL's column-major read is undone by
    ``pack`` and must be undone by whoever fills the dtype by hand. Declaring two different
    records of one name raises ValueError.
    """

    registry: ClassVar[dict[str, "Record"]] = {}

    def __init__(self, name: str, **members: "str | tuple[Record, int]") -> None:
        self.name = name
        self.members: list[_Member] = []
        offset = 0
        self.alignment = 4
        for member, kind in members.items():
            align, size = (kind[0].alignment, kind[0].size * kind[1]) if isinstance(kind, tuple) else KINDS[kind][2:]
            offset = -(-offset // align) * align
            count = kind[1] if isinstance(kind, tuple) else 0
            self.members.append(_Member(member, kind[0].name if isinstance(kind, tuple) else kind, offset, count))
            offset += size
            self.alignment = max(self.alignment, align)
        self.size: int = -(-offset // self.alignment) * self.alignment
        self._names = frozenset(members)
        self.dtype: np.dtype = np.dtype(
            {
                "names": [m.name for m in self.members],
                "formats": [_format(m) for m in self.members],
                "offsets": [m.offset for m in self.members],
                "itemsize": self.size,
            }
        )
        existing = self.registry.setdefault(name, self)
        if existing.dtype != self.dtype:
            raise ValueError(f"record {name} is declared twice with different members")

    def glsl(self) -> str:
        """The struct declaration in GLSL, on one line so that line numbers stay those of the file."""
        members = " ".join(f"{m.kind} {m.name}{f'[{m.count}]' if m.count else ''};" for m in self.members)
        return f"struct {self.name} {{ {members} }};"

    @property
    def parts(self) -> list["Record"]:
        """Records that it has arrays of, which are to be declared before it."""
        return [self.registry[m.kind] for m in self.members if m.count]

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
