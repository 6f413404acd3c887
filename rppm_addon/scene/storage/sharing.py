# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that follow each other share what is equal, so that it is known by identity what has changed."""

import dataclasses
import enum
import functools
import operator
import typing
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..meshes import Instance
from ..scene import Scene
from .documents import field_names

LISTS = ("meshes", "instances", "instance_arrays", "materials", "lights", "images")
_LARGE = {"meshes", "images"}
_MEMBERS = ("camera", "world", "settings", "dicing_view")
_SMALL = 1 << 10
_PART = 1 << 16


def equal(a: Any, b: Any) -> bool:
    """Whether two members of scenes say the same, arrays bit for bit."""
    if a is b:
        return True
    if type(a) is not type(b):
        return False
    if isinstance(a, np.ndarray):
        return same_bits(a, b)
    if dataclasses.is_dataclass(a):
        plain, others = _fields_of(a.__class__)
        for name in others:  # as a loop, for thousands of instances
            if not equal(getattr(a, name), getattr(b, name)):
                return False
        return plain is None or plain(a) == plain(b)
    if isinstance(a, list | tuple):
        return len(a) == len(b) and all(map(equal, a, b))
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(equal(value, b[key]) for key, value in a.items())
    return a == b


@functools.cache
def _fields_of(kind: type) -> tuple[Callable[[object], tuple] | None, list[str]]:
    """Return a getter of the fields of a dataclass that Python compares by itself, or None, and the others' names."""
    hints = typing.get_type_hints(kind)
    plain = [name for name in field_names(kind) if _is_plain(hints[name])]
    others = [name for name in field_names(kind) if name not in plain]
    return (operator.attrgetter(*plain) if plain else None), others


def _is_plain(hint: object) -> bool:
    if isinstance(hint, type) and typing.get_origin(hint) is None:
        return issubclass(hint, bool | int | float | str | enum.Enum)
    of_many = typing.get_origin(hint) in {tuple, list, dict}
    return of_many and all(inner is ... or _is_plain(inner) for inner in typing.get_args(hint))


def same_bits(a: np.ndarray, b: np.ndarray) -> bool:
    """Whether two arrays have the same shape, type and bits."""
    if a is b:
        return True
    if a.shape != b.shape or a.dtype != b.dtype:
        return False
    if a.nbytes <= _SMALL or a.dtype.itemsize != 4 or not (a.flags.c_contiguous and b.flags.c_contiguous):
        return a.tobytes() == b.tobytes()
    x, y = a.reshape(-1).view(np.uint32), b.reshape(-1).view(np.uint32)
    # In parts: what has changed mostly differs from the beginning, and the results stay in a cache.
    return all((x[start : start + _PART] == y[start : start + _PART]).all() for start in range(0, len(x), _PART))


def keep_equal(before: np.ndarray | None, after: np.ndarray) -> np.ndarray:
    """The array before, if there is one and it says the same."""
    return before if before is not None and same_bits(before, after) else after


def _shared_list(before: list, after: list, by_identity: bool) -> list:
    if after is before:
        return before
    shared = after
    if not by_identity:
        same = _equal_instance if before and isinstance(before[0], Instance) else equal
        shared = [old if same(old, new) else new for old, new in zip(before, after, strict=False)]
        shared += after[len(before) :]
    if same_members(before, shared):
        return before
    return after if same_members(after, shared) else shared


def _equal_instance(a: Instance, b: Instance) -> bool:
    """As equal: of thousands, most differ by their matrices if at all."""
    return a is b or (a.matrix.tobytes() == b.matrix.tobytes() and equal(a, b))


def same_members(a: Sequence, b: Sequence) -> bool:
    """Whether two lists hold the very same objects."""
    return len(a) == len(b) and all(map(operator.is_, a, b))


def changed_members(before: Sequence, after: Sequence) -> np.ndarray:
    """(n,) int64, ascending, the places where a list of as many members holds another object than the list before."""
    return np.flatnonzero(np.fromiter(map(operator.is_not, before, after), bool, len(after)))


def share(before: Scene | None, after: Scene, compare_large: bool = False) -> Scene:
    """The scene after a change, with the very objects of the scene before wherever they are equal.

    Meshes and images, which are large, are taken for equal only if they are the same, unless ``compare_large`` says
    that they have been exported anew. When nothing differs the result is the scene before.
    """
    if before is None:
        return after
    values: dict[str, Any] = {}
    for name in LISTS:
        values[name] = _shared_list(getattr(before, name), getattr(after, name), name in _LARGE and not compare_large)
    for name in _MEMBERS:
        old, new = getattr(before, name), getattr(after, name)
        values[name] = old if equal(old, new) else new
    rest = [name for name in field_names(Scene) if name not in values]
    if all(equal(getattr(before, name), getattr(after, name)) for name in rest) and all(
        value is getattr(before, name) for name, value in values.items()
    ):
        return before
    return dataclasses.replace(after, **values)
