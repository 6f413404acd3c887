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

from rppm_addon.gl import project_mesa
from rppm_addon.processors import usable_cores

from .lab import DRIVERS, Driver, LabError, Outcome, Row, compile_all, shim_folder, unpack_shims
from .limits import Limits
from .page import PAGE, write_page
from .programs import Program, all_programs
from .statistics import Statistics

QUICK = ("vega10 aco", "navi31 aco", "gm204 nouveau")
"""Drivers of three makes of compilers that need nothing but a download of 75 kB."""


def mesa_version() -> str:
    """Of the project's Mesa; empty without one."""
    names = (path.name for path in project_mesa.libraries(project_mesa.FOLDER))
    return next((name.removesuffix(".so").partition("-")[2] for name in names if name.startswith("libgallium-")), "")


def _kept_file(driver: Driver) -> Path:
    key = f"{mesa_version()} {driver.shim} {sorted(driver.environment.items())}"
    return shim_folder() / "results" / f"{hashlib.sha256(key.encode()).hexdigest()}.json"


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
    """What a driver makes of the programs, by their digests, and how many it has just compiled. Raises LabError."""
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


def _check(driver: Driver, programs: list[Program], outcome: Outcome, limits: Limits) -> list[str]:
    complaints = []
    for program in programs:
        row = outcome.rows[program.digest]
        if row.error:
            complaints.append(f"{program.name}: {program.name_lines(row.error)[:500]}")
        elif row.statistics is not None:
            complaint = limits.complaint(program.name, driver.name, row.statistics, driver.waves)
            complaints += [f"{program.name}: {complaint}"] if complaint else []
    return [f"{driver.name}: {complaint}" for complaint in complaints]


def main() -> int:
    """Do it; returns the exit status."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help=f"only {', '.join(QUICK)}, and none where none can be had")
    parser.add_argument("--only", nargs="*", metavar="DRIVER", help=", ".join(driver.name for driver in DRIVERS))
    parser.add_argument("--anew", action="store_true", help="compile what has not changed as well")
    parser.add_argument("--keep", action="store_true", help=f"write limits.json and {PAGE.name}")
    options = parser.parse_args()
    wanted = options.only or (QUICK if options.quick else [driver.name for driver in DRIVERS])
    chosen = [driver for driver in DRIVERS if driver.name in wanted]
    try:
        unpack_shims()
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
            found = _check(driver, programs, outcome, limits) if not options.keep else []
            complaints += found
            print(
                f"{driver.name:16} {len(programs)} programs, {compiled} of them compiled now: {seconds:.1f} s of "
                f"processor time for all, {len(found) or 'no'} problems ({outcome.device}, {outcome.version})",
                flush=True,
            )
    if limits.mesa != mesa_version():
        print(f"limits.json is of Mesa {limits.mesa}, this one is {mesa_version()}: make drivers DRIVERS=--keep")
    if options.keep and not complaints:
        limits.mesa = mesa_version()
        for driver in chosen:
            codes = {program.name: outcomes[driver.name].rows[program.digest].statistics for program in programs}
            limits.keep(driver.name, {name: code for name, code in codes.items() if code}, driver.waves)
        limits.store()
        write_page(limits, chosen, programs, outcomes)
    print("\n".join(complaints))
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
