# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames in three slots: whole or not at all."""

import queue
import threading

import numpy as np
import pytest

from rppm_addon.session.transport.frames import SLOTS, FrameReader, FrameWriter
from rppm_addon.session.transport.protocol import ProtocolError


def picture(value, width=8, height=4):
    return np.full((height, width, 4), value, np.float32)


@pytest.fixture
def pair():
    """A writer of up to 64 pixels and its reader."""
    writer = FrameWriter()
    reader = FrameReader(**writer.reserve(64))
    yield writer, reader
    writer.release()


def test_frames_of_changing_sizes(pair):
    writer, reader = pair
    rng = np.random.default_rng(0)
    for generation, shape in enumerate([(4, 8), (8, 8), (1, 1), (64, 1)]):
        combined = rng.random((*shape, 4), np.float32)
        assert writer.reserve(shape[0] * shape[1]) is None
        read = reader.read(**writer.write(generation, combined))
        np.testing.assert_array_equal(read, combined)


def test_larger_frames_get_new_slots(pair):
    writer, reader = pair
    old = writer.write(1, picture(1.0))
    larger = FrameReader(**writer.reserve(100))
    np.testing.assert_array_equal(reader.read(**old), picture(1.0))  # still mapped
    np.testing.assert_array_equal(larger.read(**writer.write(1, picture(2.0, 10, 10))), picture(2.0, 10, 10))


def test_a_frame_that_was_written_over_is_not_read(pair):
    writer, reader = pair
    announced = [writer.write(1, picture(value)) for value in range(SLOTS + 1)]
    assert reader.read(**announced[0]) is None
    for value in range(1, SLOTS + 1):
        np.testing.assert_array_equal(reader.read(**announced[value]), picture(value))


def test_a_frame_that_is_being_written_is_not_read(pair):
    writer, reader = pair
    first = {"slot": 1, "generation": 1, "sequence": 1, "width": 8, "height": 4}
    read = []

    class Watched(np.ndarray):
        """A picture that is read in the middle of its writing."""

        def reshape(self, *shape):
            read.append(reader.read(**first))
            return super().reshape(*shape)

    assert writer.write(1, picture(1.0).view(Watched)) == first
    assert read == [None] and reader.read(**first) is not None


def test_no_torn_frame_is_read():
    """A writer that never waits for a reader that is always late: each frame is of one value, or is not read."""
    writer = FrameWriter()
    pixels = 256 * 256
    reader = FrameReader(**writer.reserve(pixels))
    announced = queue.Queue(maxsize=SLOTS)
    stop = threading.Event()

    def write():
        value = 0
        while not stop.is_set():
            value += 1
            frame = writer.write(value, picture(value, 256, 256))
            try:
                announced.put_nowait((value, frame))
            except queue.Full:
                continue

    thread = threading.Thread(target=write)
    thread.start()
    whole = late = 0
    try:
        while whole < 50 or late < 50:
            value, frame = announced.get(timeout=30)
            combined = reader.read(**frame)
            if combined is None:
                late += 1
                continue
            whole += 1
            assert (combined == value).all()
    finally:
        stop.set()
        thread.join()
        writer.release()


@pytest.mark.parametrize("capacity", [0, -4, -(1 << 40), 1 << 50, 4.0, "64", None, True])
def test_slots_that_cannot_be(capacity):
    writer = FrameWriter()
    with pytest.raises(ProtocolError):
        FrameReader(**(writer.reserve(64) | {"capacity": capacity}))
    writer.release()


@pytest.mark.parametrize(
    "change",
    [
        {"slot": -1}, {"slot": SLOTS}, {"slot": 0.5}, {"width": -8}, {"width": 65}, {"width": 1 << 40}, {"height": 0},
        {"width": 8.0}, {"width": -8, "height": -4}, {"generation": None}, {"sequence": "1"}, {"sequence": -1},
    ],
)  # fmt: skip
def test_frames_that_cannot_be(pair, change):
    writer, reader = pair
    with pytest.raises(ProtocolError):
        reader.read(**(writer.write(1, picture(1.0)) | change))
