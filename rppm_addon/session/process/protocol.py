# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender and its renderer process say to each other: framed JSON over two pipes.

A message is a JSON object behind its length in four bytes; its "kind" says what it is. Only the standard library is
imported here: the child reads its first message before it can find anything else.

To the child                          meaning
hello version, path                   first; path are folders to find modules in
open session, session_kind            a SessionKind's name
members session, number, document, arrays
                                      new members of the snapshot of this number (transfer.py)
show session, number, document, arrays, generation, navigating
                                      a snapshot
pause session, paused
expect_snapshots session, seconds     a render is to send its picture at these times
keep_still session, path              renders go on from this checkpoint and are kept in it; "" is none
want_picture session                  a render is to send its picture once
received session                      the render's oldest frame is copied: its shared memory is free
stop session, generation              the render of a scene is to end with what it has
close session, dead                   dead are the handles of members that nothing uses any more
forget dead                           the same without closing
ping
leave                                 end; so does the end of the pipe

From the child
ready version, device                 the answer to hello
unusable text                         the device cannot be used: another child would do no better
taken session, number                 a snapshot is decoded: its shared memory is free
slots session, block, capacity        where the session's frames are from now on (frames.py)
frame session, slot, generation, sequence, width, height, progress
                                      progress 0 is a first look
status session, status                a SessionStatus
progress session, progress            a render's Progress
picture session, arrays, progress     as it was wanted
snapshot session, arrays, seconds     as it was expected
result session, arrays, statistics, stopped
failed session, error, text           the render has ended with an error of this name
prepared session                      the programs of a scene are compiled, or will be
pong
"""

import json
import struct
from typing import BinaryIO

VERSION = 5
LONGEST_MESSAGE = 1 << 28
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
    except ValueError as error:
        raise ProtocolError(f"a message is no JSON ({error})") from error
    if not isinstance(message, dict) or not isinstance(message.get("kind"), str):
        raise ProtocolError("a message is no object with a kind")
    return message
