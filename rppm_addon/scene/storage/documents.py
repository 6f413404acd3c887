# SPDX-License-Identifier: GPL-3.0-or-later
"""Dataclasses as JSON documents, their arrays kept apart: what files and pipes carry of a scene."""

import dataclasses
import enum
import functools
import typing
from collections.abc import Callable

import numpy as np

from ..node_graphs import Link

_PLAIN = (type(None), bool, int, float, str)


class Arrays(typing.Protocol):
    """Arrays by the references that stand for them in a document."""

    def __getitem__(self, reference: typing.Any, /) -> np.ndarray:
        """The array of a reference."""


def encode(value: object, keep: Callable[[np.ndarray], int | str]) -> object:
    """Return a dataclass or a part of one as json can write it; ``keep`` takes an array and returns its reference."""
    kind: typing.Any = type(value)
    if kind in _PLAIN:
        return value
    if isinstance(value, np.ndarray):
        return {"array": keep(value)}
    if isinstance(value, enum.Flag):
        return value.value  # combinations have no name
    if isinstance(value, enum.Enum):
        return value.name
    if dataclasses.is_dataclass(value):
        return {name: encode(getattr(value, name), keep) for name in field_names(kind)}
    if isinstance(value, list | tuple):
        return [encode(item, keep) for item in value]
    if isinstance(value, dict):
        return {name: encode(item, keep) for name, item in value.items()}
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"a {kind.__name__} cannot be written to a document")


def decode(document: object, kind: object, arrays: Arrays) -> typing.Any:
    """The value of type ``kind`` that encode wrote. Raises KeyError, TypeError or ValueError for another document."""
    reader = _reader(kind)
    return document if reader is None else reader(document, arrays)


@functools.cache
def field_names(kind: type) -> tuple[str, ...]:
    """The names of a dataclass's fields."""
    return tuple(field.name for field in dataclasses.fields(kind))


_Reader = Callable[[typing.Any, Arrays], object]


@functools.cache
def _reader(kind: typing.Any) -> _Reader | None:
    """How values of a type are read; None where the document has them as they are."""
    if kind in _PLAIN or kind is typing.Any:
        return None
    if kind is object:
        return _read_node_value
    if kind is np.ndarray:
        return lambda value, arrays: arrays[value["array"]]
    origin, inner = typing.get_origin(kind), typing.get_args(kind)
    if origin is tuple:
        return lambda value, _: tuple(_checked(value, list))
    if origin in (list, dict):
        return _list_reader(_reader(inner[0])) if origin is list else _dict_reader(_reader(inner[1]))
    if origin is not None:  # optional: the first alternative
        read = _reader(inner[0])
        return None if read is None else lambda value, arrays: None if value is None else read(value, arrays)
    if issubclass(kind, enum.Enum):
        return lambda value, _: kind(value) if issubclass(kind, enum.Flag) else kind[value]
    return _dataclass_reader(kind)


def _list_reader(read: _Reader | None) -> _Reader:
    return lambda value, arrays: (
        list(_checked(value, list)) if read is None else [read(item, arrays) for item in _checked(value, list)]
    )


def _dict_reader(read: _Reader | None) -> _Reader:
    return lambda value, arrays: (
        dict(_checked(value, dict)) if read is None else {name: read(item, arrays) for name, item in value.items()}
    )


def _checked(value: typing.Any, kind: type) -> typing.Any:
    """A value that must be a list or a dictionary: Python would take a text for a list of its letters."""
    if type(value) is not kind:
        raise TypeError(f"a {type(value).__name__} is no {kind.__name__}")
    return value


def _dataclass_reader(kind: type) -> _Reader:
    hints = typing.get_type_hints(kind)
    readers = {name: _reader(hints[name]) for name in field_names(kind)}

    def read(value: dict, arrays: Arrays) -> object:
        return kind(
            **{
                name: item if (reader := readers[name]) is None else reader(item, arrays)
                for name, item in value.items()
            }
        )

    return read


def _read_node_value(value: object, arrays: Arrays) -> object:
    """An input or option of a shader node."""
    if isinstance(value, dict):
        return arrays[value["array"]] if value.keys() == {"array"} else decode(value, Link, arrays)
    return tuple(value) if isinstance(value, list) else value
