# SPDX-License-Identifier: GPL-3.0-or-later
"""Saves a .blend file with equal settings for both renderers: ``... adapters.staged SOURCE TARGET WIDTHxHEIGHT``."""

import os
import sys
from pathlib import Path

import bpy

import rppm_addon
from tools.pairs import staging
from tools.pairs.settings import Effort, equalize


def main(source: Path, target: str, resolution: str) -> None:
    """Open the source and save what both renderers are given; paths in it become absolute."""
    rppm_addon.register()
    bpy.ops.wm.open_mainfile(filepath=str(source), load_ui=False, use_scripts=False)
    staging.stage(source)
    width, height = map(int, resolution.split("x"))
    equalize(bpy.context.scene, Effort((width, height), samples=1, cycles_samples=1, seconds=0.0))
    bpy.ops.file.make_paths_absolute()
    bpy.ops.wm.save_as_mainfile(filepath=target, check_existing=False)


if __name__ == "__main__":
    main(Path(sys.argv[1]), *sys.argv[2:])
    sys.stdout.flush()
    os._exit(0)  # an engine that is registered may hang Blender at its exit
