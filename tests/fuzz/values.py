# SPDX-License-Identifier: GPL-3.0-or-later
"""Values that nobody means, and changes to what was meant."""

import copy
import json
from typing import Any

import hypothesis.strategies as st

_LARGE = [1 << bits for bits in (7, 8, 31, 32, 44, 63, 64, 80)]
INTEGERS = st.one_of(st.integers(-4, 4), st.sampled_from([sign * number for number in _LARGE for sign in (1, -1)]))
NUMBERS = st.one_of(INTEGERS, st.floats(), st.sampled_from([float("nan"), float("inf"), 1e300, -0.0, 1e-320]))
TEXTS = st.one_of(
    st.text(max_size=8),
    st.sampled_from(["", "array0", "array1", "\x1b[2J\n", "../../x", "<f4", "RAYS", "name", "\x00", "a" * 300]),
)
PLAIN = st.one_of(st.none(), st.booleans(), NUMBERS, TEXTS)
VALUES = st.recursive(
    PLAIN,
    lambda inner: st.one_of(st.lists(inner, max_size=4), st.dictionaries(TEXTS, inner, max_size=4)),
    max_leaves=8,
)  # fmt: skip


def _places(document: Any, path: tuple = ()) -> list[tuple]:
    """The ways to all parts of a document."""
    found = [path]
    if isinstance(document, dict):
        for name, value in document.items():
            found += _places(value, (*path, name))
    elif isinstance(document, list):
        for index, value in enumerate(document):
            found += _places(value, (*path, index))
    return found


@st.composite
def changed_documents(draw: Any, document: Any) -> Any:
    """The document with some parts replaced, left out, added or put elsewhere."""
    document = copy.deepcopy(document)
    for _ in range(draw(st.integers(1, 3))):
        places = [place for place in _places(document) if place]
        if not places:
            return draw(VALUES)
        place = draw(st.sampled_from(places))
        owner = document
        for step in place[:-1]:
            owner = owner[step]
        change = draw(st.sampled_from(["replace", "replace", "remove", "add", "take"]))
        if change == "remove":
            del owner[place[-1]]
        elif change == "add" and isinstance(owner, list):
            owner.insert(place[-1], draw(VALUES))
        elif change == "add":
            owner[draw(TEXTS)] = draw(VALUES)
        elif change == "take":
            other = document
            for step in draw(st.sampled_from(places)):
                other = other[step]
            owner[place[-1]] = copy.deepcopy(other)
        else:
            owner[place[-1]] = draw(VALUES)
    return document


@st.composite
def damaged_bytes(draw: Any, data: bytes) -> bytes:
    """The bytes with some of them flipped, left out, doubled or replaced."""
    damaged = bytearray(data)
    for _ in range(draw(st.integers(1, 4))):
        if not damaged:
            break
        place = draw(st.integers(0, len(damaged) - 1))
        length = draw(st.sampled_from([1, 1, 2, 4, 16, 256]))
        change = draw(st.sampled_from(["flip", "flip", "cut", "end", "double", "replace"]))
        if change == "flip":
            damaged[place] ^= 1 << draw(st.integers(0, 7))
        elif change == "cut":
            del damaged[place : place + length]
        elif change == "end":
            del damaged[place:]
        elif change == "double":
            damaged[place:place] = damaged[place : place + length]
        else:
            damaged[place : place + length] = draw(st.binary(min_size=length, max_size=length))
    return bytes(damaged)


def as_json(value: Any) -> Any:
    """Return the value as it is after it went through a pipe or a file."""
    return json.loads(json.dumps(value))
