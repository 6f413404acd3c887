# SPDX-License-Identifier: GPL-3.0-or-later
"""Owen-scrambled points for what an iteration decides for all pixels, as shaders/common/low_discrepancy.glsl has them
for each pixel: Burley, Practical Hash-based Owen Scrambling (JCGT 2020)."""

_MASK = (1 << 32) - 1
_SCRAMBLE = (0x6C50B47C, 0xB82F1E52, 0xC7AFE638, 0x8D22F6E6)


def van_der_corput(index: int, seed: int) -> float:
    """Owen-scrambled van der Corput point ``index`` (from 0) in [0, 1): of 2^k points from a multiple of 2^k on, one
    lies in each 2^k-th. ``seed`` is of 32 bits."""
    return _reversed(_laine_karras(index, seed)) / 2.0**32


def scrambled_sobol(index: int, seeds: tuple[int, int, int]) -> tuple[float, float]:
    """Point ``index`` (from 0) in [0, 1)^2 of a (0, 2)-sequence, Owen-scrambled; sets of other ``seeds``, of 32 bits
    each, are independent shuffles."""
    shuffled = _owen_scramble(index, seeds[0])
    return van_der_corput(shuffled, seeds[1]), van_der_corput(_sobol_second_reversed(shuffled), seeds[2])


def _reversed(bits: int) -> int:
    return int(f"{bits:032b}"[::-1], 2)


def _laine_karras(bits: int, seed: int) -> int:
    bits = (bits + seed) & _MASK
    for factor in _SCRAMBLE:
        bits ^= (bits * factor) & _MASK
    return bits


def _owen_scramble(bits: int, seed: int) -> int:
    return _reversed(_laine_karras(_reversed(bits), seed))


def _sobol_second_reversed(index: int) -> int:
    """Bits of the second Sobol dimension, lowest first: its generator matrix is Pascal's triangle modulo 2."""
    for shift, mask in ((1, 0x55555555), (2, 0x33333333), (4, 0x0F0F0F0F), (8, 0x00FF00FF), (16, 0xFFFF)):
        index ^= (index >> shift) & mask
    return index
