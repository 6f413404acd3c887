# SPDX-License-Identifier: GPL-3.0-or-later
"""A real Blender window with the built extension installed; `make test-gui` runs these tests."""

import importlib.util
import shutil
import subprocess
from pathlib import Path

import pytest
from blender_window import BlenderWindow, blender_in_background
from chroot_machine import ChrootMachine, chroot_folder

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
CANNOT_BUILD = 77
"""Exit status of build_chroot.sh where a machine cannot have a chroot."""
PICTURES = ROOT / "out" / "gui"
"""Where logs and screenshots stay, to be looked at."""


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
    specification = importlib.util.spec_from_file_location("extension_build", ROOT / "extension" / "build.py")
    builder = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(builder)
    try:
        (file,) = builder.build(tmp_path_factory.mktemp("extension"))
    except builder.DownloadError as error:
        pytest.skip(str(error))
    return file


@pytest.fixture(scope="session")
def session_folder(chroot, archive, tmp_path_factory) -> Path:
    """What the Blenders of all tests see as /mnt: the extension is installed, caches are filled by the first."""
    folder = tmp_path_factory.mktemp("gui")
    for name in ("home", "user", "programs"):
        (folder / name).mkdir()
    shutil.copytree(HERE / "inside", folder / "inside")
    shutil.copy(ROOT / "docs" / "samples" / "first_light.blend", folder)
    shutil.copy(archive, folder / "rppm.zip")
    machine = ChrootMachine(chroot, folder)
    try:
        blender_in_background(
            machine, "--command", "extension", "install-file", "--repo=user_default", "--enable", "/mnt/rppm.zip"
        )
        blender_in_background(machine, "--python-exit-code", "1", "--python", "/mnt/inside/make_scenes.py")
    finally:
        machine.close()
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
