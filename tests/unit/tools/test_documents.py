# SPDX-License-Identifier: GPL-3.0-or-later
"""Documents: links lead somewhere, and files and names that are spoken of exist."""

import re
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
FOLDERS = ("rppm_addon", "shaders", "tests", "tools", "benchmarks", "docs", "extension", ".ci")
DOCUMENTS = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
_LINK = re.compile(r"\]\(([^)\s]+)\)")
_SOURCE = re.compile(r"`([\w./-]+\.(?:py|comp|glsl|frag|vert|sh))`")
_CODE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
_NEW_FILE = re.compile(r"^`(\S+)`\n\n```(?!diff)", re.MULTILINE)
"""Pattern of the new files that the examples of CONTRIBUTING.md make."""


@cache
def files() -> str:
    """Paths of the checkout, each with / before it and a line of its own."""
    found = [path.relative_to(ROOT) for folder in FOLDERS for path in (ROOT / folder).rglob("*") if path.is_file()]
    found += [path.relative_to(ROOT) for path in ROOT.glob("*") if path.is_file()]
    return "".join(f"/{path.as_posix()}\n" for path in found if "__pycache__" not in path.parts)


@cache
def prose(document: Path) -> str:
    return _CODE.sub("", document.read_text(encoding="utf-8"))


@cache
def anchors(document: Path) -> set[str]:
    """Return the anchors of a document's headings, as GitHub makes them."""
    headings = re.findall(r"^#+ (.+)$", prose(document), re.MULTILINE)
    plain = (re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading) for heading in headings)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in plain}


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_links_lead_somewhere(document):
    for link in _LINK.findall(prose(document)):
        if "://" in link or link.startswith("mailto:"):
            continue
        name, _, anchor = link.partition("#")
        target = (document.parent / name).resolve() if name else document
        assert target.exists(), link
        assert not anchor or anchor in anchors(target), link


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_source_files_exist(document):
    made = set(_NEW_FILE.findall(document.read_text(encoding="utf-8")))
    named = set(_SOURCE.findall(prose(document))) - made
    assert [name for name in sorted(named) if f"/{name}\n" not in files()] == []


def test_names_of_the_glossary_are_in_the_code():
    sources = [path for folder in ("rppm_addon", "shaders") for path in (ROOT / folder).rglob("*.[pgcfv]*")]
    suffixes = {".py", ".glsl", ".comp", ".frag", ".vert"}
    code = files() + "".join(path.read_text(encoding="utf-8") for path in sources if path.suffix in suffixes)
    code += (ROOT / "Makefile").read_text(encoding="utf-8").replace("\n", "\nmake ")
    rows = [line.split(" | ") for line in (ROOT / "docs/glossary.md").read_text(encoding="utf-8").splitlines()]
    names = {name for row in rows if len(row) > 2 for name in re.findall(r"`([^`]+)`", row[1])}
    assert len(names) > 50
    assert [name for name in sorted(names) if name.strip("*") not in code] == []


def test_the_site_has_all_documents():
    """In its navigation; `make docs` checks the rest."""
    navigation = (ROOT / "tools" / "site" / "mkdocs.yml").read_text(encoding="utf-8")
    listed = re.findall(r"^\s*- (?:Home: )?(\S+\.md)$", navigation, re.MULTILINE)
    there = [path.relative_to(ROOT / "docs").as_posix() for path in sorted((ROOT / "docs").rglob("*.md"))]
    assert sorted(listed) == sorted([*there, "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md"])


@pytest.mark.parametrize("picture", sorted((ROOT / "docs").rglob("*.png")), ids=lambda path: path.name)
def test_pictures_tell_no_place(picture):
    """Blender writes the file that a picture comes from into it."""
    assert b"File\0" not in picture.read_bytes()
