# SPDX-License-Identifier: GPL-3.0-or-later
"""Warnings that say the same of several things, as groups of one line each."""

import itertools
import re
from collections.abc import Iterable
from dataclasses import dataclass, field

from bpy.app.translations import pgettext_iface as iface_

from .export.common.report import listed
from .subjects import SubjectKind

FIND_MISSING_FILES = "file.find_missing_files"
"""Blender's operator that looks for missing files below a folder."""

_KINDS = {
    "Object": SubjectKind.OBJECT,
    "Light": SubjectKind.OBJECT,
    "Camera": SubjectKind.OBJECT,
    "Material": SubjectKind.MATERIAL,
    "World": SubjectKind.WORLD,
}
_START = re.compile(rf'({"|".join(_KINDS)}) "(.+?)": (?:node "(.+?)" (?:\([^()]*\) )?)?')
_IMAGE = re.compile(r'the node needs image "(.+?)"')
_VARIABLE = re.compile(r'".+?"| \((?:no file|[^()]*[/\\.][^()]*)\)|\d[\d,.]*\d|\d')
"""Parts of a text that differ within a group: names, files in parentheses, and numbers."""
_TITLES = (
    (re.compile(r"needs image .* which is missing"), ("{} missing image", "{} missing images"), FIND_MISSING_FILES),
    (re.compile(r"needs image .* cannot read"), ("{} unreadable image", "{} unreadable images"), ""),
    (re.compile(r"has no image "), ("{} texture without an image", "{} textures without an image"), ""),
    (re.compile(r"is a group whose node tree is missing"), ("{} missing node group", "{} missing node groups"), ""),
)
"""Pattern of a warning, the title for one and for several things, and the operator that is the remedy."""
_NO_TITLE = ("", "")


@dataclass(frozen=True)
class WarnedThing:
    """One of the things that a group of warnings is about."""

    label: str
    kind: SubjectKind | None = None
    """Kind of the subject that can be selected; None if there is none."""
    name: str = ""
    """Name of the subject."""
    node: str = ""
    """Name of the node of a material or world; empty if none is named."""


@dataclass
class WarningGroup:
    """Warnings that differ in names and numbers only."""

    identifier: str
    """Text that all of the group share."""
    first: str
    """First of the warnings, as it is."""
    sentence: str
    """Message about all things, with the remedy. Names and numbers that differ are left out."""
    titles: tuple[str, str] = _NO_TITLE
    """Title for one thing and for several, with a place for their number; empty where the sentence is the title."""
    operator: str = ""
    """Operator of Blender that is the remedy; empty if there is none."""
    things: list[WarnedThing] = field(default_factory=list)
    """Things that the warnings are about, each once; empty if none has a name."""
    count: int = 0
    """Number of warnings."""

    @property
    def title(self) -> str:
        """One line: ``12 missing images``, or the beginning of the sentence and how many things it is said of."""
        number = max(len(self.things), 1)
        if self.titles != _NO_TITLE:
            return iface_(self.titles[number > 1]).format(number)
        clause = self.sentence.partition("; ")[0]
        if number > 1:
            return f"{clause[:1].upper()}{clause[1:]} ({number})"
        thing = self.things[0].label if self.things else ""
        return f"{thing}: {clause}" if thing else f"{clause[:1].upper()}{clause[1:]}"


def lines_of(warnings: Iterable[str]) -> list[str]:
    """Return warnings as they are where they stand alone, and as one line with the first names where they are many."""
    return [group.first if group.count == 1 else _line(group) for group in grouped(warnings)]


def _line(group: WarningGroup) -> str:
    clause, _, remedy = group.sentence.partition("; ")
    title = clause[:1].upper() + clause[1:] if group.titles == _NO_TITLE else group.title
    names = f" ({listed(thing.label for thing in group.things)})" if group.things else ""
    return f"{title}{names}; {remedy}" if remedy else f"{title}{names}"


def grouped(warnings: Iterable[str]) -> list[WarningGroup]:
    """Return warnings as groups, in the order in which the groups' first warnings come."""
    groups: dict[str, WarningGroup] = {}
    texts: dict[str, list[str]] = {}
    for warning in warnings:
        match = _START.match(warning)
        text = warning[match.end() :] if match else warning
        known = ((titles, operator) for pattern, titles, operator in _TITLES if pattern.match(text))
        titles, operator = next(known, (_NO_TITLE, ""))
        if match and match[3]:
            text = f"the node {text}"
        identifier = _VARIABLE.sub("...", text)
        texts.setdefault(identifier, []).append(text)
        group = groups.setdefault(identifier, WarningGroup(identifier, warning, text, titles, operator))
        group.count += 1
        thing = _thing(match, text)
        if thing is not None and all(thing.label != other.label for other in group.things):
            group.things.append(thing)
    for identifier, group in groups.items():
        group.sentence = _common(texts[identifier])
    return list(groups.values())


def _common(texts: list[str]) -> str:
    """Return the text of a group's warnings, without the names, files and numbers that differ."""
    fixed = _VARIABLE.split(texts[0])
    variable = zip(*map(_VARIABLE.findall, texts), strict=True)
    parts = [found[0] if len(set(found)) == 1 else "" if found[0].startswith(" ") else "..." for found in variable]
    return "".join(itertools.chain.from_iterable(itertools.zip_longest(fixed, parts, fillvalue="")))


def _thing(match: re.Match | None, text: str) -> WarnedThing | None:
    """Return what a warning is about: the image that it names, or the subject at its beginning and the node."""
    if match is None:
        return None
    kind, name, node = _KINDS[match[1]], match[2], match[3] or ""
    image = _IMAGE.match(text)
    label = image[1] if image else f"{name}, {node}" if node else name
    return WarnedThing(label, kind, name, node)
