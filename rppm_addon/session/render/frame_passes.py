# SPDX-License-Identifier: GPL-3.0-or-later
"""The passes of a film as those of a frame: exposed, and light that surfaces scatter without their color."""

from collections.abc import Mapping, Sequence

import numpy as np

from ...scene.cryptomatte import ranked
from ...scene.passes import SHADOW_CATCHER, RenderPass


def frame_passes(
    passes: Mapping[str, np.ndarray], entries: Sequence[RenderPass], exposure: float
) -> dict[str, np.ndarray]:
    """The passes that a film, or the parts of one, keep, by name, as Frame.passes has them; ``entries``: what they
    are."""
    found = dict(passes)
    for entry in entries:
        if entry.name not in passes:
            continue
        if entry.is_radiance:
            found[entry.name] = found[entry.name] * np.float32(exposure)
        if entry.divided_by:
            found[entry.name] = without_color(found[entry.name], passes[entry.divided_by])
    if SHADOW_CATCHER in found:
        found[SHADOW_CATCHER] = arriving_light(found[SHADOW_CATCHER])
    return ranked(found)


def arriving_light(caught: np.ndarray) -> np.ndarray:
    """(height, width, 3) of the pass Shadow Catcher: the fraction of light that arrives; 1 where there is no catcher.

    caught: (height, width, 3) of the film (shaders/film/caught_shadows.comp).
    """
    lit, seen = caught[..., 0], caught[..., 1]
    fraction = np.divide(lit, seen, out=np.ones_like(lit), where=seen > 0.0)
    return np.repeat(fraction[..., None], 3, axis=-1)


def without_color(light: np.ndarray, color: np.ndarray) -> np.ndarray:
    """(height, width, 3) light over the color of what scatters it. Where a channel of the color is 0, so is that of
    the light, and it takes the mean of the other channels' quotients, which makes the least of a color cast; 0 where
    all are. As in Cycles (safe_divide_even_color)."""
    known = color != 0.0
    quotient = np.divide(light, color, out=np.zeros_like(light), where=known)
    count = known.sum(axis=-1, keepdims=True)
    mean = quotient.sum(axis=-1, keepdims=True) / np.maximum(count, 1)
    return np.where(known, quotient, mean.astype(light.dtype))
