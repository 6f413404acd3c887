# SPDX-License-Identifier: GPL-3.0-or-later
"""Constants that shaders include: what their declarations become, and that each has a user."""

import enum
import re

import pytest
from support.shader_declarations import import_declarations

from rppm_addon.gl.buffers.constants import Constants
from rppm_addon.gl.programs.sources import SHADER_FOLDER

import_declarations()
SHADERS = {
    path.relative_to(SHADER_FOLDER).as_posix(): path.read_text(encoding="utf-8")
    for path in sorted(SHADER_FOLDER.rglob("*.*"))
}
INCLUDED = re.compile(r"^#include <(\w+)>", re.MULTILINE)


@pytest.fixture(autouse=True)
def own_registry(monkeypatch):
    monkeypatch.setattr(Constants, "registry", dict(Constants.registry))


class Flag(enum.IntFlag):
    FIRST = 1
    SECOND = 2
    BOTH = 3


class Kind(enum.IntEnum):
    PLAIN = 0
    FANCY = 7


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ({"COUNT": 3}, "const uint COUNT = 3u;"),
        ({"signed": True, "COUNT": -3}, "const int COUNT = -3;"),
        ({"LEAST": 0.25}, "const float LEAST = 0.25;"),
        ({"SIZES": [1, 2]}, "const uint SIZES[2] = uint[](1u, 2u);"),
        ({"LEVELS": [0.5, 1e10]}, "const float LEVELS[2] = float[](0.5, 10000000000.0);"),
        ({"FLAG": Flag}, "const uint FLAG_FIRST = 1u; const uint FLAG_SECOND = 2u;"),
        ({"KIND": Kind}, "const uint KIND_PLAIN = 0u; const uint KIND_FANCY = 7u;"),
        ({"WRAP": ("Clip", "REPEAT")}, "const int WRAP_CLIP = 0; const int WRAP_REPEAT = 1;"),
    ],
)
def test_what_is_declared(values, expected):
    assert Constants("Declared", **values).glsl() == expected


def test_one_name_has_one_meaning():
    Constants("Twice", COUNT=3)
    Constants("Twice", COUNT=3)
    with pytest.raises(ValueError, match="Twice"):
        Constants("Twice", COUNT=4)


def test_each_constant_has_a_user():
    """Plain ones each; of an enumeration one at least, since it says more than shaders ask."""
    words = set(re.findall(r"\b[A-Z]\w+\b", "\n".join(SHADERS.values())))
    unused = [group for constants in Constants.registry.values() for group in constants.groups if not words & {*group}]
    assert not unused


def test_each_set_is_included():
    included = {name for text in SHADERS.values() for name in INCLUDED.findall(text)}
    assert not set(Constants.registry) - included


def test_shaders_declare_no_constant_of_their_own_by_such_a_name():
    names = {name for constants in Constants.registry.values() for group in constants.groups for name in group}
    own = re.compile(r"^const \w+ (\w+) *=", re.MULTILINE)
    again = {file: names & {*own.findall(text)} for file, text in SHADERS.items()}
    assert not {file: found for file, found in again.items() if found}
