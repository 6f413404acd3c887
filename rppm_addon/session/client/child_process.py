# SPDX-License-Identifier: GPL-3.0-or-later
"""The renderer's process as the process that starts it sees it: pipes, shared memory, and its end."""

import contextlib
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import BinaryIO

from ...denoising.places import LibraryPlace
from ...scene.scene import Scene
from ..transport.arrays import pack
from ..transport.protocol import VERSION, frame_message, read_message
from ..transport.shared_memory import SharedBlock
from ..transport.transfer import Part, SceneSender
from .job_object import end_with_this_process

_BOOTSTRAP = Path(__file__).parents[1] / "worker" / "bootstrap.py"
if sys.platform == "win32":
    _FLAGS = subprocess.CREATE_NO_WINDOW | subprocess.BELOW_NORMAL_PRIORITY_CLASS
else:
    _FLAGS = 0


class ProcessEnded(Exception):
    """The process has ended and receives no more messages; reading from it says why."""


class ChildProcess:
    """One started process. Messages are sent by one thread and read by another; any thread may kill it."""

    def __init__(
        self,
        python: Sequence[str],
        folders: Sequence[str],
        log_path: Path,
        denoisers: Sequence[LibraryPlace] = (),
        environment: Mapping[str, str] | None = None,
    ) -> None:
        """Start ``python`` (a program and its options) and greet it; arguments as RendererProcess's. Raises OSError
        when it cannot be started."""
        with _opened(log_path) as log:
            self._process = subprocess.Popen(
                [*python, str(_BOOTSTRAP)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=log,
                creationflags=_FLAGS,
                env={**os.environ, **(environment or {})},
            )
        end_with_this_process(self._process)
        self.pid = self._process.pid
        self._folders = list(folders)
        self._denoisers = [(place.source.name, str(place.path)) for place in denoisers]
        self._scenes = SceneSender()
        self._blocks: dict[tuple[int, int], list[SharedBlock]] = {}
        self._killed = False
        self._lock = threading.Lock()

    # In the writing thread.

    def greet(self) -> None:
        """Send the first message; the process answers when it has opened the device."""
        self.send("hello", version=VERSION, path=self._folders, denoisers=self._denoisers)

    def send(self, kind: str, **content: object) -> None:
        """Send a message. Raises ProcessEnded when the process has gone."""
        message = frame_message(kind, **content)
        try:
            self._process.stdin.write(message)
            self._process.stdin.flush()
        except (OSError, ValueError) as error:
            raise ProcessEnded(str(error)) from error

    def send_scene(self, session: int, number: int, scene: Scene, generation: int, navigating: bool) -> None:
        """Send a session's snapshot.

        Raises ProcessEnded as send does, MemoryError when there is not enough shared memory, and TypeError for a
        scene that cannot be sent.
        """
        parts, whole = self._scenes.send(session, scene)
        try:
            for part in parts:
                self._send_part("members", session, number, part)
            self._send_part("show", session, number, whole, generation=generation, navigating=navigating)
        except OSError as error:
            self.send("forget", dead=self._scenes.close(session))
            raise MemoryError(f"there is not enough shared memory ({error})") from error

    def _send_part(self, kind: str, session: int, number: int, part: Part, **content: object) -> None:
        """Raises OSError when there is not enough shared memory."""
        description, block = pack(part.arrays)
        if block is not None:
            self._lend(block, session, number)
        self.send(kind, session=session, number=number, document=part.document, arrays=description, **content)

    def _lend(self, block: SharedBlock, session: int, number: int) -> None:
        with self._lock:
            if not self._killed:
                self._blocks.setdefault((session, number), []).append(block)
                return
        block.close()
        raise ProcessEnded

    def close_session(self, session: int) -> None:
        """Have a session closed, and forget what was sent for it. Raises ProcessEnded as send does."""
        self.send("close", session=session, dead=self._scenes.close(session))

    # In the reading thread.

    def read(self) -> dict | None:
        """The next message; None when the process has ended its pipe. Raises ProtocolError for malformed data."""
        return read_message(self._process.stdout)

    def taken(self, session: int, number: int) -> None:
        """Free the arrays of a snapshot, which the process has copied."""
        with self._lock:
            blocks = self._blocks.pop((session, number), ())
        for block in blocks:
            block.close()

    # In any thread.

    def wait(self, seconds: float) -> bool:
        """Whether the process has ended within so many seconds."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(seconds)
        return self._process.returncode is not None

    def kill(self) -> None:
        """End the process, whatever it does, and give its shared memory back."""
        self._process.kill()
        self.wait(2.0)
        with self._lock:
            self._killed = True
        for session, number in list(self._blocks):
            self.taken(session, number)

    def close_pipes(self) -> None:
        """Close the pipes, after the threads that use them have ended."""
        for pipe in (self._process.stdin, self._process.stdout):
            with contextlib.suppress(OSError):
                pipe.close()

    @property
    def ending(self) -> str:
        """Words for how the process ended."""
        code = self._process.poll()
        if code is None:
            return "stopped answering"
        if code < 0:
            with contextlib.suppress(ValueError):
                return f"was ended by {signal.Signals(-code).name}"
        return f"ended with code {code if code < 256 else hex(code)}"


def _opened(log_path: Path) -> BinaryIO:
    """Open the log to append to it, or the null device: a log that cannot be written is no reason not to render."""
    try:
        log_path.parent.mkdir(parents=True, exist_ok=True)
        return log_path.open("ab")
    except OSError:
        return Path(os.devnull).open("ab")
