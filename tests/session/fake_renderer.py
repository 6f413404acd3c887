# SPDX-License-Identifier: GPL-3.0-or-later
"""Stands in for Python and the renderer's process, and goes wrong as its first argument says."""

import dataclasses
import os
import random
import select
import signal
import sys
import time
from pathlib import Path

ROOT = str(Path(__file__).resolve().parents[2])
SIZE = 8


class Pipes:
    """The process's end of the talk, with a viewport's slots."""

    def __init__(self):
        self.input, self.output = sys.stdin.buffer, os.fdopen(os.dup(1), "wb")

    def hear(self, *kinds):
        """The next message of one of these kinds; ends the process with the pipe."""
        while (message := read_message(self.input)) is not None:
            if message["kind"] in kinds:
                return message
        sys.exit(0)

    def say(self, kind, **content):
        write_message(self.output, kind, **content)

    def greet(self):
        hello = self.hear("hello")
        device = dataclasses.asdict(DeviceInformation("fake", "none", "4.3"))
        self.say("ready", version=hello["version"], device=device)

    def take(self):
        """A snapshot of a scene, and its arrays."""
        while (shown := self.hear("members", "show"))["kind"] == "members":
            unpack(shown["arrays"])
        self.say("taken", session=shown["session"], number=shown["number"])
        return shown

    def announce(self, frames, shown, generation, value, **changes):
        """Write a frame of one value and say so, with changes to what is said."""
        import numpy as np

        slots = frames.reserve(SIZE * SIZE)
        if slots is not None:
            self.say("slots", session=shown["session"], **slots)
        written = frames.write(generation, np.full((SIZE, SIZE, 4), value, np.float32))
        self.say("frame", **{"session": shown["session"], "progress": 0.5, **written, **changes})


def wait_for_leave(pipes):
    while True:
        pipes.hear("leave")
        sys.exit(0)


def import_error(pipes):
    raise ImportError("no module that draws")


def ends_before_the_greeting(pipes):
    pipes.hear("hello")
    sys.exit(3)


def hangs_in_the_greeting(pipes):
    pipes.hear("hello")


def has_no_device(pipes):
    pipes.hear("hello")
    pipes.say("unusable", text="no OpenGL 4.3; install a driver")
    sys.exit(0)


def is_of_another_version(pipes):
    pipes.hear("hello")
    pipes.say("ready", version=-1, device=None)


def hangs_and_stops_reading(pipes):
    pipes.greet()


def hangs_after_a_frame(pipes):
    pipes.greet()
    pipes.announce(FrameWriter(), shown := pipes.take(), shown["generation"], 1.0)


def ignores_the_end(pipes):
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    pipes.greet()
    pipes.take()


def is_killed_amid_a_frame(pipes):
    """The first process dies with a slot half written, the second one gives a whole frame."""
    import numpy as np

    marker = Path(sys.argv[2]) / "died"
    pipes.greet()
    shown = pipes.take()
    frames = FrameWriter()
    pipes.announce(frames, shown, shown["generation"], 1.0)
    if marker.exists():
        wait_for_leave(pipes)
    marker.touch()

    class Deadly(np.ndarray):
        """A picture that is announced, and the end of its process, before its pixels are copied."""

        def reshape(self, *shape):
            announced = {"generation": shown["generation"], "sequence": 2, "width": SIZE, "height": SIZE}
            pipes.say("frame", session=shown["session"], slot=2, progress=0.5, **announced)
            time.sleep(0.2)
            os.kill(os.getpid(), signal.SIGKILL)

    frames.write(shown["generation"], np.full((SIZE, SIZE, 4), np.nan, np.float32).view(Deadly))


def loses_the_device(pipes):
    pipes.greet()
    pipes.take()
    pipes.say("lost", text="the driver has reset the graphics device")
    wait_for_leave(pipes)


def dies_with_each_scene(pipes):
    pipes.greet()
    pipes.take()
    os.kill(os.getpid(), signal.SIGSEGV)


def dies_amid_a_message(pipes):
    pipes.greet()
    pipes.take()
    pipes.output.write(b"\xff\0\0\0{")
    pipes.output.flush()
    sys.exit(7)


def sends_malformed_data_first(pipes):
    pipes.output.write(b"\xff" + random.Random(1).randbytes(1 << 16))
    pipes.output.flush()


def sends_no_json(pipes):
    pipes.greet()
    pipes.output.write(b"\4\0\0\0abcd")
    pipes.output.flush()


def sends_unknown_messages(pipes):
    pipes.greet()
    pipes.say("weather", session=pipes.take()["session"])


def sends_wrong_content(pipes):
    pipes.greet()
    pipes.say("status", session=pipes.take()["session"], status={"mood": 1})


def sends_impossible_frames(pipes):
    pipes.greet()
    pipes.announce(FrameWriter(), shown := pipes.take(), shown["generation"], 1.0, width=1 << 20)


def names_foreign_files(pipes):
    pipes.greet()
    pipes.say("slots", session=pipes.take()["session"], block="/etc/passwd", capacity=1)


def sends_old_frames(pipes):
    """Frames of scenes that are past, that never were, and one that was written over since."""
    pipes.greet()
    frames = FrameWriter()
    shown = pipes.take()
    now = shown["generation"]
    pipes.announce(frames, shown, now, 1.0)
    pipes.announce(frames, shown, now - 1, 2.0)
    pipes.announce(frames, shown, now + 1, 3.0)
    pipes.say(
        "frame", session=shown["session"], slot=1, generation=now, sequence=4, width=SIZE, height=SIZE, progress=1
    )
    pipes.say("status", session=shown["session"], status={"generation": now, "settled": True})
    wait_for_leave(pipes)


def floods(pipes):
    pipes.greet()
    shown = pipes.take()
    status = {"session": shown["session"], "status": {"generation": shown["generation"], "warnings": ["x" * 200]}}
    message = frame_message("status", **status)
    while True:
        pipes.output.write(message)


def fills_the_log(pipes):
    pipes.greet()
    while True:
        sys.stderr.write("the driver complains\n" * 1000)
        sys.stderr.flush()
        if select.select([pipes.input], [], [], 0.0)[0]:
            pipes.hear("ping", "leave")
            pipes.say("pong")


if __name__ == "__main__":
    sys.path.insert(0, ROOT)
    from rppm_addon.session.transport.protocol import frame_message, read_message, write_message

    talk = Pipes()
    os.dup2(2, 1)
    if sys.argv[1] not in ("import_error", "ends_before_the_greeting", "hangs_in_the_greeting"):
        from rppm_addon.gl.context.context import DeviceInformation
        from rppm_addon.session.transport.arrays import unpack
        from rppm_addon.session.transport.frames import FrameWriter
    globals()[sys.argv[1]](talk)
    time.sleep(1000)  # whoever comes here hangs
