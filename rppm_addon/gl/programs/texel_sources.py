# SPDX-License-Identifier: GPL-3.0-or-later
"""Shaders that read, and write, texel buffers in place of storage blocks: their texts are rewritten."""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence

from ..buffers.records import KINDS, Record, stride
from ..buffers.texel_buffers import FORMATS, IMAGES_FOR_LARGE, WRITE_ONLY, TexelBuffer

DEFINE = "TEXEL_BUFFERS"
"""Shaders that are given it declare texel buffers in place of storage blocks of the same names."""
MAX_IMAGES = 16
"""Images of a compute shader that llvmpipe has had at all times."""
_FORMAT_BY_WORDS = {1: "r32ui", 2: "rg32ui", 4: "rgba32ui"}
_WORDS = 4
"""Words of 32 bits in the largest texels."""

_IMAGE = re.compile(
    r"#ifdef\s+(\w+)\s+layout\s*\(\s*(\w+)\s*,\s*binding\s*=\s*(\d+)\s*\)\s*restrict\s+readonly\s+uniform"
    r"\s+u?imageBuffer\s+(\w+)"
)
_ARRAY = (
    r"layout\(std430\)\s*(?:restrict\s+)?%sbuffer\s+(?P<block>\w+)\s*"
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
_LENGTH = re.compile(r"\b(\w+)\s*\.\s*length\b")
_WORD_BEFORE = re.compile(r"\b\w+$")
_MEMBER_BEHIND = re.compile(r"\.(\w+)\[")
_LONGEST_NAME = 64
_MARK = "\0"
"""In place of what is put together later."""


def declared_texel_buffers(text: str, defines: Collection[str]) -> dict[str, TexelBuffer]:
    """Find the texel buffers that a shader declares, by their names, or those of the blocks that they stand for.

    Each is declared behind an ``#ifdef``; defines: the macros that are defined.
    """
    found = _IMAGE.findall(text)
    return {name: TexelBuffer(int(unit), FORMATS[kind]) for macro, kind, unit, name in found if macro in defines}


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
    units = [unit for unit in range(MAX_IMAGES) if unit not in taken]
    large_units = dict(zip(sorted(large), units, strict=False))
    for_words = dict(zip(sorted(large), reversed(units[len(large_units) : IMAGES_FOR_LARGE]), strict=False))
    units = units[len(large_units) :]
    arrays: dict[str, frozenset[str]] = {}
    with_length = frozenset(_LENGTH.findall(text))  # which texel buffers do not have

    def declare(match: re.Match) -> str:
        block, item, array = match["block"], match["item"], match["array"]
        is_wanted = block in large_units or (others and bool(units))
        if not is_wanted or block in found or not (item in Record.registry or item in KINDS):
            return match[0]
        if array in with_length:
            return match[0]
        unit, words = (large_units[block], _WORDS) if block in large_units else (units.pop(0), _words_of_a_texel(item))
        kind = _FORMAT_BY_WORDS[words]
        found[block] = TexelBuffer(unit, FORMATS[kind])
        arrays[array] = _parts(item)
        declaration = f"layout({kind}, binding = {unit}) restrict readonly uniform uimageBuffer {block};"
        return " ".join([declaration, *_fetch_functions(block, item, array, words)])

    for match in _WRITTEN_ARRAY.finditer(text) if large_units else ():
        block, array = match["block"], match["array"]
        if block not in large_units or array in with_length:
            continue
        written = _written(text, match, large_units[block], for_words.get(block))
        if written is not None:
            text, found[block] = written
            if found[block].words_unit is not None:
                arrays[array] = _parts(match["item"])
                units.remove(for_words[block])
    text = _READ_ARRAY.sub(declare, text)
    return _with_calls(text, arrays), found


def _words_of_a_texel(item: str) -> int:
    size = stride(Record.registry.get(item, item))
    return next(words for words in (4, 2, 1) if size % (4 * words) == 0)


def _parts(item: str) -> frozenset[str]:
    """Names of a record's members that are arrays of others."""
    record = Record.registry.get(item)
    return frozenset(member.name for member in record.members if member.count) if record else frozenset()


def _fetch_functions(block: str, item: str, array: str, words: int) -> list[str]:
    """GLSL that gives an item by its number, and of members that are arrays one part, on one line so that line numbers
    stay those of the file."""
    record, size = Record.registry.get(item), _size(item)
    functions = [_fetch_function(block, item, f"fetched_{array}(uint item)", {"item": size}, words)]
    for member in record.members if record else ():
        if member.count:
            head = f"fetched_{array}_{member.name}(uint item, uint part)"
            first = {"item": size, "1": member.offset // 4, "part": _size(member.kind)}
            functions.append(_fetch_function(block, member.kind, head, first, words))
    return functions


def _size(item: str) -> int:
    """Words of an item of an array."""
    return stride(Record.registry.get(item, item)) // 4


def _fetch_function(block: str, item: str, head: str, first: Mapping[str, int], words: int) -> str:
    """first: the word from which on the item lies, as a sum of variables times so many words."""
    size = _size(item)
    if not any(factor % words for factor in (size, *first.values())):
        texel = " + ".join(f"int({name}) * {factor // words}" for name, factor in first.items())
        names = [f"t{word // words}.{'xyzw'[word % words]}" for word in range(size)]
        fetches = f"int first = {texel}; " + " ".join(
            f"uvec4 t{k} = imageLoad({block}, first + {k});" for k in range(size // words)
        )
    else:  # items begin anywhere in texels
        names = [f"t{word}" for word in range(size)]
        word = " + ".join(f"uint({name}) * {factor}u" for name, factor in first.items())
        fetches = f"uint first = {word}; " + " ".join(
            f"uint t{k} = imageLoad({block}, int((first + {k}u) / {words}u))[(first + {k}u) % {words}u];"
            for k in range(size)
        )
    return f"{item} {head} {{ {fetches} return {_made(item, names)}; }}"


def _made(item: str, names: Sequence[str]) -> str:
    """GLSL for a record or a kind, by the names of its words and of those behind."""
    if item not in Record.registry:
        return _value(item, names)
    values = []
    for member in Record.registry[item].members:
        at = names[member.offset // 4 :]
        if member.count:
            parts = (_made(member.kind, at[k * _size(member.kind) :]) for k in range(member.count))
            values.append(f"{member.kind}[{member.count}]({', '.join(parts)})")
        else:
            values.append(_made(member.kind, at))
    return f"{item}({', '.join(values)})"


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
        parts += _fetch_functions(block, item, array, _WORDS)
    parts += [_store_function(name, item, array, words, member) for member in sorted(members, key=str)]
    found = TexelBuffer(unit, FORMATS["rgba32ui"], words_unit=words_unit) if is_read else None
    return text.replace(_MARK, " ".join(parts)), found or TexelBuffer(unit, FORMATS[kind], WRITE_ONLY)


def _store_function(name: str, item: str, array: str, words: int, member: str | None) -> str:
    """GLSL that writes an item, or one of its members, by the item's number, on one line."""
    record, size = Record.registry.get(item), _size(item)
    parts = list(_values_of("value", item))
    value_kind = item
    if member is not None and record is not None:
        (stored,) = [m for m in record.members if m.name == member]
        value_kind = f"{stored.kind}[{stored.count}]" if stored.count else stored.kind
        parts = list(_values_of("value", stored.kind, stored.offset // 4, stored.count))
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


def _values_of(value: str, item: str, first: int = 0, count: int = 0) -> Iterator[tuple[str, str, int]]:
    """Yield GLSL, kind and first word of each value of a record, of an array of count of them, or of a kind."""
    if count:
        for k in range(count):
            yield from _values_of(f"{value}[{k}]", item, first + k * _size(item))
    elif item in Record.registry:
        for m in Record.registry[item].members:
            yield from _values_of(f"{value}.{m.name}", m.kind, first + m.offset // 4, m.count)
    else:
        yield value, item, first


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


def _with_calls(text: str, arrays: Mapping[str, frozenset[str]]) -> str:
    """The text with a call wherever an item of an array is read, in indices of others as well; arrays have the names of
    the members of their items that are arrays themselves."""
    pieces: list[str] = []
    begin = 0
    open_brackets: list[tuple[str, int]] = []  # the array, if it is one of these, and where its call is in the pieces
    for match in _BRACKET.finditer(text):
        at = match.start()
        if match[0] == "[" and at >= begin:
            word = _WORD_BEFORE.search(text, max(begin, at - _LONGEST_NAME), at)
            name = word[0] if word and word[0] in arrays else ""
            open_brackets.append((name, len(pieces) + 1))
            if word and name:
                pieces += [text[begin : word.start()], f"fetched_{name}(uint("]
                begin = match.end()
        elif match[0] == "]":
            name, call = open_brackets.pop()
            if not name:
                continue
            member = _MEMBER_BEHIND.match(text, match.end())
            pieces.append(text[begin:at])
            begin = match.end()
            if member and member[1] in arrays.get(name, ()):
                pieces[call] = f"fetched_{name}_{member[1]}(uint("
                pieces.append("), uint(")
                open_brackets.append((f"{name}.{member[1]}", len(pieces)))
                begin = member.end()
            else:
                pieces.append("))")
    return "".join([*pieces, text[begin:]])
