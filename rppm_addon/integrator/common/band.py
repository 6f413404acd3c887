# SPDX-License-Identifier: GPL-3.0-or-later
"""Bands of rows, in which the camera side of an iteration works."""

from dataclasses import dataclass

MAXIMUM_BAND_PIXELS = 1 << 18
"""Pixels of a band: bounds the memory of camera paths and the length of one dispatch."""

MAX_RASTER_PIXELS = 1 << 14
"""Along a side of what every device of OpenGL 4.3 draws into."""


@dataclass(frozen=True)
class Band:
    """Whole rows of a region, row 0 at the bottom."""

    columns: int
    first_row: int
    rows: int

    @property
    def first_pixel(self) -> int:
        """Its place in the region's pixels, row by row."""
        return self.first_row * self.columns

    @property
    def pixel_count(self) -> int:
        """Columns times rows."""
        return self.rows * self.columns


_ROLLING_BANDS = 128
"""Number of bands, at most, whose rows a rolling shutter exposes together."""


def rows_of_bands(width: int, height: int, is_rolling: bool = False) -> int:
    """Return the rows of a band of a width x height region. The last band may have fewer.

    is_rolling: whether a rolling shutter exposes the bands one after the other.
    """
    most = -(-height // _ROLLING_BANDS) if is_rolling else height
    return max(1, min(most, MAXIMUM_BAND_PIXELS // width, MAX_RASTER_PIXELS))


def bands_of(width: int, height: int, is_rolling: bool = False) -> list[Band]:
    """The bands of a width x height region, from below; is_rolling: as for rows_of_bands."""
    rows = rows_of_bands(width, height, is_rolling)
    return [Band(width, first, min(rows, height - first)) for first in range(0, height, rows)]
