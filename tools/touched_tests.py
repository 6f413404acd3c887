# SPDX-License-Identifier: GPL-3.0-or-later
"""Print the tests whose long ones a change asks for: ``python tools/touched_tests.py [commit]``, since that commit.

Without one, since the branch left main, or on main since the commit before. A changed test, or a module of tests, asks
for the test files that import it; all else asks for folders by the room that it is in (``ROOMS``), as nearly all tests
import nearly all of the package. Nothing is printed where git knows no history. Of more than CI has time for, only
the test files that were themselves changed are printed, if they are few: ``make test-long`` is for the rest.
"""

import ast
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
MOST_FILES = 6
"""With long tests, that CI has time for."""
PARITY = ("cameras", "geometry", "lights", "materials", "media", "nodes", "passes", "skies", "transport")
"""Folders of tests/parity but for features, whose rows take as long as all of them."""
PICTURES = ("tests/gl", *(f"tests/parity/{room}" for room in PARITY))
ROOMS: dict[str, tuple[str, ...]] = {
    "shaders/materials/": ("tests/gl/surfaces/test_closures.py", "tests/parity"),
    "rppm_addon/materials/": ("tests/gl/surfaces/test_closures.py", "tests/parity"),
    "rppm_addon/blender/export/": ("tests/blender", "tests/parity"),
    "rppm_addon/blender/": ("tests/blender",),
    "shaders/": PICTURES,
    "rppm_addon/gl/": PICTURES,
    "rppm_addon/integrator/": PICTURES,
    "rppm_addon/scene/": (*PICTURES, "tests/blender"),
    "rppm_addon/session/": ("tests/session", "tests/cli", "tests/farm", "tests/blender"),
    "rppm_addon/commands/": ("tests/cli", "tests/farm"),
    "benchmarks/": ("tests/benchmarks",),
}
"""Test files and folders by the beginning of a changed path; the first that fits counts."""


def touched(changed: list[str], root: Path = ROOT) -> list[str]:
    """Test files of the checkout, sorted, that changed paths ask for."""
    files = {path.relative_to(root).as_posix(): path for path in (root / "tests").rglob("*.py")}
    files = {name: path for name, path in files.items() if not name.startswith(("tests/gui/", "tests/versions/"))}
    found: set[str] = set()
    for name in changed:
        patterns = next((asked for room, asked in ROOMS.items() if name.startswith(room)), ())
        for pattern in patterns:
            found |= {
                path.relative_to(root).as_posix()
                for given in root.glob(pattern)
                for path in (given.rglob("test_*.py") if given.is_dir() else [given])
            }
    found |= _importing({name for name in changed if name in files}, files)
    kept = {Path(name).stem for name in changed if name.startswith("tests/parity/references/")}
    found |= {name for name in files if name.startswith("tests/parity/") and Path(name).stem in kept}
    return sorted(name for name in found if Path(name).name.startswith("test_"))


def _importing(modules: set[str], files: dict[str, Path]) -> set[str]:
    """The modules of tests and those that import them, one by way of another.

    Modules are known in their folder and below, those of tests/support in all and those of tests/parity there; a
    conftest.py counts for its folder.
    """
    imports = {name: _imported(path) for name, path in files.items()}
    found, new = set(modules), set(modules)
    while new:
        more = set()
        for module in new:
            path = Path(module)
            for_all = path.stem == "conftest"
            room = "tests/" if path.parent.name == "support" else f"{path.parent.as_posix()}/"
            if room.startswith("tests/parity/") and not for_all:
                room = "tests/parity/"
            more |= {name for name in files if name.startswith(room) and (for_all or path.stem in imports[name])}
        new = more - found
        found |= more
    return found


def _imported(path: Path) -> set[str]:
    """Last names of the modules that a file imports, and of what it imports from them."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name.rpartition(".")[2] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names |= {(node.module or "").rpartition(".")[2], *(alias.name for alias in node.names)}
    return names


def _git(*arguments: str) -> str | None:
    result = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=False)
    return result.stdout.strip() if result.returncode == 0 else None


def changed_since(commit: str | None) -> list[str]:
    """Paths that differ from a commit, uncommitted ones too; empty where git cannot tell."""
    head = _git("rev-parse", "HEAD")
    base = commit or _git("merge-base", "HEAD", "origin/main") or _git("merge-base", "HEAD", "main")
    if commit is None and base == head:
        base = _git("rev-parse", "--verify", "--quiet", "HEAD^")
    if head is None or not base:
        print("no history: no long tests are chosen", file=sys.stderr)
        return []
    return (_git("diff", "--name-only", base) or "").splitlines()


def bounded(names: list[str], changed: list[str], root: Path = ROOT) -> list[str]:
    """List the files that have long tests; of too many, the files that were changed, if these are few."""
    long = [name for name in names if "mark.long" in (root / name).read_text(encoding="utf-8")]
    if len(long) <= MOST_FILES:
        return long
    own = [name for name in long if name in changed]
    kept = own if len(own) <= MOST_FILES else []
    print(
        f"the change asks for the long tests of {len(long)} files, of which {len(kept)} run: run make test-long",
        file=sys.stderr,
    )
    return kept


if __name__ == "__main__":
    changed_files = changed_since(sys.argv[1] if len(sys.argv) > 1 else None)
    print(" ".join(bounded(touched(changed_files), changed_files)))
