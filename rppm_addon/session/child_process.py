# SPDX-License-Identifier: GPL-3.0-or-later
"""The renderer's process as the process that starts it sees it: pipes, shared memory, and its end."""

import contextlib
import signal
import subprocess
import sys
import threading
from collections.abc import Sequence
from pathlib import Path

from ..scene.scene import Scene
from .arrays import pack
from .protocol import VERSION, frame_message, read_message
from .shared_memory import SharedBlock
from .transfer import SceneSender

_BOOTSTRAP = Path(__file__).with_name("bootstrap.py")
_FLAGS = subprocess.CREATE_NO_WINDOW | subprocess.BELOW_NORMAL_PRIORITY_CLASS if sys.platform == "win32" else 0


class ProcessEnded(Exception):
    """There is nobody to send to any more; whoever reads from the process learns why."""


class ChildProcess:
    """One started process. Messages are sent by one thread and read by another; any thread may kill it."""

    def __init__(self, python: Sequence[str], folders: Sequence[str], log_path: Path) -> None:
        """Start ``python`` (a program and its options) and greet it. Raises OSError when it cannot be started."""
        log_path.parent.mkdir(parents=True, exist_ok=True)
        with open(log_path, "ab") as log:
            self._process = subprocess.Popen(
                [*python, str(_BOOTSTRAP)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=log,
                creationflags=_FLAGS,
            )
        self.pid = self._process.pid
        self._folders = list(folders)
        self._scenes = SceneSender()
        self._blocks: dict[tuple[int, int], SharedBlock] = {}
        self._killed = False
        self._lock = threading.Lock()

    # In the writing thread.

    def greet(self) -> None:
        self.send("hello", version=VERSION, path=self._folders)

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
        document, arrays = self._scenes.send(session, scene)
        try:
            description, block = pack(arrays)
        except OSError as error:
            self.send("forget", dead=self._scenes.close(session))
            raise MemoryError(f"there is not enough shared memory ({error})") from error
        if block is not None:
            self._lend(block, session, number)
        self.send(
            "show", session=session, number=number, generation=generation, navigating=navigating,
            scene=document, arrays=description,
        )  # fmt: skip

    def _lend(self, block: SharedBlock, session: int, number: int) -> None:
        with self._lock:
            if not self._killed:
                self._blocks[session, number] = block
                return
        _discard(block)
        raise ProcessEnded

    def close_session(self, session: int) -> None:
        self.send("close", session=session, dead=self._scenes.close(session))

    # In the reading thread.

    def read(self) -> dict | None:
        """The next message; None when the process has ended its pipe. Raises ProtocolError for rubbish."""
        return read_message(self._process.stdout)

    def taken(self, session: int, number: int) -> None:
        """The process has copied a snapshot's arrays."""
        with self._lock:
            block = self._blocks.pop((session, number), None)
        if block is not None:
            _discard(block)

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
        """After the threads that use them have ended."""
        for pipe in (self._process.stdin, self._process.stdout):
            with contextlib.suppress(OSError):
                pipe.close()

    @property
    def ending(self) -> str:
        """How the process ended, in words."""
        code = self._process.poll()
        if code is None:
            return "stopped answering"
        if code < 0:
            with contextlib.suppress(ValueError):
                return f"was ended by {signal.Signals(-code).name}"
        return f"ended with code {code}"


def _discard(block: SharedBlock) -> None:
    block.unlink()
    block.close()
