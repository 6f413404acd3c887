# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the files: ``python -m tools.beginner_files FOLDER [NAME ...]``."""

import os
import subprocess
import sys
import traceback
from pathlib import Path

import bpy

from . import added, arranged, lit, modified, settings, shaded, simulated, textured  # noqa: F401 (they list their files)
from .files import ALONE, FILES


def main() -> int:
    """Write all files, or those that are named; returns how many could not be made."""
    folder, names = Path(sys.argv[1]).resolve(), sys.argv[2:] or list(FILES)
    folder.mkdir(parents=True, exist_ok=True)
    failures = 0
    for name in names:
        if name in ALONE and len(names) > 1:
            alone = [sys.executable, "-m", __spec__.name, str(folder), name]
            failures += subprocess.run(alone).returncode != 0
            continue
        try:
            FILES[name]()
            bpy.ops.wm.save_as_mainfile(filepath=str(folder / f"{name}.blend"), check_existing=False)
        except Exception:
            traceback.print_exc()
            print(f"{name} could not be made", file=sys.stderr)
            failures += 1
    return failures


if __name__ == "__main__":
    status = main()
    sys.stdout.flush()
    os._exit(min(status, 1))  # a fluid domain aborts Blender's module at its end
