# SPDX-License-Identifier: GPL-3.0-or-later
"""Buffers of a film's pixels, in parts of whole bands: some drivers allow no more than 128 MiB in one buffer."""

from bisect import bisect_right
from collections.abc import Callable, Sequence

import moderngl
import numpy as np
from numpy.typing import DTypeLike

from ...gl.buffer_sets import BufferList, Declared, StorageBuffer
from ...gl.buffers.buffers import GrowingBuffer, refuse_large_block
from ...gl.buffers.records import Record, stride
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from .band import Band
from .stage_sizes import StageSizes, band_pixels

BANDS_TOGETHER = 16
"""Parts that are no single bands have a multiple of so many: then blocks of so many rows lie in one part each."""
_BYTES_TOGETHER = 16
"""Most bytes of a pixel in a part of several bands. It stands for the real size, so that such parts are equally long
whatever their pixels hold."""


class FilmParts(BufferList):
    """The parts from below, each of all columns."""

    def __init__(self, parts: Sequence[GrowingBuffer], bands: Sequence[Sequence[Band]]) -> None:
        """bands: of each part."""
        super().__init__(parts)
        self._first_rows = [part[0].first_row for part in bands]
        self._columns = bands[0][0].columns
        self._end_rows = [part[-1].first_row + part[-1].rows for part in bands]

    @property
    def height(self) -> int:
        """Rows of all parts together."""
        return self._end_rows[-1]

    @property
    def rows(self) -> list[int]:
        """Number of rows of each part."""
        return [end - first for first, end in zip(self._first_rows, self._end_rows, strict=True)]

    @property
    def whole(self) -> moderngl.Buffer | None:
        """The only part; None where there are more."""
        return self[0].buffer if len(self) == 1 else None

    def of(self, band: Band) -> moderngl.Buffer:
        """The part that a band is in."""
        return self[self._number(band)].buffer

    def first_pixel(self, band: Band) -> int:
        """Its place in that part, in pixels."""
        return (band.first_row - self._first_rows[self._number(band)]) * self._columns

    def _number(self, band: Band) -> int:
        return bisect_right(self._first_rows, band.first_row) - 1

    def read(self, dtype: DTypeLike, values: int) -> np.ndarray:
        """(height, width, values) array of a dtype, row 0 at the bottom."""
        found = np.empty((self.height, self._columns, values), dtype)
        for part, first, end in zip(self, self._first_rows, self._end_rows, strict=True):
            rows = found[first:end]
            rows.reshape(-1)[:] = part.read(dtype, rows.size)
        return found

    def upload(self, array: np.ndarray) -> None:
        """Take what ``read`` gave. Raises DeviceError as GrowingBuffer.require does."""
        for part, first, end in zip(self, self._first_rows, self._end_rows, strict=True):
            part.upload(array[first:end])

    def clear(self) -> None:
        """Zero all of it."""
        for part in self:
            part.clear()


class FilmBuffer(Declared[FilmParts]):
    """``item`` as often as ``per_pixel`` says, for each pixel of a film; where that is 0 there is none.

    Each band has a part of its own; ``together``: as many bands lie in one part as the device allows, for what looks
    at pixels around.
    """

    def __init__(
        self, name: str, item: Record | str, per_pixel: Callable[[StageSizes], int] | int = 1, together: bool = False
    ) -> None:
        self._name, self._item, self._per_pixel, self._together = name, item, per_pixel, together

    def make(self, context: Context, library: ProgramLibrary, sizes: object, remedy: str) -> FilmParts:
        """Declared.make."""
        assert isinstance(sizes, StageSizes)
        bands = self._bands_of_parts(sizes, context.storage_block_limit)
        buffers = [
            StorageBuffer(self._name, self._item, self._items(sizes, part)).make(context, library, sizes, remedy)
            for part in bands
        ]
        return FilmParts(buffers, bands)

    def make_empty(self, context: Context, library: ProgramLibrary, sizes: object, remedy: str) -> FilmParts:
        """Declared.make_empty."""
        return FilmBuffer(self._name, self._item, 0).make(context, library, sizes, remedy)

    def expected_bytes(self, sizes: object) -> dict[str, int]:
        """Declared.expected_bytes."""
        assert isinstance(sizes, StageSizes)
        return StorageBuffer(self._name, self._item, self._items(sizes, sizes.bands)).expected_bytes(sizes)

    def refuse_large(self, context: Context, sizes: object, remedy: str) -> None:
        """Declared.refuse_large."""
        assert isinstance(sizes, StageSizes)
        largest = self._bands_of_parts(sizes, context.storage_block_limit)[0]
        refuse_large_block(context, self._name, stride(self._item) * self._items(sizes, largest), remedy)

    def _items(self, sizes: StageSizes, bands: Sequence[Band]) -> int:
        per_pixel = self._per_pixel(sizes) if callable(self._per_pixel) else self._per_pixel
        return per_pixel * sum(band.pixel_count for band in bands)

    def _bands_of_parts(self, sizes: StageSizes, limit: int) -> list[list[Band]]:
        bands, together = sizes.bands, 1
        if self._together:
            together = limit // (_BYTES_TOGETHER * band_pixels(sizes))
            if together < len(bands):
                together = max(together // BANDS_TOGETHER, 1) * BANDS_TOGETHER
        return [bands[first : first + together] for first in range(0, len(bands), together)]
