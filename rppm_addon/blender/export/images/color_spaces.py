# SPDX-License-Identifier: GPL-3.0-or-later
"""Color spaces of image files, as Blender's color management decodes them."""

import tempfile
from pathlib import Path

import bpy
import numpy as np

from ....scene.common.working_space import REC709, WORKING_SPACES, WorkingSpace

WHITE_IN_CYCLES = {"Rec.2100-HLG": 2.03, "Rec.2100-PQ": 2.03}
"""By space, how much brighter Cycles takes images than Blender itself: 100 nits are 1, not 203."""


def working_space() -> WorkingSpace:
    """The file's working space; Rec.709 in a Blender that has no other (before 5.0)."""
    management = getattr(bpy.data, "colorspace", None)
    return WORKING_SPACES.get(getattr(management, "working_space", ""), REC709)


def scene_linear(colors: np.ndarray, space: str) -> np.ndarray:
    """(height, width, 3) float32 colors of a space that Blender knows, as the scene's linear ones.

    Python cannot ask Blender for a conversion, but Blender makes one when it reads a file of floats.
    """
    import OpenEXR  # late: Blender loads this module when it starts

    height, width = colors.shape[:2]
    planes = {name: np.ascontiguousarray(colors[::-1, :, k], np.float32) for k, name in enumerate("RGB")}
    header = {"compression": OpenEXR.NO_COMPRESSION, "type": OpenEXR.scanlineimage}
    with tempfile.TemporaryDirectory(prefix="rppm_") as folder:
        path = str(Path(folder) / "colors.exr")
        OpenEXR.File(header, planes).write(path)
        image = bpy.data.images.load(path)
        try:
            image.colorspace_settings.name = space
            flat = np.empty(height * width * image.channels, np.float32)
            image.pixels.foreach_get(flat)
        finally:
            bpy.data.images.remove(image)
    return flat.reshape(height, width, -1)[..., :3]
