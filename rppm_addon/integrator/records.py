# SPDX-License-Identifier: GPL-3.0-or-later
"""Records that stages hand to each other."""

from ..gl.records import Record

NO_TRIANGLE = 0xFFFFFFFF

RAY = Record("Ray", origin="vec3", source_triangle="uint", direction="vec3", maximum_distance="float")
"""A ray to be traced; maximum_distance <= 0 marks it inactive, source_triangle is never hit."""

HIT = Record("Hit", triangle="uint", b1="float", b2="float", distance="float")
"""What any kind of visibility yields; triangle NO_TRIANGLE is a miss.
The point is (1 - b1 - b2) v0 + b1 v1 + b2 v2."""
