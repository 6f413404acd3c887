# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that every stage file below shaders/ is valid OpenGL 4.3 core GLSL for glslangValidator, that none numbers a
binding, and how long lines and functions are.

A file that needs defines names values for them in a comment: ``// lint: RESOLUTION=64 DEPTH=2``; several such lines are
several variants, each checked. Stages that run node graphs are checked with every kind of node, a file of kinds at a
time.
"""

import re
import subprocess
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from support.shader_declarations import Variant, variants  # noqa: E402

from rppm_addon.gl.buffers.texel_buffers import IMAGES_FOR_LARGE  # noqa: E402
from rppm_addon.gl.programs.sources import SHADER_FOLDER, ShaderError  # noqa: E402

COLUMNS = 120
FUNCTION_LINES = 60
_NUMBER = re.compile(r"\bbinding\s*=")
_FUNCTION = re.compile(r"^\w+ (\w+)\([^;{]*\{$.*?^\}$", re.MULTILINE | re.DOTALL)
"""Functions begin and end with the lines of theirs that are not indented."""


def long_lines() -> list[str]:
    """Lines of shaders that are longer than COLUMNS."""
    return [
        f"{path.relative_to(SHADER_FOLDER).as_posix()}:{number}: {len(line)} columns, {COLUMNS} at most"
        for path in sorted(SHADER_FOLDER.rglob("*.*"))
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        if len(line) > COLUMNS
    ]


def long_functions(text: str) -> list[tuple[str, int, int]]:
    """Functions of a shader that are longer than FUNCTION_LINES: name, number of the first line, lines."""
    found = (
        (match[1], text.count("\n", 0, match.start()) + 1, match[0].count("\n") + 1)
        for match in _FUNCTION.finditer(text)
    )
    return [function for function in found if function[2] > FUNCTION_LINES]


def numbers() -> list[str]:
    """Declarations with a number, which follows from their order (rppm_addon/gl/programs/bindings.py)."""
    return [
        f"{path.relative_to(SHADER_FOLDER).as_posix()}:{number}: leave the binding out; Python binds by name"
        for path in sorted(SHADER_FOLDER.rglob("*.*"))
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        if _NUMBER.search(line)
    ]


def lengths() -> list[str]:
    """List lines and functions of shaders that are too long."""
    functions = [
        f"{path.relative_to(SHADER_FOLDER).as_posix()}:{line}: {name} has {lines} lines, {FUNCTION_LINES} at most"
        for path in sorted(SHADER_FOLDER.rglob("*.*"))
        for name, line, lines in long_functions(path.read_text(encoding="utf-8"))
    ]
    return [*long_lines(), *functions]


LARGE = {
    *("Triangles", "Attributes", "TrianglesBefore", "TrianglesAfter", "AttributeValues", "ShadingInstances"),
    *("Positions", "CornerVertices", "CornerNormals", "CornerUvs", "TriangleCorners", "TriangleSlots", "Instances"),
    *("Materials", "MaterialData", "Images", "Texels", "EmissiveTriangles", "LightNodes"),
    *("BvhNodes", "OverlapJobs", "NewFragments", "OldFragments", "BinnedFragments"),
    *("Photons", "Closures", "SortedPhotons"),
}
"""Blocks whose buffers may be larger than a storage block (gl/buffers/buffers.py)."""
BY_RANGES = {
    ("surfaces/geometry/gather.comp", "Triangles"),
    ("surfaces/geometry/gather.comp", "Attributes"),
    ("lights/mark.comp", "Triangles"),
}
"""Which these programs are given a part of at a time."""


def large_blocks(variant: Variant) -> list[str]:
    """List the blocks of a shader that may be large, as many as a program may have at once."""
    try:
        blocks = variant.expand().blocks
    except ShaderError:
        return []
    return sorted(name for name in LARGE & blocks.keys() if (variant.name, name) not in BY_RANGES)[:IMAGES_FOR_LARGE]


def check_shader(variant: Variant, reads_texels: bool, large: Sequence[str] = ()) -> str:
    """Return glslangValidator's errors for a stage file; empty when none. large: blocks that are to be texels."""
    try:
        source = variant.expand(reads_texels, large, whole=True)
    except ShaderError as error:
        return str(error)
    if stay := source.blocks.keys() & set(large):
        return f"{variant.name}: {', '.join(sorted(stay))} cannot be larger than a storage block"
    try:
        run = subprocess.run(
            ["glslangValidator", "--stdin", "-S", Path(variant.name).suffix[1:]],
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
    defines = f" (with {variant.defines})" if variant.defines else ""
    return source.name_lines("\n".join(lines[:5]) or run.stdout) + defines


def check_shaders() -> tuple[list[str], int]:
    """Problems of all stage files, and how many variants were checked."""
    # Programs of compute shaders alone read texels.
    checked: list[tuple[Variant, bool, Sequence[str]]] = [(variant, False, ()) for variant in variants()]
    checked += [(variant, True, ()) for variant, *_ in checked if variant.name.endswith(".comp")]
    checked += [(variant, False, large) for variant in variants() if (large := large_blocks(variant))]
    with ThreadPoolExecutor(2) as pool:
        results = list(pool.map(check_shader, *zip(*checked, strict=True)))
    return [*numbers(), *lengths(), *(result for result in results if result)], len(checked)


def main() -> int:
    """Print the problems; returns the exit status."""
    problems, count = check_shaders()
    for problem in problems:
        print(problem)
    print(f"{count} shader variants: {len(problems) or 'no'} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
