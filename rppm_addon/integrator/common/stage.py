# SPDX-License-Identifier: GPL-3.0-or-later
"""Base class of the stages of an iteration."""

from typing import ClassVar

from ...gl.buffer_sets import BufferSet


class Stage(BufferSet):
    """A stage of the loop in algorithm.py: the programs and the buffers that it declares.

    StageSet holds one object of each stage. A stage that not every scene needs says in ``is_needed`` which do, by their
    StageSizes. Where it is off it has no programs and its buffers are empty; the methods that the loop calls do nothing
    then, and a Listener is not called.
    """

    memory_group: ClassVar[str]
    """Name under which the bytes of its buffers are reported, together with those of other stages."""
