# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the files: ``python -m tools.combined_files FOLDER [--seeds 0-6] [KIND ...]``."""

import argparse
import sys
import traceback
from pathlib import Path

import bpy

from . import (  # noqa: F401 (they list their kinds)
    characters,
    corridors,
    crowds,
    landscapes,
    motion,
    products,
    rooms,
    shaders,
    still_lifes,
)
from .draws import Draws
from .oddities import files, strangers  # noqa: F401 (they list their kinds)
from .scenes import KINDS, begin


def seeds(words: str) -> list[int]:
    """The seeds of a range with both ends, or of a single number."""
    first, _, last = words.partition("-")
    return list(range(int(first), int(last or first) + 1))


def build(kind: str, seed: int) -> None:
    """Open the file of a kind and a seed, always the same."""
    begin()
    KINDS[kind](Draws(f"{kind} {seed}"))


def main() -> int:
    """Write a file of each kind, or of those that are named, for each seed; returns how many could not be made."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], prog="python -m tools.combined_files")
    parser.add_argument("folder", type=Path)
    parser.add_argument("kinds", nargs="*", metavar="KIND", choices=[[], *KINDS])
    parser.add_argument("--seeds", type=seeds, default=seeds("0-7"), help="a number or a range")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    failures = 0
    for kind in options.kinds or KINDS:
        for seed in options.seeds:
            try:
                build(kind, seed)
                target = options.folder.resolve() / f"{kind}_{seed}.blend"
                bpy.ops.wm.save_as_mainfile(filepath=str(target), check_existing=False)
            except Exception:
                traceback.print_exc()
                print(f"{kind} with seed {seed} could not be made", file=sys.stderr)
                failures += 1
    return failures


if __name__ == "__main__":
    sys.exit(min(main(), 1))
