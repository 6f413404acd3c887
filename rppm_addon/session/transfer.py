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


class SceneSender:
    """Knows which members the receiver has."""

    def __init__(self) -> None:
        self._members: dict[int, tuple[int, object]] = {}
        """Handle and member by the member's id, which stays its own as long as the member is kept here."""
        self._used: dict[int, set[int]] = {}
        """Ids of the members of each session's newest scene."""
        self._handles = 0
        """The last handle given."""

    def send(self, session: int, scene: Scene) -> tuple[dict, list[np.ndarray]]:
        """The document of a session's next scene, and the arrays that it refers to by their places.

        Raises TypeError for a scene with something in it that no document can hold; the receiver then has no part.
        """
        arrays: list[np.ndarray] = []
        new: dict[str, list] = {}
        added: list[int] = []
        used: set[int] = set()
        known = self._members

        def keep(array: np.ndarray) -> int:
            arrays.append(array)
            return len(arrays) - 1

        def handles(field: str, members: Sequence[object]) -> list[int]:
            result = []
            for member in members:
                entry = known.get(id(member))
                if entry is None:
                    self._handles += 1
                    new.setdefault(field, []).append([self._handles, encode(member, keep)])
                    entry = known[id(member)] = (self._handles, member)
                    added.append(id(member))
                result.append(entry[0])
            used.update(map(id, members))
            return result

        try:
            document = {
                "members": {
                    **{name: handles(name, [getattr(scene, name)])[0] for name in _SINGLE},
                    **{name: handles(name, getattr(scene, name)) for name in _LISTS},
                },
                "values": {name: encode(getattr(scene, name), keep) for name in _VALUES},
                "new": new,
            }
        except BaseException:
            for member in added:
                del known[member]
            raise
        before, self._used[session] = self._used.get(session, set()), used
        document["dead"] = self._forget(before)
        return document, arrays

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

    def receive(self, document: dict, arrays: Sequence[np.ndarray]) -> Scene:
        """The scene of a document. Raises KeyError, TypeError or ValueError for what send has not made."""
        kinds = _SINGLE | _LISTS
        for name, members in document["new"].items():
            for handle, member in members:
                self._members[handle] = decode(member, kinds[name], arrays)
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
