# SPDX-License-Identifier: GPL-3.0-or-later
"""Storage blocks that programs read through image units, as texel buffers.

llvmpipe fetches the texels of all threads at once, but the words of storage blocks thread by thread, each behind a
branch of its own: of 40 loads it takes 2 s to make code, and more with the square of their number; of 40 fetches
0.1 s. The bits are the same.

And on any driver arrays that are larger than it allows a storage block to be, 128 MiB on some: of texels of 16 bytes
these have 2 GiB.
"""

import ctypes
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import moderngl

from .context import TEXEL_SIZE, Context
from .records import KINDS, Record, stride

DEFINE = "TEXEL_BUFFERS"
"""Shaders that are given it declare texel buffers in place of storage blocks of the same names."""
MOST_IMAGES = 16
"""Images of a compute shader that llvmpipe has had at all times."""
IMAGES_FOR_LARGE = 8
"""And those that every device has: the most arrays of a program that are larger than a storage block."""
MOST_ADDED = TEXEL_SIZE + 256
"""Bytes that allocated_size adds, at most."""
_TEXTURE_BUFFER, _READ_ONLY, _WRITE_ONLY = 0x8C2A, 0x88B8, 0x88B9
_FORMATS = {"r32ui": 0x8236, "rg32ui": 0x823C, "rgba32ui": 0x8D70, "rgba32f": 0x8814}
"""By their names in shaders."""
_FORMAT_BY_WORDS = {1: "r32ui", 2: "rg32ui", 4: "rgba32ui"}
_BYTES = {0x8236: 4, 0x823C: 8, 0x8D70: 16, 0x8814: 16}
"""Of a texel, by format."""
_WORDS = 4
"""Of the largest."""

_IMAGE = re.compile(
    r"layout\s*\(\s*(\w+)\s*,\s*binding\s*=\s*(\d+)\s*\)\s*restrict\s+readonly\s+uniform\s+u?imageBuffer\s+(\w+)"
)
_READ_ARRAY = re.compile(
    r"layout\s*\(\s*std430\s*,\s*binding\s*=\s*\d+\s*\)\s*(?:restrict\s+)?readonly\s+buffer\s+(?P<block>\w+)\s*"
    r"\{\s*(?P<item>\w+)\s+(?P<array>\w+)\s*\[\s*\]\s*;\s*\}\s*;"
)
"""A block that is an array and nothing else, and is only read."""
_WRITTEN_ARRAY = re.compile(_READ_ARRAY.pattern.replace("readonly", "writeonly"))
_ASSIGNMENT = re.compile(r"\s*=(?!=)")
_BRACKET = re.compile(r"//.*|[\[\]]")
"""And comments, whose brackets are none."""
_WORD_BEFORE = re.compile(r"\b\w+$")
_LONGEST_NAME = 64
_MARK = "\0"
"""In place of what is put together later."""


def allocated_size(size: int) -> int:
    """Bytes to allocate for a buffer of so many.

    llvmpipe has code of its own for texel buffers whose size is a power of two, and, as it takes their sizes' bits for
    a texture's levels, for those with zeros in the lowest byte or the one above: other sizes of a scene would have
    programs compiled anew.
    """
    if size & (size - 1) == 0 or size & 0xFF == 0:
        size += TEXEL_SIZE
    return size + 256 if (size >> 8) & 0xFF == 0 else size


@dataclass(frozen=True)
class TexelBuffer:
    """Image unit and GL's format."""

    unit: int
    format: int
    access: int = _READ_ONLY

    @property
    def texel_bytes(self) -> int:
        """Of one texel."""
        return _BYTES[self.format]


def declared_texel_buffers(text: str) -> dict[str, TexelBuffer]:
    """Those that a shader with DEFINE declares, by the names of the blocks that they stand for."""
    return {name: TexelBuffer(int(unit), _FORMATS[kind]) for kind, unit, name in _IMAGE.findall(text)}


def read_as_texels(
    text: str, declared: Mapping[str, TexelBuffer], large: Collection[str] = (), others: bool = True
) -> tuple[str, dict[str, TexelBuffer]]:
    """A shader's text with texel buffers in place of the storage blocks that it only reads, as far as these are arrays
    and there are units, and all of its texel buffers. Those that it has ``declared`` stay.

    ``lights[i]`` becomes ``fetched_lights(i)``, which puts an item together from its texels. They are images and not
    textures: for these llvmpipe has code by the samplers that other programs have left behind as well.
    large: names of blocks whose texels are to be the largest, each of which has the same unit in all shaders of a
    program; such a one may be one that is only written, item by item: ``lights[i] = light;``. others: whether there are
    any besides.
    """
    found = dict(declared)
    taken = {buffer.unit for buffer in declared.values()}
    units = [unit for unit in range(MOST_IMAGES) if unit not in taken]
    large_units = dict(zip(sorted(large), units, strict=False))
    units = units[len(large_units) :]
    arrays: set[str] = set()

    def declare(match: re.Match) -> str:
        block, item, array = match["block"], match["item"], match["array"]
        is_wanted = block in large_units or (others and bool(units))
        if not is_wanted or block in found or not (item in Record.registry or item in KINDS):
            return match[0]
        if re.search(rf"\b{array}\s*\.\s*length\b", text):  # which texel buffers do not tell
            return match[0]
        unit, words = (large_units[block], _WORDS) if block in large_units else (units.pop(0), _words_of_a_texel(item))
        kind = _FORMAT_BY_WORDS[words]
        found[block] = TexelBuffer(unit, _FORMATS[kind])
        arrays.add(array)
        declaration = f"layout({kind}, binding = {unit}) restrict readonly uniform uimageBuffer {block};"
        return f"{declaration} {_fetch_function(block, item, array, words)}"

    for match in _WRITTEN_ARRAY.finditer(text) if large_units else ():
        block, item, array = match["block"], match["item"], match["array"]
        stored = _with_stores(text.replace(match[0], _MARK), array) if block in large_units else None
        if stored is not None:
            words = _words_of_a_texel(item)
            kind, unit = _FORMAT_BY_WORDS[words], large_units[block]
            found[block] = TexelBuffer(unit, _FORMATS[kind], _WRITE_ONLY)
            declaration = f"layout({kind}, binding = {unit}) restrict writeonly uniform uimageBuffer {block};"
            text = stored.replace(_MARK, f"{declaration} {_store_function(block, item, array, words)}")
    text = _READ_ARRAY.sub(declare, text)
    return _with_calls(text, arrays), found


