# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays that go along with a message: many bytes in shared memory, few in the message itself."""

import base64
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


def pack(arrays: Sequence[np.ndarray]) -> tuple[dict, SharedBlock | None]:
    """What the message says of the arrays, and the block that they lie in, if any.

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

    Raises ProtocolError for a description that pack has not made.
    """
    block = None
    try:
        size = description["size"]
        if "block" in description:
            block = SharedBlock.open(description["block"], size)
        memory = base64.b64decode(description["bytes"]) if block is None else block.memory
        runs = [_run(memory, *layout) for layout in description["layout"]]
        return [run[place, ...] for run in runs for place in range(len(run))]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise ProtocolError(f"arrays cannot be read ({error})") from error
    finally:
        if block is not None:
            block.close()


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


def _run(memory: Any, kind: str, shape: list[int], offset: int) -> np.ndarray:
    """A run of arrays, as the rows of one."""
    dtype = np.dtype(kind)
    if dtype.hasobject:  # bytes are not to be taken for addresses
        raise ValueError(f"an array of {dtype}")
    run: np.ndarray = np.ndarray(shape, dtype, memory, offset)
    if run.nbytes < LARGE:
        return run.copy()
    # Unlike the array above, what frombuffer makes keeps the memory from being closed.
    return np.frombuffer(memory, np.uint8, run.nbytes, offset).view(dtype).reshape(shape)
