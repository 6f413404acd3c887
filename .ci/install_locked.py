# SPDX-License-Identifier: GPL-3.0-or-later
"""Installs the packages of a lock into the environment of the Python that runs this, and resolves no versions.

``PYTHON .ci/install_locked.py GROUP`` installs ``.ci/locks/GROUP.txt`` (tools/lock.py makes the locks). Quick where the
environment has them already.
"""

import hashlib
import subprocess
import sys
from collections.abc import Iterator
from importlib import metadata
from pathlib import Path

from pip._vendor.packaging.requirements import Requirement
from pip._vendor.packaging.utils import canonicalize_name

LOCKS = Path(__file__).resolve().parent / "locks"
OPTIONS = ("--require-hashes", "--no-deps", "--only-binary=:all:")
"""Options with which pip takes a lock as it is: neither the requirements of its packages nor those of builds are looked
up, as an index could answer with releases that are newer than the lock."""
_QUIET = ("--quiet", "--disable-pip-version-check", "--root-user-action=ignore")


class LockError(Exception):
    """A lock could not be installed; the message says what to do."""


def locked_versions(lock: str) -> dict[str, str]:
    """Versions of the packages that a lock's text pins, by canonical name."""
    pins = (line.split()[0].partition("==") for line in lock.splitlines() if "==" in line and line[0].isalnum())
    return {canonicalize_name(name): version for name, _, version in pins}


def requirements_of(name: str, extras: frozenset[str]) -> Iterator[Requirement]:
    """Requirements of an installed package with extras, for this Python and system.

    Raises:
        metadata.PackageNotFoundError: The package is not installed.
    """
    for text in metadata.distribution(name).requires or ():
        requirement = Requirement(text)
        marker = requirement.marker
        if marker is None or any(marker.evaluate({"extra": extra}) for extra in extras | {""}):
            yield requirement


def unmet_requirements(lock: str) -> list[str]:
    """Requirements of a lock's installed packages that the lock does not meet, extras included; a line each."""
    versions = locked_versions(lock)
    unmet = []
    seen: set[tuple[str, frozenset[str]]] = set()
    queue = [(name, frozenset[str]()) for name in versions]
    while queue:
        name, extras = queue.pop()
        if (name, extras) in seen:
            continue
        seen.add((name, extras))
        try:
            needed = list(requirements_of(name, extras))
        except metadata.PackageNotFoundError:
            unmet.append(f"{name} is not installed")
            continue
        for requirement in needed:
            found = canonicalize_name(requirement.name)
            if found not in versions:
                unmet.append(f"{name} needs {requirement}, which is not locked")
            elif not requirement.specifier.contains(versions[found], prereleases=True):
                unmet.append(f"{name} needs {requirement}, and {versions[found]} is locked")
            else:
                queue.append((found, frozenset(requirement.extras)))
    return sorted(unmet)


def install(lock: Path, *options: str) -> None:
    """Install a lock with pip.

    Args:
        lock: The lock's file.
        options: Further options of pip, such as ``--no-compile``.

    Raises:
        LockError: A package could not be fetched, is another file than the lock means, or needs one that is not locked.
    """
    command = [sys.executable, "-m", "pip", "install", *_QUIET, *OPTIONS, *options, f"--requirement={lock}"]
    run = subprocess.run(command, stderr=subprocess.PIPE, text=True)
    if run.returncode:
        errors = [line for line in run.stderr.splitlines() if line.startswith("ERROR")] or run.stderr.splitlines()
        reason = errors[-1].removeprefix("ERROR: ") if errors else f"pip ended with code {run.returncode}"
        remedy = "check the way to PyPI and the room on the disk, then run make again"
        raise LockError(f"pip could not install {lock.name} ({reason}): {remedy}")
    unmet = unmet_requirements(lock.read_text(encoding="utf-8"))
    if unmet:
        raise LockError(f"{lock.name} is not complete ({'; '.join(unmet)}): run make lock, and commit the locks")


def main() -> int:
    """Install the lock that the command line names, unless that was done; returns the exit status."""
    if len(sys.argv) != 2 or not (LOCKS / f"{sys.argv[1]}.txt").is_file():
        groups = ", ".join(sorted(path.stem for path in LOCKS.glob("*.txt")))
        print(f"usage: install_locked.py GROUP, with GROUP one of {groups}", file=sys.stderr)
        return 2
    lock = LOCKS / f"{sys.argv[1]}.txt"
    stamp = Path(sys.prefix) / f"locked-{lock.stem}"
    wanted = hashlib.sha256(lock.read_bytes()).hexdigest()
    if stamp.is_file() and stamp.read_text(encoding="utf-8") == wanted:
        return 0
    try:
        # A hundred megabytes of Python take half a minute to compile; what is imported is compiled then, and kept.
        install(lock, "--no-compile")
    except LockError as error:
        print(f"set-up: {error}", file=sys.stderr)
        return 1
    stamp.write_text(wanted, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
