# SPDX-License-Identifier: GPL-3.0-or-later
"""The table through which a simulated sky is seen, laid out as that of Cycles.

Cycles simulates 512 x 256 directions and interpolates between them. Half a row at the horizon, where a sky changes
within a degree, shows; so the rows lie where those of Cycles lie. Row by row the elevation is that of a square
root, which puts most rows at the horizon; columns are azimuths, and one half of the table mirrors the other.
"""

import numpy as np

COLUMNS = 512
ROWS = 256


def row_elevations(offset: float) -> np.ndarray:
    """(ROWS,) float64 elevations in radians of the rows' directions, the lowest row first.

    offset: where in its row the direction lies; rows are looked up at 0.5.
    """
    fraction = (np.arange(ROWS) + offset) / (ROWS // 2) - 1.0
    return np.sign(fraction) * fraction**2 * np.pi / 2


def azimuths_from_sun(offset: float) -> np.ndarray:
    """(COLUMNS / 2,) float64 angles in radians between the columns' azimuths and the sun's, from -pi to 0."""
    return (np.arange(COLUMNS // 2) + offset) / COLUMNS * 2.0 * np.pi - np.pi


def mirrored(half: np.ndarray) -> np.ndarray:
    """(ROWS, COLUMNS / 2, 3) to (ROWS, COLUMNS, 3): the sky beyond the sun's meridian."""
    return np.concatenate([half, half[:, ::-1]], axis=1)


def look_up(table: np.ndarray, directions: np.ndarray, sun_rotation: float) -> np.ndarray:
    """(n, 3) float32 bilinear values of a table (ROWS, COLUMNS, 3) in unit directions (n, 3), z up.

    sun_rotation: the sun's azimuth from +Y toward +X, radians.
    """
    directions = np.asarray(directions, np.float64)
    horizontal = np.hypot(directions[:, 0], directions[:, 1])
    elevation = np.arctan2(directions[:, 2], horizontal)
    azimuth = np.arctan2(directions[:, 0], directions[:, 1]) - sun_rotation
    x = (azimuth / (2.0 * np.pi) + 0.5) * COLUMNS - 0.5
    fraction = elevation / (np.pi / 2)
    y = (0.5 + 0.5 * np.sign(fraction) * np.sqrt(np.abs(fraction))) * ROWS - 0.5
    column, row = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    u, v = (x - column)[:, None].astype(np.float32), (y - row)[:, None].astype(np.float32)
    columns = np.mod(column, COLUMNS), np.mod(column + 1, COLUMNS)
    rows = np.clip(row, 0, ROWS - 1), np.clip(row + 1, 0, ROWS - 1)
    below, above = ((1 - u) * table[r, columns[0]] + u * table[r, columns[1]] for r in rows)
    return (1 - v) * below + v * above
