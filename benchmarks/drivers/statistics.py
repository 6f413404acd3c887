# SPDX-License-Identifier: GPL-3.0-or-later
"""Statistics that drivers print about the code that they have made of a program."""

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Statistics:
    """Statistics of a program, that is of the worst of its stages."""

    registers: int
    """Registers of a thread; 0 where the driver does not tell."""
    spills: int
    """Registers kept in memory, or, where the driver counts these, the reads and writes of such."""
    waves: int
    """Waves that a processor of the device has room for at a time; of Intel, how many of our threads make one."""


def worst(stages: Iterable[Statistics]) -> Statistics | None:
    """Return the worst statistics of the stages of a program; None where there are no stages."""
    found = list(stages)
    if not found:
        return None
    return Statistics(
        max(stage.registers for stage in found),
        max(stage.spills for stage in found),
        min(stage.waves for stage in found),
    )


def _reader(pattern: str, convert: Callable[..., Statistics]) -> Callable[[str], list[Statistics]]:
    compiled = re.compile(pattern)
    return lambda text: [convert(*map(int, match.groups())) for match in compiled.finditer(text)]


def _maxwell(local: int, registers: int) -> Statistics:
    """Return statistics for 65,536 registers of a multiprocessor, taken 256 at a time, for 64 warps of 32 at most."""
    return Statistics(registers, local // 4, min(64, 65536 // (-(-32 * registers // 256) * 256)))


radeonsi = _reader(
    r"VGPRS: (\d+) .*?Max Waves: (\d+) Spilled SGPRs: (\d+) Spilled VGPRs: (\d+)",
    lambda registers, waves, scalars, vectors: Statistics(registers, scalars + vectors, waves),
)
nouveau = _reader(r"local: (\d+), shared: \d+, gpr: (\d+)", _maxwell)
iris = _reader(
    r"SIMD(\d+) shader: .*?(\d+):(\d+) spills:fills",
    lambda width, spills, fills: Statistics(0, spills + fills, width),
)
asahi = _reader(
    r"(\d+) gprs, .*?(\d+) threads, .*?(\d+):(\d+) spills:fills",
    lambda registers, threads, spills, fills: Statistics(registers, spills + fills, threads),
)
