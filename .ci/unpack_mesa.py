# SPDX-License-Identifier: GPL-3.0-or-later
"""Unpacks the Mesa of Debian 12's backports into .mesa, where there is no GPU: it renders twice as fast as Debian's.

Neither the system's Mesa nor its package sources are touched, and nobody needs to be root: apt works in a folder of its
own, with the mirrors that the system has. Quick when it is there; a failure is told and not tried again for a day.
"""

import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from rppm_addon.gl.context.project_mesa import (  # noqa: E402
    FOLDER,
    RELEASE_FILE,
    VARIABLE,
    has_gpu,
    is_unpacked,
    libraries,
    system_release,
)

RELEASE, CODENAME = "debian 12", "bookworm"
BACKPORTS = f"{CODENAME}-backports"
KEYRING = Path("/usr/share/keyrings/debian-archive-keyring.gpg")
TESTED_VERSION = "25.0.7-2~bpo12+1"
"""Version of Mesa that RPPM was tested with. A mirror has only the newest of the backports: another version is taken as
well, if it starts, and named."""
TRY_AGAIN_SECONDS = 24 * 3600.0
LONGEST_SECONDS = 60
"""Seconds that apt may take at a time: where the mirrors are out of reach, set-up does not wait for long."""

# Without the hooks with which container images delete what apt fetches.
_CONFIGURATION = """
#clear APT::Update;
#clear DPkg::Post-Invoke;
APT::Sandbox::User "root";
Acquire::Languages "none";
Acquire::Retries "0";
Acquire::http::Timeout "10";
Acquire::https::Timeout "10";
Dir::Etc::SourceList "{folder}/sources.list";
Dir::Etc::SourceParts "/dev/null";
Dir::State::Lists "{folder}/lists";
Dir::Cache "{folder}/cache";
"""


class UnavailableError(Exception):
    """There is no newer Mesa to be had; the message says why."""


def _run(command: Sequence[str], folder: Path | None = None, check: bool = True) -> str:
    """Return what a program prints. Raises UnavailableError with its last complaint, if it fails and that counts."""
    try:
        run = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=LONGEST_SECONDS)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise UnavailableError(str(error)) from error
    if check and run.returncode != 0:
        complaints = run.stderr.strip().splitlines() or [f"{command[0]} ended with code {run.returncode}"]
        raise UnavailableError(complaints[-1])
    return run.stdout


def mirrors(targets: str) -> list[str]:
    """Addresses that offer the release's main component, of lines with address, release and component."""
    fields = (line.split() for line in targets.splitlines())
    return list(dict.fromkeys(field[0] for field in fields if field[1:] == [CODENAME, "main"]))


def _configure(folder: Path, kind: str = "deb") -> str:
    """Have apt work in an empty folder, with backports; returns the argument that tells it. Raises UnavailableError.

    kind: ``deb`` for packages, ``deb-src`` for sources.
    """
    wanted = "$(REPO_URI) $(RELEASE) $(COMPONENT)"
    addresses = mirrors(_run(["apt-get", "indextargets", "--format", wanted, "Created-By: Packages"]))
    if not addresses:
        raise UnavailableError(f"the system's package sources have no {CODENAME} main")
    signed = f"[signed-by={KEYRING}] " if KEYRING.exists() else ""
    lines = [f"{kind} {signed}{address} {BACKPORTS} main\n" for address in addresses]
    (folder / "sources.list").write_text("".join(lines), encoding="utf-8")
    (folder / "apt.conf").write_text(_CONFIGURATION.format(folder=folder), encoding="utf-8")
    for name in ("lists/partial", "cache/archives/partial", "packages"):
        (folder / name).mkdir(parents=True)
    configured = f"--config-file={folder / 'apt.conf'}"
    _run(["apt-get", configured, "update"], check=False)  # of several mirrors one may have no backports
    return configured


def _fetch(folder: Path, configured: str, names: Sequence[str]) -> list[Path]:
    _run(["apt-get", configured, "download", *(f"{name}/{BACKPORTS}" for name in names)], folder / "packages")
    return sorted((folder / "packages").glob("*.deb"))


def download(folder: Path) -> list[Path]:
    """Fetch the packages of Mesa and of its libdrm into an empty folder. Raises UnavailableError."""
    configured = _configure(folder)
    try:
        needed = _run(["apt-cache", configured, "depends", "--important", f"mesa-libgallium/{BACKPORTS}"]).split()
    except UnavailableError as error:
        raise UnavailableError(f"{BACKPORTS} cannot be reached, or have no Mesa") from error
    names = ["mesa-libgallium", "libegl-mesa0", "libgbm1", *(name for name in needed if name.startswith("libdrm"))]
    return _fetch(folder, configured, names)


