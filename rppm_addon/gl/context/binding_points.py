# SPDX-License-Identifier: GPL-3.0-or-later
"""Binding points of a context, and what they hold: what is bound already is not bound again."""

from collections.abc import Mapping
from typing import Any

import moderngl


class BindingPoints:
    """Indexed binding points of a context for storage blocks and uniform blocks.

    All programs of the context bind through it. A released buffer leaves its binding point, and no program is given it
    again.
    """

    def __init__(self) -> None:
        self._storage: dict[int, moderngl.Buffer] = {}
        self._uniform: dict[int, moderngl.Buffer] = {}
        self.images: dict[int, tuple[int, int]] = {}
        """By image unit, the texture and the access that it has; emptied whenever a texture is freed, whose name may be
        given anew."""

    def bind_storage(self, bindings: Mapping[str, int], buffers: Mapping[str, Any]) -> None:
        """Bind buffers, or ranges of them, as storage blocks. Raises KeyError where one is missing.

        bindings: by the names of the blocks.
        """
        bound = self._storage
        for name, binding in bindings.items():
            block = buffers[name]
            if bound.get(binding) is block:
                continue
            block.bind_to_storage_buffer(binding)
            if isinstance(block, moderngl.Buffer):
                bound[binding] = block
            else:  # the buffer of a range may be replaced by another one
                bound.pop(binding, None)

    def bind_uniform(self, binding: int, buffer: moderngl.Buffer) -> None:
        """Bind a buffer as a uniform block."""
        if self._uniform.get(binding) is not buffer:
            buffer.bind_to_uniform_block(binding)
            self._uniform[binding] = buffer
