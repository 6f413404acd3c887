# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the extension that Blender installs: fetches its wheels, builds the zip and validates it.

Blender's own builder does the work; it is a script in the bpy wheel that runs without Blender. The
manifest lists the wheels by name, wheels.txt their versions and hashes.
"""

import argparse
import hashlib
import importlib.util
import re
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
REQUIREMENTS = Path(__file__).resolve().with_name("wheels.txt")


class BuildError(Exception):
    """The extension cannot be built; the message names the remedy."""


class DownloadError(BuildError):
    """Wheels could not be fetched."""


def wheel_paths() -> list[Path]:
    """The wheels that the manifest lists."""
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
    return [ROOT / name for name in manifest["wheels"]]


def fetch_wheels() -> None:
    """Download the wheels that are not there yet, and check the hashes of all.

    Raises DownloadError when pip cannot fetch them, BuildError when what is there is something else.
    """
    wheels = wheel_paths()
    environments: dict[tuple[str, bool], set[str]] = {}
    for wheel in wheels:
        _, _, python, _, platform = wheel.stem.split("-")
        environments.setdefault((python, platform.startswith("win")), set()).update(platform.split("."))
    for (python, windows), platforms in environments.items():
        mine = [wheel for wheel in wheels if f"-{python}-" in wheel.name and ("-win_" in wheel.name) == windows]
        if not all(wheel.is_file() for wheel in mine):
            _download(python, sorted(platforms), mine[0].parent)
    hashes = set(re.findall(r"--hash=sha256:(\w+)", REQUIREMENTS.read_text(encoding="utf-8")))
    for wheel in wheels:
        if not wheel.is_file():
            raise BuildError(f"{wheel} is not what PyPI calls it: make blender_manifest.toml and {REQUIREMENTS} agree")
        if hashlib.sha256(wheel.read_bytes()).hexdigest() not in hashes:
            raise BuildError(f"{wheel} is not the file that {REQUIREMENTS} means: delete it and build again")


def _download(python: str, platforms: list[str], folder: Path) -> None:
    command = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps"]
    command += ["--only-binary=:all:", "--require-hashes", f"--requirement={REQUIREMENTS}", f"--dest={folder}"]
    command += [f"--python-version={python.removeprefix('cp')}", *(f"--platform={tag}" for tag in platforms)]
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode != 0:
        errors = [line for line in run.stderr.splitlines() if line.startswith("ERROR")] or [run.stderr.strip()]
        raise DownloadError(f"pip could not fetch the wheels for {python} ({errors[-1]}): check the way to PyPI")


def blender_command(*arguments: str) -> None:
    """Run a command of Blender's tool for extensions; raises BuildError with what it says."""
    specification = importlib.util.find_spec("bpy")
    folders = specification.submodule_search_locations if specification else []
    tools = [
        tool for folder in folders for tool in Path(folder).glob("*/scripts/addons_core/bl_pkg/cli/blender_ext.py")
    ]
    if not tools:
        raise BuildError("Blender's builder is part of the bpy wheel, which is missing: make setup")
    run = subprocess.run([sys.executable, str(tools[0]), *arguments], capture_output=True, text=True, cwd=ROOT)
    if run.returncode != 0:
        raise BuildError(f"Blender's tool refuses to {arguments[0]}:\n{run.stdout}{run.stderr}".rstrip())


def build(folder: Path, split_platforms: bool = False) -> list[Path]:
    """Build the zip, or one of each platform, into ``folder`` and validate it; returns the files."""
    fetch_wheels()
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("rppm-*.zip"):
        old.unlink()
    options = ["--split-platforms"] if split_platforms else []
    blender_command("build", f"--source-dir={ROOT}", f"--output-dir={folder.resolve()}", *options)
    zips = sorted(folder.glob("rppm-*.zip"))
    for file in zips:
        blender_command("validate", str(file.resolve()))
    return zips


def main() -> int:
    """Build as the command line says; returns the exit status."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", type=Path, default=ROOT / "build" / "extension", metavar="FOLDER")
    parser.add_argument("--split-platforms", action="store_true", help="a smaller zip for each platform")
    arguments = parser.parse_args()
    try:
        zips = build(arguments.output, arguments.split_platforms)
    except BuildError as error:
        print(f"extension: {error}", file=sys.stderr)
        return 1
    for file in zips:
        print(f"{file} ({file.stat().st_size / 1e6:.1f} MB)")
    return 0


if __name__ == "__main__":
    sys.exit(main())
