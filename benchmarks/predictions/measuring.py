# SPDX-License-Identifier: GPL-3.0-or-later
"""Seconds of each program of a render, beside what was predicted."""

import contextlib
import time
from collections.abc import Callable, Mapping
from typing import Any

from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.program import ComputeProgram, DrawProgram

from .model import GPUS, RTX_2080_TI, Demand

_METHODS = ((ComputeProgram, "run"), (ComputeProgram, "run_indirect"), (DrawProgram, "draw"))


class KernelTimes:
    """Times programs that run within ``with``: by queries on GPUs, else by all threads' processor time.

    Stages must not be timed meanwhile, as queries do not nest.
    """

    def __init__(self, context: Context) -> None:
        self._context = context
        self._queries: list[tuple[str, Any]] = []
        self._seconds: dict[str, float] = {}
        self._restore = contextlib.ExitStack()

    def __enter__(self) -> "KernelTimes":
        for kind, name in _METHODS:
            self._replace(kind, name, self._timed(getattr(kind, name)))
        return self

    def __exit__(self, *_: object) -> None:
        self._restore.close()

    def _replace(self, kind: type, name: str, method: Callable) -> None:
        self._restore.callback(setattr, kind, name, getattr(kind, name))
        setattr(kind, name, method)

    def _timed(self, method: Callable) -> Callable:
        def run(program: Any, *arguments: object, **named: object) -> None:
            if self._context.is_software:
                self._context.finish()
                start = time.process_time()
                method(program, *arguments, **named)
                self._context.finish()
                self._seconds[program.name] = self._seconds.get(program.name, 0.0) + time.process_time() - start
                return
            query = self._context.moderngl.query(time=True)
            with query:
                method(program, *arguments, **named)
            self._queries.append((program.name, query))

        return run

    def seconds(self) -> dict[str, float]:
        """By program, so far."""
        for name, query in self._queries:
            self._seconds[name] = self._seconds.get(name, 0.0) + query.elapsed * 1e-9
        self._queries.clear()
        return dict(self._seconds)


def comparison(device: str, pixels: int, stored: Mapping[str, Demand], seconds: Mapping[str, float]) -> str:
    """Return a table of predicted and measured times, the longest first."""
    gpu = next((gpu for gpu in GPUS if gpu.part_of_name in device), None)
    lines = [
        f"{device}, {pixels} pixels, {pixels // 4} photons; the floor is that of {(gpu or RTX_2080_TI).name}",
        f"{'program':48} {'measured ms':>12} {'floor':>9} {'least GB/s':>11} {'asked GB/s':>11}",
    ]
    for name, measured in sorted(seconds.items(), key=lambda pair: -pair[1]):
        demand = stored.get(name)
        row = f"{name[-48:]:48} {1e3 * measured:12.3f}"
        if demand is not None:
            floor = demand.seconds(gpu or RTX_2080_TI, pixels)
            speeds = (line.at(pixels) / measured / 1e9 for line in (demand.least, demand.asked))
            row += f" {1e3 * floor:9.3f} {' '.join(f'{speed:11.1f}' for speed in speeds)}"
        lines.append(row)
    return "\n".join([*lines, f"{'all':48} {1e3 * sum(seconds.values()):12.3f}"])
