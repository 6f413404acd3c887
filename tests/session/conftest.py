# SPDX-License-Identifier: GPL-3.0-or-later
"""Renderer processes, real and faked, that leave nothing behind."""

import dataclasses
import os
import sys
import time
from pathlib import Path

import pytest
from floor import floor_scene

from rppm_addon.session.client import Patience, RendererProcess
from rppm_addon.session.shared_memory import PREFIX

FAKE = Path(__file__).with_name("fake_renderer.py")
SHARED = Path("/dev/shm")


def wait_until(condition, seconds=60.0):
    """What the condition gives once it is true; fails the test when it does not become so."""
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


def shared_blocks(*processes):
    """The names of what the processes have left in shared memory."""
    starts = tuple(f"{PREFIX}{process}-" for process in processes)
    return [path.name for path in SHARED.iterdir() if path.name.startswith(starts)]


def children():
    """This process's children that run."""
    tasks = Path("/proc/self/task").iterdir()
    return {int(pid) for task in tasks for pid in (task / "children").read_text().split() if is_running(int(pid))}


def scene_of(iterations=1000, size=16, **changes):
    """The floor, to be rendered so often."""
    scene = floor_scene()
    scene.camera = dataclasses.replace(scene.camera, width=size, height=size)
    scene.settings = dataclasses.replace(scene.settings, iterations=iterations)
    return dataclasses.replace(scene, **changes)


@pytest.fixture
def start(tmp_path):
    """start(fault, **patience): a renderer process that is faked, or real when no fault is given."""
    before = children()
    processes = []

    def start(fault=None, **patience):
        python = [sys.executable, "-I"] if fault is None else [sys.executable, "-I", str(FAKE), fault, str(tmp_path)]
        process = RendererProcess(python, sys.path, tmp_path / "renderer.log", Patience(**patience))
        processes.append(process)
        return process

    yield start
    for process in processes:
        began = time.monotonic()
        process.close()
        assert time.monotonic() - began < 8.0
    assert children() == before
    assert not shared_blocks(os.getpid())
