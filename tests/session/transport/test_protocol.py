# SPDX-License-Identifier: GPL-3.0-or-later
"""Framed messages."""

import io
import subprocess
import sys
from pathlib import Path

import pytest

from rppm_addon.session.transport import protocol
from rppm_addon.session.transport.protocol import ProtocolError

ROOT = Path(__file__).resolve().parents[3]


def test_messages_come_one_after_the_other():
    messages = [("a", {}), ("b", {"text": "\u00e4\u20ac\n", "number": 1.5e-300, "list": [None, True]})]
    stream = io.BytesIO(b"".join(protocol.frame_message(kind, **content) for kind, content in messages))
    for kind, content in messages:
        assert protocol.read_message(stream) == {"kind": kind, **content}
    assert protocol.read_message(stream) is None


@pytest.mark.parametrize("length", range(12))
def test_a_pipe_that_ends_amid_a_message_has_ended(length):
    whole = protocol.frame_message("a")
    assert len(whole) > 12 and protocol.read_message(io.BytesIO(whole[:length])) is None


@pytest.mark.parametrize(
    "text",
    [b"\4\0\0\0abcd", b"\2\0\0\0[]", b"\2\0\0\0{}", b'\x0a\0\0\0{"kind":3}', b"\2\0\0\0\xff\xfe",
     (protocol.LONGEST_MESSAGE + 1).to_bytes(4, "little")],
)  # fmt: skip
def test_malformed_text(text):
    with pytest.raises(ProtocolError):
        protocol.read_message(io.BytesIO(text))


def test_the_child_can_read_its_first_message_before_it_finds_numpy():
    code = (
        "import sys; sys.modules['numpy'] = sys.modules['moderngl'] = None; sys.path.insert(0, sys.argv[1]);"
        "import rppm_addon.session.transport.protocol"
    )
    subprocess.run([sys.executable, "-I", "-S", "-c", code, str(ROOT)], check=True, timeout=60)


def test_messages_of_the_tables_are_let_in():
    for table in (protocol.TO_CHILD, protocol.FROM_CHILD):
        for kind, fields in table.items():
            values = {name: (types if isinstance(types, type) else types[0])() for name, types in fields.items()}
            protocol.check_message({"kind": kind, **values}, table)


@pytest.mark.parametrize(
    "message",
    [
        {"kind": "weather"}, {"kind": "pong", "session": 1}, {"kind": "taken", "session": 1},
        {"kind": "taken", "session": [1], "number": 1}, {"kind": "taken", "session": 1, "number": 1.0},
        {"kind": "taken", "session": True, "number": 1}, {"kind": "status", "session": 1, "status": []},
        {"kind": "failed", "session": 1, "error": "E", "text": None}, {"kind": "prepared", "session": "1"},
    ],
    ids=str,
)  # fmt: skip
def test_other_messages_are_refused(message):
    with pytest.raises(ProtocolError):
        protocol.check_message(message, protocol.FROM_CHILD)


def test_a_message_of_brackets():
    text = b"[" * 100000
    with pytest.raises(ProtocolError):
        protocol.read_message(io.BytesIO(len(text).to_bytes(4, "little") + text))
