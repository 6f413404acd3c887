# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders .blend files with RPPM and with Cycles and compares them: ``python -m tools.pairs FOLDER [NAME ...]``.

Each file is rendered by a process of its own, which gets a time limit, so that one that fails or hangs is a line of
the table and the others go on. Both renderers have equal settings (settings.py) and render two pictures each, whose
difference is their noise. OUT gets the pictures (NAME.npz, NAME.png), what was said (NAME.json) and sheet_NN.png, all
of them together; what is there already is not rendered again. A line tells of a file:

    mean       RPPM's mean over Cycles', and its standard error
    median     of the ratios of blocks of 8 x 8 pixels
    off        share of blocks that are 10 % off beyond noise
    FLIP       of the pictures, and of Cycles' two pictures
    first      seconds to RPPM's first picture, export included
    warnings   how many RPPM gave
    and what Cycles gets wrong, where the scene shows it (suspects.py)
"""

import argparse
import json
import os
import signal
import subprocess
import sys
from dataclasses import asdict
from pathlib import Path

import numpy as np
import PIL.Image

from .figures import figures_of
from .settings import Effort
from .sheets import pair_image, sheet

ROOT = Path(__file__).resolve().parents[2]
STAGE = "@stage "
SHEET = (3, 12)
"""Columns and rows of a sheet."""
HEADER = f"{'file':32} {'mean':>14} {'median':>7} {'off':>6} {'FLIP':>13} {'first':>6} {'warnings':>8}"


def render(source: Path, target: Path, effort: Effort, values: list[str], limit: float) -> str:
    """Render a file in a process of its own; returns what went wrong, empty when nothing."""
    told = json.dumps({"effort": asdict(effort), "values": values})
    command = [sys.executable, "-m", "tools.pairs.worker", str(source), str(target), told]
    log = Path(f"{target}.log")
    with log.open("w", encoding="utf-8") as output:
        process = subprocess.Popen(command, cwd=ROOT, stdout=output, stderr=subprocess.STDOUT, start_new_session=True)
        try:
            status = process.wait(limit)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            return f"no end after {limit:.0f} s, {stage_of(log)}"
    if status == 0:
        return ""
    lines = [line for line in log.read_text(encoding="utf-8", errors="replace").splitlines() if line.strip()]
    return f"{stage_of(log)}: {lines[-1] if status == 1 and lines else f'exit status {status}'}"


def stage_of(log: Path) -> str:
    """Where a worker was when its log ends."""
    lines = log.read_text(encoding="utf-8", errors="replace").splitlines()
    return next((line.removeprefix(STAGE) for line in reversed(lines) if line.startswith(STAGE)), "starting")


def finished(target: Path) -> dict | None:
    """The report of an earlier run about a file, or None where that is not complete."""
    report = Path(f"{target}.json")
    if not report.exists():
        return None
    found = json.loads(report.read_text(encoding="utf-8"))
    return found if "failed" in found or Path(f"{target}.npz").exists() else None


def line_of(name: str, report: dict) -> str:
    """A file's line of the table."""
    if "failed" in report:
        return f"{name:32} FAILED {report['failed']}"
    figures = report["figures"]
    return (
        f"{name:32} {figures['mean']:7.4f} ±{figures['error']:6.4f} {figures['median']:7.4f} {figures['off']:6.1%} "
        f"{figures['flip']:.3f} ({figures['flip_of_noise']:.3f}) {report['first_picture_seconds']:5.1f}s "
        f"{len(report['warnings']):8}" + "".join(f"  Cycles: {suspect}" for suspect in report["suspects"])
    )


def compare(source: Path, target: Path, options: argparse.Namespace) -> dict:
    """The report of a file, rendered if it must be."""
    report = finished(target)
    if report is None:
        for old in (".json", ".npz", ".png"):
            Path(f"{target}{old}").unlink(missing_ok=True)
        effort = Effort(options.resolution, options.samples, options.cycles_samples, options.seconds)
        problem = render(source, target, effort, options.set, options.limit)
        written = Path(f"{target}.json")
        report = {"failed": problem} if problem else json.loads(written.read_text(encoding="utf-8"))
    if "failed" not in report:
        with np.load(Path(f"{target}.npz")) as pictures:
            ours, theirs = pictures["ours"], pictures["theirs"]
        report["figures"] = asdict(figures_of(ours, theirs))
        pair_image(ours.mean(axis=0), theirs.mean(axis=0)).save(Path(f"{target}.png"))
    Path(f"{target}.json").write_text(json.dumps(report, indent=2), encoding="utf-8")
    return report


def write_sheets(folder: Path, reports: dict[str, dict]) -> None:
    """All pairs, those that differ most first."""
    shown = [name for name, report in reports.items() if "failed" not in report]
    shown.sort(key=lambda name: -difference(reports[name]))
    per_sheet = SHEET[0] * SHEET[1]
    for number, start in enumerate(range(0, len(shown), per_sheet)):
        names = shown[start : start + per_sheet]
        images = [PIL.Image.open(folder / f"{name}.png") for name in names]
        labels = [f"{name} {reports[name]['figures']['mean']:.3f}" for name in names]
        sheet(images, labels, SHEET[0]).save(folder / f"sheet_{number:02}.png")


def difference(report: dict) -> float:
    """The distance of a pair's pictures, to sort by: FLIP above noise and blocks that are off."""
    figures = report["figures"]
    return figures["flip"] - figures["flip_of_noise"] + figures["off"]


def parsed() -> argparse.Namespace:
    """The options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], prog="python -m tools.pairs")
    parser.add_argument("scenes", type=Path, help="a folder of .blend files")
    parser.add_argument("names", nargs="*", help="files without .blend; none given: all in the folder")
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "pairs")
    parser.add_argument("--set", action="append", default=[], metavar="PATH=VALUE", help="for both, as of rppm render")
    parser.add_argument("--resolution", type=lambda text: tuple(map(int, text.split("x"))), help="default: the file's")
    parser.add_argument("--samples", type=int, default=64, help="of RPPM")
    parser.add_argument("--cycles-samples", type=int, default=128)
    parser.add_argument("--seconds", type=float, default=60.0, help="longest time of each of the four pictures")
    parser.add_argument("--limit", type=float, default=600.0, help="seconds after which a file is given up")
    return parser.parse_args()


def main() -> int:
    """Compare all files; returns the exit status, 1 where one failed."""
    options = parsed()
    options.out.mkdir(parents=True, exist_ok=True)
    reports = {}
    print(HEADER)
    for name in options.names or sorted(path.stem for path in options.scenes.glob("*.blend")):
        source = (options.scenes / f"{name}.blend").resolve()
        reports[name] = compare(source, (options.out / name).resolve(), options)
        print(line_of(name, reports[name]), flush=True)
    write_sheets(options.out, reports)
    return int(any("failed" in report for report in reports.values()))


if __name__ == "__main__":
    sys.exit(main())
