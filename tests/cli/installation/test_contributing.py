# SPDX-License-Identifier: GPL-3.0-or-later
"""CONTRIBUTING.md followed to the letter: its examples, made in a copy of the checkout, do what it says."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
GUIDE = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
COPIED = ("rppm_addon", "shaders", "tests", "pyproject.toml")
_HOW_TO = re.compile(r"^### (.+?)\n(.*?)(?=^##|\Z)", re.MULTILINE | re.DOTALL)
_BLOCK = re.compile(r"^`(\S+)`\n\n```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)
HOW_TOS = {title: body for title, body in _HOW_TO.findall(GUIDE) if "```" in body}


def patched(text: str, difference: str) -> str:
    """A file's text with one place changed, which its unchanged and removed lines must name without a doubt."""
    lines = difference.splitlines(keepends=True)
    assert {line[0] for line in lines} <= set(" +-"), difference
    before = "".join(line[1:] for line in lines if line[0] != "+")
    assert text.count(before) == 1, f"{text.count(before)} places are\n{before}"
    return text.replace(before, "".join(line[1:] for line in lines if line[0] != "-"))


def follow(body: str, checkout: Path) -> list[str]:
    """Make the changes of a how-to; the files that it names."""
    blocks = _BLOCK.findall(body)
    assert len(blocks) == body.count("\n```") // 2, "a block does not say its file"
    for name, language, text in blocks:
        path = checkout / name
        assert path.exists() == (language == "diff"), name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(patched(path.read_text(encoding="utf-8"), text) if language == "diff" else text, "utf-8")
    return [name for name, _, _ in blocks]


@pytest.fixture
def checkout(tmp_path):
    """A copy that may be changed."""
    for name in COPIED:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(ROOT / name, tmp_path)
    return tmp_path


def run(checkout: Path, *command: object) -> str:
    environment = os.environ | {"PYTHONPATH": str(checkout)}
    done = subprocess.run(
        [sys.executable, "-m", *map(str, command)],
        cwd=checkout, env=environment, capture_output=True, text=True, timeout=240,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_there_are_four():
    assert len(HOW_TOS) == 4


@pytest.mark.parametrize("title", HOW_TOS)
def test_the_example_works(checkout, title):
    files = follow(HOW_TOS[title], checkout)
    python = [name for name in files if name.endswith(".py")]
    tests = [name for name in python if name.startswith("tests/")]
    assert tests
    if any(name.startswith("tests/blender/") for name in tests):
        pytest.importorskip("bpy", reason="the bpy module is not installed")
    run(checkout, "ruff", "check", "--no-cache", *python)
    assert " passed" in run(checkout, "pytest", "--quiet", "-p", "no:cacheprovider", *tests)


def test_examples_are_no_part_of_the_checkout():
    for body in HOW_TOS.values():
        for name, language, _ in _BLOCK.findall(body):
            assert (ROOT / name).exists() == (language == "diff"), name
