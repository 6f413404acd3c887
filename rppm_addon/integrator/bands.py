# SPDX-License-Identifier: GPL-3.0-or-later
"""Bands of rows, in which the camera side of an iteration works."""

MAXIMUM_BAND_PIXELS = 1 << 18
"""Pixels of a band: bounds the memory of camera paths and the length of one dispatch."""


def bands_of(width: int, height: int) -> list[tuple[int, int]]:
    """First row and rows of each band of a width x height region."""
    rows = max(1, min(height, MAXIMUM_BAND_PIXELS // width))
    return [(first, min(rows, height - first)) for first in range(0, height, rows)]
