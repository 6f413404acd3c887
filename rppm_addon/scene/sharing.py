# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that follow each other share what is equal, so that it is known by identity what has changed."""

import dataclasses

import numpy as np

from .scene import Scene

_LISTS = ("meshes", "instances", "materials", "lights", "images")
_MEMBERS = ("camera", "world", "settings")


def equal(a: object, b: object) -> bool:
    """Whether two members of scenes say the same, arrays bit for bit."""
    if a is b:
        return True
    if type(a) is not type(b):
        return False
    if isinstance(a, np.ndarray):
        return a.dtype == b.dtype and np.array_equal(a, b)
    if dataclasses.is_dataclass(a):
        return all(equal(getattr(a, f.name), getattr(b, f.name)) for f in dataclasses.fields(a))
    if isinstance(a, list | tuple):
        return len(a) == len(b) and all(map(equal, a, b))
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(equal(value, b[key]) for key, value in a.items())
    return a == b


def share(before: Scene | None, after: Scene) -> Scene:
    """The scene after a change, with the very objects of the scene before wherever they are equal.

    Meshes and images, which are large, are taken for equal only if they are the same. When nothing differs the
    result is the scene before.
    """
    if before is None:
        return after
    values: dict[str, object] = {}
    for name in _LISTS:
        old, new = getattr(before, name), getattr(after, name)
        if name not in {"meshes", "images"}:
            new = [a if i < len(old) and equal(a := old[i], b) else b for i, b in enumerate(new)]
        same = len(old) == len(new) and all(a is b for a, b in zip(old, new, strict=True))
        values[name] = old if same else new
    for name in _MEMBERS:
        old, new = getattr(before, name), getattr(after, name)
        values[name] = old if equal(old, new) else new
    rest = ("exposure", "cubemap_centre", "warnings")
    if all(equal(getattr(before, name), getattr(after, name)) for name in rest) and all(
        value is getattr(before, name) for name, value in values.items()
    ):
        return before
    return dataclasses.replace(after, **values)
