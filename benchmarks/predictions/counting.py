# SPDX-License-Identifier: GPL-3.0-or-later
"""Shaders that count what they ask of memory: invocations, reads, writes and atomics of each storage block.

An index of a block's array goes through a function that counts it, an atomic function through a macro that does. What
an invocation has counted it adds to a texel buffer as it ends; that needs no storage block, of which some shaders have
all that there are.
"""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from rppm_addon.gl.buffers.records import KINDS

UNIT = 15
"""Image unit of the texel buffer that takes the counts."""
_BLOCK = re.compile(r"\bbuffer\s+(\w+)\s*\{([^}]*)\}\s*;")
_MEMBER = re.compile(r"(\w+)\s+(\w+)\s*(\[[^\]]*\])?\s*;")
_VERSION = re.compile(r"^\s*#\s*version\b.*$", re.MULTILINE)
_MAIN = re.compile(r"\bvoid\s+main\s*\(\s*(?:void)?\s*\)")
_ATOMIC = re.compile(r"\b(atomic(?:Add|Min|Max|And|Or|Xor|Exchange|CompSwap))\s*\(")
_BEHIND = re.compile(r"\s*((?:\.\s*\w+(?:\[[^\]]*\])?)*)\s*(=(?!=)|[-+*/|&^]=)?")
_COUNTED_BEFORE = re.compile(r"COUNTED_ATOMIC_\d+\(\w+,\s*$")
_STRUCT = re.compile(r"\bstruct\s+(\w+)\s*\{([^}]*)\}")
_INDEX = re.compile(r"\[[^\]]*\]")
_ARRAY = re.compile(r"(\w+)\[(\w+)\]")
_COMMENT = re.compile(r"//[^\n]*")


@dataclass(frozen=True)
class Site:
    """Invocations or memory accesses that a counter counts."""

    kind: str
    """invocations, read, write, atomic (of an array's item) or counter (an atomic of a single word)."""
    block: str = ""
    size: int = 0
    """Bytes of each."""


def counted(text: str, first: int) -> tuple[str, list[Site]]:
    """A shader that counts in the texel buffer's words from ``first`` on, one for each of the sites.

    The text is expanded (gl/programs/sources.py), without texel buffers of its own.
    """
    text = _COMMENT.sub("", text)
    arrays, words = _members(text)
    sites = [Site("invocations")]

    def number(site: Site) -> int:
        if site not in sites:
            sites.append(site)
        return sites.index(site)

    text = _with_counted_atomics(text, arrays, words, number)
    text = _with_counted_items(text, arrays, number)
    counters = "".join(
        f"uint counted_{k} = 0u; uint counted_item_{k}(uint item) {{ counted_{k} += 1u; return item; }}\n"
        f"#define COUNTED_ATOMIC_{k}(function, memory, value) (counted_{k} += 1u, function(memory, value))\n"
        for k in range(len(sites))
    )
    text = _VERSION.sub(lambda match: f"{match[0]}\n{counters}", text, count=1)
    adding = " ".join(
        f"if (counted_{k} != 0u) imageAtomicAdd(access_counts, {first + k}, counted_{k});" for k in range(len(sites))
    )
    declared = f"layout(r32ui, binding = {UNIT}) uniform uimageBuffer access_counts;"
    text = text.replace("discard;", "{ end_counting(); discard; }")
    text = _VERSION.sub(lambda match: f"{match[0]}\nvoid end_counting();\n", text, count=1)
    text = _MAIN.sub("void counted_main()", text)
    return f"{text}\n{declared}\nvoid end_counting() {{ {adding} }}\n" + (
        "void main() { counted_0 += 1u; counted_main(); end_counting(); }\n"
    ), sites


def _members(text: str) -> tuple[dict[str, tuple[str, str]], dict[str, str]]:
    """Block and item's type by the name of an array, and block by the name of a member that is none."""
    arrays: dict[str, tuple[str, str]] = {}
    words: dict[str, str] = {}
    for block, members in _BLOCK.findall(text):
        for kind, name, brackets in _MEMBER.findall(members):
            if brackets:
                arrays[name] = block, kind
            else:
                words[name] = block
    return arrays, words


def _with_counted_atomics(
    text: str, arrays: Mapping[str, tuple[str, str]], words: Mapping[str, str], number: Callable[[Site], int]
) -> str:
    """Atomics of other memory, which is that of a work group, stay."""

    def count(match: re.Match) -> str:
        target = re.match(r"\s*(\w+)\s*(\[)?", text[match.end() :])
        name = target[1] if target else ""
        if name in arrays:
            site = Site("atomic", arrays[name][0], 4)
        elif name in words:
            site = Site("counter", words[name], 4)
        else:
            return match[0]
        return f"COUNTED_ATOMIC_{number(site)}({match[1]}, "

    return _ATOMIC.sub(count, text)


def _with_counted_items(text: str, arrays: dict[str, tuple[str, str]], number: Callable[[Site], int]) -> str:
    structs = {name: dict(_kinds_and_names(members)) for name, members in _STRUCT.findall(text)}
    inserted: list[tuple[int, str]] = []
    for name, start, opening, closing in _items(text, arrays):
        block, kind = arrays[name]
        behind = _BEHIND.match(text, closing + 1)
        member, assignment = behind.groups() if behind else ("", None)
        if _COUNTED_BEFORE.search(text, max(0, start - 60), start):
            continue
        size = _size(kind, re.findall(r"\w+|\[", _INDEX.sub("[", member)), structs)
        counters = [number(Site("write", block, size))] if assignment else []
        if assignment != "=":
            counters.append(number(Site("read", block, size)))
        inserted.append((opening + 1, "".join(f"counted_item_{k}(" for k in counters) + "uint("))
        inserted.append((closing, ")" * (len(counters) + 1)))
    made, begin = [], 0
    for place, piece in sorted(inserted, key=lambda pair: pair[0]):
        made += [text[begin:place], piece]
        begin = place
    return "".join([*made, text[begin:]])


def _items(text: str, arrays: Iterable[str]) -> Iterator[tuple[str, int, int, int]]:
    """Where an item of an array is named: its name and place, the opening bracket's place and the closing one's."""
    bodies = [match.span() for match in _BLOCK.finditer(text)]
    names = "|".join(arrays) or "(?!)"
    for match in re.finditer(rf"(?<![.\w])({names})\s*\[", text):
        if any(low <= match.start() < high for low, high in bodies):
            continue
        depth, place = 1, match.end()
        while depth:
            depth += {"[": 1, "]": -1}.get(text[place], 0)
            place += 1
        yield match[1], match.start(), match.end() - 1, place - 1


def _kinds_and_names(members: str) -> list[tuple[str, str]]:
    return [(name, kind + brackets) for kind, name, brackets in _MEMBER.findall(members)]


def _size(kind: str, named: Sequence[str], structs: Mapping[str, Mapping[str, str]]) -> int:
    """Bytes of an item, or of the member or the components of it that are named; "[" is one of an array."""
    array = _ARRAY.fullmatch(kind)
    if array and named[:1] == ["["]:
        return _size(array[1], named[1:], structs)
    if array:
        return int(array[2]) * _size(array[1], (), structs)
    if kind not in KINDS and named:
        return _size(structs[kind][named[0]], named[1:], structs)
    if kind not in KINDS:
        return sum(_size(member, (), structs) for member in structs[kind].values())
    if named and re.fullmatch(r"[xyzwrgba]{1,4}", named[0]):
        return 4 * len(named[0])
    return KINDS[kind][3]
