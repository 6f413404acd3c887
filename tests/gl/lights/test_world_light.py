# SPDX-License-Identifier: GPL-3.0-or-later
"""Direct light of the world that comes through an opening."""

import numpy as np
import pytest
import scenes
from moving_scenes import open_for, way
from openings import BLACK, FLOOR, GRAY, hole_form_factor, room
from path_comparison import judge, picture_by_seed
from support.render_states import assert_goes_on

from rppm_addon.scene import Instance


@pytest.mark.parametrize("radius", [0.05, 0.5])
def test_the_floor_gets_the_sky_through_the_hole(mapper, radius):
    """To the closed form, however wide the disks of photons are: these bring no direct light."""
    scene = room(BLACK, photons=1 << 8, iterations=64, radius_minimum=radius, radius_maximum=radius)
    pictures = picture_by_seed(mapper, f"hole {radius}", scene)
    judge(f"hole {radius}", pictures, FLOOR * hole_form_factor(scene)[..., None])


@pytest.mark.parametrize("moving", [False, True])
def test_it_goes_on_bit_for_bit(mapper, other_mapper, moving):
    """Also where something moves by which the scene grows, and with it the world's photons."""
    scene = room(GRAY, photons=1 << 12)
    if moving:
        scene.meshes.append(scenes.rectangle("bird", (3, 3, 3), (4, 3, 3), (4, 4, 3), (3, 4, 3)))
        scene.instances.append(Instance(len(scene.meshes) - 1, np.eye(4), [1]))
        scene = open_for(scene, instances=[way(len(scene.instances) - 1, np.eye(4), 4.0, 0.0, 0.0)])
    assert_goes_on(mapper, scene, iterations=5, stops=(1, 2, 3), other=other_mapper)
