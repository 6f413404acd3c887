# SPDX-License-Identifier: GPL-3.0-or-later
"""Check that docstrings name what they describe.

An editor shows a docstring by itself. One that begins with "Of", "What", "That" or "Those" leaves its reader to guess
what the thing is. Strings below attributes and constants count as docstrings, since editors show these as well.
"""

import ast
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = ("rppm_addon", "extension", "benchmarks", "tools", "tests")
_RIDDLE = re.compile(r"\s*(Of|What|That|Those)\b")


def riddles(text: str) -> list[tuple[int, str]]:
    """Line and first line of each docstring of a module's text that does not begin with a noun or a verb."""
    found = [
        (node.lineno, node.value.value.strip().splitlines()[0])
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
        and _RIDDLE.match(node.value.value)
    ]
    return sorted(found)


def main() -> int:
    """Print the docstrings to be rewritten; returns the exit status."""
    problems = [
        f"{path.relative_to(ROOT)}:{line}: begin with what it is, a noun, or with a verb: {first}"
        for folder in FOLDERS
        for path in sorted((ROOT / folder).rglob("*.py"))
        for line, first in riddles(path.read_text(encoding="utf-8"))
    ]
    print("\n".join(problems) or "docstrings name what they describe")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
