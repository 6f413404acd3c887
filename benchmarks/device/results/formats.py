# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers and tables in Markdown."""

import math


def table(heads: list[str], lines: list[list[str]]) -> str:
    rows = ["| " + " | ".join(heads) + " |", "|---" + "|---:" * (len(heads) - 1) + "|"]
    if any(len(line) != len(heads) for line in lines):
        raise ValueError(f"a table's lines are not as long as its head: {heads}")
    return "\n".join(rows + ["| " + " | ".join(line) + " |" for line in lines])


def number(value: float) -> str:
    """Three digits."""
    if value == 0:
        return "0"
    return f"{value:,.{max(0, 2 - math.floor(math.log10(abs(value))))}f}"


def milliseconds(seconds: float | None) -> str:
    return "-" if seconds is None else f"{number(1e3 * seconds)}"


def mebibytes(sizes: dict[str, int]) -> float:
    return sum(sizes.values()) / 2**20


def geometric_mean(values: list[float]) -> float:
    return math.exp(sum(math.log(value) for value in values) / len(values))
