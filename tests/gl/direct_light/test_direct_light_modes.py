# SPDX-License-Identifier: GPL-3.0-or-later
"""Direct light by photons and by rays make the same picture of a room with all kinds of surfaces."""

import dataclasses

import numpy as np
import pytest
import scenes
from parity.comparison import write_pair
from path_comparison import BLOCKS, OUTPUT, ROUNDING, SEEDS, SHARPNESS, block_errors, blocks, render
from path_constants import CUT, FIRST, MODES, PHOTONS, SECOND, SIZE, STORED, TRACED
from path_scenes import lobe
from support.lobes import material

from rppm_addon.scene import DirectLight, Scene

NEAREST_BLOCK = 0.8 * 2.6 / BLOCKS
"""Meters across a block of the room's front, the window's width being 0.8 at 1 m."""
EDGES = 3
"""Edges between walls that cross a block."""


def all_kinds(mode: DirectLight) -> Scene:
    """A room with diffuse walls, a glass ball and a mirror ball, a back wall and a ceiling that are glossy too."""
    scene = scenes.room(
        2 * SIZE, iterations=5, photons=16384, direct_light=mode, photon_path_length=5, camera_path_length=5,
        radius_minimum=0.025, radius_maximum=0.025, filter_width=0.0, specular_roughness=CUT,
    )  # fmt: skip
    for index, roughness in ((1, TRACED), (2, STORED)):
        scene.materials.append(material("glossy", lobe("D", 0.4 * FIRST), lobe(roughness, 0.5 * SECOND)))
        scene.instances[index].materials = [len(scene.materials) - 1]
    # Half as wide as the room: glossy walls find it by scattering, too.
    scene.lights[0] = dataclasses.replace(scene.lights[0], strength=np.full(3, 3.0), size=(1.0, 1.0))
    return scene


@pytest.mark.long
def test_direct_light_by_photons_or_by_rays_is_the_same_picture(mapper):
    """Block by block; light that photons alone bring is the same in both and cancels.

    What a kernel of radius r spreads beyond a surface's edge is lost: a strip's worth of 0.17 r, the mean of the
    kernel's positive half. Two walls that meet across a block of width w lose 2 x 0.17 r / w of its direct light.
    """
    renders = {mode: [render(mapper, all_kinds(mode), 100 + k) for k in range(SEEDS)] for mode in MODES}
    by_rays, by_photons = (np.array([picture for picture, _ in renders[mode]]) for mode in MODES)
    radius = np.sqrt(np.mean([square[0] for _, square in renders[PHOTONS]]))
    write_pair("direct light modes", by_photons.mean(axis=0), by_rays.mean(axis=0), OUTPUT)
    level, difference = blocks(by_rays.mean(axis=0)), blocks(by_photons - by_rays)
    errors = block_errors(difference, level)
    lost = EDGES * 2 * 0.17 * radius / NEAREST_BLOCK
    relative, noise = difference.mean(axis=0) / level, errors / level
    assert (4 * noise).max() + lost < 2 * SHARPNESS
    assert (relative <= 4 * noise + ROUNDING).all() and (relative >= -4 * noise - lost - ROUNDING).all()
    overall, spread = relative.mean(), np.sqrt((noise**2).mean()) / BLOCKS
    assert 4 * spread + lost < SHARPNESS
    assert -4 * spread - lost - ROUNDING <= overall <= 4 * spread + ROUNDING
