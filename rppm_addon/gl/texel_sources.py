# SPDX-License-Identifier: GPL-3.0-or-later
"""Shaders that read, and write, texel buffers in place of storage blocks: their texts are rewritten."""

import re
from collections.abc import Collection, Mapping, Sequence

from .records import KINDS, Record, stride
from .texel_buffers import FORMATS, IMAGES_FOR_LARGE, WRITE_ONLY, TexelBuffer

DEFINE = "TEXEL_BUFFERS"
"""Shaders that are given it declare texel buffers in place of storage blocks of the same names."""
MOST_IMAGES = 16
"""Images of a compute shader that llvmpipe has had at all times."""
_FORMAT_BY_WORDS = {1: "r32ui", 2: "rg32ui", 4: "rgba32ui"}
_WORDS = 4
"""Of the largest texels."""

_IMAGE = re.compile(
    r"layout\s*\(\s*(\w+)\s*,\s*binding\s*=\s*(\d+)\s*\)\s*restrict\s+readonly\s+uniform\s+u?imageBuffer\s+(\w+)"
)
_ARRAY = (
    r"layout\s*\(\s*std430\s*,\s*binding\s*=\s*\d+\s*\)\s*(?:restrict\s+)?%sbuffer\s+(?P<block>\w+)\s*"
    r"\{\s*(?P<item>\w+)\s+(?P<array>\w+)\s*\[\s*\]\s*;\s*\}\s*;"
)
"""A block that is an array and nothing else."""
_READ_ARRAY = re.compile(_ARRAY % r"readonly\s+")
_WRITTEN_ARRAY = re.compile(_ARRAY % r"(?P<access>writeonly\s+|)")
_ASSIGNMENT = re.compile(r"\s*(?:\.\s*(?P<member>\w+)\s*)?=(?!=)")
_OTHER_CHANGE = re.compile(r"\s*(?:\.\s*\w+\s*)*(?:(?:[-+*/%|&^]|<<|>>)?=(?!=)|\+\+|--)")
_CHANGE_BEFORE = re.compile(r"(?:\batomic\w+\s*\(|\+\+|--)\s*$")
_BRACKET = re.compile(r"//.*|[\[\]]")
"""And comments, whose brackets are none."""
_WORD_BEFORE = re.compile(r"\b\w+$")
_LONGEST_NAME = 64
_MARK = "\0"
"""In place of what is put together later."""


def declared_texel_buffers(text: str) -> dict[str, TexelBuffer]:
    """Those that a shader with DEFINE declares, by the names of the blocks that they stand for."""
    return {name: TexelBuffer(int(unit), FORMATS[kind]) for kind, unit, name in _IMAGE.findall(text)}


def read_as_texels(
    text: str, declared: Mapping[str, TexelBuffer], large: Collection[str] = (), others: bool = True
) -> tuple[str, dict[str, TexelBuffer]]:
    """A shader's text with texel buffers in place of the storage blocks that it only reads, as far as these are arrays
    and there are units, and all of its texel buffers. Those that it has ``declared`` stay.

    ``lights[i]`` becomes ``fetched_lights(i)``, which puts an item together from its texels. They are images and not
    textures: for these llvmpipe has code by the samplers that other programs have left behind as well.
    large: names of blocks whose texels are to be the largest, each of which has the same unit in all shaders of a
    program; such a one may be written as well, ``lights[i] = light;`` or ``lights[i].color = color;``, but not by
    atomic operations. others: whether there are any besides.
    """
    found = dict(declared)
    taken = {buffer.unit for buffer in declared.values()}
    units = [unit for unit in range(MOST_IMAGES) if unit not in taken]
    large_units = dict(zip(sorted(large), units, strict=False))
    for_words = dict(zip(sorted(large), reversed(units[len(large_units) : IMAGES_FOR_LARGE]), strict=False))
    units = units[len(large_units) :]
    arrays: set[str] = set()

    def declare(match: re.Match) -> str:
        block, item, array = match["block"], match["item"], match["array"]
        is_wanted = block in large_units or (others and bool(units))
        if not is_wanted or block in found or not (item in Record.registry or item in KINDS):
            return match[0]
        if _asks_for_length(text, array):
            return match[0]
        unit, words = (large_units[block], _WORDS) if block in large_units else (units.pop(0), _words_of_a_texel(item))
        kind = _FORMAT_BY_WORDS[words]
        found[block] = TexelBuffer(unit, FORMATS[kind])
        arrays.add(array)
        declaration = f"layout({kind}, binding = {unit}) restrict readonly uniform uimageBuffer {block};"
        return f"{declaration} {_fetch_function(block, item, array, words)}"

    for match in _WRITTEN_ARRAY.finditer(text) if large_units else ():
        block, array = match["block"], match["array"]
        if block not in large_units or _asks_for_length(text, array):
            continue
        written = _written(text, match, large_units[block], for_words.get(block))
        if written is not None:
            text, found[block] = written
            if found[block].words_unit is not None:
                arrays.add(array)
                units.remove(for_words[block])
    text = _READ_ARRAY.sub(declare, text)
    return _with_calls(text, arrays), found


