# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits of programs on a processor: no spills and room for enough waves, or no more than is kept."""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from .statistics import Statistics

FILE = Path(__file__).resolve().parent / "limits.json"
_LEAST = 0.25
"""Least fraction of a processor's waves: fewer hide no latency of memory."""
_SLACK = 1.1
"""Other versions of a program that spills anyway spill a little more or less."""


def is_light(code: Statistics, most_waves: int) -> bool:
    """Whether code of a program needs no word of its own."""
    return code.spills == 0 and code.waves >= _LEAST * most_waves


@dataclass
class Limits:
    """Limits of heavy programs by the names of program and driver."""

    versions: dict[str, str] = field(default_factory=dict)
    """Version of each driver: another version makes other code, for which the limits say nothing."""
    heavy: dict[str, dict[str, Statistics]] = field(default_factory=dict)

    @classmethod
    def load(cls, file: Path = FILE) -> "Limits":
        """Load the limits that are kept."""
        found = json.loads(file.read_text(encoding="utf-8"))
        heavy = {
            program: {driver: Statistics(**code) for driver, code in drivers.items()}
            for program, drivers in found["heavy"].items()
        }
        return cls(found["versions"], heavy)

    def store(self, file: Path = FILE) -> None:
        """Keep them."""
        lines = [
            f"  {json.dumps(program)}: {{\n"
            + ",\n".join(f"   {json.dumps(driver)}: {json.dumps(vars(code))}" for driver, code in drivers.items())
            + "\n  }"
            for program, drivers in sorted(self.heavy.items())
        ]
        heavy = ",\n".join(lines)
        text = f'{{\n "versions": {json.dumps(self.versions, indent=2)},\n "heavy": {{\n{heavy}\n }}\n}}\n'
        file.write_text(text, encoding="utf-8")

    def complaint(self, program: str, driver: str, code: Statistics, most_waves: int) -> str:
        """Return in what way the code is worse than it may be; empty where nothing is."""
        if is_light(code, most_waves):
            return ""
        kept = self.heavy.get(program, {}).get(driver)
        if kept is None:
            return f"{code.waves} of {most_waves} waves, {code.spills} spills, {code.registers} registers: it was light"
        if code.waves < kept.waves:
            return f"{code.waves} of {most_waves} waves ({code.registers} registers), {kept.waves} so far"
        if code.spills > math.ceil(_SLACK * kept.spills):
            return f"{code.spills} spills, {kept.spills} so far"
        return ""

    def keep(self, driver: str, version: str, found: Mapping[str, Statistics], most_waves: int) -> None:
        """Take what a driver makes of all programs in place of what was kept of it."""
        self.versions[driver] = version
        for drivers in self.heavy.values():
            drivers.pop(driver, None)
        for program, code in found.items():
            if not is_light(code, most_waves):
                self.heavy.setdefault(program, {})[driver] = code
        self.heavy = {program: drivers for program, drivers in self.heavy.items() if drivers}
