# SPDX-License-Identifier: GPL-3.0-or-later
"""Renderer processes, real and faked, that leave nothing behind."""

import contextlib
import dataclasses
import gc
import os
import sys
import time
from pathlib import Path

import pytest
from support.floor import floor_scene

from rppm_addon.session.client.client import RendererProcess, Timeouts
from rppm_addon.session.render.renderer import Renderer
from rppm_addon.session.transport.sessions import SessionKind

FAKE = Path(__file__).with_name("fake_renderer.py")


def wait_until(condition, seconds=180.0):
    """Return the condition's value once it is true; fail the test when it does not become so."""
    deadline = time.monotonic() + seconds
    while not (value := condition()):
        assert time.monotonic() < deadline, "it did not happen in time"
        time.sleep(0.005)
    return value


def is_running(process):
    """Whether there is a process that has not ended, nor waits for its parent to be told so."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def shared_files():
    """Return the names in the folder of named shared memory that Python and this package could have put there."""
    return {path.name for path in Path("/dev/shm").iterdir() if path.name.startswith(("psm_", "rppm"))}


def open_blocks(process="self"):
    """How many blocks a process has open or mapped."""
    links = []
    for entry in Path(f"/proc/{process}/fd").iterdir():
        with contextlib.suppress(FileNotFoundError):
            links.append(os.readlink(entry))
    maps = Path(f"/proc/{process}/maps").read_text()
    return sum(link.startswith("/memfd:rppm") for link in links) + maps.count("/memfd:rppm")


def children():
    """This process's children that run."""
    found = []
    for thread in Path("/proc/self/task").iterdir():
        with contextlib.suppress(OSError):  # a thread may end meanwhile
            found += (thread / "children").read_text().split()
    return {int(pid) for pid in found if is_running(int(pid))}


def scene_of(iterations=1000, size=16, **changes):
    """The floor, to be rendered so often."""
    scene = with_settings(floor_scene(), iterations=iterations)
    scene.camera = dataclasses.replace(scene.camera, width=size, height=size)
    return dataclasses.replace(scene, **changes)


def with_settings(scene, **values):
    """The scene with other settings; it shares the rest."""
    return dataclasses.replace(scene, settings=dataclasses.replace(scene.settings, **values))


def open_viewport(process, scene=None, generation=1):
    """A viewport's session that shows a scene, or else the floor."""
    session = process.open(SessionKind.VIEWPORT)
    session.show(scene or scene_of(), generation, False)
    return session


def settled_picture(session, generation=1):
    """The picture of a generation when there is nothing left to do for it."""
    wait_until(lambda: session.status.generation == generation and session.status.settled)
    return session.newest().combined


def rendered(scene):
    """The frame of a scene by a renderer of its own in this process."""
    with Renderer() as renderer:
        return renderer.render(scene).frame


def run_to_the_end(work):
    """Run the slices of a viewport, render or preparation in this process until it has nothing to do."""
    deadline = time.monotonic() + 180.0
    while work.busy:
        work.run_slice()
        assert time.monotonic() < deadline, "it did not end in time"


@pytest.fixture
def process(start):
    """A renderer process that is real."""
    return start()


@pytest.fixture
def start(tmp_path):
    """start(fault, **timeouts): a renderer process that is faked, or real when no fault is given."""
    before = children(), open_blocks()
    processes = []

    def start(fault=None, **timeouts):
        python = [sys.executable, "-I"] if fault is None else [sys.executable, "-I", str(FAKE), fault, str(tmp_path)]
        process = RendererProcess(python, sys.path, tmp_path / "renderer.log", Timeouts(**timeouts))
        processes.append(process)
        return process

    yield start
    for process in processes:
        began = time.monotonic()
        process.close()
        assert time.monotonic() - began < 8.0
    processes.clear()
    gc.collect()
    assert children() == before[0] and open_blocks() <= before[1]
    assert not shared_files()
