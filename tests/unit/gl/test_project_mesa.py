# SPDX-License-Identifier: GPL-3.0-or-later
"""Which Mesa a process takes, and how set-up unpacks one. Nothing is loaded or fetched."""

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import pytest

from rppm_addon.gl.context import project_mesa
from rppm_addon.gl.context.context import DeviceInformation
from rppm_addon.scene.errors import DeviceError

ROOT = Path(__file__).resolve().parents[3]
NAMES = ("libdrm.so.2", "libdrm_amdgpu.so.1", "libdrm_intel.so.1", "libgallium-25.0.7.so", "libgbm.so.1")
NAMES += ("libEGL_mesa.so.0",)


def library_folder(folder):
    return folder / "usr" / "lib" / "x86_64-linux-gnu"


def make_libraries(folder, names=NAMES):
    library_folder(folder).mkdir(parents=True)
    for name in names:
        (library_folder(folder) / name).touch()
        (library_folder(folder) / f"{name}.0.0").touch()  # the files that the names link to


@pytest.fixture(autouse=True)
def debian(monkeypatch):
    monkeypatch.setattr(project_mesa, "system_release", lambda: "debian 12")


@pytest.fixture
def mesa(tmp_path):
    """A folder like one that set-up unpacked."""
    folder = tmp_path / ".mesa"
    make_libraries(folder)
    (folder / "release").write_text("debian 12\n")
    return folder


@pytest.fixture
def devices(tmp_path):
    """Like /dev of a machine that has a graphics card's console, but no GPU."""
    folder = tmp_path / "dev"
    (folder / "dri").mkdir(parents=True)
    (folder / "dri" / "card0").touch()
    return folder


def test_without_a_gpu_the_folder_is_taken(mesa, devices):
    assert project_mesa.choose_folder({}, devices, mesa) == mesa


@pytest.mark.parametrize("file", ["dri/renderD128", "nvidia0", "nvidiactl", "kfd", "dxg"])
def test_with_a_gpu_the_system_keeps_its_driver(mesa, devices, file):
    assert not project_mesa.has_gpu(devices)
    (devices / file).touch()
    assert project_mesa.has_gpu(devices)
    assert project_mesa.choose_folder({}, devices, mesa) is None
    assert project_mesa.choose_folder({"RPPM_MESA": str(mesa)}, devices, mesa) is None


@pytest.mark.parametrize("name", ["LIBGL_DRIVERS_PATH", "__EGL_VENDOR_LIBRARY_FILENAMES", "__EGL_VENDOR_LIBRARY_DIRS"])
def test_a_driver_that_the_user_chose_stays(mesa, devices, name):
    assert project_mesa.choose_folder({name: "/somewhere"}, devices, mesa) is None
    assert project_mesa.choose_folder({name: ""}, devices, mesa) == mesa


def test_a_library_path_counts_where_it_has_a_mesa(mesa, devices, tmp_path):
    other = tmp_path / "other"
    other.mkdir()
    environment = {"LD_LIBRARY_PATH": f":{tmp_path}:{other}"}
    assert project_mesa.choose_folder(environment, devices, mesa) == mesa
    (other / "libEGL_mesa.so.0").touch()
    assert project_mesa.choose_folder(environment, devices, mesa) is None


def test_the_variable_names_a_folder_or_the_system(mesa, devices, tmp_path):
    nowhere = tmp_path / "nowhere"
    assert project_mesa.choose_folder({"RPPM_MESA": "system"}, devices, mesa) is None
    assert project_mesa.choose_folder({"RPPM_MESA": str(mesa)}, devices, nowhere) == mesa
    assert project_mesa.choose_folder({"RPPM_MESA": ""}, devices, nowhere) is None
    with pytest.raises(DeviceError, match="RPPM_MESA names .*nowhere.*make setup"):
        project_mesa.choose_folder({"RPPM_MESA": str(nowhere)}, devices, mesa)


def test_another_systems_folder_is_left_alone(mesa, devices, monkeypatch):
    for release in ("debian 13", ""):
        monkeypatch.setattr(project_mesa, "system_release", lambda release=release: release)
        assert project_mesa.choose_folder({}, devices, mesa) is None
    (mesa / "release").write_text("")
    assert project_mesa.choose_folder({}, devices, mesa) is None


def test_libraries_come_after_what_they_need(mesa):
    assert [path.name for path in project_mesa.libraries(mesa)] == list(NAMES)


def test_a_folder_without_one_of_them_is_none(mesa, devices):
    (library_folder(mesa) / "libgbm.so.1").unlink()
    assert project_mesa.libraries(mesa) == []
    assert project_mesa.choose_folder({}, devices, mesa) is None


@pytest.mark.parametrize(
    "driver, label",
    [
        ("Mesa 4.5 (Core Profile) Mesa 25.0.7-2~bpo12+1", "Card, Mesa 25.0.7-2~bpo12+1"),
        ("Mesa/X.org 4.5 (Core Profile) Mesa 22.3.6", "Card, Mesa 22.3.6"),
        ("NVIDIA Corporation 4.6.0 NVIDIA 550.54.14", "Card, NVIDIA 550.54.14"),
        ("ATI Technologies Inc. 4.6.0 Core Profile Context 22.5.1", "Card, Core Profile Context 22.5.1"),
    ],
)
def test_a_label_has_the_version_of_the_driver(driver, label):
    assert DeviceInformation("Card", driver, "4.5").label == label


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="Mesa is the driver on Linux only")
def test_a_process_takes_the_chosen_mesa():
    """The chosen Mesa is the one that is unpacked in this checkout, if any; else the system's."""
    program = (
        "from rppm_addon.gl.context.context import device_information as d; print(d().driver_folder); print(d().driver)"
    )

    def device_lines(**environment):
        command = [sys.executable, "-c", program]
        run = subprocess.run(
            command, cwd=ROOT, env=os.environ | environment, capture_output=True, text=True, check=True, timeout=60
        )
        return run.stdout.splitlines()

    assert device_lines(RPPM_MESA="system")[0] == ""
    chosen = project_mesa.choose_folder()
    folder, driver = device_lines()
    assert folder == str(chosen or "")
    if chosen:
        (gallium,) = chosen.glob("usr/lib/*/libgallium-*.so")
        assert driver.endswith(gallium.stem.removeprefix("libgallium-"))


