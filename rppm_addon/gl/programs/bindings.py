# SPDX-License-Identifier: GPL-3.0-or-later
"""Binding numbers of storage blocks, parameter blocks, textures and images.

Shaders declare these by name alone, and Python binds them by name. The numbers are written into a source when it is put
together, in the order of the declarations.
"""

import re
from collections.abc import Callable, Mapping

PARAMETERS, ITERATION = "Parameters", "Iteration"
"""Names of the uniform blocks that a program may have."""
UNIFORM_BINDINGS = {PARAMETERS: 0, ITERATION: 1}
"""Bindings of uniform blocks by name: that of a program's own parameters, and that of all stages of an iteration."""

BLOCK_LAYOUT = "layout(std430)"
"""The layout of storage blocks until they are numbered."""

_STORAGE_BLOCK = re.compile(r"layout\(std430\)(?P<rest>[\w\s]*?\bbuffer\s+(?P<name>\w+))")
_UNIFORM_BLOCK = re.compile(r"uniform[^\S\n]+(\w+)[^\S\n]*\{")
_TEXTURE = re.compile(r"(?P<text>uniform[^\S\n]+sampler\w+[^\S\n]+(?P<name>\w+)[^\S\n]*;)")
_IMAGE = re.compile(r"layout\((?P<format>\w+)\)(?= restrict readonly uniform uimageBuffer (?P<name>\w+))")
_NUMBERED_BLOCK = re.compile(r"layout\(std430, binding = (\d+)\)[\w\s]*?\bbuffer\s+(\w+)")
_NUMBERED_TEXTURE = re.compile(r"layout\(binding = (\d+)\) uniform sampler\w+ (\w+)")


def number_images(text: str) -> str:
    """A source with a unit for each image buffer that it declares."""
    return _IMAGE.sub(_numbering({}, "layout({format}, binding = {number})"), text)


def number_bindings(text: str, blocks: Mapping[str, int], textures: Mapping[str, int]) -> str:
    """A source with a binding for each storage block and uniform block, and a unit for each texture.

    blocks, textures: numbers that another stage of the program has given to names. The source keeps them for these
    names, and gives no other name one of them.
    """
    text = _STORAGE_BLOCK.sub(_numbering(blocks, "layout(std430, binding = {number}){rest}"), text)
    text = _UNIFORM_BLOCK.sub(lambda match: f"layout(std140, binding = {UNIFORM_BINDINGS[match[1]]}) {match[0]}", text)
    return _TEXTURE.sub(_numbering(textures, "layout(binding = {number}) {text}"), text)


def _numbering(given: Mapping[str, int], form: str) -> Callable[[re.Match], str]:
    numbers = dict(given)

    def numbered(match: re.Match) -> str:
        taken = numbers.values()
        free = next(number for number in range(len(taken) + 1) if number not in taken)
        return form.format(number=numbers.setdefault(match["name"], free), **match.groupdict())

    return numbered


def numbered_blocks(text: str) -> dict[str, int]:
    """Bindings of the storage blocks of a source that was numbered, by name."""
    return {name: int(binding) for binding, name in _NUMBERED_BLOCK.findall(text)}


def numbered_textures(text: str) -> dict[str, int]:
    """Units of the textures of a source that was numbered, by name."""
    return {name: int(unit) for unit, name in _NUMBERED_TEXTURE.findall(text)}
