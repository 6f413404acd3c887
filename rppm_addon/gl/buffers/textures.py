# SPDX-License-Identifier: GPL-3.0-or-later
"""Kinds of textures that programs sample, declared beside what fills them."""

from collections.abc import Sequence
from typing import ClassVar

import moderngl


class TextureKind:
    """Linearly filtered RGBA textures by the names of their samplers: drivers compile programs for such kinds."""

    by_sampler: ClassVar[dict[str, "TextureKind"]] = {}

    def __init__(self, samplers: Sequence[str], dtype: str, repeats: tuple[bool, bool]) -> None:
        """dtype: moderngl's, ``f4`` or ``f2``; repeats: in x and in y, else the border goes on."""
        self._dtype = dtype
        self._repeats = repeats
        self.by_sampler.update(dict.fromkeys(samplers, self))

    def make(self, gl: moderngl.Context, size: tuple[int, int], data: bytes | None = None) -> moderngl.Texture:
        """A texture of columns and rows."""
        texture = gl.texture(size, 4, data, dtype=self._dtype)
        texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        texture.repeat_x, texture.repeat_y = self._repeats
        return texture
