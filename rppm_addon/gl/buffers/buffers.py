# SPDX-License-Identifier: GPL-3.0-or-later
"""Storage buffers that grow with need and are reported by name."""

from dataclasses import dataclass

import moderngl
import numpy as np
from numpy.typing import DTypeLike

from ...scene.errors import DeviceError
from ..context.context import TEXEL_SIZE, Context
from .texel_buffers import allocated_size, release_textures

_RANGE_ITEMS = 256
"""Alignment of a range in items: items of any size then begin where every device lets a block begin."""
SMALLEST = 64
"""Bytes that every buffer has at least."""
REMEDY = "simplify the scene"


def refuse_large_block(
    context: Context, name: str, size: int, remedy: str, limit: int | None = None, item_size: int = 1
) -> None:
    """Raise DeviceError, with the numbers and the remedy, for more bytes than the device allows in one buffer.

    limit: those, where these are not what a storage block may span. item_size: bytes of an item, where the error is to
    say how many have room.
    """
    limit = context.storage_block_limit if limit is None else limit
    if size > limit:
        room = f" ({limit // item_size:,} of {size // item_size:,} items)" if item_size > 1 else ""
        raise DeviceError(
            f"{name} needs {size / 2**20:.0f} MiB but the device {context.information.name} "
            f"allows {limit / 2**20:.0f} MiB{room} in one buffer; {remedy}"
        )


