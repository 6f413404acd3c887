# SPDX-License-Identifier: GPL-3.0-or-later
"""Device limits that programs need beyond what OpenGL 4.3 promises, by OpenGL's names of the limits.

The numbers follow from the shaders' declarations; a test computes them anew. Of all else they need less than every
device has: work groups of 1024 invocations, 16 texture units, textures of 16384 texels a side, and 8 images, for
arrays that are larger than a storage block (texel_buffers.py). Software drivers alone are given more.
"""

from collections.abc import Mapping
from typing import Any

from ...scene.errors import DeviceError

NEEDS: Mapping[str, tuple[int, str]] = {
    "GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS": (16, "storage blocks in a compute shader"),
    "GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS": (9, "storage blocks in a fragment shader"),
    "GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS": (5, "storage blocks in a vertex shader"),
    "GL_MAX_COMBINED_SHADER_STORAGE_BLOCKS": (16, "storage blocks in a program"),
    "GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS": (16, "bindings of storage blocks"),
}
"""Smallest sufficient values of limits, with their names."""


def refuse_small_devices(name: str, limits: Mapping[str, Any]) -> None:
    """Raise DeviceError where a device has less than programs need. What a driver does not report counts as enough."""
    for limit, (needed, words) in NEEDS.items():
        offered = int(limits.get(limit, needed))
        if offered < needed:
            raise DeviceError(
                f"the device {name} offers {offered} {words} and RPPM needs {needed}; "
                "install a newer driver, or choose another device"
            )
