# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes from one process to another, each member once.

A scene's members (its meshes, images, materials, lights, instances, world, camera and settings) are not changed after
they were handed over. A member that the receiver has is therefore sent as its handle, a number, and the receiver's
scenes share members as the sender's do. What no session's newest scene uses is forgotten on both sides.
"""

import dataclasses
import typing
from collections.abc import Sequence

import numpy as np

from ..scene.documents import decode, encode
from ..scene.scene import Scene

_HINTS = typing.get_type_hints(Scene)
_SINGLE = {name: kind for name, kind in _HINTS.items() if dataclasses.is_dataclass(kind)}
_LISTS = {
    name: typing.get_args(kind)[0]
    for name, kind in _HINTS.items()
    if typing.get_origin(kind) is list and dataclasses.is_dataclass(typing.get_args(kind)[0])
}
_VALUES = {name: kind for name, kind in _HINTS.items() if name not in _SINGLE and name not in _LISTS}
_PART_MEMBERS = 256
_PART_BYTES = 1 << 25
"""What one message says of new members. Turning a document into text holds the interpreter, and Blender with it."""


class Part:
    """A document and the arrays that it refers to by their places."""

    def __init__(self) -> None:
        self.document: dict = {}
        self.arrays: list[np.ndarray] = []
        self._members = 0
        self._bytes = 0

    def keep(self, array: np.ndarray) -> int:
        self.arrays.append(array)
        self._bytes += array.nbytes
        return len(self.arrays) - 1

    def add(self, field: str, handle: int, member: object) -> None:
        """Say what a member is."""
        self._members += 1
        self.document.setdefault(field, []).append([handle, encode(member, self.keep)])

    @property
    def is_full(self) -> bool:
        return self._members >= _PART_MEMBERS or self._bytes >= _PART_BYTES


class SceneSender:
    """Knows which members the receiver has."""

    def __init__(self) -> None:
        self._members: dict[int, tuple[int, object]] = {}
        """Handle and member by the member's id, which stays its own as long as the member is kept here."""
        self._used: dict[int, set[int]] = {}
        """Ids of the members of each session's newest scene."""
        self._handles = 0
        """The last handle given."""

    def send(self, session: int, scene: Scene) -> tuple[list[Part], Part]:
        """What to tell of members that are new, and then of a session's next scene.

        Raises TypeError for a scene with something in it that no document can hold; the receiver then has no part.
        """
        parts, whole = [Part()], Part()
        added: list[int] = []
        used: set[int] = set()
        known = self._members

        def handles(field: str, members: Sequence[object]) -> list[int]:
            result = []
            for member in members:
                entry = known.get(id(member))
                if entry is None:
                    if parts[-1].is_full:
                        parts.append(Part())
                    self._handles += 1
                    parts[-1].add(field, self._handles, member)
                    entry = known[id(member)] = (self._handles, member)
                    added.append(id(member))
                result.append(entry[0])
            used.update(map(id, members))
            return result

        try:
            whole.document = {
                "members": {
                    **{name: handles(name, [getattr(scene, name)])[0] for name in _SINGLE},
                    **{name: handles(name, getattr(scene, name)) for name in _LISTS},
                },
                "values": {name: encode(getattr(scene, name), whole.keep) for name in _VALUES},
            }
        except BaseException:
            for member in added:
                del known[member]
            raise
        before, self._used[session] = self._used.get(session, set()), used
        whole.document["dead"] = self._forget(before)
        return [part for part in parts if part.document], whole

    def close(self, session: int) -> list[int]:
        """Forget a session; returns the handles that the receiver is to forget."""
        return self._forget(self._used.pop(session, set()))

    def _forget(self, candidates: set[int]) -> list[int]:
        unused = candidates.difference(*self._used.values())
        return [self._members.pop(member)[0] for member in unused]


class SceneReceiver:
    """Keeps the members that the sender refers to."""

    def __init__(self) -> None:
        self._members: dict[int, object] = {}

    def learn(self, document: dict, arrays: Sequence[np.ndarray]) -> None:
        """Take a part that tells of new members. Raises KeyError, TypeError or ValueError for what is none."""
        kinds = _SINGLE | _LISTS
        for name, members in document.items():
            for handle, member in members:
                self._members[handle] = decode(member, kinds[name], arrays)

    def receive(self, document: dict, arrays: Sequence[np.ndarray]) -> Scene:
        """The scene of the part that tells of it, once its members are known. Raises as learn does."""
        known, handles = self._members, document["members"]
        scene = Scene(
            **{name: known[handles[name]] for name in _SINGLE},
            **{name: [known[handle] for handle in handles[name]] for name in _LISTS},
            **{name: decode(value, _VALUES[name], arrays) for name, value in document["values"].items()},
        )
        self.forget(document["dead"])
        return scene

    def forget(self, handles: Sequence[int]) -> None:
        """Forget members that no session uses any more."""
        for handle in handles:
            self._members.pop(handle, None)
