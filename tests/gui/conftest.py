# SPDX-License-Identifier: GPL-3.0-or-later
"""A real Blender window with the built extension installed; `make test-gui` runs these tests."""

import contextlib
import fcntl
import hashlib
import json
import shutil
import subprocess
from pathlib import Path

import pytest
from blender_window import BlenderWindow, blender_in_background
from chroot_machine import ChrootMachine, chroot_folder
from support.extension_zip import built_zip
from viewport_window import from_camera

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
CANNOT_BUILD = 77
"""Exit status of build_chroot.sh where a machine cannot have a chroot."""
PICTURES = ROOT / "out" / "gui"
"""Where logs and screenshots stay, to be looked at."""
CACHES = ("home/.cache", "programs")
"""Subfolders of a session's folder with what the driver and RPPM compiled."""


@pytest.fixture(scope="session")
def chroot() -> Path:
    """Debian with Blender; built when it is missing."""
    folder = chroot_folder()
    build = subprocess.run([HERE / "build_chroot.sh", folder], stderr=subprocess.PIPE, text=True)
    if build.returncode == CANNOT_BUILD:
        pytest.skip(build.stderr.strip())
    assert build.returncode == 0, build.stderr
    return folder


@pytest.fixture(scope="session")
def archive(tmp_path_factory) -> Path:
    """The zip that `make extension` builds."""
    return built_zip(tmp_path_factory.mktemp("extension"))


@contextlib.contextmanager
def kept_caches(chroot: Path):
    """Where a session leaves what its first render compiled to those after it and beside it, until the sources change;
    no other session reads or writes there meanwhile."""
    digest = hashlib.sha256()
    for folder in ("shaders", "rppm_addon"):
        for file in sorted(path for path in (ROOT / folder).rglob("*") if path.suffix not in ("", ".pyc")):
            digest.update(file.read_bytes())
    kept = chroot.with_name(f"compiled-{digest.hexdigest()[:16]}")
    with chroot.with_name("compiled.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield kept


def keep_caches(chroot: Path, folder: Path) -> None:
    with kept_caches(chroot) as kept:
        if kept.is_dir():
            return
        for old in kept.parent.glob("compiled-*"):
            shutil.rmtree(old)
        for name in CACHES:
            shutil.copytree(folder / name, kept / name)


def take_caches(chroot: Path, folder: Path) -> None:
    with kept_caches(chroot) as kept:
        if kept.is_dir():
            shutil.copytree(kept, folder, dirs_exist_ok=True)


@pytest.fixture(scope="session")
def session_folder(chroot, archive, tmp_path_factory) -> Path:
    """Folder that the Blenders of all tests see as /mnt: the extension is installed, caches are filled by the first."""
    folder = tmp_path_factory.mktemp("gui")
    for name in ("home", "user", "programs"):
        (folder / name).mkdir()
    take_caches(chroot, folder)
    shutil.copytree(HERE / "inside", folder / "inside")
    shutil.copy(ROOT / "docs" / "samples" / "first_light.blend", folder)
    shutil.copy(archive, folder / "rppm.zip")
    machine = ChrootMachine(chroot, folder)
    try:
        blender_in_background(
            machine, "--command", "extension", "install-file", "--repo=user_default", "--enable", "/mnt/rppm.zip"
        )
        blender_in_background(machine, "--python-exit-code", "1", "--python", "/mnt/inside/make_scenes.py")
        # The first render of all also compiles the programs, which all others then find in the cache.
        blender_in_background(machine, "/mnt/small.blend", "--render-output", "/mnt/first_#", "--render-frame", "1")
        (folder / "first_1.png").unlink()
    finally:
        machine.close()
    keep_caches(chroot, folder)
    return folder


@pytest.fixture
def machine(chroot, session_folder, request):
    """Namespaces of the test's own; its logs and pictures are kept in out/gui/."""
    kept = PICTURES / request.node.name
    machine = ChrootMachine(chroot, session_folder)
    try:
        yield machine
        if any(command[0] == "blender" for command in machine.processes().values()):
            machine.screenshot("failed")
    finally:
        machine.close()
        shutil.rmtree(kept, ignore_errors=True)
        kept.mkdir(parents=True)
        for file in [*session_folder.glob("*.png"), *session_folder.glob("*.log"), *session_folder.glob("*.json")]:
            shutil.move(file, kept / file.name)


@pytest.fixture
def open_blender(machine):
    """Opens a file of the session's folder in a Blender window of a given size."""

    def open_blender(file: str, width: int = 1280, height: int = 800) -> BlenderWindow:
        machine.start_display(width, height)
        return BlenderWindow(machine, file, width, height)

    return open_blender


@pytest.fixture
def viewport(open_blender) -> BlenderWindow:
    """A window whose viewport is about to be rendered, from the camera."""
    return from_camera(open_blender("small.blend"))


def pytest_terminal_summary(terminalreporter) -> None:
    """Print what the tests measured."""
    for path in sorted(PICTURES.glob("*/measurements.json")):
        terminalreporter.write_line(f"{path.parent.name}: {json.dumps(json.loads(path.read_text()))}")
