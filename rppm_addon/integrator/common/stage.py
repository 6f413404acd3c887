# SPDX-License-Identifier: GPL-3.0-or-later
"""Base class of the stages of an iteration."""

from typing import ClassVar

from ...gl.buffer_sets import BufferSet


class Stage(BufferSet):
    """A stage of the loop in algorithm.py: its programs, and the buffers that it declares.

    StageSet holds one object of each stage.
    """

    memory_group: ClassVar[str]
    """Name under which the bytes of its buffers are reported, together with those of other stages."""
