# SPDX-License-Identifier: GPL-3.0-or-later
"""Packages that make installs are pinned, one by one."""

import re
import subprocess
from pathlib import Path

import pytest

from tools.lock import GROUPS, LOCKS, disagreements, lock_of, problems

ROOT = Path(__file__).resolve().parents[3]
PROJECT = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
SETUP = lock_of("setup").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", GROUPS)
def test_a_lock_is_that_of_the_project(name):
    assert problems(lock_of(name).read_text(encoding="utf-8"), GROUPS[name].requirements(PROJECT)) == []


def test_each_lock_has_a_group():
    assert {path.stem for path in LOCKS.glob("*")} == set(GROUPS)


@pytest.mark.parametrize("name", [name for name, group in GROUPS.items() if group.beside])
def test_locks_of_one_environment_agree(name):
    assert disagreements(lock_of(name).read_text(encoding="utf-8"), SETUP) == []


def test_locks_that_disagree_are_told():
    assert "numpy is 1.26.4 here and 1.26.5" in disagreements(SETUP, SETUP.replace("numpy==1.26.4", "numpy==1.26.5"))[0]


@pytest.mark.parametrize(
    ("before", "after", "text"),
    [
        ("moderngl==5.13.0", "moderngl==5.12.0", "moderngl==5.13.0 is not in the lock"),
        ("moderngl==5.13.0", "otherngl==5.13.0", "moderngl==5.13.0 is not in the lock"),
        ("sha256:", "md5:", "has no hash"),
        ("moderngl==", "--extra-index-url https://host/simple\nmoderngl==", "names a place"),
        ("moderngl==", "moderngl @ https://host/a.whl\nmoderngl==", "names a place"),
    ],
)
def test_what_is_wrong_with_a_lock_is_told(before, after, text):
    found = problems(SETUP.replace(before, after), GROUPS["setup"].requirements(PROJECT))
    assert found and all(text in line for line in found)


def test_whatever_calls_pip_has_it_resolve_nothing():
    calls = re.compile(r"\bpip\b[\"', ]+(install|download|wheel)\b|\b(uv|pipx|npm|conda)[\"', ]+(install|run|add)\b")
    tracked = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True).stdout.splitlines()
    named = [ROOT / name for name in tracked] or [path for path in ROOT.rglob("*") if "." not in path.parent.name]
    scripts = [path for path in named if path.suffix in (".sh", ".py") or path.name in ("Makefile", "run")]
    scripts = [path for path in scripts if path.is_file() and path != Path(__file__)]
    found = []
    for path in scripts:
        # A command goes on where a line ends in a backslash; a message may name pip, a command hands options on.
        text = path.read_text(encoding="utf-8", errors="replace").replace("\\\n", " ")
        found += [(path.relative_to(ROOT).as_posix(), line) for line in text.splitlines() if calls.search(line)]
    commands = [(name, line) for name, line in found if "-m pip" in line or '"pip"' in line]
    assert {name for name, _ in commands} >= {".ci/set_up.sh", ".ci/install_locked.py", "extension/build.py"}
    resolving = [call for call in commands if "--no-deps" not in call[1] and "*OPTIONS" not in call[1]]
    assert [
        call for call in resolving if call[0] != "tests/cli/installation/test_wheel.py"
    ] == []  # it has options of its own