def texel_bytes(item_size: int) -> int:
    """Of the largest texels, so many of which make an item of so many bytes."""
    return next(size for size in (16, 8, 4) if item_size % size == 0)


def _words_of_a_texel(item: str) -> int:
    return texel_bytes(stride(Record.registry.get(item, item))) // 4


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


def _store_function(block: str, item: str, array: str, words: int) -> str:
    """GLSL that writes an item by its number, on one line."""
    record = Record.registry.get(item)
    members = [(f"value.{m.name}", m.kind, m.offset // 4) for m in record.members] if record else [("value", item, 0)]
    written = ["0u"] * (stride(record or item) // 4)
    for name, kind, first in members:
        element, shape, _, _ = KINDS[kind]
        places = [f".{c}" for c in "xyzw"[: sum(shape)]] or [""]
        if kind == "mat4":
            places = [f"[{k // 4}][{k % 4}]" for k in range(16)]
        for k, place in enumerate(places):
            written[first + k] = f"floatBitsToUint({name}{place})" if element == "<f4" else f"uint({name}{place})"
    stores = []
    for texel in range(len(written) // words):
        parts = [*written[words * texel : words * (texel + 1)], *["0u"] * (4 - words)]
        stores.append(f"imageStore({block}, first + {texel}, uvec4({', '.join(parts)}));")
    texels = len(written) // words
    return f"void stored_{array}(uint item, {item} value) {{ int first = int(item) * {texels}; {' '.join(stores)} }}"


def _with_stores(text: str, array: str) -> str | None:
    """The text with a call wherever an item of an array is assigned; None where it stands elsewhere as well."""
    pieces, begin = [], 0
    for match in re.finditer(rf"\b{array}\s*\[", text):
        depth, end = 1, match.end()
        while depth:
            depth += {"[": 1, "]": -1}.get(text[end], 0)
            end += 1
        assignment = _ASSIGNMENT.match(text, end)
        if assignment is None:
            return None
        stop = text.index(";", assignment.end())
        index, value = text[match.end() : end - 1], text[assignment.end() : stop]
        pieces += [text[begin : match.start()], f"stored_{array}(uint({index}),{value})"]
        begin = stop
    return "".join([*pieces, text[begin:]])


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


class TexelBuffers:
    """Binds the texel buffers of a program, by their names."""

    def __init__(self, context: Context, buffers: Mapping[str, TexelBuffer]) -> None:
        self._buffers = dict(buffers)
        unsigned, integer = ctypes.c_uint, ctypes.c_int
        self._generate = context.function("glGenTextures", None, integer, ctypes.POINTER(unsigned))
        self._bind = context.function("glBindTexture", None, unsigned, unsigned)
        self._attach = context.function("glTexBuffer", None, unsigned, unsigned, unsigned)
        self._bind_image = context.function(
            "glBindImageTexture", None, unsigned, unsigned, integer, ctypes.c_ubyte, integer, unsigned, unsigned
        )

    def bind(self, contents: Mapping[str, moderngl.Buffer]) -> None:
        """Have each buffer at its unit."""
        for name, buffer in self._buffers.items():
            texture = self._texture(contents[name], buffer.format)
            self._bind_image(buffer.unit, texture, 0, 0, 0, buffer.access, buffer.format)

    def _texture(self, contents: moderngl.Buffer, number: int) -> int:
        """A buffer's texture of a format, made when it is first asked for."""
        textures = contents.extra = contents.extra or {}
        if number not in textures:
            made = ctypes.c_uint(0)
            self._generate(1, ctypes.byref(made))
            self._bind(_TEXTURE_BUFFER, made.value)
            self._attach(_TEXTURE_BUFFER, number, contents.glo)
            textures[number] = made.value
        return textures[number]


def release_textures(context: Context, contents: moderngl.Buffer) -> None:
    """Free a buffer's textures, which would keep what it has on the device."""
    textures = list((contents.extra or {}).values())
    if textures:
        delete = context.function("glDeleteTextures", None, ctypes.c_int, ctypes.POINTER(ctypes.c_uint))
        delete(len(textures), (ctypes.c_uint * len(textures))(*textures))
        contents.extra = None
