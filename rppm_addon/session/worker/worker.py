# SPDX-License-Identifier: GPL-3.0-or-later
"""The renderer's process: sessions that render on one device."""

import contextlib
import functools
import logging
import os
import queue
import threading
import time
from dataclasses import asdict
from pathlib import Path
from typing import BinaryIO

from ...denoising.denoiser import Denoiser
from ...denoising.places import LibraryPlace, Source
from ...gl.context.context import Context, open_others
from ...gl.programs.programs import ProgramLibrary
from ...scene.errors import DeviceLostError, RppmError
from ...scene.scene import Scene
from ..placeholders.known_programs import KnownPrograms
from ..transport.arrays import unpack
from ..transport.kept_renders import pause_of
from ..transport.protocol import TO_CHILD, VERSION, ProtocolError, check_message, read_message, write_message
from ..transport.sessions import SessionKind
from ..transport.transfer import SceneReceiver
from ..viewport.viewport_renderer import ViewportRenderer
from .fair_share import FairShare
from .preparation import Preparation
from .rendering import Rendering

log = logging.getLogger(__name__)

_FOR_SESSIONS = frozenset(
    ("show", "pause", "expect_snapshots", "set_checkpoint", "resume", "request_picture", "received", "stop")
)
LEAVE_SECONDS = 1.0
"""Time that the device may take to finish its work once Blender has left."""


def work(hello: dict, reader: BinaryIO, writer: BinaryIO) -> int:
    """Serve Blender until it leaves; returns the process's exit code."""
    logging.basicConfig(level=logging.INFO, format="%(asctime)s %(levelname)s %(name)s: %(message)s")
    if hello.get("version") != VERSION:  # Blender runs what was installed before an update
        write_message(writer, "ready", version=VERSION, device=None)
        return 1
    try:
        context = Context.create()
    except RppmError as error:
        log.error("%s", error)
        write_message(writer, "unusable", text=str(error))
        return 1
    write_message(writer, "ready", version=VERSION, device=asdict(context.information))
    with contextlib.suppress(BrokenPipeError):
        places = [LibraryPlace(Source[source], Path(path)) for source, path in hello["denoisers"]]
        try:
            Worker(context, Denoiser(places), reader, writer).run()
        except DeviceLostError as error:
            log.error("%s", error)
            return 1
    return 0


class Worker:
    """Reads messages in one thread and renders in another."""

    def __init__(self, context: Context, denoiser: Denoiser, reader: BinaryIO, writer: BinaryIO) -> None:
        self._context = context
        self._denoiser = denoiser
        self._library = ProgramLibrary(context)
        self._reader = reader
        self._writer = writer
        self._writing = threading.Lock()
        self._receiver = SceneReceiver()
        self._inbox: queue.SimpleQueue[dict | None] = queue.SimpleQueue()
        self._sessions: dict[int, tuple[SessionKind, ViewportRenderer | Rendering | Preparation]] = {}
        self._programs = KnownPrograms()
        self._scheduler = FairShare()
        self._shown: dict[int, Scene] = {}
        """By session, the scene that was last received, in the reading thread: what is edited shares its instances."""
        self._whole = threading.Event()
        """Cleared while a scene is received: the drivers leave the reading thread little of the interpreter."""
        self._whole.set()
        self._left = threading.Event()

    def run(self) -> None:
        """Render until Blender leaves. Raises DeviceLostError."""
        threading.Thread(target=self._read, name="RPPM messages", daemon=True).start()
        try:
            while self._handle_messages():
                self._whole.wait()
                self._run_slice()
        except DeviceLostError as error:
            self._send("lost", text=str(error))
            raise
        finally:
            for number in list(self._sessions):
                self._close(number)
            self._left.set()

    def _send(self, kind: str, **content: object) -> None:
        with self._writing:
            write_message(self._writer, kind, **content)

    # In the reading thread.

    def _read(self) -> None:
        code = 0
        try:
            while (message := read_message(self._reader)) is not None and message["kind"] != "leave":
                check_message(message, TO_CHILD)
                self._decode(message)
                if message["kind"] != "members":
                    self._inbox.put(message)
        except BrokenPipeError:
            pass
        except Exception:
            log.exception("Blender sent what cannot be understood")
            code = 1
        self._inbox.put(None)
        self._whole.set()
        if not self._left.wait(LEAVE_SECONDS):
            os._exit(code)

    def _decode(self, message: dict) -> None:
        """Replace the documents and arrays that describe a scene by the scene."""
        kind = message["kind"]
        if kind == "members":
            self._whole.clear()
            self._receiver.learn(message["document"], unpack(message["arrays"]))
        elif kind == "show":
            scene = self._receiver.receive(message.pop("document"), unpack(message.pop("arrays")))
            message["scene"] = scene.expanded(self._shown.get(message["session"]))
            self._shown[message["session"]] = scene
            _, session = self._sessions.get(message["session"], (None, None))
            if isinstance(session, ViewportRenderer):
                session.expect(message["scene"], message["generation"])
            self._send("taken", session=message["session"], number=message.pop("number"))
            self._whole.set()
        elif kind == "close":
            self._shown.pop(message["session"], None)
        elif kind == "resume":
            message["pause"] = pause_of(message.pop("document"), unpack(message.pop("arrays")))
        self._receiver.forget(message.pop("dead", ()))

    # In the main thread.

    def _handle_messages(self) -> bool:
        """Handle the messages that have come; wait for one when there is nothing to render.

        Returns False when Blender has left.
        """
        with contextlib.suppress(queue.Empty):
            while True:
                busy = any(session.busy for _, session in self._sessions.values())
                message = self._inbox.get(block=not busy)
                if message is None:
                    return False
                self._handle(message)
        return True

    def _handle(self, message: dict) -> None:
        kind, number = message.pop("kind"), message.pop("session", None)
        if kind == "ping":
            self._send("pong")
        elif kind == "list_devices":
            threading.Thread(target=self._list_devices, name="RPPM devices", daemon=True).start()
        elif kind == "open":
            session_kind = SessionKind[message["session_kind"]]
            send = functools.partial(self._send, session=number)
            session: ViewportRenderer | Rendering | Preparation
            if session_kind is SessionKind.VIEWPORT:
                session = ViewportRenderer(self._context, self._library, self._denoiser, send, self._programs)
            elif session_kind is SessionKind.PREPARATION:
                session = Preparation(self._context, self._library, send)
            else:
                looks_first = session_kind is SessionKind.FINAL
                session = Rendering(self._context, self._library, self._denoiser, send, self._programs, looks_first)
            self._sessions[number] = session_kind, session
        elif kind == "close":
            self._close(number)
        elif kind in _FOR_SESSIONS:
            if number in self._sessions:  # else it was closed meanwhile
                getattr(self._sessions[number][1], kind)(**message)
        elif kind != "forget":
            raise ProtocolError(f"there is no message {kind}")

    def _list_devices(self) -> None:
        """Open each device, in a thread of its own: drivers take their time, and contexts belong to threads."""
        information = self._context.information
        devices = open_others(information.devices, information.number)
        with contextlib.suppress(BrokenPipeError):
            self._send("devices", devices=[asdict(device) for device in devices])

    def _run_slice(self) -> None:
        number = self._scheduler.next(number for number, (_, session) in self._sessions.items() if session.busy)
        if number is None:
            return
        kind, session = self._sessions[number]
        started = time.perf_counter()
        session.run_slice()
        self._context.finish()
        self._scheduler.charge(number, time.perf_counter() - started, kind.value)

    def _close(self, number: int) -> None:
        if number in self._sessions:
            self._sessions.pop(number)[1].release()
