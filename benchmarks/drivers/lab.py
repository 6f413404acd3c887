# SPDX-License-Identifier: GPL-3.0-or-later
"""Drivers of Mesa that compile without their hardware.

Mesa's drm-shim answers a driver in the kernel's place: what is drawn and dispatched vanishes, but each program is
compiled and linked by the driver's own compiler, as on a machine that has the device.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from rppm_addon.gl.context import project_mesa

from . import statistics
from .compile import MARK
from .programs import Program
from .statistics import Statistics, worst

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
WINDOWS = ROOT / "tests" / "gui"
LONGEST_SECONDS = 900
_SILENT_FAILURE = re.compile(r"translation failed|unknown nir_op|LLVM ERROR|ACO ERROR|[Aa]ssertion", re.IGNORECASE)
"""Printed by drivers that tell OpenGL nothing of it."""
_NO_CODE = "the driver has made no code of it"


class LabError(Exception):
    """A driver cannot be had here; the message says why."""


@dataclass(frozen=True)
class Driver:
    """A compiler and a device that it compiles for."""

    name: str
    shim: str
    """The library of drm-shim that answers it."""
    environment: dict[str, str]
    words: str
    """For whom it stands."""
    read: Callable[[str], list[Statistics]] | None = None
    """Statistics of what it prints; None where it prints none."""
    waves: int = 0
    """The most that a program can have."""
    is_newest: bool = False
    """Choice of Mesa: Debian's development release in the chroot of the window tests, or else the project's own."""


def _amd(device: str, waves: int, words: str, compiler: str = "aco", is_newest: bool = False) -> Driver:
    environment = {"AMDGPU_GPU_ID": device, "AMD_DEBUG": f"vs,ps,cs,stats,use{compiler}"}
    name = f"{device.lower()} {compiler}"
    return Driver(name, _shim("amdgpu"), environment, words, statistics.radeonsi, waves, is_newest)


def _intel(platform: str, words: str) -> Driver:
    environment = {"INTEL_STUB_GPU_PLATFORM": platform, "INTEL_DEBUG": "cs,vs,fs"}
    return Driver(f"{platform} iris", _shim("intel"), environment, words, statistics.iris, 32)


def _nvk(name: str, chipset: str, words: str) -> Driver:
    environment = {
        "NOUVEAU_CHIPSET": chipset,
        "MESA_LOADER_DRIVER_OVERRIDE": "zink",
        "NVK_I_WANT_A_BROKEN_VULKAN_DRIVER": "1",
        "VK_DRIVER_FILES": f"{_INSIDE}/usr/share/vulkan/icd.d/nouveau_icd.json",
    }
    return Driver(f"{name} nvk", _shim("nouveau"), environment, words, is_newest=True)


def _shim(kernel: str) -> str:
    return f"lib{kernel}_noop_drm_shim.so"


_INSIDE = "/mnt/root"
"""Where the chroot has what fetch_newest.sh unpacked."""
_MAXWELL = {"NOUVEAU_CHIPSET": "124"}
DRIVERS = (
    _amd("POLARIS10", 8, "Radeon RX 400 and 500, GCN 4"),
    _amd("VEGA10", 10, "Radeon RX Vega and most APUs, GCN 5"),
    _amd("NAVI21", 16, "Radeon RX 6000, RDNA 2"),
    _amd("NAVI31", 16, "Radeon RX 7000, RDNA 3"),
    _amd("NAVI31", 16, "the same by LLVM 15, the older compiler", "llvm"),
    _amd("GFX1201", 16, "Radeon RX 9000, RDNA 4", is_newest=True),
    Driver("gm204 nouveau", _shim("nouveau"), _MAXWELL, "GeForce GTX 900, Maxwell", statistics.nouveau, 64),
    Driver("gm204 newest", _shim("nouveau"), _MAXWELL, "the same, newest Mesa", statistics.nouveau, 64, True),
    _nvk("tu102", "162", "GeForce RTX 2000, Turing, through zink"),
    _nvk("ad102", "192", "GeForce RTX 4000, Ada, through zink"),
    _intel("skl", "HD Graphics 500, Gen 9"),
    _intel("tgl", "Iris Xe, Gen 12"),
    _intel("dg2", "Arc A, Gen 12.5"),
    Driver("a660 freedreno", _shim("freedreno"), {"FD_GPU_ID": "660"}, "Adreno 660", is_newest=True),
    Driver("m1 asahi", _shim("asahi"), {}, "Apple M1", statistics.asahi, 1024, True),
)


@dataclass(frozen=True)
class Row:
    """A program on a driver."""

    seconds: float
    """Processor time of the compilation, seconds."""
    statistics: Statistics | None
    error: str = ""
    """Error; empty where the program is sound."""


@dataclass
class Outcome:
    """Outcome of a driver's compilation of the programs."""

    device: str
    version: str
    limits: dict[str, int]
    """Limits of OpenGL, by their names."""
    rows: dict[str, Row] = field(default_factory=dict)
    """By the programs' digests."""


def lab_folder() -> Path:
    """Where the lab is kept between runs: RPPM_DRIVERS, or the user's cache folder."""
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return Path(os.environ.get("RPPM_DRIVERS") or cache / "rppm-drivers")


