# SPDX-License-Identifier: GPL-3.0-or-later
"""Uses a real Blender window for so many minutes, and says what grew: tests/gui/window_soak.py.

python tools/soak.py MINUTES: a line of out/soak/soak.jsonl each minute, then a table of it and what is wrong.
python tools/soak.py out/soak/soak.jsonl: the table and what is wrong, of a run that goes on or has ended.
"""

import json
import os
import statistics
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LOG = ROOT / "out/soak/soak.jsonl"
FLAT = {
    "blender_anonymous": 16.0,
    "renderer_anonymous": 16.0,
    "blender_handles": 2,
    "renderer_handles": 2,
    "blender_threads": 2,
    "renderer_threads": 2,
    "processes": 0,
    "shared_blocks": 2,
    "shared": 1.0,
    "temporary_files": 0,
    "temporary_bytes": 1.0,
    "kept_files": 8,
    "kept_bytes": 4.0,
}
"""By how much the middle of a run's last quarter may lie above that of its second; bytes are MiB. In the first
quarter, what is used for the first time is loaded and compiled."""


def read(path: Path) -> list[dict[str, float]]:
    """The lines of a log."""
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def quarters(lines: list[dict[str, float]], name: str) -> list[float]:
    """The median of each quarter of a run."""
    count = len(lines)
    parts = [lines[part * count // 4 : (part + 1) * count // 4] for part in range(4)]
    return [statistics.median(line[name] for line in part) for part in parts if part]


def wrong(lines: list[dict[str, float]]) -> list[str]:
    """List the values that grew, and whatever else was not as it should be."""
    found = []
    for name, allowed in FLAT.items():
        middles = quarters(lines, name)
        if len(middles) == 4 and middles[3] - middles[1] > allowed:
            found.append(f"{name} grew from {middles[1]:g} to {middles[3]:g}")
    if lines[-1]["mismatches"]:
        found.append(f"{lines[-1]['mismatches']} pictures were others")
    if len({line["renderer_pid"] for line in lines}) > 1:
        found.append("the renderer's process was started anew")
    return found


def print_table(lines: list[dict[str, float]]) -> None:
    """Medians of the quarters of a run."""
    last = lines[-1]
    print(f"\n{last['minutes']:.0f} minutes, {last['frames']} frames, {last['animations']} animations", end=", ")
    print(f"{last['stopped']} renders stopped; {last['repeated']} frames compared with the same one before", end=", ")
    print(f"{last['compared']} with a fresh Blender's: {last['mismatches']} mismatches\n")
    print("| MiB, or number | first quarter | second | third | last |\n|---|---|---|---|---|")
    for name in ("blender_resident", "renderer_resident", *FLAT):
        print(f"| {name.replace('_', ' ')} | {' | '.join(f'{middle:g}' for middle in quarters(lines, name))} |")


def main() -> int:
    """Do it; the exit status is 1 where something is wrong."""
    if sys.argv[1].endswith(".jsonl"):
        status, path = 0, Path(sys.argv[1])
    else:
        path = LOG
        command = [sys.executable, "-m", "pytest", "-n", "0", "-q", "--timeout=0"]
        command += ["-o", "python_files=window_soak.py", "tests/gui/window_soak.py"]
        environment = os.environ | {"RPPM_SOAK_MINUTES": sys.argv[1], "RPPM_SOAK_FOLDER": str(path.parent)}
        status = subprocess.run(command, cwd=ROOT, env=environment, check=False).returncode
    lines = read(path)
    print_table(lines)
    found = wrong(lines)
    print(f"\nwrong: {'; '.join(found) or 'nothing'}")
    return 1 if status or found else 0


if __name__ == "__main__":
    sys.exit(main())
