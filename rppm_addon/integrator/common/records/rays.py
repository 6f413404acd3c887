# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays, their hits, and shadow rays."""

from ....gl.buffers.constants import Constants
from ....gl.buffers.records import Record
from ....gl.buffers.storage_blocks import StorageBlock
from ....scene.meshes import RayVisibility

NO_TRIANGLE = 0xFFFFFFFF
INFINITY_DISTANCE = 1e30
"""Meters, of rays that may go on for ever."""
Constants("Distances", NO_TRIANGLE=NO_TRIANGLE, INFINITY_DISTANCE=INFINITY_DISTANCE)
Constants("RayVisibility", RAY=RayVisibility)
RAY = Record("Ray", origin="vec3", source_triangle="uint", direction="vec3", maximum_distance="float")
"""A ray to be traced; maximum_distance <= 0 marks it inactive, source_triangle is never hit."""
StorageBlock("Rays", "Ray rays[];")
StorageBlock("ShadowRays", "Ray shadow_rays[];")
HIT = Record("Hit", triangle="uint", b1="float", b2="float", distance="float")
"""Hit of a ray, as any kind of visibility yields it; triangle NO_TRIANGLE is a miss.
The point is (1 - b1 - b2) v0 + b1 v1 + b2 v2."""
StorageBlock("Hits", "Hit hits[];")
StorageBlock("Visibility", "uint visibility[];")
"""Visibility of shadow rays: 1 where nothing is in the way."""
StorageBlock("Contributions", "vec4 contributions[];")
StorageBlock("LightTriangles", "uint light_triangles[];")
"""Radiance that shadow rays add where nothing is in their way, with a signed code (shaders/common/light_sets.glsl) of
whether a gathering ray found it and of the light's LightLink; and the emissive triangles that the shadow rays go to."""
