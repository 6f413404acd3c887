# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of a self-test: text to be attached to a bug report, without names of people, machines and files."""

import importlib.metadata
import importlib.util
import logging
import os
import platform
import re
import sys
import time
import tomllib
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from ..denoising.denoiser import Denoiser
from ..denoising.places import library_places
from ..gl.context.context import DeviceInformation, device_information
from ..processors import usable_cores
from ..scene.common.quantities import count_text
from ..scene.common.whole_files import renamed_when_whole
from ..scene.errors import DenoiserError, RppmError
from ..session.render.renderer import Renderer
from .checks import Finding, Speed, energy, exact_rays, picture, speed
from .published import PUBLISHED, SPEED_SCENE

_PACKAGES = ("bpy", "moderngl", "glcontext", "numpy", "OpenEXR")


@dataclass
class SelfTest:
    """Results of a self-test."""

    device: DeviceInformation | None = None
    """None where none could be opened."""
    findings: list[Finding] = field(default_factory=list)
    speed: Speed | None = None
    problems: list[str] = field(default_factory=list)
    """Errors that stopped the checks, and warnings, a line each."""
    seconds: float = 0.0

    @property
    def passed(self) -> bool:
        """Whether everything was tried and is as it should be."""
        return self.speed is not None and all(finding.passed for finding in self.findings)


class _Collected(logging.Handler):
    """Warnings as they are logged, each once."""

    def __init__(self, lines: list[str]) -> None:
        super().__init__(logging.WARNING)
        self._lines = lines

    def emit(self, record: logging.LogRecord) -> None:
        """As Handler has it."""
        line = f"{record.levelname.lower()}: {record.getMessage()}"
        if line not in self._lines:
            self._lines.append(line)


def run_self_test(on_progress: Callable[[float, str], None], device: str | None = None) -> SelfTest:
    """Try the device; failures are in the report that is returned.

    ``on_progress`` gets how far the test is, 0 to 1, and what is tried next. device: as of Context.create.
    """
    found = SelfTest()
    start = time.perf_counter()
    handler = _Collected(found.problems)
    logger = logging.getLogger(__package__.rpartition(".")[0])
    logger.addHandler(handler)
    try:
        on_progress(0.0, "device")
        found.device = device_information(device)
        on_progress(0.05, "rays")
        found.findings.append(exact_rays(device))
        with Renderer(device, times_stages=True) as renderer:
            found.speed = speed(renderer, lambda words: on_progress(0.2, words))
            on_progress(0.5, "energy")
            found.findings += energy(renderer)
            on_progress(0.8, "picture")
            found.findings.append(picture(renderer))
    except RppmError as error:
        found.problems.append(f"stopped: {error}")
    finally:
        logger.removeHandler(handler)
    found.seconds = time.perf_counter() - start
    return found


def write_report(path: Path, on_progress: Callable[[float, str], None], device: str | None = None) -> SelfTest:
    """Try the device as run_self_test does, and write the report. Raises OSError where it cannot be written."""
    found = run_self_test(on_progress, device)
    with renamed_when_whole(path) as name:
        Path(name).write_text(report_text(found), encoding="utf-8")
    return found


def report_text(found: SelfTest) -> str:
    """The report, lines of text; the home folder is written as ~."""
    lines = [
        f"RPPM {_own_version()}, self-test",
        "",
        f"System    {platform.system()} {platform.release()} {platform.machine()}, Python {platform.python_version()}",
        f"Packages  {', '.join(_versions())}",
        f"Processor {usable_cores()} cores of {os.cpu_count()}",
        *_device_lines(found.device),
        f"Denoiser  {_denoiser()}",
        "",
        *map(_finding_line, found.findings),
        *(_speed_lines(found.speed) if found.speed is not None else []),
        *(["", *found.problems] if found.problems else []),
        "",
        f"{'All is well' if found.passed else 'Not all is well'}, after {found.seconds:.0f} s",
    ]
    return _without_home("\n".join(lines)) + "\n"


def _without_home(text: str) -> str:
    """The text without the user's name in paths, which Windows writes in letters of either case."""
    return re.sub(re.escape(str(Path.home())), "~", text, flags=re.IGNORECASE if sys.platform == "win32" else 0)


def _finding_line(finding: Finding) -> str:
    return f"{'passed' if finding.passed else 'FAILED'}    {finding.name}: {finding.text}"


def _own_version() -> str:
    """By the extension's manifest, or by the installed package, which has none."""
    manifest = Path(__file__).parents[2] / "blender_manifest.toml"
    if manifest.is_file():
        return str(tomllib.loads(manifest.read_text(encoding="utf-8"))["version"])
    return importlib.metadata.version("rppm-addon")


def _versions() -> list[str]:
    versions = []
    for name in _PACKAGES:
        try:
            versions.append(f"{name} {importlib.metadata.version(name)}")
        except importlib.metadata.PackageNotFoundError:
            there = name in sys.modules or importlib.util.find_spec(name) is not None
            versions.append(f"{name} {'of unknown version' if there else 'missing'}")
    return versions


def _device_lines(device: DeviceInformation | None) -> list[str]:
    if device is None:
        return ["Device    none"]
    others = [f"          {other.number} or {other.identity}: {other.label}" for other in device.devices]
    limits = [f"          {name} {value}" for name, value in device.limits.items()]
    return [
        f"Device    {device.name}",
        f"Driver    {device.driver}{', of make setup' if device.driver_folder else ''}",
        f"OpenGL    {device.version}",
        *limits,
        *(f"Warning   {warning}" for warning in device.warnings),
        f"Missing   {'; '.join(device.missing) or 'nothing'}",
        *(["Devices", *others] if others else []),
    ]


def _denoiser() -> str:
    try:
        return Denoiser(library_places()).description.partition(",")[0]  # the file's place follows
    except DenoiserError as error:
        return f"none: {error}"


def _speed_lines(measured: Speed) -> list[str]:
    lines = [
        "",
        f"Speeds    {SPEED_SCENE}",
        f"          {'':34}{'first s':>9}{'sample s':>10}{'build s':>9}{'photons/s':>12}",
        _speed_line("this device", measured.first_seconds, measured.sample_seconds, measured.build_seconds),
    ]
    lines[-1] += f"{count_text(round(measured.photons_a_second)):>12}"
    lines += [_speed_line(of.device, of.first_seconds, of.sample_seconds, of.build_seconds) for of in PUBLISHED]
    stages = sorted(measured.stage_seconds.items(), key=lambda item: -item[1])
    whole = sum(seconds for _, seconds in stages) or 1.0
    named = ", ".join(f"{name} {seconds / whole:.0%}" for name, seconds in stages if seconds > 0.02 * whole)
    return [*lines, f"          by stage: {named}"]


def _speed_line(name: str, first: float, sample: float, build: float) -> str:
    return f"          {name:34}{first:9.2f}{sample:10.3f}{build:9.4f}"
