# SPDX-License-Identifier: GPL-3.0-or-later
"""Locks of the packages that make installs, .ci/locks/: every package of a group, with its version and hashes.

``python tools/lock.py [GROUP...]`` makes them from pyproject.toml and keeps the versions that still do; ``--check``
says, without a network, whether they have what pyproject.toml pins, a hash for each package and no place to get them
from. ``.ci/install_locked.py`` installs them.
"""

import re
import subprocess
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LOCKS = ROOT / ".ci" / "locks"
_HEADER = """# SPDX-License-Identifier: GPL-3.0-or-later
# {purpose}, for Python {python}; python tools/lock.py {name} makes it from pyproject.toml.
"""
_PIN = re.compile(r"^([A-Za-z0-9._-]+)==(\S+)(.*?)(?=^\S|\Z)", re.MULTILINE | re.DOTALL)
_HASH = re.compile(r"--hash=sha256:[0-9a-f]{64}\b")


@dataclass(frozen=True)
class Group:
    """Packages that are installed together."""

    purpose: str
    extras: tuple[str, ...] = ()
    """Extras of the project, installed with its dependencies."""
    dependency_groups: tuple[str, ...] = ()
    """Dependency groups of pyproject.toml, installed without the project."""
    python: str = "3.11"
    """Version of the Python that they are installed for."""
    beside: str = ""
    """Group of the same environment, whose versions hold for this one too."""

    def requirements(self, project: str) -> list[str]:
        """Pinned requirements of the group in the text of pyproject.toml."""
        table = tomllib.loads(project)
        extras = table["project"]["optional-dependencies"]
        found = [line for name in self.extras for line in extras[name]]
        found += [line for name in self.dependency_groups for line in table["dependency-groups"][name]]
        return [*table["project"]["dependencies"], *found] if self.extras else found

    def header(self, name: str) -> str:
        """First lines of the group's lock."""
        return _HEADER.format(name=name, purpose=self.purpose, python=self.python)


GROUPS = {
    "setup": Group("What make setup installs", ("blender", "farm", "test")),
    "bench": Group("What make bench installs beside it", ("bench",), beside="setup"),
    "docs": Group("What make docs installs beside it", ("docs",), beside="setup"),
    "gpu": Group("What tools/gpu_run.sh takes to a machine with a GPU", dependency_groups=("gpu",), python="3.12"),
    "luxcore": Group("LuxCore for make bench-peers", dependency_groups=("luxcore",)),
    "mitsuba": Group("Mitsuba for make bench-peers", dependency_groups=("mitsuba",)),
    "blender-4.2": Group("Blender for make test-wheels", dependency_groups=("blender-4-2",)),
    "blender-4.5": Group("Blender for make test-wheels", dependency_groups=("blender-4-5",)),
    "blender-5.0": Group("Blender for make test-wheels", dependency_groups=("blender-5-0",)),
    "blender-5.1": Group("Blender for make test-wheels", dependency_groups=("blender-5-1",), python="3.13"),
    "blender-5.2": Group("Blender for make test-wheels", dependency_groups=("blender-5-2",), python="3.13"),
}
"""Groups by the names of their locks."""


def lock_of(name: str) -> Path:
    """The lock's file of a group."""
    return LOCKS / f"{name}.txt"


def pins(lock: str) -> dict[str, tuple[str, str]]:
    """Version and hashes by canonical name, of a lock's text."""
    return {_plain(name): (version, hashes) for name, version, hashes in _PIN.findall(lock)}


def problems(lock: str, requirements: list[str]) -> list[str]:
    """Faults of a lock's text, by the pinned requirements of its group; a line each."""
    found = pins(lock)
    wrong = []
    for requirement in requirements:
        name, _, version = requirement.partition("==")
        if found.get(_plain(name), ("nothing", ""))[0] != version:
            wrong.append(f"{requirement} is not in the lock; run python tools/lock.py")
    wrong += [f"{name} has no hash" for name, (_, hashes) in found.items() if not _HASH.search(hashes)]
    if "://" in lock or re.search(r"^-", lock, re.MULTILINE):
        wrong.append("the lock names a place to get packages from; it is the user's to choose")
    return wrong


def disagreements(lock: str, other: str) -> list[str]:
    """Packages that two locks of one environment pin at different versions; a line each."""
    first, second = pins(lock), pins(other)
    return [
        f"{name} is {first[name][0]} here and {second[name][0]} in the lock beside it; run python tools/lock.py"
        for name in first.keys() & second.keys()
        if first[name][0] != second[name][0]
    ]


def _plain(name: str) -> str:
    """A package's name as PyPI compares it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def _make(name: str, group: Group) -> None:
    """Write a group's lock. Raises CalledProcessError when uv finds no versions that fit."""
    lock = lock_of(name)
    options = ["--generate-hashes", "--no-emit-index-url", "--no-emit-find-links", "--no-header", "--no-annotate"]
    command = [sys.executable, "-m", "uv", "pip", "compile", *options, "--only-binary=:all:"]
    if group.extras:
        command += ["pyproject.toml", *(word for extra in group.extras for word in ("--extra", extra))]
    command += [word for named in group.dependency_groups for word in ("--group", named)]
    if group.beside:
        command += ["--constraint", str(lock_of(group.beside))]
    command += ["--python-version", group.python, "--quiet", "--output-file", str(lock)]
    subprocess.run(command, cwd=ROOT, check=True)
    text = "".join(line for line in lock.read_text(encoding="utf-8").splitlines(True) if not line.startswith("#"))
    lock.write_text(group.header(name) + text, encoding="utf-8")


def main() -> int:
    """Make or check the locks; the exit status is 1 where one is wrong."""
    named = [word for word in sys.argv[1:] if word != "--check"]
    unknown = [name for name in named if name not in GROUPS]
    if unknown:
        sys.stderr.write(f"there is no group {', '.join(unknown)}: {', '.join(GROUPS)}\n")
        return 2
    groups = {name: GROUPS[name] for name in named or GROUPS}
    if "--check" not in sys.argv[1:]:
        for name, group in groups.items():
            _make(name, group)
    project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    wrong = []
    for name, group in groups.items():
        lock = lock_of(name).read_text(encoding="utf-8")
        beside = lock_of(group.beside).read_text(encoding="utf-8") if group.beside else ""
        found = [*problems(lock, group.requirements(project)), *disagreements(lock, beside)]
        wrong += [f"{lock_of(name).relative_to(ROOT)}: {line}\n" for line in found]
    sys.stderr.write("".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
