# SPDX-License-Identifier: GPL-3.0-or-later
"""The rppm program and the small scenes of the tests of the command line; finding a farm's processes."""

import contextlib
import os
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest
from cli.conftest import blend_files, rppm, rppm_here, saved_scene, start_rppm, succeed  # noqa: F401 (fixtures)

ROOT = Path(__file__).resolve().parents[2]
TIMEOUT_SECONDS = 60.0


def wait_for(what, condition):
    """Return the value of ``condition()`` once it is true; fail after a minute."""
    give_up = time.monotonic() + TIMEOUT_SECONDS
    while time.monotonic() < give_up:
        found = condition()
        if found:
            return found
        time.sleep(0.05)
    pytest.fail(f"{what}: not after {TIMEOUT_SECONDS:.0f} s")


def renders_below(process, words=""):
    """The renders that a farm's workers have started with such words; their parents are the workers."""
    return _children_with(process, "rppm_addon.watched", words, recursive=True)


def workers_of(process):
    """The workers of a farm on this machine, also those that are about to start."""
    return _children_with(process, "spawn_main", recursive=False)


def _children_with(process, *words, recursive):
    found = []
    for child in psutil.Process(process.pid).children(recursive=recursive):
        with contextlib.suppress(psutil.Error):
            if all(word in " ".join(child.cmdline()) for word in words):
                found.append(child)
    return found


@contextlib.contextmanager
def started(words, folder, **variables):
    """A Python module as a program in a folder; ends with the context."""
    command, environment = [sys.executable, "-m", *words], os.environ | variables
    with subprocess.Popen(command, cwd=folder, env=environment, stderr=subprocess.DEVNULL) as process:
        try:
            yield process
        finally:
            process.terminate()
            try:
                process.wait(30)
            except subprocess.TimeoutExpired:
                process.kill()
