# SPDX-License-Identifier: GPL-3.0-or-later
"""The memory of a scene as lines of text."""

from collections.abc import Mapping

from ..integrator.memory import Memory


def memory_lines(memory: Memory, resolution: tuple[int, int]) -> list[str]:
    """Bytes by buffer and sums by group; the PPM buffers against the paper's."""
    width, height = resolution
    lines = [
        f"R = {memory.pixels:,} pixels ({width} x {height}), M = {memory.photons:,} photons an iteration, "
        f"L = {memory.segments} segments of a photon path",
        *_group("PPM buffers", memory.ppm),
        _line("  of the paper: 32 R + 64 M L", memory.paper_bytes),
    ]
    for name, sizes in memory.working.items():
        lines += _group(f"Working memory: {name}", sizes)
    return [*lines, _line("Working memory, all", sum(memory.working_bytes.values())), _line("All", memory.total_bytes)]


def _group(title: str, sizes: Mapping[str, int]) -> list[str]:
    return [title, *(_line(f"    {name}", size) for name, size in sizes.items()), _line("  sum", sum(sizes.values()))]


def _line(name: str, size: int) -> str:
    return f"{name:<40}{size:>16,}{size / 2**20:>10.1f} MiB"
