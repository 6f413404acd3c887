# SPDX-License-Identifier: GPL-3.0-or-later
"""Storage blocks that programs read through image units, as texel buffers.

llvmpipe fetches the texels of all threads at once, but the words of storage blocks thread by thread, each behind a
branch of its own: of 40 loads it takes 2 s to make code, and more with the square of their number; of 40 fetches
0.1 s. The bits are the same.

And on any driver arrays that are larger than it allows a storage block to be, 128 MiB on some: of texels of 16 bytes
these have 2 GiB.
"""

import ctypes
from collections.abc import Mapping
from dataclasses import dataclass

import moderngl

from ..context.context import TEXEL_SIZE, Context

IMAGES_FOR_LARGE = 8
"""Images that every device has: the most arrays of a program that may be larger than a storage block."""
MAX_ADDED = TEXEL_SIZE + 256
"""Bytes that allocated_size adds, at most."""
_TEXTURE_BUFFER, _READ_ONLY, WRITE_ONLY = 0x8C2A, 0x88B8, 0x88B9
FORMATS = {"r32ui": 0x8236, "rg32ui": 0x823C, "rgba32ui": 0x8D70, "rgba32f": 0x8814}
"""By their names in shaders."""
_BYTES = {0x8236: 4, 0x823C: 8, 0x8D70: 16, 0x8814: 16}
"""Bytes of a texel, by format."""


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
    """Image unit, GL's format, and access; and the unit through which single words are written, if they are."""

    unit: int
    format: int
    access: int = _READ_ONLY
    words_unit: int | None = None

    @property
    def texel_bytes(self) -> int:
        """Bytes of the smallest texels that the buffer is bound with."""
        return _BYTES[self.format] if self.words_unit is None else _BYTES[FORMATS["r32ui"]]


class TexelBuffers:
    """Binds the texel buffers of a program, by their names."""

    def __init__(self, context: Context, buffers: Mapping[str, TexelBuffer]) -> None:
        unsigned, integer, numbers = ctypes.c_uint, ctypes.c_int, ctypes.POINTER(ctypes.c_uint)
        self._generate = context.function("glGenTextures", None, integer, numbers)
        self._bind = context.function("glBindTexture", None, unsigned, unsigned)
        self._attach = context.function("glTexBuffer", None, unsigned, unsigned, unsigned)
        self._bind_image = context.function(
            "glBindImageTexture", None, unsigned, unsigned, integer, ctypes.c_ubyte, integer, unsigned, unsigned
        )
        self._bind_images = context.function("glBindImageTextures", None, unsigned, integer, numbers)
        read_only = {name: buffer for name, buffer in buffers.items() if buffer.words_unit is None}
        self._together = read_only if context.is_software and context.has_multi_bind else {}
        """Buffers that are bound by one call: on llvmpipe six calls take longer than many a dispatch."""
        self._others = {name: buffer for name, buffer in buffers.items() if name not in self._together}
        units = [buffer.unit for buffer in self._together.values()]
        self._first = min(units, default=0)
        self._textures = (unsigned * (max(units) - self._first + 1 if units else 0))()
        """Textures by unit from the first on; 0 at units that the program does not have."""

    def bind(self, contents: Mapping[str, moderngl.Buffer]) -> None:
        """Have each buffer at its unit."""
        for name, buffer in self._others.items():
            texture = self._texture(contents[name], buffer.format)
            self._bind_image(buffer.unit, texture, 0, 0, 0, buffer.access, buffer.format)
            if buffer.words_unit is not None:
                words = FORMATS["r32ui"]
                texture = self._texture(contents[name], words)
                self._bind_image(buffer.words_unit, texture, 0, 0, 0, WRITE_ONLY, words)
        if self._together:
            for name, buffer in self._together.items():
                self._textures[buffer.unit - self._first] = self._texture(contents[name], buffer.format)
            self._bind_images(self._first, len(self._textures), self._textures)

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
