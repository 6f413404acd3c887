# SPDX-License-Identifier: GPL-3.0-or-later
"""Drivers of Mesa that compile without their hardware.

Mesa's drm-shim answers a driver in the kernel's place: what is drawn and dispatched vanishes, but each program is
compiled and linked by the driver's own compiler, as on a machine that has the device.
"""

import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from rppm_addon.gl import project_mesa

from . import statistics
from .compile import MARK
from .programs import Program
from .statistics import Statistics, worst

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
LONGEST_SECONDS = 900
_SILENT_FAILURE = re.compile(r"translation failed|unknown nir_op|LLVM ERROR|ACO ERROR|[Aa]ssertion", re.IGNORECASE)
"""Printed by drivers that tell OpenGL nothing of it."""


class LabError(Exception):
    """A driver cannot be had here; the message says why."""


@dataclass(frozen=True)
class Driver:
    """A compiler and a device that it compiles for."""

    name: str
    shim: str
    """The library of drm-shim that answers it."""
    environment: dict[str, str]
    read: Callable[[str], list[Statistics]]
    waves: int
    """The most that a program can have."""
    words: str
    """For whom it stands."""


def _amd(device: str, waves: int, words: str, compiler: str = "aco") -> Driver:
    debug = f"vs,ps,cs,stats,use{compiler}"
    return Driver(
        f"{device.lower()} {compiler}",
        "libamdgpu_noop_drm_shim.so",
        {"AMDGPU_GPU_ID": device, "AMD_DEBUG": debug},
        statistics.radeonsi,
        waves,
        words,
    )


def _intel(platform: str, words: str) -> Driver:
    environment = {"INTEL_STUB_GPU_PLATFORM": platform}
    return Driver(f"{platform} iris", "libintel_noop_drm_shim.so", environment, statistics.iris, 32, words)


DRIVERS = (
    _amd("POLARIS10", 8, "Radeon RX 400 and 500, GCN 4"),
    _amd("VEGA10", 10, "Radeon RX Vega and most APUs, GCN 5"),
    _amd("NAVI21", 16, "Radeon RX 6000, RDNA 2"),
    _amd("NAVI31", 16, "Radeon RX 7000, RDNA 3"),
    _amd("NAVI31", 16, "the same by LLVM, the default of Mesa up to 25.0", "llvm"),
    Driver(
        "gm204 nouveau",
        "libnouveau_noop_drm_shim.so",
        {"NOUVEAU_CHIPSET": "124"},
        statistics.nouveau,
        64,
        "GeForce GTX 900, Maxwell",
    ),
    _intel("skl", "HD Graphics 500, Gen 9"),
    _intel("tgl", "Iris Xe, Gen 12"),
    _intel("dg2", "Arc A, Gen 12.5"),
)


@dataclass(frozen=True)
class Row:
    """A program on a driver."""

    seconds: float
    """Of the processor."""
    statistics: Statistics | None
    error: str = ""
    """What is wrong; empty where the program is sound."""


@dataclass
class Outcome:
    """What a driver has made of the programs."""

    device: str
    version: str
    limits: dict[str, int]
    rows: dict[str, Row] = field(default_factory=dict)
    """By the programs' digests."""


def shim_folder() -> Path:
    """Where drm-shim is kept between runs: RPPM_DRIVERS, or the user's cache folder."""
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return Path(os.environ.get("RPPM_DRIVERS") or cache / "rppm-drivers")


def unpack_shims() -> None:
    """Fetch those that Debian has, once. Raises LabError."""
    run = subprocess.run(
        [sys.executable, ROOT / ".ci" / "unpack_mesa.py", "--shims", shim_folder() / "debian"],
        capture_output=True,
        text=True,
    )
    if run.returncode:
        raise LabError(run.stderr.strip())


def shim(driver: Driver) -> Path:
    """Its file. Raises LabError where there is none."""
    for path in sorted(shim_folder().glob(f"**/{driver.shim}")):
        return path
    builder = "; benchmarks/drivers/build_intel_shim.sh builds it" if "intel" in driver.shim else ""
    raise LabError(f"{driver.shim} is not in {shim_folder()}{builder}")


def compile_all(driver: Driver, programs: Sequence[Program]) -> Outcome:
    """Compile programs. Raises LabError when there is no such driver."""
    paths = project_mesa.libraries(project_mesa.FOLDER)
    if not paths:
        raise LabError(f"there is no Mesa in {project_mesa.FOLDER}: make setup, on Debian 12 without a GPU")
    environment = {
        "PATH": os.environ["PATH"],
        "HOME": os.environ.get("HOME", "/"),
        "LD_LIBRARY_PATH": str(paths[0].parent),
        "MESA_SHADER_CACHE_DISABLE": "true",
        "LD_PRELOAD": str(shim(driver)),
        **driver.environment,
    }
    with tempfile.TemporaryDirectory() as folder:
        asked, answered = Path(folder, "programs.json"), Path(folder, "results.json")
        asked.write_text(json.dumps([program.texts for program in programs]), encoding="utf-8")
        command = [sys.executable, HERE / "compile.py", asked, answered]
        run = subprocess.run(
            command, env=environment, stderr=subprocess.PIPE, text=True, errors="replace", timeout=LONGEST_SECONDS
        )
        if run.returncode or not answered.exists():
            raise LabError(f"{driver.name} ended with code {run.returncode}: {run.stderr[-1000:]}")
        return _outcome(driver, programs, json.loads(answered.read_text(encoding="utf-8")), run.stderr)


def _outcome(driver: Driver, programs: Sequence[Program], found: dict, printed: str) -> Outcome:
    outcome = Outcome(found["device"], found["version"], found["limits"])
    parts = re.split(rf"^{MARK}\d*$", printed, flags=re.MULTILINE)[1:]
    for program, row, part in zip(programs, found["programs"], parts, strict=False):  # a last part follows
        said = "\n".join([part, *row["messages"]])
        code = worst(driver.read(part) or driver.read("\n".join(row["messages"])))
        failures = [line for line in said.splitlines() if _SILENT_FAILURE.search(line)]
        error = row["error"] or "; ".join(failures) or ("" if code else "the driver has made no code of it")
        outcome.rows[program.digest] = Row(row["seconds"], code, error.strip())
    return outcome
