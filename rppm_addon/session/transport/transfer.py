# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes from one process to another, each member once.

A scene's members (its meshes, images, materials, lights, instances, world, camera and settings) are not changed after
they were handed over. A member that the receiver has is therefore sent as its handle, a number, and the receiver's
scenes share members as the sender's do. Large arrays have handles as well: a mesh that bends has the corners that it
had. What no session's newest scene uses is forgotten on both sides.
"""

import dataclasses
import functools
import itertools
import typing
from collections.abc import Sequence
from typing import Any

import numpy as np

from ...scene.common.garbage import collector_paused
from ...scene.scene import Scene
from ...scene.storage.columns import decode_columns, encode_columns
from ...scene.storage.documents import decode, encode
from .arrays import LARGE

_HINTS = typing.get_type_hints(Scene)
_SINGLE = {name: kind for name, kind in _HINTS.items() if dataclasses.is_dataclass(kind)}
_LISTS = {
    name: typing.get_args(kind)[0]
    for name, kind in _HINTS.items()
    if typing.get_origin(kind) is list and dataclasses.is_dataclass(typing.get_args(kind)[0])
}
_VALUES = {name: kind for name, kind in _HINTS.items() if name not in _SINGLE and name not in _LISTS}
_ARRAYS = "arrays"
_IN_COLUMNS = {"instances"}
"""Members of which there are thousands."""
_PART_COLUMNS = 4096
_PART_MEMBERS = 256
_PART_BYTES = 1 << 25
"""Limits of one message about new members: members in columns, other members, and bytes of arrays.
Turning a document into text holds the interpreter, and Blender with it."""


class Part:
    """A document and the arrays that it refers to by their places."""

    def __init__(self) -> None:
        self.document: dict = {}
        self.arrays: list[np.ndarray] = []
        self._members = 0
        self._bytes = 0

    def keep(self, array: np.ndarray) -> int:
        """Add an array; returns its place."""
        self.arrays.append(array)
        self._bytes += array.nbytes
        return len(self.arrays) - 1

    def add(self, field: str, entry: object, members: int = 1) -> None:
        """Say what members are."""
        self._members += members
        self.document.setdefault(field, []).append(entry)

    @property
    def is_full(self) -> bool:
        """Whether the next member belongs into another message."""
        return self._members >= _PART_MEMBERS or self._bytes >= _PART_BYTES


@dataclasses.dataclass
class _Sent:
    """Members and arrays that the receiver has.

    Objects are known by their ids, which stay their own as long as they are kept here.
    """

    members: dict[int, tuple[int, object, Sequence[int]]] = dataclasses.field(default_factory=dict)
    """Handle, member, and the ids of its large arrays."""
    arrays: dict[int, tuple[int, np.ndarray]] = dataclasses.field(default_factory=dict)
    """Handle and array, of large arrays, which members share."""
    users: dict[int, int] = dataclasses.field(default_factory=dict)
    """How many members have a large array."""
    handles: int = 0
    """The last handle given."""

    def new_handle(self) -> int:
        self.handles += 1
        return self.handles

    def leave_array(self, key: int) -> int | None:
        """A member less has a large array: the handle of one that no member has any more."""
        self.users[key] -= 1
        if self.users[key] > 0:
            return None
        del self.users[key]
        return self.arrays.pop(key)[0]


class SceneSender:
    """Knows which members the receiver has."""

    def __init__(self) -> None:
        self._sent = _Sent()
        self._used: dict[int, set[int]] = {}
        """Ids of the members of each session's newest scene."""

    @collector_paused()
    def send(self, session: int, scene: Scene) -> tuple[list[Part], Part]:
        """Return the parts that describe new members, to be sent first, and the part for a session's next scene.

        Raises TypeError for a scene with something in it that no document can hold; the receiver then has no part.
        """
        message = _NewMembers(self._sent)
        try:
            whole = Part()
            whole.document = {
                "members": {
                    **{name: message.handles(name, [getattr(scene, name)])[0] for name in _SINGLE},
                    **{name: message.handles(name, getattr(scene, name)) for name in _LISTS},
                },
                "values": {name: encode(getattr(scene, name), whole.keep) for name in _VALUES},
            }
        except BaseException:
            message.withdraw()
            raise
        before, self._used[session] = self._used.get(session, set()), message.used
        whole.document["dead"] = self._forget(before)
        return message.parts, whole

    def close(self, session: int) -> list[int]:
        """Forget a session; returns the handles that the receiver is to forget."""
        return self._forget(self._used.pop(session, set()))

    def _forget(self, candidates: set[int]) -> list[int]:
        unused = candidates.difference(*self._used.values())
        if not unused:
            return []
        handles = []
        for key in unused:
            handle, _, arrays = self._sent.members.pop(key)
            handles.append(handle)
            handles += [free for array in arrays if (free := self._sent.leave_array(array)) is not None]
        return handles


