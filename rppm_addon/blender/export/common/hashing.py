# SPDX-License-Identifier: GPL-3.0-or-later
"""Random numbers that Cycles makes of whole numbers."""

import functools

import numpy as np

_MIXED = ((2, 1, 14), (0, 2, 11), (1, 0, 25), (2, 1, 16), (0, 2, 4), (1, 0, 14), (2, 1, 24))
"""Which of three numbers is mixed with which, turned by how many bits."""


@functools.lru_cache(1 << 16)
def hashed(number: int) -> float:
    """From 0 to 1, the last mix of Bob Jenkins' lookup3 of a number and 0."""
    values = [(0xDEADBEEF + (2 << 2) + 13) & 0xFFFFFFFF] * 3
    values[0] = (values[0] + number) & 0xFFFFFFFF
    for first, second, bits in _MIXED:
        rotated = ((values[second] << bits) | (values[second] >> (32 - bits))) & 0xFFFFFFFF
        values[first] = ((values[first] ^ values[second]) - rotated) & 0xFFFFFFFF
    return values[2] / 0xFFFFFFFF


def hashed_numbers(numbers: np.ndarray) -> np.ndarray:
    """(n,) float64, what hashed() gives of each of (n,) whole numbers from 0 on."""
    start = np.uint32((0xDEADBEEF + (2 << 2) + 13) & 0xFFFFFFFF)
    values = [start + numbers.astype(np.uint32), np.full(len(numbers), start), np.full(len(numbers), start)]
    for first, second, bits in _MIXED:
        rotated = (values[second] << np.uint32(bits)) | (values[second] >> np.uint32(32 - bits))
        values[first] = (values[first] ^ values[second]) - rotated
    return values[2] / np.float64(0xFFFFFFFF)


def hashed_up_to(count: int) -> np.ndarray:
    """(count,) float32, what hashed() gives of 0, 1, 2 ..."""
    return hashed_numbers(np.arange(count)).astype(np.float32)