def _asks_for_length(text: str, array: str) -> bool:
    """Of the array, which texel buffers do not tell."""
    return re.search(rf"\b{array}\s*\.\s*length\b", text) is not None


def _words_of_a_texel(item: str) -> int:
    size = stride(Record.registry.get(item, item))
    return next(words for words in (4, 2, 1) if size % (4 * words) == 0)


def _fetch_function(block: str, item: str, array: str, words: int) -> str:
    """GLSL that gives an item by its number, on one line so that line numbers stay those of the file."""
    record = Record.registry.get(item)
    members = [(member.kind, member.offset // 4) for member in record.members] if record else [(item, 0)]
    size = stride(record or item) // 4
    if size % words == 0:
        names = [f"t{word // words}.{'xyzw'[word % words]}" for word in range(size)]
        fetches = f"int first = int(item) * {size // words}; " + " ".join(
            f"uvec4 t{k} = imageLoad({block}, first + {k});" for k in range(size // words)
        )
    else:  # items begin anywhere in texels
        names = [f"t{word}" for word in range(size)]
        fetches = f"uint first = item * {size}u; " + " ".join(
            f"uint t{k} = imageLoad({block}, int((first + {k}u) / {words}u))[(first + {k}u) % {words}u];"
            for k in range(size)
        )
    values = ", ".join(_value(kind, names[first:]) for kind, first in members)
    made = f"{item}({values})" if record else values
    return f"{item} fetched_{array}(uint item) {{ {fetches} return {made}; }}"


def _value(kind: str, names: Sequence[str]) -> str:
    """GLSL for a member, by the names of its words and of those behind."""
    if kind == "mat4":
        return f"mat4({', '.join(_value('vec4', names[4 * k :]) for k in range(4))})"
    element, _, _, size = KINDS[kind]
    count = size // 4
    parts = names[:count]
    bits = parts[0] if count == 1 else f"uvec{count}({', '.join(parts)})"
    if element == "<f4":
        return f"uintBitsToFloat({bits})"
    return f"{kind}({bits})"


def _written(text: str, declaration: re.Match, unit: int, words_unit: int | None) -> tuple[str, TexelBuffer] | None:
    """The text with an array that is written as texels, which are single words where only some of an item are, or the
    array is read as well; None where that cannot be. Reads are left as they are."""
    block, item, array = declaration["block"], declaration["item"], declaration["array"]
    is_read = not declaration["access"]
    stores = _with_stores(text.replace(declaration[0], _MARK), array, is_read)
    if stores is None or (is_read and words_unit is None):
        return None
    text, members = stores
    words = 1 if is_read or members - {None} else _words_of_a_texel(item)
    kind = _FORMAT_BY_WORDS[words]
    name, written_unit = (f"{block}Words", words_unit) if is_read else (block, unit)
    parts = [f"layout({kind}, binding = {written_unit}) writeonly uniform uimageBuffer {name};"]
    if is_read:
        parts += [f"layout(rgba32ui, binding = {unit}) readonly uniform uimageBuffer {block};"]
        parts += [_fetch_function(block, item, array, _WORDS)]
    parts += [_store_function(name, item, array, words, member) for member in sorted(members, key=str)]
    found = TexelBuffer(unit, FORMATS["rgba32ui"], words_unit=words_unit) if is_read else None
    return text.replace(_MARK, " ".join(parts)), found or TexelBuffer(unit, FORMATS[kind], WRITE_ONLY)


def _store_function(name: str, item: str, array: str, words: int, member: str | None) -> str:
    """GLSL that writes an item, or one of its members, by the item's number, on one line."""
    record, size = Record.registry.get(item), stride(Record.registry.get(item, item)) // 4
    parts = [(f"value.{m.name}", m.kind, m.offset // 4) for m in record.members] if record else [("value", item, 0)]
    value_kind = item
    if member is not None and record is not None:
        ((value_kind, first),) = [(m.kind, m.offset // 4) for m in record.members if m.name == member]
        parts = [("value", value_kind, first)]
    written: dict[int, str] = {} if words == 1 else dict.fromkeys(range(size), "0u")
    for value, kind, first in parts:
        written |= {first + k: word for k, word in enumerate(_words_of(value, kind))}
    stores = [
        f"imageStore({name}, first + {texel}, uvec4("
        + ", ".join([written.get(words * texel + k, "0u") if k < words else "0u" for k in range(4)])
        + "));"
        for texel in dict.fromkeys(word // words for word in sorted(written))
    ]
    body = " ".join([f"int first = int(item * {size // words}u);", *stores])
    return f"void {_stored(array, member)}(uint item, {value_kind} value) {{ {body} }}"


def _stored(array: str, member: str | None) -> str:
    return f"stored_{array}" if member is None else f"stored_{array}_{member}"


def _words_of(value: str, kind: str) -> list[str]:
    """GLSL of the words of a value."""
    element, shape, _, _ = KINDS[kind]
    places = [f"[{k // 4}][{k % 4}]" for k in range(16)] if kind == "mat4" else [f".{c}" for c in "xyzw"[: sum(shape)]]
    cast = "floatBitsToUint" if element == "<f4" else "uint"
    return [f"{cast}({value}{place})" for place in places or [""]]


def _with_stores(text: str, array: str, is_read: bool) -> tuple[str, set[str | None]] | None:
    """The text with a call wherever an item of an array, or a member of one, is assigned, and those members, None for
    all of an item; None where it is changed in another way, or read though it is not to be."""
    pieces, begin = [], 0
    members: set[str | None] = set()
    for match in re.finditer(rf"\b{array}\s*\[", text):
        line = text.rfind("\n", 0, match.start()) + 1
        if "//" in text[line : match.start()]:
            continue
        depth, end = 1, match.end()
        while depth:
            depth += {"[": 1, "]": -1}.get(text[end], 0)
            end += 1
        assignment = _ASSIGNMENT.match(text, end)
        if assignment is None:
            changes = _OTHER_CHANGE.match(text, end) or _CHANGE_BEFORE.search(text, line, match.start())
            if changes or not is_read:
                return None
            continue
        stop = text.index(";", assignment.end())
        index, value, member = text[match.end() : end - 1], text[assignment.end() : stop], assignment["member"]
        members.add(member)
        pieces += [text[begin : match.start()], f"{_stored(array, member)}(uint({index}),{value})"]
        begin = stop
    return "".join([*pieces, text[begin:]]), members


def _with_calls(text: str, arrays: set[str]) -> str:
    """The text with a call wherever an item of an array is read, in indices of others as well."""
    pieces: list[str] = []
    begin, closing = 0, []
    for match in _BRACKET.finditer(text):
        replaced, at = "", match.start()
        if match[0] == "[":
            word = _WORD_BEFORE.search(text, max(begin, at - _LONGEST_NAME), at)
            if word and word[0] in arrays:
                at, replaced = word.start(), f"fetched_{word[0]}(uint("
            closing.append("))" if replaced else "")
        elif match[0] == "]":
            replaced = closing.pop()
        if replaced:
            pieces += [text[begin:at], replaced]
            begin = match.end()
    return "".join([*pieces, text[begin:]])