def next_range(item: int) -> int:
    """First item from one on where a range may begin."""
    return -(-item // _RANGE_ITEMS) * _RANGE_ITEMS


@dataclass(frozen=True)
class BufferRange:
    """Some items of a buffer without a header, to be bound as a storage block in place of all."""

    buffer: "GrowingBuffer"
    first: int
    count: int

    @property
    def size(self) -> int:
        """Bytes."""
        return self.buffer.item_size * self.count

    def bind_to_storage_buffer(self, binding: int) -> None:
        """As moderngl.Buffer's."""
        whole = self.first == 0 and self.size == self.buffer.size
        place = {} if whole else {"offset": self.buffer.item_size * self.first, "size": self.size}
        self.buffer.buffer.bind_to_storage_buffer(binding, **place)


class GrowingBuffer:
    """A named storage buffer that is kept between frames and made anew only to grow.

    item_size, header_size: bytes of one of its items, and of what lies before them.
    texel_bytes: where given, it may be larger than the device allows a storage block to be. Then programs to which it
    is an array read and write texels of so many bytes (texel_sources.py), unless they are given a BufferRange at a
    time: 16 where they only read it, 4 where they write single words of its items.
    """

    def __init__(
        self,
        context: Context,
        name: str,
        remedy: str = REMEDY,
        item_size: int = 1,
        header_size: int = 0,
        texel_bytes: int | None = None,
    ) -> None:
        self.name = name
        self.remedy = remedy
        self.item_size, self._header_size = item_size, header_size
        self._texel_bytes = texel_bytes
        self._context = context
        self._buffer: moderngl.Buffer | None = None
        self._size = 0
        self._is_large = False

    @property
    def buffer(self) -> moderngl.Buffer:
        """To be bound; a few bytes while nothing was required."""
        if self._buffer is None:
            self._buffer = self._context.moderngl.buffer(reserve=allocated_size(SMALLEST))
        return self._buffer

    @property
    def size(self) -> int:
        """Bytes; 0 while nothing was required."""
        return self._size

    def ranges(self, count: int, first: int = 0) -> list["BufferRange"]:
        """Split ``count`` items, from a place that next_range gives on, into parts that a storage block holds and that
        begin where one may."""
        most = self._context.storage_block_limit // self.item_size
        if count > most:
            most -= most % _RANGE_ITEMS
        return [BufferRange(self, first + part, min(most, count - part)) for part in range(0, count, most)]

    @property
    def limit(self) -> int:
        """Largest size that the buffer may have, bytes."""
        return self._context.array_limit(self._texel_bytes)

    @property
    def capacity(self) -> int:
        """Items that there is room for."""
        return max(self.size - self._header_size, 0) // self.item_size

    def refuse_items(self, count: int) -> None:
        """Raise DeviceError for more items than the device allows, before there are any."""
        size = self._header_size + self.item_size * count
        refuse_large_block(self._context, self.name, size, self.remedy, self.limit, self.item_size)

    def require_items(self, count: int) -> bool:
        """Make sure of so many items; returns and raises as require does."""
        return self.require(self._header_size + self.item_size * count)

    def extend_items(self, count: int) -> None:
        """Make sure of so many items, as require_items does, and keep what the buffer holds."""
        size = self._header_size + self.item_size * count
        if size <= self.size:
            return
        before, had, was_large = self._buffer, self._size, self._is_large
        self._buffer, self._size, self._is_large = None, 0, False
        try:
            # Some more, lest it grow with every iteration.
            self.require(max(size, min(had + had // 4, self.limit)))
        except DeviceError:
            self.release()
            self._buffer, self._size, self._is_large = before, had, was_large
            raise
        if before is not None:
            self._context.moderngl.copy_buffer(self.buffer, before, had)
            release_textures(self._context, before)
            before.release()
            self._context.large_buffers -= was_large

    def require(self, size: int) -> bool:
        """Make sure of so many bytes; True when the buffer was made anew and its contents are gone.

        Raises DeviceError, with the numbers and the remedy, past the device's limit.
        """
        if size <= self.size:
            return False
        refuse_large_block(self._context, self.name, size, self.remedy, self.limit, self.item_size)
        available = self._context.available_memory
        if available is not None and size > available + self.size:
            raise DeviceError(
                f"{self.name} needs {size / 2**20:.0f} MiB but the device {self._context.information.name} "
                f"has {available / 2**20:.0f} MiB left; {self.remedy}"
            )
        self.release()
        self._context.refuse_lost_memory()  # what else ran out of it is not to be taken for this
        # What lies in a part of a texel could not be read.
        least = -(-size // TEXEL_SIZE) * TEXEL_SIZE if self._texel_bytes else size
        try:
            self._buffer = self._context.moderngl.buffer(reserve=allocated_size(max(least, SMALLEST)))
        except moderngl.Error as error:
            raise self._no_memory(size) from error
        if self._context.lacks_memory:
            self.release()
            raise self._no_memory(size)
        self._size = max(size, SMALLEST)
        self._is_large = size > self._context.whole_limit
        self._context.large_buffers += self._is_large
        return True

    def _no_memory(self, size: int) -> DeviceError:
        return DeviceError(f"{self.name} needs {size / 2**20:.0f} MiB, which the device does not have; {self.remedy}")

    def upload(self, array: np.ndarray | np.void) -> None:
        """Hold a contiguous array's bytes from the buffer's start. Raises DeviceError as require does."""
        data = np.ascontiguousarray(array)
        self.require(data.nbytes)
        self.write(data)

    def write(self, array: np.ndarray, offset: int = 0) -> None:
        """Put a contiguous array's bytes where there is room for them, so many bytes from the buffer's start."""
        if array.nbytes:
            self.buffer.write(array.reshape(-1).view(np.uint8), offset=offset)

    def read(self, dtype: DTypeLike, count: int, offset: int = 0) -> np.ndarray:
        """(count,) array of a dtype from a byte offset on."""
        size = np.dtype(dtype).itemsize * count
        return np.frombuffer(self.buffer.read(size, offset=offset), dtype) if size else np.empty(0, dtype)

    def clear(self) -> None:
        """Zero the whole buffer."""
        self.buffer.clear()

    def release(self) -> None:
        """Free the buffer."""
        if self._buffer is not None:
            release_textures(self._context, self._buffer)
            self._buffer.release()
            self._buffer, self._size = None, 0
            self._context.large_buffers -= self._is_large
            self._is_large = False
