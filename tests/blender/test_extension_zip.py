# SPDX-License-Identifier: GPL-3.0-or-later
"""The zip that `make extension` builds: its manifest, its files, and that Blender installs it and renders with it."""

import ast
import fcntl
import hashlib
import json
import os
import re
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path, PurePosixPath

import bpy
import numpy as np
import OpenEXR
import pytest
from install_extension import render_default_scene
from support import extension_zip

ROOT = Path(__file__).resolve().parents[2]
MANIFEST = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
OF_OTHER_PROCESSES = ("rppm_addon/session/worker/bootstrap.py", "rppm_addon/self_test/run.py")
RUNTIME = {"bpy", "gpu", "mathutils", "moderngl", "numpy", "OpenEXR"}
"""Modules that the extension may import beside Python's own library."""
BLENDERS = {"bl_operators", "bl_ui", "bpy_extras", "gpu_extras"}
"""Modules that Blender brings beside its API."""


@pytest.fixture(scope="module")
def builder():
    return extension_zip.builder()


def built(builder, folder, **options):
    """The zips; one test process fetches the wheels, another waits for it."""
    lock = ROOT / "build" / "wheels.lock"
    lock.parent.mkdir(exist_ok=True)
    try:
        with lock.open("w") as handle:
            fcntl.flock(handle, fcntl.LOCK_EX)
            return builder.build(folder, **options)
    except builder.DownloadError as error:
        pytest.skip(f"the wheels cannot be had: {error}")


@pytest.fixture(scope="module")
def archive(builder, tmp_path_factory):
    """The zip, built and validated by Blender's own tool."""
    (file,) = built(builder, tmp_path_factory.mktemp("extension"))
    return file


def python_files(archive):
    with zipfile.ZipFile(archive) as file:
        for name in file.namelist():
            if name.endswith(".py"):
                yield name, ast.parse(file.read(name))


def test_manifest_keeps_the_rules_of_the_review():
    assert MANIFEST["id"] == "rppm" and MANIFEST["blender_version_min"] == "4.2.0"
    assert MANIFEST["platforms"] == ["linux-x64", "windows-x64"] and list(MANIFEST["permissions"]) == ["files"]
    assert "blender" not in MANIFEST["name"].lower()
    for text in (MANIFEST["tagline"], *MANIFEST["permissions"].values()):
        assert len(text) <= 64 and text[-1].isalnum()


def test_wheels_serve_every_python_on_every_platform():
    kinds = set()
    for path in MANIFEST["wheels"]:
        assert PurePosixPath(path).parent == PurePosixPath("wheels")
        name, _, python, abi, platform = PurePosixPath(path).stem.split("-")
        assert python == abi
        kinds.add((name, python, "windows" if platform == "win_amd64" else "linux"))
    pythons = ("cp311", "cp313", "cp314")
    packages = ("glcontext", "moderngl", "openexr")
    expected = {(name, python, system) for name in packages for python in pythons for system in ("linux", "windows")}
    assert kinds == expected and len(MANIFEST["wheels"]) == len(expected)


def test_wheels_are_the_versions_that_are_tested():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    pins = dict(item.lower().split("==") for item in project["dependencies"])
    for path in MANIFEST["wheels"]:
        name, version, *_ = PurePosixPath(path).stem.split("-")
        assert pins.get(name, version) == version


COMMAND_LINE = ("rppm_addon/cli.py", "rppm_addon/__main__.py", "rppm_addon/watched.py", "rppm_addon/commands/")


def test_zip_holds_what_runs_and_nothing_else(archive):
    listing = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT, check=True, capture_output=True, text=True,
    )  # fmt: skip
    wanted = {name for name in listing.stdout.split("\n") if name.startswith(("rppm_addon/", "shaders/"))}
    wanted -= {name for name in wanted if name.startswith(COMMAND_LINE)}
    wanted |= {"__init__.py", "blender_manifest.toml", "LICENSE"}
    wanted |= {path.removeprefix("./") for path in MANIFEST["wheels"]}
    with zipfile.ZipFile(archive) as file:
        names = file.namelist()
        assert file.testzip() is None
    assert len(names) == len(set(names)) and set(names) == wanted
    assert not [name for name in names if "numpy" in name.lower()]


