# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/benchmarks/drivers.md: what each driver makes of the programs."""

from collections.abc import Mapping, Sequence

from .. import ROOT
from .lab import Driver, Outcome
from .programs import Program

PAGE = ROOT / "docs" / "benchmarks" / "drivers.md"
BEGIN, END = "<!-- measured -->\n", "<!-- end -->\n"
_MOST_ROWS = 24


def write_page(drivers: Sequence[Driver], programs: Sequence[Program], outcomes: Mapping[str, Outcome]) -> None:
    """Write the tables anew between the page's marks."""
    text = PAGE.read_text(encoding="utf-8")
    before, after = text.partition(BEGIN)[0], text.partition(END)[2]
    tables = [
        f"{len(programs)} programs.\n\n",
        *_driver_table(drivers, programs, outcomes),
        "\n",
        *_program_table(drivers, programs, outcomes),
    ]
    PAGE.write_text(before + BEGIN + "\n" + "".join(tables) + "\n" + END + after, encoding="utf-8")


def _driver_table(drivers: Sequence[Driver], programs: Sequence[Program], outcomes: Mapping[str, Outcome]) -> list[str]:
    lines = [
        "| driver | stands for | Mesa | processor s | longest program | blocks a stage | largest block, MiB |\n",
        "|---|---|---|---:|---|---:|---:|\n",
    ]
    for driver in drivers:
        outcome = outcomes[driver.name]
        rows = {program.name: outcome.rows[program.digest] for program in programs}
        longest = max(rows, key=lambda name: rows[name].seconds)
        lines.append(
            f"| {driver.name} | {driver.words} | {outcome.version.rpartition(' ')[2].partition('-')[0]} "
            f"| {sum(row.seconds for row in rows.values()):.1f} "
            f"| {longest}, {rows[longest].seconds:.1f} s | {outcome.limits['GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS']} "
            f"| {(outcome.limits['GL_MAX_SHADER_STORAGE_BLOCK_SIZE'] + 1) >> 20} |\n"
        )
    return lines


def _program_table(
    drivers: Sequence[Driver], programs: Sequence[Program], outcomes: Mapping[str, Outcome]
) -> list[str]:
    def room(program: Program) -> float:
        codes = ((driver, outcomes[driver.name].rows[program.digest].statistics) for driver in drivers)
        return sum(code.waves / driver.waves for driver, code in codes if code)

    drivers = [driver for driver in drivers if driver.read]
    worst = sorted(programs, key=room)[:_MOST_ROWS]
    lines = [
        f"| program | {' | '.join(f'{driver.name} (of {driver.waves})' for driver in drivers)} |\n",
        f"|---|{'---:|' * len(drivers)}\n",
    ]
    for program in worst:
        cells = []
        for driver in drivers:
            code = outcomes[driver.name].rows[program.digest].statistics
            spilled = f", {code.spills} spills" if code and code.spills else ""
            registers = f" ({code.registers})" if code and code.registers else ""
            cells.append(f"{code.waves}{registers}{spilled}" if code else "")
        lines.append(f"| {program.name} | {' | '.join(cells)} |\n")
    return lines
