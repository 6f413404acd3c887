# SPDX-License-Identifier: GPL-3.0-or-later
"""Cycles' settings of light paths, and passes of light beside those of Cycles."""

import bpy
import numpy as np

from rppm_addon.scene.passes import PASSES, SCATTERED_LIGHT
from rppm_addon.session.render.renderer import Renderer

from ..comparison import Tolerance, compare
from ..engines import FIRST_SEED, cycles_channels, render_frame

OF_PASSES = Tolerance(mean=0.03, block=0.09, mode=0.03)
"""Passes have more noise than pictures, since each has a part of the light."""
_SEEDS = 2


def limit(**values: object) -> None:
    """Set Cycles' settings by name."""
    for name, value in values.items():
        setattr(bpy.context.scene.cycles, name, value)


def compare_light_passes(renderer: Renderer, name: str, samples: int, **settings: object) -> None:
    """Render the current Blender scene with both engines and assert that the passes of light agree, each times the
    color that it is divided by.

    samples: Cycles'. settings: of RPPM, by the names of RenderSettings.
    """
    colors = dict.fromkeys(entry.divided_by for entry in SCATTERED_LIGHT)
    layer = bpy.context.scene.view_layers[0]
    for entry in SCATTERED_LIGHT:
        setattr(layer, entry.switch, True)
    for color in colors:
        setattr(layer, "use_pass_" + color.lower().replace(" ", "_"), True)
    mine, theirs = [], []
    names = tuple(entry.name for entry in SCATTERED_LIGHT)
    for seed in range(_SEEDS):
        mine.append(render_frame(renderer, seed=seed, passes=(*names, *colors), **settings).passes)
        bpy.context.scene.cycles.seed = FIRST_SEED + seed
        channels = cycles_channels(samples)
        theirs.append({name: _stacked(channels, name) for name in (*names, *colors)})
    for entry in SCATTERED_LIGHT:
        # Of quotients over the colors of edges, next to nothing is known.
        both = [
            np.array([passes[entry.name] * passes[entry.divided_by] for passes in engine], np.float64)
            for engine in (mine, theirs)
        ]
        if both[1].mean() > 1e-4:
            compare(f"{name}_{entry.name}".lower().replace(" ", "_"), *both, OF_PASSES)
        else:
            assert both[0].mean() < 1e-3, f"{entry.name}: there is light where Cycles has none"


def _stacked(channels: dict[str, np.ndarray], name: str) -> np.ndarray:
    """(H, W, 3) of Cycles' pass of RPPM's name, row 0 at the bottom."""
    entry = next(entry for entry in PASSES if entry.name == name)
    return np.stack([channels[layer] for layer in entry.layers], axis=-1)
