# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that every stage file below shaders/ is valid OpenGL 4.3 core GLSL for glslangValidator.

A file that needs defines names values for them in a comment: ``// lint: RESOLUTION=64 DEPTH=2``; several such lines are
several variants, each checked. Stages that run node graphs are checked with every kind of node, a file of kinds at a
time.
"""

import importlib
import pkgutil
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
STAGES = (".comp", ".vert", ".frag", ".geom")
GENERATED = "materials/generated.glsl"
"""Stands for what the compiler of node graphs writes."""
_LINT = re.compile(r"^\s*//\s*lint:(.*)$", re.MULTILINE)


def register_records() -> None:
    """Import every module without Blender, so that all records known to shaders are declared."""
    sys.path.insert(0, str(ROOT))
    import rppm_addon

    for floor in ("gl", "materials", "integrator"):
        package = importlib.import_module(f"{rppm_addon.__name__}.{floor}")
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            importlib.import_module(module.name)


def node_texts() -> list[str]:
    """The programs of graphs that together have every function of every kind of node."""
    sys.path.insert(0, str(ROOT / "tests"))
    from support.every_node import programs

    return list(programs().values())


def check_shader(file: Path, defines: dict[str, str], generated: str = "") -> str:
    """What glslangValidator has against a stage file; empty when nothing. generated: of a node graph."""
    from rppm_addon.gl.sources import ShaderError, expand

    name = file.relative_to(ROOT / "shaders").as_posix()
    try:
        source = expand(name, defines, {GENERATED: generated} if generated else {})
    except ShaderError as error:
        return str(error)
    try:
        run = subprocess.run(
            ["glslangValidator", "--stdin", "-S", file.suffix[1:]],
            input=source.text,
            capture_output=True,
            text=True,
            timeout=60,
        )
    except FileNotFoundError:
        return "glslangValidator is missing: apt-get install glslang-tools"
    if run.returncode == 0:
        return ""
    lines = [line for line in run.stdout.splitlines() if line.startswith("ERROR: ")]
    return source.name_lines("\n".join(lines[:5]) or run.stdout) + (f" (with {defines})" if defines else "")


def check_shaders() -> tuple[list[str], int]:
    """Problems of all stage files, and how many variants were checked."""
    register_records()
    variants = []
    for file in sorted((ROOT / "shaders").rglob("*")):
        if file.suffix in STAGES:
            text = file.read_text(encoding="utf-8")
            lines = _LINT.findall(text) or [""]
            graphs = node_texts() if GENERATED in text else [""]
            variants += [
                (file, dict(item.partition("=")[::2] for item in line.split()), graph)
                for line in lines
                for graph in graphs
            ]
    with ThreadPoolExecutor(2) as pool:
        results = list(pool.map(lambda variant: check_shader(*variant), variants))
    return [result for result in results if result], len(variants)


def main() -> int:
    """Print the problems; returns the exit status."""
    problems, count = check_shaders()
    for problem in problems:
        print(problem)
    print(f"{count} shader variants: {len(problems) or 'no'} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