def prepare(drivers: Sequence[Driver]) -> None:
    """Have what drivers need, fetched and built once. Raises LabError."""
    folder = lab_folder()
    _do(sys.executable, ROOT / ".ci" / "unpack_mesa.py", "--shims", folder / "project")
    if any(driver.shim == _shim("intel") for driver in drivers):
        _do(HERE / "build_intel_shim.sh", folder)
    if any(driver.is_newest for driver in drivers):
        _do(WINDOWS / "build_chroot.sh", _chroot())
        _do(HERE / "fetch_newest.sh", _chroot(), folder / "newest")


def _do(*command: str | Path) -> None:
    run = subprocess.run(command, cwd=ROOT, stderr=subprocess.PIPE, text=True)
    if run.returncode:
        raise LabError(run.stderr.strip() or f"{command[0]} ended with code {run.returncode}")


def _chroot() -> Path:
    """As the window tests choose it."""
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return Path(os.environ.get("RPPM_GUI") or cache / "rppm-gui") / "chroot"


def version_of(driver: Driver) -> str:
    """Mesa's, as far as it tells what has to be compiled anew. Raises LabError."""
    folder = lab_folder() / "newest" / "root" if driver.is_newest else project_mesa.FOLDER
    pattern = "libvulkan_radeon.so" if driver.is_newest else "libgallium-*.so"
    for path in sorted(folder.glob(f"usr/lib/*/{pattern}")):
        return f"{path.name} {path.stat().st_size}"
    raise LabError(f"there is no Mesa in {folder}: make setup, on Debian 12 without a GPU")


def compile_all(driver: Driver, programs: Sequence[Program]) -> Outcome:
    """Compile programs. Raises LabError when the driver does not.

    What makes no code is asked for once more: statistics may come late, from threads of the driver's.
    """
    outcome = _compile(driver, programs)
    silent = [program for program in programs if outcome.rows[program.digest].error == _NO_CODE]
    if silent:
        outcome.rows |= _compile(driver, silent).rows
    return outcome


def _compile(driver: Driver, programs: Sequence[Program]) -> Outcome:
    with tempfile.TemporaryDirectory(dir=lab_folder()) as temporary:  # where links reach
        folder = Path(temporary)
        (folder / "programs.json").write_text(json.dumps([program.texts for program in programs]), encoding="utf-8")
        shutil.copy(HERE / "compile.py", folder)
        command, environment = _newest_command(driver, folder) if driver.is_newest else _command(driver, folder)
        try:
            run = subprocess.run(
                command, env=environment, stderr=subprocess.PIPE, text=True, errors="replace", timeout=LONGEST_SECONDS
            )
        except subprocess.TimeoutExpired as error:
            raise LabError(
                f"{driver.name} did not compile {len(programs)} programs in {LONGEST_SECONDS} s; give it more time"
            ) from error
        answer = folder / "results.json"
        if run.returncode or not answer.exists():
            raise LabError(f"{driver.name} ended with code {run.returncode}: {run.stderr[-1000:]}")
        return outcome_of(driver, programs, json.loads(answer.read_text(encoding="utf-8")), run.stderr)


_UNKEPT = {"MESA_SHADER_CACHE_DISABLE": "true"}
_FILES = ("compile.py", "programs.json", "results.json")


def _command(driver: Driver, folder: Path) -> tuple[list[str], dict[str, str]]:
    """And its environment."""
    (shim,) = lab_folder().glob(f"{'intel' if driver.shim == _shim('intel') else 'project/usr/lib/*'}/{driver.shim}")
    environment = {
        "PATH": os.environ["PATH"],
        "LD_LIBRARY_PATH": str(project_mesa.libraries(project_mesa.FOLDER)[0].parent),
        "LD_PRELOAD": str(shim),
        **_UNKEPT,
        **driver.environment,
    }
    return [sys.executable, *(str(folder / name) for name in _FILES)], environment


def _newest_command(driver: Driver, folder: Path) -> tuple[list[str], dict[str, str]]:
    """The same inside the chroot, where the folder is /mnt."""
    (libraries,) = (lab_folder() / "newest" / "root" / "usr" / "lib").glob("*-linux-gnu*/")
    inside = f"{_INSIDE}/usr/lib/{libraries.name}"
    shutil.copytree(lab_folder() / "newest" / "root", folder / "root", symlinks=True, copy_function=os.link)
    environment = {
        "PYTHONPATH": f"{_INSIDE}/usr/lib/python3/dist-packages",
        "LD_LIBRARY_PATH": inside,
        "LD_PRELOAD": f"{inside}/{driver.shim}",
        **_UNKEPT,
        **driver.environment,
    }
    variables = (f"{name}={value}" for name, value in environment.items())
    inner = ["env", *variables, "python3", *(f"/mnt/{name}" for name in _FILES)]
    return [str(WINDOWS / "enter_chroot.sh"), str(_chroot()), str(folder), *inner], dict(os.environ)


def outcome_of(driver: Driver, programs: Sequence[Program], found: dict, printed: str) -> Outcome:
    outcome = Outcome(found["device"], found["version"], found["limits"])
    _, *marked = re.split(rf"{MARK}(\d+)\n", printed)
    parts = dict(zip(map(int, marked[::2]), marked[1::2]))
    for number, (program, row) in enumerate(zip(programs, found["programs"], strict=True)):
        said = "\n".join([parts.get(number, ""), *row["messages"]])
        code = worst(driver.read(said)) if driver.read else None
        failures = [line for line in said.splitlines() if _SILENT_FAILURE.search(line)]
        made = code is not None or driver.read is None
        error = row["error"] or "; ".join(failures) or ("" if made else _NO_CODE)
        outcome.rows[program.digest] = Row(row["seconds"], code, error.strip())
    return outcome
