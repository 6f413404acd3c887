# SPDX-License-Identifier: GPL-3.0-or-later
"""House rules that ruff does not know: licence lines, which floor imports which, and GLSL.

Every stage file below shaders/ must be valid OpenGL 4.3 core GLSL for glslangValidator. A file that
needs defines names values for them in a comment: ``// lint: RESOLUTION=64 DEPTH=2``; several such
lines are several variants, each checked. Stages that run node graphs are checked with every kind of
node, a file of kinds at a time.
"""

import ast
import importlib
import pkgutil
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LICENCE = "SPDX-License-Identifier: GPL-3.0-or-later"
FLOORS = ("scene", "gl", "materials", "integrator", "session", "blender")
"""Bottom to top: a floor imports itself and those before it."""
ROOMS = {"pictures": "gl", "commands": "session", "cli": "session"}
"""Modules beside the floors, and the highest floor that they may import."""
STAGES = (".comp", ".vert", ".frag", ".geom")
GENERATED = "materials/generated.glsl"
"""Stands for what the compiler of node graphs writes."""
_LINT = re.compile(r"^\s*//\s*lint:(.*)$", re.MULTILINE)


def tracked_files() -> list[Path]:
    """Files that git tracks or would track."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listing = subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    names = {name for name in listing.stdout.decode().split("\0") if name}
    return sorted(ROOT / name for name in names if (ROOT / name).is_file())


def check_licence_lines(files: list[Path]) -> list[str]:
    """Source files say their licence in the first lines (after #! or #version)."""
    suffixes = {".py", ".glsl", ".sh", ".toml", *STAGES}
    wanted = [file for file in files if file.suffix in suffixes or file.name in ("Makefile", "run")]
    return [
        f"{file.relative_to(ROOT)}: no line '{LICENCE}' at the top"
        for file in wanted
        if LICENCE not in "\n".join(file.read_text(encoding="utf-8").splitlines()[:2])
    ]


def imported_modules(node: ast.AST, package: list[str]) -> list[str]:
    """Absolute dotted names that an import statement in ``package`` names."""
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    if isinstance(node, ast.ImportFrom):
        base = package[: len(package) - node.level + 1] if node.level else []
        base = base + (node.module.split(".") if node.module else [])
        return [".".join([*base, alias.name]) for alias in node.names]
    return []


def is_above(names: list[str], floor: str | None) -> bool:
    """Whether a dotted name lies on a floor above ``floor``."""
    if floor is None or len(names) < 2 or names[0] != "rppm_addon" or names[1] not in FLOORS:
        return False
    return FLOORS.index(names[1]) > FLOORS.index(floor)


def check_imports(files: list[Path]) -> list[str]:
    """Imports point down, and only rppm_addon/blender imports bpy (commands do inside functions)."""
    problems = []
    for file in files:
        parts = list(file.relative_to(ROOT).with_suffix("").parts)
        if file.suffix != ".py" or parts[0] != "rppm_addon" or len(parts) < 2:
            continue
        place = parts[1]
        floor = place if place in FLOORS else ROOMS.get(place)
        tree = ast.parse(file.read_text(encoding="utf-8"))
        late = {
            id(node)
            for function in ast.walk(tree)
            if isinstance(function, ast.FunctionDef | ast.AsyncFunctionDef)
            for node in ast.walk(function)
        }
        for node in ast.walk(tree):
            for name in imported_modules(node, parts[:-1]):
                where = f"{file.relative_to(ROOT)}:{node.lineno}"
                names = name.split(".")
                if names[0] in ("bpy", "bmesh", "mathutils", "gpu") and place != "blender":
                    if place != "commands" or id(node) not in late:
                        problems.append(f"{where}: imports {names[0]}; only rppm_addon/blender may")
                elif is_above(names, floor):
                    problems.append(f"{where}: {place} imports {names[1]}, which lies above it")
    return problems


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
    from every_node import programs

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


def check_shaders(files: list[Path]) -> tuple[list[str], int]:
    """Problems of all stage files, and how many variants were checked."""
    register_records()
    variants = []
    for file in files:
        if file.suffix in STAGES and file.is_relative_to(ROOT / "shaders"):
            lines = _LINT.findall(file.read_text(encoding="utf-8")) or [""]
            texts = node_texts() if GENERATED in file.read_text(encoding="utf-8") else [""]
            variants += [
                (file, dict(item.partition("=")[::2] for item in line.split()), text)
                for line in lines
                for text in texts
            ]
    with ThreadPoolExecutor(2) as pool:
        results = list(pool.map(lambda variant: check_shader(*variant), variants))
    return [result for result in results if result], len(variants)


def main() -> int:
    files = tracked_files()
    shader_problems, shader_count = check_shaders(files)
    problems = check_licence_lines(files) + check_imports(files) + shader_problems
    for problem in problems:
        print(problem)
    print(f"{len(files)} files, {shader_count} shader variants: {len(problems) or 'no'} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
