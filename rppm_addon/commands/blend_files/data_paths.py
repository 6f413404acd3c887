# SPDX-License-Identifier: GPL-3.0-or-later
"""PATH=VALUE of --set: finds and sets a value of a .blend file without evaluating code.

A path is what Blender's "Copy Full Data Path" shows after ``bpy.data.`` or after the scene:
``render.film_transparent``, ``objects["Light"].data.energy``, ``objects["Light"].location[2]``.
"""

import re
from collections.abc import Sequence
from typing import Any

from ...scene.errors import SettingsError

_QUOTED = r'"(?:[^"\\]|\\.)*"'
_ASSIGNMENT = re.compile(rf"((?:{_QUOTED}|[^\"=])+)=(.*)", re.DOTALL)
_NAME = r"(?:^|\.)(?P<name>[A-Za-z_]\w*)(?:\[(?P<index>\d+)\])?"
_LAST_STEP = re.compile(rf"(?P<owner>.*?)(?:{_NAME}|\[(?P<key>{_QUOTED})\])")
_TRUE, _FALSE = ("true", "yes", "on", "1"), ("false", "no", "off", "0")


def split_assignment(text: str) -> tuple[str, str]:
    """PATH and VALUE of ``PATH=VALUE``; quotes in the path may hold ``=``. Raises SettingsError."""
    match = _ASSIGNMENT.fullmatch(text)
    if match is None:
        raise SettingsError(f"--set {text}: write it as path=value")
    return match.group(1).strip(), match.group(2).strip()


def set_data_path(roots: Sequence, path: str, value: str) -> None:
    """Set what ``path`` names below the first of ``roots`` (RNA structs) that has it.

    The text is read as the property's own type wants it: true or false, a number, an item's name,
    several numbers with commas, or, for a pointer, the path of a datablock.

    Raises SettingsError when the path names nothing or the value does not fit.
    """
    step = _LAST_STEP.fullmatch(path)
    if step is None:
        raise SettingsError(f"--set {path}: that is no data path; it looks like render.film_transparent")
    owner = _owner(roots, path, step["owner"], step["name"])
    if step["key"] is not None:
        _set_custom_property(owner, path, step["key"][1:-1].replace('\\"', '"'), value)
        return
    name = step["name"]
    prop = owner.bl_rna.properties[name]
    if prop.is_readonly or prop.type == "COLLECTION":
        raise SettingsError(f"--set {path}: it cannot be changed")
    length = getattr(prop, "array_length", 0)
    try:
        if step["index"] is not None:
            index = int(step["index"])
            if index >= length:
                raise SettingsError(f"--set {path}: it has {length} elements")
            getattr(owner, name)[index] = _scalar(prop, path, value)
        elif length and getattr(prop, "is_array", True):
            items = [item.strip() for item in value.strip("()[] ").split(",")]
            if len(items) != length:
                raise SettingsError(f"--set {path}: it takes {length} values with commas between, not {value!r}")
            setattr(owner, name, [_scalar(prop, path, item) for item in items])
        elif prop.type == "POINTER":
            setattr(owner, name, _datablock(roots, path, value))
        elif prop.type == "ENUM" and prop.is_enum_flag:
            setattr(owner, name, {item.strip() for item in value.strip("{} ").split(",") if item.strip()})
        else:
            setattr(owner, name, _scalar(prop, path, value))
    except (TypeError, ValueError, AttributeError) as error:
        raise SettingsError(f"--set {path}={value}: {' '.join(str(error).split())}") from error


def _owner(roots: Sequence, path: str, owner_path: str, name: str | None) -> Any:
    """The struct that holds the last step of the path."""
    for root in roots:
        owner = root
        if owner_path:
            try:
                owner = root.path_resolve(owner_path)
            except ValueError:
                continue
        properties = getattr(getattr(owner, "bl_rna", None), "properties", None)
        if properties is not None and (name is None or name in properties):
            return owner
    raise SettingsError(f"--set {path}: the file has nothing of that name")


def _set_custom_property(owner: Any, path: str, key: str, value: str) -> None:
    if not hasattr(owner, "keys") or key not in owner.keys():  # noqa: SIM118 (an RNA struct is no mapping)
        raise SettingsError(f"--set {path}: the file has no custom property of that name")
    kind = type(owner[key])
    if kind not in (bool, int, float, str):
        raise SettingsError(f"--set {path}: only custom properties of one value can be changed")
    try:
        owner[key] = _boolean(path, value) if kind is bool else kind(value)
    except ValueError as error:
        raise SettingsError(f"--set {path}: {value!r} is no {kind.__name__}") from error


def _scalar(prop: Any, path: str, value: str) -> bool | int | float | str:
    """One value of the property's type, checked against its hard limits."""
    if prop.type == "BOOLEAN":
        return _boolean(path, value)
    if prop.type in ("INT", "FLOAT"):
        try:
            number = int(value) if prop.type == "INT" else float(value)
        except ValueError as error:
            kind = "whole number" if prop.type == "INT" else "number"
            raise SettingsError(f"--set {path}: {value!r} is no {kind}") from error
        if not prop.hard_min <= number <= prop.hard_max:  # Blender would clamp without a word; NaN fails too
            raise SettingsError(f"--set {path}: {value} is not within {prop.hard_min:g} to {prop.hard_max:g}")
        return number
    if prop.type == "STRING" and len(value) >= 2 and value[0] == value[-1] == '"':
        return value[1:-1]
    return value


def _boolean(path: str, value: str) -> bool:
    if value.lower() not in _TRUE + _FALSE:
        raise SettingsError(f"--set {path}: {value!r} is neither true nor false")
    return value.lower() in _TRUE


def _datablock(roots: Sequence, path: str, value: str) -> Any:
    """Return the data-block that a path such as ``objects["Camera.001"]`` names; None for the word None."""
    if value == "None":
        return None
    for root in roots:
        try:
            return root.path_resolve(value)
        except ValueError:
            continue
    raise SettingsError(f'--set {path}: {value} names nothing in the file; write it like objects["Camera"]')
