# SPDX-License-Identifier: GPL-3.0-or-later
"""Buffers that programs read through texture units, in texels of 16 bytes.

llvmpipe fetches a texel of each thread without a branch, but the words of storage blocks thread by thread.
"""

import ctypes
from collections.abc import Mapping

import moderngl

from .context import Context

DEFINE = "TEXEL_BUFFERS"
"""Shaders that are given it declare texel buffers in place of storage blocks of the same names."""
TEXEL_SIZE = 16
_TEXTURE_BUFFER, _TEXTURE0, _MAX_TEXTURE_BUFFER_SIZE = 0x8C2A, 0x84C0, 0x8C2B
_FORMATS = {"samplerBuffer": 0x8814, "usamplerBuffer": 0x8D70}
"""GL_RGBA32F and GL_RGBA32UI by the type of the sampler."""


def most_texels(context: Context) -> int:
    """Texels that one texel buffer may span."""
    return context.integers(_MAX_TEXTURE_BUFFER_SIZE)[0]


class TexelBuffers:
    """The texel buffers of a program: ``units``, the texture unit and type of sampler by name."""

    def __init__(self, context: Context, units: Mapping[str, tuple[int, str]]) -> None:
        self._units = dict(units)
        unsigned, names = ctypes.c_uint, ctypes.POINTER(ctypes.c_uint)
        self._delete = context.function("glDeleteTextures", None, ctypes.c_int, names)
        self._activate = context.function("glActiveTexture", None, unsigned)
        self._bind = context.function("glBindTexture", None, unsigned, unsigned)
        self._attach = context.function("glTexBuffer", None, unsigned, unsigned, unsigned)
        self._textures = (ctypes.c_uint * len(self._units))()
        context.function("glGenTextures", None, ctypes.c_int, names)(len(self._units), self._textures)

    def bind(self, buffers: Mapping[str, moderngl.Buffer]) -> None:
        """Attach each buffer to its unit: a buffer that grew is another one."""
        for texture, (name, (unit, sampler)) in zip(self._textures, self._units.items(), strict=True):
            self._activate(_TEXTURE0 + unit)
            self._bind(_TEXTURE_BUFFER, texture)
            self._attach(_TEXTURE_BUFFER, _FORMATS[sampler], buffers[name].glo)

    def release(self) -> None:
        """Free the textures; the buffers stay."""
        self._delete(len(self._textures), self._textures)
