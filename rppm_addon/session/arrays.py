# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays that go along with a message: many bytes in shared memory, few in the message itself."""

import base64
from collections.abc import Sequence

import numpy as np

from .protocol import ProtocolError
from .shared_memory import SharedBlock

_ALIGNMENT = 64
_MOST_INLINE = 1 << 15
"""Bytes that the message itself takes: a moved camera needs no shared memory."""


def pack(arrays: Sequence[np.ndarray]) -> tuple[dict, SharedBlock | None]:
    """What the message says of the arrays, and the block that they lie in, if any.

    The block is the caller's to close and to unlink once the receiver has unpacked it, or has died. Raises OSError
    when there is not enough shared memory.
    """
    layout, size = [], 0
    for array in arrays:
        layout.append([array.dtype.str, array.shape, size])
        size += -(-array.nbytes // _ALIGNMENT) * _ALIGNMENT
    block = SharedBlock.create(size) if size > _MOST_INLINE else None
    memory = bytearray(size) if block is None else block.memory
    for array, (_, _, offset) in zip(arrays, layout, strict=True):
        view = np.ndarray(array.shape, array.dtype, memory, offset)
        view[...] = array
    description = {"layout": layout, "size": size}
    if block is None:
        return {**description, "bytes": base64.b64encode(memory).decode()}, None
    return {**description, "block": block.name}, block


def unpack(description: dict) -> list[np.ndarray]:
    """The arrays, as copies of the receiver's own; the block's name is gone afterwards.

    Raises ProtocolError for a description that pack has not made.
    """
    block = None
    try:
        size = description["size"]
        if "block" in description:
            block = SharedBlock.open(description["block"], size)
            block.unlink()
        memory = base64.b64decode(description["bytes"]) if block is None else block.memory
        return [
            np.ndarray(shape, np.dtype(kind), memory, offset).copy() for kind, shape, offset in description["layout"]
        ]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise ProtocolError(f"arrays cannot be read ({error})") from error
    finally:
        if block is not None:
            block.close()
