# SPDX-License-Identifier: GPL-3.0-or-later
"""Many dataclasses of one type as a document, field by field: what is alike is said once, numbers become arrays."""

import dataclasses
import functools
import operator
import types
import typing
from collections.abc import Callable, Hashable, Sequence

import numpy as np

from .documents import Arrays, decode, encode, field_names

_Keep = Callable[[np.ndarray], int | str]
_NUMBERS = {int: np.int64, float: np.float64}


def encode_columns(members: Sequence[object], kind: type, keep: _Keep) -> dict:
    """Return members of a dataclass ``kind`` as json can write them; ``keep`` as for documents.encode.

    Raises TypeError for a member of another type, or with something in it that no document can hold.
    """
    for other in set(map(type, members)) - {kind}:
        raise TypeError(f"a {other.__name__} is no {kind.__name__}")
    columns = {
        name: _encode_column(list(map(operator.attrgetter(name), members)), hint, keep)
        for name, hint in _hints(kind).items()
    }
    return {"count": len(members), "columns": columns}


def decode_columns(document: dict, kind: type, arrays: Arrays) -> list:
    """The members that encode_columns wrote; those that were alike share their lists and dictionaries.

    Raises KeyError, TypeError or ValueError for another document.
    """
    count = document["count"]
    columns = [_decode_column(document["columns"][name], hint, arrays, count) for name, hint in _hints(kind).items()]
    if any(len(column) != count for column in columns):
        raise ValueError("the columns are not of one length")
    return list(map(kind, *columns)) if columns else []


@functools.cache
def _hints(kind: type) -> dict[str, object]:
    hints = typing.get_type_hints(kind)
    return {name: hints[name] for name in field_names(kind)}


@functools.cache
def _optional(hint: object) -> type | None:
    """The dataclass of which a field holds one or None."""
    if typing.get_origin(hint) not in {typing.Union, types.UnionType}:
        return None
    inner, *others = typing.get_args(hint)
    is_record = isinstance(inner, type) and dataclasses.is_dataclass(inner)
    return inner if others == [type(None)] and is_record else None


def _encode_column(values: list, hint: object, keep: _Keep) -> dict:
    inner = _optional(hint)
    if inner is not None:
        there = [value for value in values if value is not None]
        present = np.array([value is not None for value in values])
        return {"present": keep(present), "of": encode_columns(there, inner, keep)} if there else {"none": True}
    array = _as_array(values, hint)
    if array is not None:
        return {"rows": keep(array)}
    keys = _keys(values, hint)
    places = {key: place for place, key in enumerate(dict.fromkeys(keys))}
    which = np.array([places[key] for key in keys], np.int32)
    distinct = dict(zip(reversed(keys), reversed(values), strict=True))
    return {"which": keep(which), "distinct": [encode(distinct[key], keep) for key in places]}


def _as_array(values: list, hint: object) -> np.ndarray | None:
    """One row a value; None where these are no numbers, or of several lengths."""
    if hint is np.ndarray:
        first = values[0] if values else np.zeros(0)
        alike = all(value.dtype == first.dtype and value.shape == first.shape for value in values)
        return np.array(values) if alike else None
    if hint in _NUMBERS:
        return np.array(values, _NUMBERS[hint])
    if typing.get_origin(hint) is tuple and set(typing.get_args(hint)) <= {float}:
        return np.array(values, np.float64) if len({len(value) for value in values}) == 1 else None
    return None


def _keys(values: list, hint: object) -> Sequence[Hashable]:
    """Return keys that distinguish values of a field; numbers in containers by their text, for -0.0 equals 0.0."""
    if hint is np.ndarray:
        return list(map(id, values))
    if typing.get_origin(hint) in {list, dict, tuple}:
        return [repr(value) if value else None for value in values]
    return values


def _decode_column(document: dict, hint: object, arrays: Arrays, count: int) -> list:
    inner = _optional(hint)
    if inner is not None:
        if "none" in document:
            return [None] * count
        there = iter(decode_columns(document["of"], inner, arrays))
        return [next(there) if present else None for present in arrays[document["present"]].tolist()]
    if "rows" in document:
        rows = arrays[document["rows"]]
        if hint is np.ndarray:
            return list(rows)
        return list(map(tuple, rows.tolist())) if rows.ndim > 1 else rows.tolist()
    distinct = [decode(value, hint, arrays) for value in document["distinct"]]
    return [distinct[index] for index in arrays[document["which"]].tolist()]
