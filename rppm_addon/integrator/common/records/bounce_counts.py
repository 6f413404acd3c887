# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of bounces by type, for limits of each type and for nodes that ask for them."""

from ....gl.buffers.constants import Constants
from ....scene.settings import MOST_COUNTED_BOUNCES

COUNT_BITS = MOST_COUNTED_BOUNCES.bit_length()
"""Bits of a count. A word holds four, in the order of Scatter: diffuse and glossy reflection, transmission, and a place
that is free."""
Constants("BounceCounting", COUNT_BITS=COUNT_BITS)
