# SPDX-License-Identifier: GPL-3.0-or-later
"""Signals that come while Python does not run."""

import signal
import subprocess
import sys

import pytest

PROGRAM = """
import ctypes, sys
from rppm_addon.commands.terminal import interruption as module
module.GRACE_SECONDS = 0.2
with module.Interruption() as interruption:
    interruption.has_work = lambda: {has_work}
    print("entered", flush=True)
    ctypes.CDLL(None).{call}
    print("asked" if interruption.asked else "not asked", flush=True)
"""


def run(call, has_work):
    """Exit status, output and errors of a program that is to end during a call that ignores signals."""
    arguments = [sys.executable, "-c", PROGRAM.format(has_work=has_work, call=call)]
    with subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout.readline() == "entered\n"
            process.send_signal(signal.SIGTERM)
            output, errors = process.communicate(timeout=60)
        finally:
            process.kill()
    return process.returncode, output, errors


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_a_call_that_hears_nothing_is_ended_where_nothing_is_lost():
    status, output, errors = run("system(b'exec sleep 10 >&- 2>&-')", has_work=False)
    assert (status, output) == (128 + signal.SIGTERM, "")
    assert "nothing was done yet" in errors and "Traceback" not in errors


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_what_is_worth_keeping_is_waited_for():
    assert run("system(b'exec sleep 0.5')", has_work=True)[:2] == (0, "asked\n")
