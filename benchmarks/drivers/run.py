# SPDX-License-Identifier: GPL-3.0-or-later
"""Compile every program on the drivers of GPUs that are not there: ``python -m benchmarks.drivers.run``.

Fails where a driver refuses a program, drops it without a word, or needs more of a processor for it than limits.json
allows. What a driver has made of a program is kept below the user's cache folder, so that only programs that changed
are compiled again.
"""

import argparse
import hashlib
import json
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
from pathlib import Path

from rppm_addon.processors import usable_cores

from .. import ROOT
from .lab import DRIVERS, Driver, LabError, Outcome, Row, compile_all, lab_folder, prepare, version_of
from .limits import Limits
from .page import PAGE, write_page
from .programs import Program, all_programs
from .statistics import Statistics

QUICK = ("vega10 aco", "navi31 aco", "gm204 nouveau")
"""Drivers of three makes of compilers that need nothing but a download of 75 kB."""


def _kept_file(driver: Driver) -> Path:
    key = f"{version_of(driver)} {driver.shim} {sorted(driver.environment.items())}"
    return lab_folder() / "results" / f"{hashlib.sha256(key.encode()).hexdigest()}.json"


def _load(file: Path) -> Outcome | None:
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    rows = {
        digest: Row(row["seconds"], Statistics(**row["statistics"]) if row["statistics"] else None, row["error"])
        for digest, row in found["rows"].items()
    }
    return Outcome(found["device"], found["version"], found["limits"], rows)


def outcome_of(driver: Driver, programs: list[Program], anew: bool) -> tuple[Outcome, int]:
    """Return a driver's outcome for the programs, by digest, and how many it has just compiled. Raises LabError."""
    file = _kept_file(driver)
    kept = None if anew else _load(file)
    rows = kept.rows if kept else {}
    new = [program for program in programs if program.digest not in rows]
    if new:
        compiled = compile_all(driver, new)
        rows = {digest: row for digest, row in rows.items() if digest in {program.digest for program in programs}}
        kept = Outcome(compiled.device, compiled.version, compiled.limits, rows | compiled.rows)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps(asdict(kept)), encoding="utf-8")
    assert kept is not None
    return kept, len(new)


def _check(driver: Driver, programs: list[Program], outcome: Outcome, limits: Limits | None) -> list[str]:
    """List what is wrong; without limits, what is wrong whatever they are."""
    complaints = []
    for program in programs:
        row = outcome.rows[program.digest]
        if row.error:
            complaints.append(f"{program.name}: {program.name_lines(row.error)[:500]}")
        elif limits and row.statistics is not None:
            complaint = limits.complaint(program.name, driver.name, row.statistics, driver.waves)
            complaints += [f"{program.name}: {complaint}"] if complaint else []
    return [f"{driver.name}: {complaint}" for complaint in complaints]


def _keep(limits: Limits, drivers: list[Driver], programs: list[Program], outcomes: dict[str, Outcome]) -> None:
    for driver in drivers:
        outcome = outcomes[driver.name]
        codes = {program.name: outcome.rows[program.digest].statistics for program in programs}
        light = {name: code for name, code in codes.items() if code}
        limits.keep(driver.name, outcome.version, light, driver.waves)
    limits.store()
    write_page(drivers, programs, outcomes)
    try:
        from .plot import FIGURE, draw
    except ModuleNotFoundError as error:
        if error.name != "matplotlib":
            raise
        print("drivers: the figure stays as it was: make bench-tools installs matplotlib", file=sys.stderr)
        return
    draw(drivers, programs, outcomes)
    print(FIGURE.relative_to(ROOT))


def _parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help=f"only {', '.join(QUICK)}, and none where none can be had")
    parser.add_argument("--only", nargs="*", metavar="DRIVER", help=", ".join(driver.name for driver in DRIVERS))
    parser.add_argument("--anew", action="store_true", help="compile what has not changed as well")
    parser.add_argument("--keep", action="store_true", help=f"write limits.json, {PAGE.name} and its figure")
    return parser.parse_args()


def main() -> int:
    """Do it; returns the exit status."""
    options = _parse()
    wanted = options.only or (QUICK if options.quick else [driver.name for driver in DRIVERS])
    chosen = [driver for driver in DRIVERS if driver.name in wanted]
    try:
        prepare(chosen)
    except LabError as error:
        print(f"drivers: nothing is compiled: {error}", file=sys.stderr)
        return 0 if options.quick else 1
    programs, limits = all_programs(), Limits.load()
    outcomes: dict[str, Outcome] = {}
    complaints: list[str] = []
    with ThreadPoolExecutor(usable_cores()) as pool:
        jobs = [(driver, pool.submit(outcome_of, driver, programs, options.anew)) for driver in chosen]
        for driver, job in jobs:
            try:
                outcome, compiled = job.result()
            except LabError as error:
                complaints.append(f"{driver.name}: {error}")
                continue
            outcomes[driver.name] = outcome
            seconds = sum(outcome.rows[program.digest].seconds for program in programs)
            is_known = limits.versions.get(driver.name) == outcome.version
            found = _check(driver, programs, outcome, limits if is_known and not options.keep else None)
            complaints += found
            print(
                f"{driver.name:16} {len(programs)} programs, {compiled} of them compiled now: {seconds:.1f} s of "
                f"processor time for all, {len(found) or 'no'} problems ({outcome.device}, {outcome.version})"
                + ("" if is_known or options.keep else "; limits.json is of another version"),
                flush=True,
            )
    if options.keep:
        _keep(limits, [driver for driver in chosen if driver.name in outcomes], programs, outcomes)
    print("\n".join(complaints))
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
