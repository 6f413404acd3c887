# SPDX-License-Identifier: GPL-3.0-or-later
"""Installation by `pip install .`: the program renders without the checkout."""

import importlib.metadata
import os
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
SOURCES = ("rppm_addon", "shaders", "setup.py", "pyproject.toml", "blender_manifest.toml", "README.md", "LICENSE")


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The wheel, built from a copy: setuptools leaves its folders where it builds."""
    copy, made = tmp_path_factory.mktemp("checkout"), tmp_path_factory.mktemp("wheel")
    for name in SOURCES:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, copy / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(ROOT / name, copy)
    _pip("wheel", "--no-build-isolation", f"--wheel-dir={made}", copy)
    (file,) = made.glob("*.whl")
    return file


def _pip(command, *arguments):
    options = ("--quiet", "--disable-pip-version-check", "--no-deps", "--no-index")
    run = subprocess.run(
        [sys.executable, "-m", "pip", command, *options, *map(str, arguments)],
        capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr


def test_the_wheel_holds_the_package_and_its_shaders(wheel):
    wanted = {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / "rppm_addon").rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    shaders = [path for path in (ROOT / "shaders").rglob("*") if path.is_file()]
    wanted |= {"rppm_addon/" + path.relative_to(ROOT).as_posix() for path in shaders}
    with zipfile.ZipFile(wheel) as file:
        names = {name for name in file.namelist() if ".dist-info/" not in name}
    assert names == wanted


def test_the_version_is_the_extensions(wheel):
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
    assert wheel.name.split("-")[1] == manifest["version"] == importlib.metadata.version("rppm-addon")


def test_an_installed_rppm_renders(wheel, tmp_path, saved_scene):
    target = tmp_path / "installed"
    _pip("install", f"--target={target}", wheel)
    environment = os.environ | {"PYTHONPATH": str(target)}

    def run(*command):
        done = subprocess.run(
            [*map(str, command)], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=240
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    folder = run(sys.executable, "-c", "from rppm_addon.gl.programs.sources import SHADER_FOLDER; print(SHADER_FOLDER)")
    assert Path(folder.strip()) == target / "rppm_addon" / "shaders"
    assert "OpenGL" in run(target / "bin" / "rppm", "info")
    run(target / "bin" / "rppm", "render", saved_scene, "-o", tmp_path / "floor.exr", "--set", "rppm.samples=1")
    assert (tmp_path / "floor.exr").stat().st_size > 0
