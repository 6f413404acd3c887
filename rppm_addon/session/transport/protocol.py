# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages between Blender and its renderer process: framed JSON over two pipes.

A message is a JSON object behind its length in four bytes; its "kind" says what it is. Only the standard library is
imported here: the child reads its first message before it can find anything else.
A table lists the fields of each kind of message; both sides refuse anything else.
"""

import json
import struct
from collections.abc import Mapping
from typing import Any, BinaryIO, TypeAlias

VERSION = 8
LONGEST_MESSAGE = 1 << 28
_Fields: TypeAlias = dict[str, Any]
"""Types, or tuples of types, of what a message has beside its kind."""
_SESSION: _Fields = {"session": int}
_PACKED: _Fields = {"document": dict, "arrays": dict}
"""A part of a scene (transfer.py), and the arrays that it refers to (arrays.py)."""

TO_CHILD: dict[str, _Fields] = {
    # First; path are folders to find modules in.
    "hello": {"version": int, "path": list, "denoisers": list},
    # session_kind is a SessionKind's name.
    "open": _SESSION | {"session_kind": str},
    # New members of the snapshot of this number.
    "members": _SESSION | _PACKED | {"number": int},
    # A snapshot.
    "show": _SESSION | _PACKED | {"number": int, "generation": int, "navigating": bool},
    "pause": _SESSION | {"paused": bool},
    # Times at which a render sends its picture.
    "expect_snapshots": _SESSION | {"seconds": list},
    # Renders continue from this checkpoint and are kept in it; "" is none.
    "set_checkpoint": _SESSION | {"path": str},
    # The render of the next scene continues from the state of a process that has ended for this reason.
    "resume": _SESSION | _PACKED | {"seconds": (float, int), "reason": str},
    # A render sends its picture once.
    "request_picture": _SESSION,
    # The render's oldest frame is copied: its shared memory is free.
    "received": _SESSION,
    # The render of a scene ends with the picture that it has.
    "stop": _SESSION | {"generation": int},
    # dead are the handles of members that nothing uses any more.
    "close": _SESSION | {"dead": list},
    # The same without closing.
    "forget": {"dead": list},
    "ping": {},
    # Open each device for a moment, to report more about it.
    "list_devices": {},
    # End; so does the end of the pipe.
    "leave": {},
}
FROM_CHILD: dict[str, _Fields] = {
    # The answer to hello; device is a DeviceInformation, or None from another version.
    "ready": {"version": int, "device": (dict, type(None))},
    # The device cannot be used: another child would do no better.
    "unusable": {"text": str},
    # A snapshot is decoded: its shared memory is free.
    "taken": _SESSION | {"number": int},
    # Where the session's frames are from now on (frames.py).
    "slots": _SESSION | {"block": str, "capacity": int},
    # progress 0 is a first look.
    "frame": _SESSION
    | {"slot": int, "generation": int, "sequence": int, "width": int, "height": int, "progress": (float, int)},
    # A SessionStatus.
    "status": _SESSION | {"status": dict},
    # A render's Progress.
    "progress": _SESSION | {"progress": dict},
    # The picture that was requested.
    "picture": _SESSION | {"arrays": dict, "passes": list, "progress": dict},
    # The picture at a time that was named.
    "snapshot": _SESSION | {"arrays": dict, "passes": list, "seconds": (float, int)},
    # State with which another process continues a render (kept_renders.py).
    "kept": _SESSION | _PACKED | {"generation": int, "seconds": (float, int)},
    # The last; statistics are RenderStatistics.
    "result": _SESSION | {"arrays": dict, "passes": list, "statistics": dict, "stopped": bool},
    # The render has ended with an error of this name.
    "failed": _SESSION | {"error": str, "text": str},
    # The programs of a scene are compiled, or will be.
    "prepared": _SESSION,
    # The driver has reset the device: the child ends.
    "lost": {"text": str},
    "pong": {},
    # As they were asked for; each is a Device.
    "devices": {"devices": list},
}
_LENGTH = struct.Struct("<I")


class ProtocolError(Exception):
    """The other side does not speak this protocol."""


def frame_message(kind: str, **content: object) -> bytes:
    """A message as it goes through the pipe."""
    text = json.dumps({"kind": kind, **content}, separators=(",", ":")).encode()
    return _LENGTH.pack(len(text)) + text


def write_message(stream: BinaryIO, kind: str, **content: object) -> None:
    """Send a message. Raises OSError when the pipe is gone."""
    stream.write(frame_message(kind, **content))
    stream.flush()


def read_message(stream: BinaryIO) -> dict | None:
    """The next message, or None when the pipe has ended, be it amid a message. Raises ProtocolError if malformed."""
    header = stream.read(_LENGTH.size)
    if len(header) < _LENGTH.size:
        return None
    (length,) = _LENGTH.unpack(header)
    if length > LONGEST_MESSAGE:
        raise ProtocolError(f"a message of {length} bytes was announced")
    text = stream.read(length)
    if len(text) < length:
        return None
    try:
        message = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ProtocolError(f"a message is no JSON ({error})") from error
    if not isinstance(message, dict) or not isinstance(message.get("kind"), str):
        raise ProtocolError("a message is no object with a kind")
    return message


def check_message(message: Mapping[str, object], table: Mapping[str, _Fields]) -> None:
    """Raise ProtocolError unless a message is one of a table's, with what the table says and nothing else."""
    kind = message["kind"]
    if kind not in table:
        raise ProtocolError(f"there is no message {kind!r:.40}")
    fields = table[str(kind)]
    if message.keys() - {"kind"} != fields.keys():
        raise ProtocolError(f"the message {kind} has {', '.join(sorted(message.keys() - {'kind'}))!r:.200}")
    for name, types in fields.items():
        value = message[name]
        if not isinstance(value, types) or (isinstance(value, bool) and types is not bool):
            raise ProtocolError(f"the message {kind} has the {name} {value!r:.60}")