# Set-up.


@pytest.fixture
def unpacking(monkeypatch, tmp_path):
    """The program of set-up, with a system whose apt has ``targets`` and whose libraries lack what is ``missing``."""
    specification = importlib.util.spec_from_file_location("unpack_mesa", ROOT / ".ci" / "unpack_mesa.py")
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    module.calls = []
    module.missing, module.failure = "", ""
    module.targets = "file:/mirror/ bookworm main\nfile:/other/ bookworm-updates main\nfile:/tools/ stable main\n"

    def run(command, cwd=None, **_):
        module.calls.append(command)
        output = failure = ""
        if "indextargets" in command:
            output = module.targets
        elif "depends" in command:
            output = "mesa-libgallium\n  Depends: libc6\n  Depends: libdrm2\n  Depends: libdrm-amdgpu1\n"
        elif "download" in command:
            (cwd / "mesa.deb").touch()
        elif command[0] == "dpkg-deb":
            make_libraries(Path(command[-1]))
        elif command[0] == "ldd":
            output = f"\tlibc.so.6 => /lib/libc.so.6 (0x1)\n\tlibdrm.so.2 => not found\n{module.missing}"
        elif "info" in command:
            failure = module.failure
        return subprocess.CompletedProcess(command, int(bool(failure)), output, failure)

    monkeypatch.setattr(subprocess, "run", run)
    monkeypatch.setattr(module, "has_gpu", lambda: False)
    monkeypatch.setattr(module, "system_release", lambda: "debian 12")
    monkeypatch.delenv("RPPM_MESA", raising=False)
    return module


@pytest.fixture
def set_up(unpacking, tmp_path, capsys):
    """A function that runs set-up, which never fails; returns what it prints."""

    def set_up():
        assert unpacking.main(tmp_path / ".mesa") == 0
        return capsys.readouterr().out

    return set_up


def test_set_up_unpacks_once(unpacking, set_up, tmp_path, devices):
    folder = tmp_path / ".mesa"
    assert "Mesa 25.0.7 from bookworm-backports" in set_up()
    assert project_mesa.choose_folder({}, devices, folder) == folder
    (download,) = (command for command in unpacking.calls if "download" in command)
    fetched = {f"{name}/bookworm-backports" for name in ("libdrm2", "libdrm-amdgpu1", "libgbm1", "libegl-mesa0")}
    assert fetched | {"mesa-libgallium/bookworm-backports"} == set(download[3:])
    (tried,) = (command for command in unpacking.calls if "info" in command)
    assert tried[:2] == ["env", f"RPPM_MESA={tmp_path / '.mesa.new'}"]
    count = len(unpacking.calls)
    assert set_up() == "" and len(unpacking.calls) == count
    assert {path.name for path in tmp_path.iterdir()} == {".mesa", "dev"}


@pytest.mark.parametrize("tested", ["25.0.7", "25.0.7-2~bpo12+1"])
def test_set_up_names_a_version_that_was_not_tested(unpacking, set_up, tested):
    unpacking.TESTED_VERSION = tested
    assert (f"tested with Mesa {tested}; RPPM_MESA=system" in set_up()) == (tested != "25.0.7")


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("failure", "no OpenGL context", "will do (no OpenGL context)"),
        ("missing", "\tlibLLVM-15.so.1 => not found\n", "needs libLLVM-15.so.1"),
    ],
)
def test_set_up_keeps_no_driver_that_would_not_start(unpacking, set_up, tmp_path, name, value, words):
    setattr(unpacking, name, value)
    assert words in set_up()
    assert [path.name for path in tmp_path.iterdir()] == [".mesa.tried"]


def test_set_up_says_why_not_and_waits_a_day(unpacking, set_up, tmp_path):
    unpacking.targets = "file:/mirror/ trixie main\n"
    found = set_up()
    assert "no bookworm main" in found and found.count("\n") == 1 and not (tmp_path / ".mesa").exists()
    assert set_up() == ""
    tried = tmp_path / ".mesa.tried"
    os.utime(tried, (0, tried.stat().st_mtime - unpacking.TRY_AGAIN_SECONDS))
    unpacking.targets = "file:/mirror/ bookworm main\n"
    assert set_up() and (tmp_path / ".mesa").is_dir() and not tried.exists()


def test_set_up_leaves_other_machines_alone(unpacking, set_up, monkeypatch):
    monkeypatch.setenv("RPPM_MESA", "system")
    assert set_up() == ""
    monkeypatch.delenv("RPPM_MESA")
    monkeypatch.setattr(unpacking, "has_gpu", lambda: True)
    assert set_up() == ""
    monkeypatch.setattr(unpacking, "has_gpu", lambda: False)
    monkeypatch.setattr(unpacking, "system_release", lambda: "debian 13")
    assert "another system" in set_up() and unpacking.calls == []
