# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes of a scene with fog beside Cycles' of the same name."""

import bpy
import numpy as np
import pytest

from rppm_addon.scene.passes import PASSES, VOLUME_LIGHT

from ..comparison import block_means
from ..engines import FIRST_SEED, cycles_channels, render_frame, stacked
from ..net import material as net_material
from ..scenes import DIFFUSE, box, camera, light, material, new_scene, place, plane

VOLUME = tuple(entry.name for entry in VOLUME_LIGHT)
NAMES = (*VOLUME, "Environment", "Mist", "Denoising Albedo")


def cloud() -> None:
    """Build a box of fog above a small floor, under a lamp and a gray world."""
    scene = new_scene(32, world=0.3)
    plane(0.7, material(DIFFUSE, Color=(0.7, 0.5, 0.3)), place(at=(0.0, 0.0, -0.5)))
    fog, net = net_material("Fog")
    net.output(Volume=net.out("VolumeScatter", 0, {"Density": 0.6, "Color": (0.8, 0.9, 1.0)}))
    box((0.8, 0.8, 0.4), fog)
    light("POINT", 30.0, place(at=(0.5, -0.5, 2.0)), shadow_soft_size=0.1)
    camera((0.0, -3.0, 1.5), (0.0, 0.0, 0.0), 45.0)
    scene.cycles.volume_bounces = 16
    mist = scene.world.mist_settings
    mist.start, mist.depth, mist.falloff = 1.0, 4.0, "LINEAR"


def passes_of_cycles(samples: int) -> dict[str, np.ndarray]:
    """(H, W, channels) by name, row 0 at the bottom."""
    scene = bpy.context.scene
    scene.cycles.seed = FIRST_SEED
    layer = scene.view_layers[0]
    layer.use_pass_environment = layer.use_pass_mist = True
    for name in ("use_pass_volume_direct", "use_pass_volume_indirect", "denoising_store_passes"):
        setattr(layer.cycles, name, True)
    channels = cycles_channels(samples)
    for name in ("use_pass_volume_direct", "use_pass_volume_indirect", "denoising_store_passes"):
        setattr(layer.cycles, name, False)
    found = {entry.name: stacked(channels, entry.name, entry.channels) for entry in PASSES if entry.name in NAMES}
    return found | {"Combined": stacked(channels, "Combined", "RGBA")}


@pytest.mark.parametrize("film_transparent", [False, pytest.param(True, marks=pytest.mark.long)])
def test_passes_of_fog_are_those_of_cycles(renderer, film_transparent):
    cloud()
    bpy.context.scene.render.film_transparent = film_transparent
    expected = passes_of_cycles(samples=256)
    settings = {"iterations": 48, "photons": 16384, "passes": NAMES, "volume_bounces": 16}
    frame = render_frame(renderer, **settings)
    mine = frame.passes | {"Combined": frame.combined}
    assert expected["Combined"][..., 3].min() < (0.1 if film_transparent else 1.1)
    np.testing.assert_allclose(mine["Combined"][..., 3].mean(), expected["Combined"][..., 3].mean(), rtol=0.01)
    np.testing.assert_allclose(mine["Mist"].mean(), expected["Mist"].mean(), rtol=2e-3)
    # Those of paths that Cycles guides (Volume Scatter Probability Guiding) are not the mean in all places.
    limits = {"Volume Direct": 0.03, "Volume Indirect": 0.1}
    if not film_transparent:
        limits |= {"Environment": 0.01, "Denoising Albedo": 0.05}
    for name, limit in limits.items():
        np.testing.assert_allclose(mine[name].mean(), expected[name].mean(), rtol=limit, err_msg=name)
        blocks, reference = block_means(mine[name]), block_means(expected[name])
        np.testing.assert_allclose(blocks, reference, atol=0.1 * reference.max(), err_msg=name)
