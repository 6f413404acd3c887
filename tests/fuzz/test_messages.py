# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages that the renderer's process may send to Blender, and that a farm may hand to its workers."""

import dataclasses
import io
import json
from pathlib import Path

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given
from support.full_scene import full_scene

from fuzz.counting import fuzzed, may_refuse
from fuzz.values import INTEGERS, NUMBERS, TEXTS, VALUES, as_json, changed_documents, damaged_bytes
from rppm_addon.commands.farm.tasks import Task
from rppm_addon.scene.errors import SettingsError
from rppm_addon.session.render.results import PhotonStatistics, Progress, RenderStatistics
from rppm_addon.session.transport import protocol
from rppm_addon.session.transport.arrays import pack, unpack
from rppm_addon.session.transport.frames import FrameReader, FrameWriter
from rppm_addon.session.transport.protocol import ProtocolError
from rppm_addon.session.transport.received import received
from rppm_addon.session.transport.sessions import SessionStatus

_ARRAYS = [np.arange(12, dtype=np.float32).reshape(3, 4), np.zeros(3, np.uint8), np.zeros((0, 3))]
_PACKED, _ = pack(_ARRAYS)
_KINDS = st.sampled_from(["<f4", "<f8", "|u1", "<i8", "|O", "V0", "<U0", "f4,O", "(9,9)f4", "<c16", "", 5])
LAYOUTS = st.lists(
    st.one_of(VALUES, st.tuples(_KINDS, st.lists(INTEGERS, max_size=10), st.one_of(INTEGERS, NUMBERS))), max_size=3
)


@pytest.fixture(scope="module")
def shared():
    """A description whose arrays lie in shared memory."""
    description, block = pack([np.arange(1 << 14, dtype=np.float32), *_ARRAYS])
    yield description
    block.close()


@fuzzed
@given(layout=LAYOUTS, where=st.sampled_from(["shared", "message"]), data=st.data())
def test_layouts(shared, layout, where, data):
    description = shared if where == "shared" else _PACKED
    if data.draw(st.booleans()):
        description = description | {"layout": layout}
    else:
        description = data.draw(changed_documents(as_json(description)))
    with may_refuse("layouts-of-arrays", ProtocolError):
        if not isinstance(description, dict):
            raise ProtocolError("the table of messages says that it is one")
        arrays = unpack(as_json(description))
        assert sum(array.nbytes for array in arrays) <= description["size"]
        for array in arrays:
            array.sum()  # which reads all of it


@fuzzed
@given(data=st.data())
def test_pipes(data):
    stream = b"".join(protocol.frame_message("status", session=1, status={"iteration": place}) for place in range(3))
    pipe = io.BytesIO(data.draw(damaged_bytes(stream)))
    with may_refuse("pipes", ProtocolError):
        while (message := protocol.read_message(pipe)) is not None:
            protocol.check_message(message, protocol.FROM_CHILD)


@fuzzed
@given(data=st.data())
def test_messages(data):
    table = data.draw(st.sampled_from([protocol.TO_CHILD, protocol.FROM_CHILD]))
    kind = data.draw(st.sampled_from(sorted(table)))
    fields = table[kind]
    message = {name: (types if isinstance(types, type) else types[0])() for name, types in fields.items()}
    message = data.draw(changed_documents({"kind": kind, **message}))
    with may_refuse("messages", ProtocolError):
        text = json.dumps(message).encode()
        read = protocol.read_message(io.BytesIO(len(text).to_bytes(4, "little") + text))
        protocol.check_message(read, table)
        assert read.keys() - {"kind"} == table[read["kind"]].keys()


@fuzzed
@given(data=st.data())
def test_records(data):
    good = data.draw(
        st.sampled_from(
            [
                SessionStatus(
                    progress=Progress(1, 2, 3.0, 4),
                    photon_statistics=PhotonStatistics(0.1, source_watts={"Lamp": 5.0}),
                    warnings=["w"],
                ),
                Progress(1, 2, 3.0, 4),
                RenderStatistics(1, 2, 3.0, 4.0, "d", 5, PhotonStatistics(0.1), stage_seconds={"a": 1.0}),
            ]
        )
    )
    values = data.draw(changed_documents(as_json(dataclasses.asdict(good))))
    with may_refuse("records-of-messages", ProtocolError):
        if not isinstance(values, dict):
            raise ProtocolError("the table of messages says that it is one")
        record = received(type(good), values)
        if isinstance(record, Progress):
            assert record.fraction <= 1.0 or record.fraction != record.fraction
        assert type(record) is type(good)


@pytest.fixture(scope="module")
def frames():
    writer = FrameWriter()
    slots = writer.reserve(64)
    yield FrameReader(**slots), writer.write(1, np.ones((4, 8, 4), np.float32)), slots["block"]
    writer.release()


@fuzzed
@given(data=st.data())
def test_frames(frames, data):
    reader, announced, name = frames
    changes = data.draw(st.dictionaries(st.sampled_from(sorted(announced)), st.one_of(NUMBERS, VALUES), max_size=3))
    with may_refuse("frames", ProtocolError):
        picture = reader.read(**(announced | changes))
        assert picture is None or picture.shape == (4, 8, 4)
    block = data.draw(st.one_of(st.just(name), TEXTS, st.just("/proc/1/fd/0:1")))
    with may_refuse("slots-of-frames", ProtocolError, FileNotFoundError):
        FrameReader(block, data.draw(st.one_of(st.just(64), NUMBERS)))


FOLDER = Path("/out/x.farm")
PATHS = st.one_of(
    st.sampled_from(["/out/####.exr", "/out/a.png", "/out/../etc/x.exr", "/out/..", "x.exr", "/", "/out/x.farm/a.exr"]),
    st.text(max_size=12),
).map(Path)
_WORDS = """render merge export info /in/a.blend -o /etc/x.exr --json --js=/etc/x --checkpoint --checkp=/etc/c.exr
--resume --samples-range 0:4 --set rppm.alpha=0.5 --frames --help --"""
WORDS = st.one_of(st.sampled_from(_WORDS.split()), TEXTS)


@fuzzed
@given(
    arguments=st.lists(WORDS, max_size=6).map(lambda words: ("render", "/in/a.blend", *words)),
    outputs=st.lists(PATHS, max_size=2).map(tuple),
    frames=st.lists(st.one_of(INTEGERS, VALUES), max_size=2).map(tuple),
    changes=st.dictionaries(st.sampled_from(["arguments", "outputs", "frames", "words"]), VALUES, max_size=1),
)
def test_tasks_of_farms(arguments, outputs, frames, changes):
    task = dataclasses.replace(Task(arguments, outputs, frames), **changes)
    with may_refuse("tasks-of-farms", SettingsError):
        task.check(FOLDER)
        for path in task.outputs:
            assert path.is_absolute() and ".." not in path.parts and path.suffix in (".exr", ".png")
        written = [word for word in task.arguments if word.startswith("/etc")]
        marks = [place for place, word in enumerate(task.arguments) if word in written]
        assert all(task.arguments[place - 1] not in ("-o", "--json", "--checkpoint") for place in marks)


def test_the_full_scene_is_full():
    """Fuzzing forgets what the scene that it changes has none of."""
    scene = full_scene()
    assert all((scene.meshes, scene.instances, scene.lights, scene.images, scene.shutter, scene.neighbors))
