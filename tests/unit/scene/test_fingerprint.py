# SPDX-License-Identifier: GPL-3.0-or-later
"""Equal scenes have equal digests, and a change shows in the digest of what was changed."""

import copy
import dataclasses

import numpy as np
import pytest
from support.full_scene import full_scene

from rppm_addon.scene import DirectLight, RenderSettings, load_scene, save_scene
from rppm_addon.scene.meshes import Dicing, MeshShape
from rppm_addon.scene.storage.fingerprint import UNSEEN, plain_settings, scene_digests


def test_a_scene_that_was_saved_is_the_same(tmp_path):
    scene = full_scene()
    save_scene(scene, tmp_path / "scene.npz")
    loaded = load_scene(tmp_path / "scene.npz")
    loaded.warnings.append("says nothing of the picture")
    loaded.settings.iterations += 1
    loaded.stamps["Date"] = "another one"
    assert scene_digests(loaded) == scene_digests(scene) == scene_digests(copy.deepcopy(scene))
    unseen = {"settings", "stamps", "warnings", "instance_arrays"}
    assert scene_digests(scene).keys() == {field.name for field in dataclasses.fields(scene)} - unseen


def smallest_change(array: np.ndarray) -> np.ndarray:
    changed = array.copy()
    changed.reshape(-1).view(np.uint8)[-1] ^= 1
    return changed


def smallest_change_of(owner, name):
    setattr(owner, name, smallest_change(getattr(owner, name)))


@pytest.mark.parametrize(
    ("member", "change"),
    [
        ("camera", lambda scene: setattr(scene.camera, "matrix", smallest_change(scene.camera.matrix))),
        ("meshes", lambda scene: setattr(scene.meshes[0], "positions", smallest_change(scene.meshes[0].positions))),
        ("meshes", lambda scene: setattr(scene.meshes[0], "positions", scene.meshes[0].positions.astype(np.float64))),
        ("meshes", lambda scene: setattr(scene.meshes[0], "dicing", Dicing(2.5, True, False))),
        ("meshes", lambda scene: setattr(scene.meshes[1], "shape", MeshShape.POINTS)),
        ("materials", lambda scene: setattr(scene.materials[1].graph, "displacement", None)),
        ("materials", lambda scene: setattr(scene.materials[1], "on_round_shapes", False)),
        ("dicing_view", lambda scene: setattr(scene, "dicing_view", dataclasses.replace(scene.dicing_view, rate=0.6))),
        ("dicing_view", lambda scene: smallest_change_of(scene.dicing_view.camera, "matrix")),
        ("instances", lambda scene: setattr(scene.instances[0], "holdout", not scene.instances[0].holdout)),
        ("instances", lambda scene: smallest_change_of(scene.instance_arrays[0], "matrices")),
        ("instances", lambda scene: smallest_change_of(scene.instance_arrays[0], "randoms")),
        ("lights", lambda scene: setattr(scene.lights[0], "strength", smallest_change(scene.lights[0].strength))),
        ("exposure", lambda scene: setattr(scene, "exposure", np.nextafter(scene.exposure, 9.0))),
    ],
)
def test_the_least_change_shows(member, change):
    before, scene = scene_digests(full_scene()), full_scene()
    change(scene)
    after = scene_digests(scene)
    assert [name for name in before if before[name] != after[name]] == [member]


def test_settings_but_for_the_limits():
    plain = plain_settings(RenderSettings(direct_light=DirectLight.PHOTONS, alpha=0.6))
    assert (plain["direct_light"], plain["alpha"]) == ("PHOTONS", 0.6)
    assert plain.keys() == {field.name for field in dataclasses.fields(RenderSettings)} - UNSEEN
    assert plain == plain_settings(
        RenderSettings(direct_light=DirectLight.PHOTONS, alpha=0.6, iterations=7, time_limit=5.0)
    )
