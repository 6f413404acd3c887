# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays that go along with a message: many bytes in shared memory, few in the message itself."""

import base64
import math
import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from .protocol import ProtocolError
from .shared_memory import SharedBlock

_ALIGNMENT = 64
_SMALL = 1 << 10
LARGE = 1 << 20
"""Bytes from which on an array is not copied more often than it must be."""
_MOST_INLINE = 1 << 15
"""Bytes that the message itself takes: a moved camera needs no shared memory."""
_NUMBERS = re.compile(r"[<>|][biuf][1248]")
"""Types of arrays: numbers without any that would be taken for addresses."""
_MOST_ARRAYS = 1 << 20
_MOST_AXES = 8
"""Limits on the arrays of a message and on the axes of an array, which no scene comes near.
Without them a message could hold any number of arrays without bytes."""


def pack(arrays: Sequence[np.ndarray]) -> tuple[dict, SharedBlock | None]:
    """Return the message's description of the arrays, and the block that they lie in, if any.

    The block is the caller's to close once the receiver has unpacked it, or has died. Raises OSError when there is
    not enough shared memory.
    """
    layout, size, runs = [], 0, _runs(arrays)
    for run in runs:
        layout.append([run[0].dtype.str, (len(run), *run[0].shape), size])
        size += -(-len(run) * run[0].nbytes // _ALIGNMENT) * _ALIGNMENT
    block = SharedBlock.create(size) if size > _MOST_INLINE else None
    memory = bytearray(size) if block is None else block.memory
    for run, (_, shape, offset) in zip(runs, layout, strict=True):
        if block is not None and run[0].nbytes >= LARGE:
            block.write(offset, np.ascontiguousarray(run[0]))
        else:
            np.stack(run, out=np.ndarray(shape, run[0].dtype, memory, offset))
    description = {"layout": layout, "size": size}
    if block is None:
        return {**description, "bytes": base64.b64encode(memory).decode()}, None
    return {**description, "block": block.name}, block


def unpack(description: dict) -> list[np.ndarray]:
    """The arrays, as copies of the receiver's own, but for LARGE ones: these stay in the block's memory.

    Whatever the other process says is checked before memory is read. Raises ProtocolError for a description that pack
    has not made.
    """
    block = None
    try:
        size = natural(description["size"], "a size")
        runs = _checked(description["layout"], size)
        if sum(shape[0] for _, shape, _ in runs) > _MOST_ARRAYS:
            raise ProtocolError(f"more than {_MOST_ARRAYS} arrays came in one message")
        if "block" in description:
            block = SharedBlock.open(description["block"], size)
            memory: Any = block.memory
        else:
            memory = base64.b64decode(description["bytes"], validate=True)
            if len(memory) != size:
                raise ProtocolError(f"{len(memory)} bytes came in place of {size}")
        return [row for run in runs for row in _rows(memory, *run)]
    except (OSError, ValueError, KeyError, TypeError, OverflowError) as error:
        raise ProtocolError(f"arrays cannot be read ({error})") from error
    finally:
        if block is not None:
            block.close()


def natural(value: object, what: str) -> int:
    """A number of the other process that must be an integer from 0 on. Raises ProtocolError."""
    if type(value) is not int or value < 0:
        raise ProtocolError(f"{value!r} cannot be {what}")
    return value


def _checked(layout: Any, size: int) -> list[tuple[np.dtype, tuple[int, ...], int]]:
    """Type, shape and offset of runs that lie one behind the other in so many bytes. Raises ProtocolError."""
    runs, end = [], 0
    for kind, shape, offset in layout:
        if not isinstance(kind, str) or _NUMBERS.fullmatch(kind) is None:
            raise ProtocolError(f"an array of {kind!r}")
        if not isinstance(shape, list | tuple) or not 1 <= len(shape) <= _MOST_AXES:
            raise ProtocolError(f"an array of the shape {shape!r}")
        lengths = tuple(natural(length, "a length") for length in shape)
        dtype, start = np.dtype(kind), natural(offset, "an offset")
        if start < end:  # else a few bytes would stand for any number of arrays
            raise ProtocolError(f"an array begins at byte {start}, amid another")
        end = start + math.prod(lengths) * dtype.itemsize
        if end > size:
            raise ProtocolError(f"an array ends at byte {end} of {size}")
        runs.append((dtype, lengths, start))
    return runs


def _runs(arrays: Sequence[np.ndarray]) -> list[list[np.ndarray]]:
    """The arrays in their order, those together that are small and alike: the matrices of thousands of instances."""
    runs: list[list[np.ndarray]] = []
    for array in arrays:
        last = runs[-1][-1] if runs else None
        if last is not None and array.nbytes <= _SMALL and (array.shape, array.dtype) == (last.shape, last.dtype):
            runs[-1].append(array)
        else:
            runs.append([array])
    return runs


def _rows(memory: Any, dtype: np.dtype, shape: tuple[int, ...], offset: int) -> list[np.ndarray]:
    """The arrays of a run, which are the rows of one; where it lies was checked."""
    count = math.prod(shape)
    if count == 0:  # numpy finds nothing in nothing
        run = np.empty(shape, dtype)
    else:
        # Unlike an ndarray of the memory, what frombuffer makes keeps it from being closed.
        run = np.frombuffer(memory, dtype, count, offset).reshape(shape)
        if run.nbytes < LARGE:
            run = run.copy()
    return [run[place, ...] for place in range(len(run))]
