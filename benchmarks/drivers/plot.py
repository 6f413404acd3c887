# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/benchmarks/drivers.png: processor seconds in which each driver compiles the programs."""

from collections.abc import Mapping, Sequence

import matplotlib.pyplot as plt

from ..device.results.drawing import COLORS, STYLE
from .lab import Driver, Outcome
from .page import PAGE
from .programs import Program

FIGURE = PAGE.with_suffix(".png")


def draw(drivers: Sequence[Driver], programs: Sequence[Program], outcomes: Mapping[str, Outcome]) -> None:
    """A bar a driver, with the programs apart that take longest in all."""

    def seconds(program: Program) -> list[float]:
        return [outcomes[driver.name].rows[program.digest].seconds for driver in drivers]

    by_length = sorted(programs, key=lambda program: -sum(seconds(program)))
    parts = {program.name: seconds(program) for program in by_length[: len(COLORS) - 1]}
    others = [seconds(program) for program in by_length[len(parts) :]]
    parts[f"{len(others)} others"] = [sum(column) for column in zip(*others, strict=True)]
    names = [driver.name for driver in drivers]
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(figsize=(8, 0.3 * len(names) + 1.2))
        begins = [0.0] * len(names)
        for (name, lengths), color in zip(parts.items(), COLORS, strict=True):
            axes.barh(names, lengths, left=begins, label=name, color=color)
            begins = [begin + length for begin, length in zip(begins, lengths, strict=True)]
        axes.invert_yaxis()
        axes.grid(axis="y", visible=False)
        axes.set_xlabel("processor seconds, without any cache")
        axes.legend(fontsize=7, loc="upper left", bbox_to_anchor=(0.0, -0.1))
        figure.savefig(FIGURE, bbox_inches="tight")
        plt.close(figure)
