# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes in which things move, rendered blurred and at moments."""

import bpy
import numpy as np
from support.moving import FRAME, taken_scene

from rppm_addon.session.render.renderer import Renderer

from ..engines import render_cycles


def render_blurred(renderer: Renderer, seeds: int = 3, **settings: object) -> np.ndarray:
    """(seeds, height, width, 3) float64 pictures by RPPM, row 0 at the bottom."""
    scene = taken_scene()
    assert scene.shutter is not None and scene.warnings == []
    pictures = []
    for seed in range(seeds):
        scene.settings = scene.settings.with_values(seed=seed, **settings)
        pictures.append(renderer.render(scene).frame.combined[..., :3].astype(np.float64))
    return np.array(pictures)


def cycles_at_moments(samples: int, times: np.ndarray, seeds: int = 2) -> np.ndarray:
    """Brute force: the mean of Cycles without blur, at times from FRAME, in frames. Ends at FRAME, with blur."""
    scene = bpy.context.scene
    scene.render.use_motion_blur = False
    pictures = []
    for time in times:
        whole = int(np.floor(FRAME + time))
        scene.frame_set(whole, subframe=FRAME + time - whole)
        pictures.append(render_cycles(samples, seeds))
    scene.render.use_motion_blur = True
    scene.frame_set(FRAME)
    return np.mean(pictures, axis=0)
