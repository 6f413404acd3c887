# SPDX-License-Identifier: GPL-3.0-or-later
"""From what programs ask of memory to what they are bound to cost on a device."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field

import numpy as np

from .recorder import Asked


@dataclass(frozen=True)
class Gpu:
    """Properties of a device, as its maker states them."""

    name: str
    part_of_name: str
    """By which OpenGL's name of the device tells it."""
    bytes_per_second: float
    clock: float
    """Hz."""
    processors: int
    waves: int
    """Waves that a processor has room for."""
    width: int
    """Threads of a wave."""
    driver: str
    """Driver of benchmarks/drivers whose compiler stands for the device's."""


RTX_2080_TI = Gpu("GeForce RTX 2080 Ti", "RTX 2080 Ti", 616e9, 1.545e9, 68, 32, 32, "gm204 nouveau")
IRIS_XE = Gpu("Iris Xe, 96 units, LPDDR4X-4267", "Iris(R) Xe", 68e9, 1.35e9, 96, 7, 8, "tgl iris")
GPUS = (RTX_2080_TI, IRIS_XE)
LATENCY = 0.3e-6
"""Seconds that a load waits for memory, about; in caches it is a third of that."""


@dataclass
class Line:
    """A quantity by the number of pixels: what it is at none, and what a pixel adds."""

    base: float = 0.0
    slope: float = 0.0

    def at(self, pixels: float) -> float:
        return self.base + self.slope * pixels

    @classmethod
    def through(cls, pixels: Sequence[int], values: Sequence[float]) -> "Line":
        """Least squares, without negative parts."""
        slope, base = np.polyfit(pixels, values, 1) if len(set(values)) > 1 else (0.0, values[0])
        if base < 0.0 or slope < 0.0:
            slope = max(0.0, float(np.dot(pixels, values) / np.dot(pixels, pixels))) if slope > 0.0 else 0.0
            base = 0.0 if slope > 0.0 else float(np.mean(values))
        return cls(float(base), float(slope))


@dataclass
class Demand:
    """Demand of one program in an iteration, by the number of pixels; there are four pixels to a photon."""

    runs: float
    threads: Line = field(default_factory=Line)
    loads: Line = field(default_factory=Line)
    asked: Line = field(default_factory=Line)
    """Bytes that its source reads and writes."""
    least: Line = field(default_factory=Line)
    """Bytes with caches that lose nothing: no block is read or written more than once as a whole."""
    atomics: Line = field(default_factory=Line)
    """Atomics of items of arrays."""
    counters: Line = field(default_factory=Line)
    """Atomics of single words, which wait for each other."""

    def seconds(self, gpu: Gpu, pixels: int) -> float:
        """The floor: memory at full speed, and an atomic of a word a clock where a wave makes one of its threads'."""
        counters = self.counters.at(pixels) / gpu.width
        return max(self.least.at(pixels) / gpu.bytes_per_second, counters / gpu.clock)

    def waiting_seconds(self, gpu: Gpu, pixels: int, waves: float, width: int) -> float:
        """The same, and loads and atomics of a word as long as each thread's take one after the other."""
        together = gpu.processors * waves * width
        loads, counters = self.loads.at(pixels) * LATENCY / together, self.counters.at(pixels) / gpu.clock
        return self.seconds(gpu, pixels) + loads + counters

    @classmethod
    def of(cls, values: Mapping) -> "Demand":
        """From what asdict made of it."""
        lines = {name: Line(**value) for name, value in values.items() if name != "runs"}
        return cls(values["runs"], **lines)

    def as_dict(self) -> dict:
        return asdict(self)


def demands(pixels: Sequence[int], found: Sequence[Mapping[str, Asked]], iterations: int) -> dict[str, Demand]:
    """By program, from what was asked at several numbers of pixels."""
    made = {}
    for name in dict.fromkeys(name for at in found for name in at):
        rows = [_totals(at.get(name, Asked())) for at in found]
        lines = {
            key: Line.through(pixels, [row[key] / iterations for row in rows])
            for key in ("threads", "loads", "asked", "least", "atomics", "counters")
        }
        made[name] = Demand(max(at[name].runs for at in found if name in at) / iterations, **lines)
    return made


def _totals(asked: Asked) -> dict[str, float]:
    totals = dict.fromkeys(("threads", "loads", "asked", "least", "atomics", "counters"), 0.0)
    totals["threads"] = asked.invocations
    moved: dict[tuple[str, str], int] = {}
    for site, count in asked.asked.items():
        size = site.size * count
        totals["asked"] += size
        if site.kind in {"read", "write"}:
            totals["loads"] += count if site.kind == "read" else 0
            moved[site.block, site.kind] = moved.get((site.block, site.kind), 0) + size
        else:
            totals["counters" if site.kind == "counter" else "atomics"] += count
            for kind in ("read", "write"):
                moved[site.block, kind] = moved.get((site.block, kind), 0) + size
    totals["least"] = sum(min(size, asked.sizes[block] * asked.runs) for (block, _), size in moved.items())
    return totals
