# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender as a module in the versions that the extension claims, each in an environment of its own, which is kept."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tools.lock import GROUPS, lock_of, pins

ROOT = Path(__file__).resolve().parents[2]
LOCKS = {
    pins(lock_of(name).read_text(encoding="utf-8"))["bpy"][0]: name for name in GROUPS if name.startswith("blender-")
}
"""Names of the locked groups by the version of bpy that each pins."""
CURRENT = "5.0.1"
"""The one that all other tests run in."""


def python_with_blender(version: str) -> Path:
    """The Python of an environment with bpy of this version and nothing that the extension brings; made where it is
    missing, below RPPM_WHEELS or the user's cache. Skips the test where it cannot be had."""
    folder = Path(os.environ.get("RPPM_WHEELS") or Path.home() / ".cache" / "rppm-wheels") / version
    python, done = folder / "bin" / "python", folder / "complete"
    if done.exists():
        return python
    wanted = GROUPS[LOCKS[version]].python
    base = _interpreter(wanted)
    if base is None:
        pytest.skip(f"bpy {version} needs Python {wanted}, which is not there")
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run([base, "-m", "venv", folder], check=True)
    command = [python, ROOT / ".ci" / "install_locked.py", LOCKS[version]]
    installed = subprocess.run(command, capture_output=True, text=True)
    if installed.returncode:
        pytest.skip(f"bpy {version} cannot be had: {installed.stderr.strip().splitlines()[-1]}")
    done.touch()
    return python


def _interpreter(version: str) -> Path | None:
    """A Python of this version: the one that runs, one on the path, or pyenv's."""
    name = f"python{version}"
    of_pyenv = Path(os.environ.get("PYENV_ROOT") or Path.home() / ".pyenv") / "versions"
    found = [shutil.which(name), *map(str, sorted(of_pyenv.glob(f"{version}.*/bin/{name}")))]
    if sys.version_info[:2] == tuple(map(int, version.split("."))):
        found.insert(0, sys.executable)
    for candidate in filter(None, found):
        if subprocess.run([candidate, "-c", "import ensurepip"], capture_output=True).returncode == 0:
            return Path(candidate)
    return None