class _NewMembers:
    """Members of one scene that the receiver does not have yet."""

    def __init__(self, sent: _Sent) -> None:
        self._sent = sent
        self._parts = [Part()]
        self._array_parts: list[Part] = []
        self._added: list[int] = []
        self._asked: list[int] = []
        """Ids of large arrays, as often as new members have them."""
        self.used: set[int] = set()
        """Ids of all members of the scene."""

    @property
    def parts(self) -> list[Part]:
        """Arrays come before the members that have them."""
        return self._array_parts + [part for part in self._parts if part.document]

    def handles(self, field: str, members: Sequence[object]) -> list[int]:
        """The handles of a scene's members, of which new ones are to be sent."""
        known = self._sent.members
        ids = list(map(id, members))
        self.used.update(ids)
        new = {key: member for key, member in zip(ids, members, strict=True) if key not in known}
        if field in _IN_COLUMNS:
            self._add_columns(field, new)
        else:
            for key, member in new.items():
                if self._parts[-1].is_full:
                    self._parts.append(Part())
                part = self._parts[-1]
                large: list[int] = []
                document = encode(member, functools.partial(self._keep, part, large))
                part.add(field, [self._give(key, member, large), document])
        return [known[key][0] for key in ids]

    def _add_columns(self, field: str, new: dict[int, object]) -> None:
        for start in range(0, len(new), _PART_COLUMNS):
            chosen = dict(itertools.islice(new.items(), start, start + _PART_COLUMNS))
            if self._parts[-1].is_full:
                self._parts.append(Part())
            part = self._parts[-1]
            document = encode_columns(list(chosen.values()), _LISTS[field], part.keep)
            first = self._sent.handles + 1
            for key, member in chosen.items():
                self._give(key, member)
            part.add(field, [first, document], _PART_MEMBERS)

    def _give(self, key: int, member: object, large: Sequence[int] = ()) -> int:
        handle = self._sent.new_handle()
        self._sent.members[key] = handle, member, large
        self._added.append(key)
        return handle

    def _keep(self, part: Part, large: list[int], array: np.ndarray) -> int | str:
        """A large array goes by itself, and only once."""
        if array.nbytes < LARGE:
            return part.keep(array)
        sent, key = self._sent, id(array)
        if key not in sent.arrays:
            handle = sent.new_handle()
            sent.arrays[key] = handle, array
            alone = Part()
            alone.add(_ARRAYS, [handle, {"array": alone.keep(array)}])
            self._array_parts.append(alone)
        large.append(key)
        self._asked.append(key)
        sent.users[key] = sent.users.get(key, 0) + 1
        return str(sent.arrays[key][0])

    def withdraw(self) -> None:
        """Nothing is sent after all."""
        for key in self._added:
            del self._sent.members[key]
        for key in self._asked:
            self._sent.leave_array(key)


class SceneReceiver:
    """Keeps the members that the sender refers to."""

    def __init__(self) -> None:
        self._members: dict[int, Any] = {}
        """Large arrays are among them."""

    @collector_paused()
    def learn(self, document: dict, arrays: Sequence[np.ndarray]) -> None:
        """Take a part that describes new members. Raises KeyError, TypeError or ValueError for what is none."""
        kinds = _SINGLE | _LISTS | {_ARRAYS: np.ndarray}
        found = _Found(self._members, arrays)
        for name, entries in document.items():
            for handle, entry in entries:
                if name in _IN_COLUMNS:
                    self._members.update(enumerate(decode_columns(entry, kinds[name], found), handle))
                else:
                    self._members[handle] = decode(entry, kinds[name], found)

    def receive(self, document: dict, arrays: Sequence[np.ndarray]) -> Scene:
        """The scene of the part that describes it, once its members are known. Raises as learn does."""
        known, handles = self._members, document["members"]
        members: dict[str, Any] = {name: known[handles[name]] for name in _SINGLE}
        members |= {name: [known[handle] for handle in handles[name]] for name in _LISTS}
        members |= {name: decode(value, _VALUES[name], arrays) for name, value in document["values"].items()}
        scene = Scene(**members)
        self.forget(document["dead"])
        return scene

    def forget(self, handles: Sequence[int]) -> None:
        """Forget members that no session uses any more."""
        for handle in handles:
            self._members.pop(handle, None)


class _Found:
    """Arrays by their references: places in the message, or handles as text."""

    def __init__(self, members: dict[int, Any], arrays: Sequence[np.ndarray]) -> None:
        self._members, self._arrays = members, arrays

    def __getitem__(self, reference: int | str) -> np.ndarray:
        return self._members[int(reference)] if isinstance(reference, str) else self._arrays[reference]
