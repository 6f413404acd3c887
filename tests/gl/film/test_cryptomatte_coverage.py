# SPDX-License-Identifier: GPL-3.0-or-later
"""Cryptomatte: how much of a pixel each object, material and asset covers."""

import numpy as np
import scenes
from support.lobes import Lobe, LobeKind, material
from support.render_states import assert_goes_on

from rppm_addon.scene import Camera, Light, LightKind, Scene
from rppm_addon.scene.cryptomatte import identifiers_of

PASSES = tuple(f"Crypto{layer}{part:02d}" for layer in ("Object", "Material", "Asset") for part in range(2))


def stripes(objects: int = 3, alpha: float = 0.25, **settings) -> Scene:
    """A camera 4 m above a floor of so many strips, below a pane: the floor covers two and a half of the four pixels of
    the only row, which the filter does not look beyond."""
    camera = Camera(scenes.looking((0, 0, 4), (0, 0, 0)), (-0.5, 0.5, -0.125, 0.125), 4, 1)
    edges, white = np.linspace(-3.5, 0.5, objects + 1), scenes.diffuse(1, 1, 1)
    strips = [scenes.rectangle("strip", (a, -2, 0), (b, -2, 0), (b, 2, 0), (a, 2, 0)) for a, b in zip(edges, edges[1:])]
    pane = scenes.square("pane", 2.0, 1.0), material("Pane", Lobe(LobeKind.PRINCIPLED, alpha=alpha))
    parts, sun = [*((strip, white) for strip in strips), pane], Light("sun", LightKind.SUN, np.eye(4), np.ones(3))
    fixed = {"iterations": 32, "photons": 64, "filter_width": 0.5, "passes": PASSES}
    scene = scenes.scene_of(camera, *parts, lights=[sun], **fixed | settings)
    for index, instance in enumerate(scene.instances):
        instance.object_name = f"Strip {index}" if index < objects else "Pane"
    scene.asset_names = {f"Strip {index}": "Floor" for index in range(objects)}
    return scene


def shares(frame, layer: str, names: list[str]) -> np.ndarray:
    """(names, width) share of each name in the only row of pixels."""
    pairs = np.concatenate([frame.passes[name][0] for name in PASSES if name.startswith(layer)], -1).reshape(4, -1, 2)
    identifiers = np.ascontiguousarray(pairs[..., 0]).view(np.uint32)
    assert (np.diff(pairs[..., 1]) <= 0.0).all()
    return np.array([np.where(identifiers == one, pairs[..., 1], 0.0).sum(1) for one in identifiers_of(names)])


def test_what_is_behind_counts_by_what_is_let_through(renderer):
    """A pane that hides a quarter; edges by how often the filter's rays come to either side of them."""
    scene = stripes()
    frame = renderer.render(scene).frame
    objects = shares(frame, "CryptoObject", ["Strip 0", "Strip 1", "Strip 2", "Pane"])
    np.testing.assert_allclose(objects[3], 0.25, atol=1e-6)
    # Whether a path goes through the pane is chosen, evenly over the iterations: one more or less, and another half.
    np.testing.assert_allclose(objects[:3, :2].sum(0), 0.75, atol=1.5 / 32)
    np.testing.assert_array_equal(objects[:3, 3], 0.0)
    assert 0.25 < objects[2, 2] < 0.5 and objects[1, 0] > 0.0  # the floor ends in the middle of this pixel
    floor_and_pane = [objects[:3].sum(0), objects[3]]
    np.testing.assert_allclose(shares(frame, "CryptoAsset", ["Floor", "Pane"]), floor_and_pane, atol=1e-6)
    names = [scene.materials[0].name, scene.materials[-1].name]
    np.testing.assert_allclose(shares(frame, "CryptoMaterial", names), floor_and_pane, atol=1e-6)


def test_more_things_than_pairs_count_for_the_last(renderer):
    frame = renderer.render(stripes(objects=24, alpha=0.0)).frame
    pairs = np.concatenate([frame.passes[f"CryptoObject{part:02d}"][0] for part in range(2)], -1).reshape(4, -1, 2)
    np.testing.assert_allclose(pairs[0, :, 1].sum(), 1.0, rtol=1e-5)
    assert (pairs[0, :, 1] > 0.0).all()


def test_catchers_hide_all_that_is_behind(renderer):
    scene = stripes(alpha=0.0)
    scene.instances[-1].shadow_catcher = True
    frame = renderer.render(scene).frame
    np.testing.assert_allclose(shares(frame, "CryptoObject", ["Pane"]), 1.0, atol=1e-6)
    np.testing.assert_allclose(shares(frame, "CryptoAsset", ["Pane"]), 1.0, atol=1e-6)
    assert shares(frame, "CryptoMaterial", [scene.materials[0].name]).sum() == 0.0


def test_holdouts_cover_nothing(renderer):
    scene = stripes(alpha=0.0)
    scene.instances[2].holdout = True
    objects = shares(renderer.render(scene).frame, "CryptoObject", ["Strip 0", "Strip 1", "Strip 2"])
    assert objects[2].sum() == 0.0 and objects[:2].sum() > 0.5


def test_a_render_goes_on_bit_for_bit(mapper):
    """Without more things than pairs, and with."""
    state = assert_goes_on(mapper, stripes(objects=24), "passes", "radiance", iterations=5)
    assert state.passes["CryptoObject01"].any()


def test_cryptomatte_leaves_the_picture_alone(renderer):
    with_passes, without = (renderer.render(stripes(iterations=2, passes=passes)).frame for passes in (PASSES, ()))
    np.testing.assert_array_equal(with_passes.combined, without.combined)
