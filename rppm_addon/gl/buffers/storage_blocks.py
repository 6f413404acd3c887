# SPDX-License-Identifier: GPL-3.0-or-later
"""Storage blocks that several shaders read or write: what is in them is declared once."""

import re
from typing import ClassVar

from .records import Record

_MEMBER_TYPE = re.compile(r"(\w+) \w+(?:\[\d*\])?;")


class StorageBlock:
    """A block by name, e.g. ``StorageBlock("Rays", "Ray rays[];")`` for ``layout(...) readonly buffer Rays;``.

    ``members`` are those of GLSL. Binding and access are each shader's own. Declaring two different blocks of one name
    raises ValueError.
    """

    registry: ClassVar[dict[str, "StorageBlock"]] = {}

    def __init__(self, name: str, members: str) -> None:
        self.name, self.members = name, members
        existing = self.registry.setdefault(name, self)
        if existing.members != members:
            raise ValueError(f"storage block {name} is declared twice with different members")

    @property
    def records(self) -> list[Record]:
        """Record types of its members, each once; members of plain kinds have none."""
        kinds = _MEMBER_TYPE.findall(self.members)
        return [Record.registry[kind] for kind in dict.fromkeys(kinds) if kind in Record.registry]
