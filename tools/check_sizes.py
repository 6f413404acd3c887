# SPDX-License-Identifier: GPL-3.0-or-later
"""Check that files, folders and classes stay small enough to have one subject.

A reader finds a subject by its name: in a folder of few files, in a file of few screens, in a class of few attributes.
"""

import ast
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = ("rppm_addon", "extension", "benchmarks", "tools", "tests")
MAX_LINES = 450
"""Lines of a file."""
MAX_FILES = 16
"""Python files of a folder."""
MAX_ATTRIBUTES = 15
"""Attributes of a class: its own and those of its instances."""
TABLES = {
    "RenderSettings": "each setting is declared once, with its range, unit and texts",
    "Light": "a light's record holds the members of all kinds of lights",
    "Instance": "an instance lists all that a mesh may have anew in each place",
    "Scene": "a scene lists all that a render needs",
}
"""Dataclasses that list what a format has, by name, with the reason why they are not split."""


def attributes(node: ast.ClassDef) -> set[str]:
    """Names of the fields of a class and of the attributes that its methods assign to self."""
    fields = {
        item.target.id for item in node.body if isinstance(item, ast.AnnAssign) and isinstance(item.target, ast.Name)
    }
    assigned = {
        item.attr
        for item in ast.walk(node)
        if isinstance(item, ast.Attribute)
        and isinstance(item.ctx, ast.Store)
        and isinstance(item.value, ast.Name)
        and item.value.id == "self"
    }
    return fields | assigned


def large_classes(text: str) -> list[tuple[int, str, int]]:
    """Line, name and number of attributes of each class of a module's text that has too many."""
    classes = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.ClassDef) and node.name not in TABLES]
    counted = [(node.lineno, node.name, len(attributes(node))) for node in classes]
    return sorted(entry for entry in counted if entry[2] > MAX_ATTRIBUTES)


def problems(root: Path) -> list[str]:
    """Descriptions of all files, folders and classes below a folder that are too large."""
    found = []
    paths = [path for folder in FOLDERS for path in sorted((root / folder).rglob("*.py"))]
    for folder in sorted({path.parent for path in paths}):
        count = sum(path.parent == folder for path in paths)
        if count > MAX_FILES:
            found.append(
                f"{folder.relative_to(root)}: {count} Python files, {MAX_FILES} at most; give subjects folders"
            )
    for path in paths:
        text, name = path.read_text(encoding="utf-8"), path.relative_to(root)
        lines = text.count("\n")
        if lines > MAX_LINES:
            found.append(f"{name}: {lines} lines, {MAX_LINES} at most; split it by subject")
        found += [
            f"{name}:{line}: {kind} has {count} attributes, {MAX_ATTRIBUTES} at most; compose it of parts"
            for line, kind, count in large_classes(text)
        ]
    return found


def main() -> int:
    """Print what is too large; returns the exit status."""
    found = problems(ROOT)
    print("\n".join(found) or "files, folders and classes are small")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