def fetch_shims(folder: Path) -> Path:
    """Unpack Mesa's drm-shim within an empty folder, and say where. Raises UnavailableError."""
    for package in _fetch(folder, _configure(folder), ["mesa-drm-shim"]):
        _run(["dpkg-deb", "--extract", str(package), str(folder / "unpacked")])
    return folder / "unpacked"


def fetch_source(folder: Path) -> Path:
    """Unpack Mesa's sources within an empty folder, and say where. Raises UnavailableError."""
    configured = _configure(folder, "deb-src")
    _run(["apt-get", configured, "source", "--tar-only", "--download-only", f"mesa/{BACKPORTS}"], folder / "packages")
    (folder / "unpacked").mkdir()
    for archive in (folder / "packages").glob("*.orig.tar.xz"):
        _run(["tar", "--extract", "--file", str(archive), "--strip-components=1"], folder / "unpacked")
    return folder / "unpacked"


EXTRAS: dict[str, Callable[[Path], Path]] = {"--shims": fetch_shims, "--source": fetch_source}


def unpack_extra(fetch: Callable[[Path], Path], folder: Path) -> int:
    """Have what is fetched in a folder, unless it is there; returns the exit status."""
    if folder.exists():
        return 0
    try:
        if system_release() != RELEASE:
            raise UnavailableError("it comes with Debian 12's backports, and this is another system")
        folder.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder.parent) as temporary:
            fetch(Path(temporary)).replace(folder)
    except (UnavailableError, OSError) as error:
        print(error, file=sys.stderr)
        return 1
    return 0


def unpack(folder: Path) -> str:
    """Put Mesa into a folder in place of what is there, whole or not at all.

    Returns Mesa's version. Raises UnavailableError.
    """
    if system_release() != RELEASE:
        raise UnavailableError("it comes with Debian 12's backports, and this is another system")
    new = folder.with_name(f"{folder.name}.new")
    shutil.rmtree(new, ignore_errors=True)
    try:
        with tempfile.TemporaryDirectory() as temporary:
            for package in download(Path(temporary)):
                _run(["dpkg-deb", "--extract", str(package), str(new)])
        (new / RELEASE_FILE).write_text(f"{RELEASE}\n", encoding="utf-8")
        paths = libraries(new)
        if not paths:
            raise UnavailableError("libraries are missing in its packages")
        _check_dependencies(paths)
        # Another release may want more of the system than its libraries.
        _run(["env", f"{VARIABLE}={new}", sys.executable, "-m", "rppm_addon", "info"], ROOT)
        shutil.rmtree(folder, ignore_errors=True)
        new.rename(folder)
    finally:
        shutil.rmtree(new, ignore_errors=True)
    return next(path.stem.removeprefix("libgallium-") for path in paths if path.name.startswith("libgallium-"))


def _check_dependencies(paths: Sequence[Path]) -> None:
    """Raises UnavailableError when the system lacks a library that these need."""
    present = {path.name for path in paths}
    for path in paths:
        fields = (line.partition("=>") for line in _run(["ldd", str(path)]).splitlines())
        missing = {name.strip() for name, _, found in fields if found.strip() == "not found"} - present
        if missing:
            raise UnavailableError(f"{path.name} needs {', '.join(sorted(missing))}")


def main(folder: Path = FOLDER) -> int:
    """Unpack Mesa if it is wanted and not there; says what was done. Never fails: the system's Mesa does too."""
    tried = folder.with_name(f"{folder.name}.tried")
    if VARIABLE in os.environ or has_gpu() or is_unpacked(folder):
        return 0
    if tried.exists() and abs(time.time() - tried.stat().st_mtime) < TRY_AGAIN_SECONDS:
        return 0
    try:
        version = unpack(folder)
    except (UnavailableError, OSError) as error:
        tried.touch()
        print(f"set-up: no newer Mesa than the system's, which will do ({error}); tried again after a day")
        return 0
    tried.unlink(missing_ok=True)
    print(f"set-up: Mesa {version} from {BACKPORTS} into {folder.name}, for RPPM alone; the system's stays")
    if version != TESTED_VERSION:
        print(f"set-up: RPPM was tested with Mesa {TESTED_VERSION}; {VARIABLE}=system keeps to the system's driver")
    return 0


if __name__ == "__main__":
    extra = EXTRAS.get(sys.argv[1]) if len(sys.argv) == 3 else None
    sys.exit(unpack_extra(extra, Path(sys.argv[2])) if extra else main())
