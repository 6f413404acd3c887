# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's ray visibility."""

import bpy

from ....scene import RayVisibility

_CAMERA, _DIFFUSE, _GLOSSY, _TRANSMISSION, _SHADOW, _VOLUME_SCATTER = map(int, RayVisibility)
_OF_BITS = [RayVisibility(bits) for bits in range(int(RayVisibility.ALL) + 1)]


def visibility_of(source: bpy.types.Object) -> RayVisibility:
    """The rays that see an object."""
    # Written out: it is asked of thousands of objects.
    return _OF_BITS[
        _CAMERA * source.visible_camera
        + _DIFFUSE * source.visible_diffuse
        + _GLOSSY * source.visible_glossy
        + _TRANSMISSION * source.visible_transmission
        + _SHADOW * source.visible_shadow
        + _VOLUME_SCATTER * source.visible_volume_scatter
    ]


def is_seen(visibility: RayVisibility) -> bool:
    """Return whether any rays see an object but those that a volume has scattered, which see no surfaces."""
    return visibility._value_ & ~_VOLUME_SCATTER != 0


def common_visibility(first: RayVisibility, second: RayVisibility) -> RayVisibility:
    """The rays that are among both."""
    # A flag's own operator takes several times as long.
    return _OF_BITS[first._value_ & second._value_]