def test_wheels_in_the_zip_are_those_of_pypi(archive, builder):
    requirements = builder.REQUIREMENTS.read_text(encoding="utf-8")
    with zipfile.ZipFile(archive) as file:
        for path in MANIFEST["wheels"]:
            assert hashlib.sha256(file.read(path.removeprefix("./"))).hexdigest() in requirements


def test_imports_are_relative_or_declared(archive):
    for name, tree in python_files(archive):
        for node in ast.walk(tree):
            modules = []
            if isinstance(node, ast.Import):
                modules = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and node.level == 0:
                modules = [node.module]
            for module in modules:
                top = module.split(".")[0]
                if top == "rppm_addon" and name in OF_OTHER_PROCESSES:
                    continue  # which have the package by its folder
                assert top in RUNTIME | BLENDERS or top in sys.stdlib_module_names, f"{name}: imports {module}"
                assert top not in ("socket", "ssl", "urllib", "http", "pickle"), f"{name}: imports {module}"


def test_code_does_what_the_review_allows(archive):
    for name, tree in python_files(archive):
        for node in ast.walk(tree):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
                assert node.func.id not in ("eval", "exec"), f"{name}:{node.lineno}"
        if name.startswith("rppm_addon/blender/"):
            edits = re.findall(r"sys\.path(?:\.\w+|\[.*\] =| \+?=)", ast.unparse(tree))
            assert not edits, f"{name}: Blender's sys.path is not ours to edit"


def test_a_zip_for_each_platform(builder, tmp_path):
    files = built(builder, tmp_path, split_platforms=True)
    assert [file.stem.rsplit("-", 1)[1] for file in files] == ["linux_x64", "windows_x64"]
    for file, tag in zip(files, ("manylinux", "win_amd64"), strict=True):
        with zipfile.ZipFile(file) as content:
            wheels = [name for name in content.namelist() if name.endswith(".whl")]
        assert len(wheels) == len(MANIFEST["wheels"]) // 2 and all(tag in name for name in wheels)


def read(picture):
    with OpenEXR.File(str(picture)) as file:
        return file.channels()["RGBA"].pixels


def as_user(folder, *arguments):
    """Return the report of install_extension.py, in a Blender whose user folder is ``folder``/user."""
    run = subprocess.run(
        [sys.executable, Path(__file__).with_name("install_extension.py"), *arguments],
        env=os.environ | {"BLENDER_USER_RESOURCES": str(folder / "user")},
        cwd=folder, capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert run.returncode == 0, run.stdout + run.stderr
    return json.loads(run.stdout.strip().splitlines()[-1])


def test_blender_installs_the_zip_and_renders_with_it(archive, tmp_path):
    assert as_user(tmp_path, "install", archive) == {"enabled": True}
    report = as_user(tmp_path, "render", tmp_path / "installed.exr")
    assert Path(report["moderngl"]).is_relative_to(tmp_path / "user"), "the wheel is not what was imported"
    assert not Path(report["numpy"]).is_relative_to(tmp_path / "user")
    assert report["left"] == report["outside"] == []
    bpy.ops.wm.read_factory_settings()
    render_default_scene(tmp_path / "source.exr")
    installed = read(tmp_path / "installed.exr")
    assert installed.shape == (16, 16, 4) and installed[..., :3].max() > 0.05
    np.testing.assert_allclose(installed, read(tmp_path / "source.exr"), rtol=1e-3, atol=1e-4)


def test_macos_is_refused_with_the_reason(monkeypatch):
    import rppm_addon
    from rppm_addon.scene.errors import DeviceError

    monkeypatch.setattr(sys, "platform", "darwin")
    with pytest.raises(DeviceError, match=r"4\.1.*Linux or Windows"):
        rppm_addon.register()
