# SPDX-License-Identifier: GPL-3.0-or-later
"""What set-up installs is pinned, package by package."""

from pathlib import Path

import pytest

from tools.lock import LOCK, problems

PROJECT = (Path(__file__).resolve().parents[3] / "pyproject.toml").read_text(encoding="utf-8")


def test_the_lock_is_that_of_the_project():
    assert problems(LOCK.read_text(encoding="utf-8"), PROJECT) == []


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
    found = problems(LOCK.read_text(encoding="utf-8").replace(before, after), PROJECT)
    assert found and all(text in line for line in found)
