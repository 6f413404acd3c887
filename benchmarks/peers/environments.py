# SPDX-License-Identifier: GPL-3.0-or-later
"""Where each renderer is installed, and how its adapter is run."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

from .jobs import Answer, Job

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "build" / "peers"

PACKAGES = {
    "luxcore": ("pyluxcore==2.11.2", "numpy==1.26.4"),
    "mitsuba": ("mitsuba==3.9.1", "numpy==1.26.4"),
}
"""What environments of their own hold; the other adapters run in that of the project, which has bpy."""
_LONGEST_INSTALLATION = 900.0
_START_SECONDS = 300.0
"""How long loading, compiling and building may take beside the seconds asked for."""


def python_of(adapter: str) -> Path:
    """The Python that runs an adapter."""
    return FOLDER / adapter / "bin" / "python" if adapter in PACKAGES else Path(sys.executable)


def install(adapter: str) -> str:
    """Make the environment of an adapter, unless it is there; returns what went wrong, empty when nothing."""
    if adapter not in PACKAGES:
        return ""
    packages = PACKAGES[adapter]
    stamp = FOLDER / adapter / "packages.txt"
    if stamp.exists() and stamp.read_text(encoding="utf-8") == "\n".join(packages):
        return ""
    print(f"installing {', '.join(packages)} into {stamp.parent.relative_to(ROOT)}", flush=True)
    commands = [
        [sys.executable, "-m", "venv", str(stamp.parent)],
        [str(python_of(adapter)), "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *packages],
    ]
    for command in commands:
        problem = run(command, _LONGEST_INSTALLATION, ROOT / "out" / "peers" / f"install_{adapter}.log")
        if problem:
            return problem
    stamp.write_text("\n".join(packages), encoding="utf-8")
    return ""


def run_job(adapter: str, job: Job) -> Answer:
    """Run an adapter in a process of its own; what went wrong is the answer's error."""
    folder = Path(job.folder)
    folder.mkdir(parents=True, exist_ok=True)
    for old in [*folder.glob("*.npy"), folder / "answer.json"]:
        old.unlink(missing_ok=True)
    job.launched = time.time()
    job.write(folder / "job.json")
    limit = 4.0 * sum(job.seconds) + _START_SECONDS
    command = [str(python_of(adapter)), "-m", f"benchmarks.peers.adapters.{adapter}", str(folder / "job.json")]
    problem = run(command, limit, folder / "log.txt")
    if not (folder / "answer.json").exists():
        return Answer(error=problem or "the adapter gave no answer")
    return Answer.read(folder / "answer.json")


def run(command: list[str], seconds: float, log: Path) -> str:
    """Run a program from the checkout's folder; returns what went wrong, empty when nothing."""
    log.parent.mkdir(parents=True, exist_ok=True)
    with log.open("w", encoding="utf-8") as output:
        process = subprocess.Popen(command, stdout=output, stderr=output, cwd=ROOT, start_new_session=True)
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
    return f"{lines[-1] if lines else 'no message'} (exit status {status}; see {log.relative_to(ROOT)})"
