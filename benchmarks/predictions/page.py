# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/benchmarks/predictions.md."""

from collections.abc import Mapping
from pathlib import PurePosixPath

from benchmarks.drivers.lab import DRIVERS, prepare
from benchmarks.drivers.programs import all_programs
from benchmarks.drivers.run import outcome_of
from benchmarks.drivers.statistics import Statistics, worst

from .. import ROOT
from .model import GPUS, IRIS_XE, RTX_2080_TI, Demand, Gpu

PAGE = ROOT / "docs" / "benchmarks" / "predictions.md"
BEGIN, END = "<!-- predicted -->", "<!-- end -->"
_SHORTEST = 0.0005
"""Share of an iteration's bytes below which a program has no row."""


def statistics_of(gpu: Gpu) -> dict[str, Statistics]:
    """Return statistics of programs by the driver that stands for a device, by the file of each program's last stage.

    A program with several variants has those of the heaviest. Raises LabError.
    """
    (driver,) = (driver for driver in DRIVERS if driver.name == gpu.driver)
    prepare([driver])
    programs = all_programs()
    outcome, _ = outcome_of(driver, programs, anew=False)
    found: dict[str, list[Statistics]] = {}
    for program in programs:
        statistics = outcome.rows[program.digest].statistics
        if statistics is not None:
            found.setdefault(program.name.split()[0], []).append(statistics)
    return {name: code for name, codes in found.items() if (code := worst(codes)) is not None}


def waves_and_width(gpu: Gpu, code: Statistics | None) -> tuple[int, int]:
    """Waves that a processor of the device has room for at a time, and threads of each."""
    if gpu is IRIS_XE:
        return gpu.waves, code.waves if code else gpu.width
    if code is None:
        return gpu.waves, gpu.width
    registers = -(-max(code.registers, 1) // 8) * 8 * gpu.width
    return min(gpu.waves, 65536 // registers), gpu.width


def _file(name: str) -> str:
    """The last stage's file of a program's name."""
    return name.split(" + ")[-1]


def write_page(stored: Mapping[str, Demand], pixels: int) -> None:
    """Write the table anew. Raises LabError."""
    codes = {gpu.name: statistics_of(gpu) for gpu in GPUS}
    rows = [
        "| program | runs | threads, M | loads a thread | asked, MB | least, MB | atomics, M | on one word, M "
        "| 2080 Ti: warps of 32 | floor, ms | waiting, ms | Iris Xe: width | floor, ms | waiting, ms |",
        "|---|" + "---:|" * 13,
    ]
    total = sum(demand.least.at(pixels) for demand in stored.values())
    sums = {(gpu.name, is_grid): [0.0, 0.0] for gpu in GPUS for is_grid in (False, True)}
    for name, demand in sorted(stored.items(), key=lambda pair: -pair[1].least.at(pixels)):
        cells = []
        for gpu in GPUS:
            code = codes[gpu.name].get(_file(name))
            waves, width = waves_and_width(gpu, code)
            floor = demand.seconds(gpu, pixels)
            waiting = demand.waiting_seconds(gpu, pixels, waves, width)
            for is_grid in (False, True):
                if route_of(name) in {None, is_grid}:
                    sums[gpu.name, is_grid][0] += floor
                    sums[gpu.name, is_grid][1] += waiting
            shown = waves if gpu is RTX_2080_TI else width
            spills = f", {code.spills} spills" if code and code.spills else ""
            cells += [f"{shown}{spills}", _number(1e3 * floor), _number(1e3 * waiting)]
        if demand.least.at(pixels) < _SHORTEST * total:
            continue
        threads = demand.threads.at(pixels)
        numbers = (
            demand.runs,
            threads / 1e6,
            demand.loads.at(pixels) / max(threads, 1.0),
            demand.asked.at(pixels) / 1e6,
            demand.least.at(pixels) / 1e6,
            demand.atomics.at(pixels) / 1e6,
            demand.counters.at(pixels) / 1e6,
        )
        rows.append(f"| {name} | {' | '.join(map(_number, numbers))} | {' | '.join(cells)} |")
    lines = [
        f"- {gpu.name}, {'photon grid' if is_grid else 'splatting by rasterization'}: "
        f"{_number(1e3 * sums[gpu.name, is_grid][0])} to {_number(1e3 * sums[gpu.name, is_grid][1])} ms"
        for gpu in GPUS
        for is_grid in (False, True)
    ]
    before, _, rest = PAGE.read_text(encoding="utf-8").partition(BEGIN)
    _, _, after = rest.partition(END)
    table = "\n".join(["All programs of an iteration together:", "", *lines, "", *rows])
    PAGE.write_text(f"{before}{BEGIN}\n\n{table}\n\n{END}{after}", encoding="utf-8")


def route_of(name: str) -> bool | None:
    """Whether a program belongs to the grid (True) or to splatting (False) alone."""
    return {"photon_grid": True, "splatting": False}.get(PurePosixPath(name).parts[0])


def _number(value: float) -> str:
    if value == 0.0:
        return "0"
    return f"{value:,.0f}" if value >= 100.0 else f"{value:.3g}"
