# SPDX-License-Identifier: GPL-3.0-or-later
"""Where each renderer is installed, and how its adapter is run."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

from ..machine import describe_host
from .jobs import Answer, Job

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "build" / "peers"
"""A folder a renderer."""
OUT = ROOT / "out" / "peers"
"""Folder of everything that is made and measured."""

LOCKED = ("luxcore", "mitsuba")
"""Adapters with an environment of their own, of the locked packages of that name; the others run in the project's,
which has bpy."""
_LLVM = "libllvm19"
_LONGEST_INSTALLATION = 900.0
_START_SECONDS = 300.0
"""Most seconds that loading, compiling and building may take beside those asked for."""
_SECONDS_A_SAMPLE = 4.0
"""Most seconds that a sample of all pixels may take, where samples are asked for."""


def describe_busy_host() -> dict[str, object]:
    """Describe the machine of a comparison, and how busy it is before."""
    return describe_host() | {"load": os.getloadavg()[0]}


def python_of(adapter: str) -> Path:
    """The Python that runs an adapter."""
    return FOLDER / adapter / "bin" / "python" if adapter in LOCKED else Path(sys.executable)


def variables_of(adapter: str) -> dict[str, str]:
    """Environment variables that an adapter needs beside the usual ones."""
    folder = FOLDER / adapter
    # pyluxcore brings an allocator that must be the process's from its start, or memory is freed by another one.
    allocators = sorted(folder.glob("lib/python*/site-packages/pyluxcore.libs/libtbbmalloc_proxy*"))
    compilers = sorted(folder.glob("llvm/usr/lib/*/libLLVM.so.*"))
    found = {}
    if adapter == "luxcore" and allocators:
        found["LD_PRELOAD"] = str(allocators[0])
    if adapter == "mitsuba" and compilers:
        found["DRJIT_LIBLLVM_PATH"] = str(compilers[0])
    return found


def install(adapter: str) -> str:
    """Make the environment of an adapter, unless it is there; returns what went wrong, empty when nothing."""
    if adapter not in LOCKED:
        return ""
    folder, installer = FOLDER / adapter, str(ROOT / ".ci" / "install_locked.py")
    commands = [[str(python_of(adapter)), installer, adapter]]
    if not python_of(adapter).exists():
        print(f"installing {adapter} into {folder.relative_to(ROOT)}", flush=True)
        commands.insert(0, [sys.executable, "-m", "venv", str(folder)])
    for command in commands:
        problem = run(command, _LONGEST_INSTALLATION, OUT / f"install_{adapter}.log")
        if problem:
            return problem
    if adapter == "mitsuba" and not (folder / "llvm").exists():
        _fetch_llvm(folder / "llvm")
    return ""


def _fetch_llvm(folder: Path) -> None:
    """Unpack Debian's LLVM beside Mitsuba, which needs 16 or later; without it the slower scalar variant is taken."""
    folder.mkdir(exist_ok=True)
    log = OUT / "install_llvm.log"
    script = f"cd '{folder}' && apt-get -qq download {_LLVM} && dpkg -x {_LLVM}_*.deb . && rm {_LLVM}_*.deb"
    problem = run(["sh", "-c", script], _LONGEST_INSTALLATION, log)
    if problem:
        print(f"Mitsuba runs without LLVM: {problem}", flush=True)


def run_job(adapter: str, job: Job) -> Answer:
    """Run an adapter in a process of its own; what went wrong is the answer's error."""
    folder = Path(job.folder)
    folder.mkdir(parents=True, exist_ok=True)
    for old in [*folder.glob("*.npy"), folder / "answer.json"]:
        old.unlink(missing_ok=True)
    job.launched = time.time()
    job.write(folder / "job.json")
    limit = 4.0 * sum(job.seconds) + _SECONDS_A_SAMPLE * sum(job.samples) + _START_SECONDS
    command = [str(python_of(adapter)), "-m", f"benchmarks.peers.adapters.{adapter}", str(folder / "job.json")]
    problem = run(command, limit, folder / "log.txt", variables_of(adapter))
    if not (folder / "answer.json").exists():
        return Answer(error=problem or "the adapter gave no answer")
    return Answer.read(folder / "answer.json")


def run(command: list[str], seconds: float, log: Path, variables: dict[str, str] | None = None) -> str:
    """Run a program from the checkout's folder; returns what went wrong, empty when nothing."""
    log.parent.mkdir(parents=True, exist_ok=True)
    environment = os.environ | (variables or {})
    with log.open("w", encoding="utf-8") as output:
        process = subprocess.Popen(
            command, stdout=output, stderr=output, cwd=ROOT, env=environment, start_new_session=True
        )
        try:
            status = process.wait(seconds)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            return f"no end after {seconds:.0f} s"
        except BaseException:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            raise
    if status == 0:
        return ""
    lines = log.read_text(encoding="utf-8", errors="replace").strip().splitlines()
    return f"{lines[-1] if lines else 'no message'} (exit status {status}; see {os.path.relpath(log, ROOT)})"
