# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that follow each other share what is equal."""

import copy
import dataclasses

import numpy as np
import pytest
from support.lobes import Lobe, LobeKind, image_world, material

from rppm_addon.scene import Camera, Image, Instance, Light, LightKind, Mesh, Scene
from rppm_addon.scene.storage.sharing import share


@pytest.fixture
def scene() -> Scene:
    mesh = Mesh(
        "triangle", np.eye(3, dtype=np.float32), np.arange(3, dtype=np.int32), np.eye(3, dtype=np.float32),
        np.array([[0, 1, 2]], np.int32), np.zeros(1, np.int32),
    )  # fmt: skip
    return Scene(
        camera=Camera(np.eye(4), (-1.0, 1.0, -1.0, 1.0), 8, 8),
        meshes=[mesh],
        instances=[Instance(0, np.eye(4), [0]), Instance(0, 2.0 * np.eye(4), [1])],
        materials=[material(name, Lobe(LobeKind.DIFFUSE)) for name in ("a", "b")],
        lights=[Light("light", LightKind.POINT, np.eye(4), np.ones(3))],
        world=image_world(0),
        images=[Image("sky", np.zeros((2, 2, 4), np.uint8), "LINEAR")],
        warnings=["something"],
    )


def again(scene: Scene) -> Scene:
    """The same, exported a second time: meshes and images are known, the rest is new."""
    return dataclasses.replace(copy.deepcopy(scene), meshes=list(scene.meshes), images=list(scene.images))


def test_a_scene_that_says_the_same_is_the_scene_before(scene):
    assert share(scene, again(scene)) is scene
    assert share(None, scene) is scene


def test_what_differs_is_new_and_the_rest_is_not(scene):
    other = again(scene)
    other.instances[1].matrix[0, 3] = 1e-9
    shared = share(scene, other)
    assert shared.instances[0] is scene.instances[0] and shared.instances[1] is other.instances[1]
    names = ("meshes", "materials", "lights", "images", "world", "camera", "settings")
    assert all(getattr(shared, name) is getattr(scene, name) for name in names)


@pytest.mark.parametrize(
    "change",
    [
        lambda s: s.instances.pop(),
        lambda s: s.instances.append(Instance(0, np.eye(4))),
        lambda s: s.materials[0].graph.nodes[0].inputs.update(roughness=0.7),
        lambda s: setattr(s.lights[0], "strength", np.array([1.0, 1.0, 1.5])),
        lambda s: setattr(s.world, "radiance", np.zeros(3)),
        lambda s: setattr(s.camera, "width", 9),
        lambda s: setattr(s.settings, "photons", 5),
        lambda s: setattr(s, "exposure", 2.0),
        lambda s: setattr(s, "cubemap_center", np.zeros(3)),
        lambda s: setattr(s, "stamps", {"Frame": "2"}),  # files of the frame tell of it
        lambda s: s.warnings.append("more"),
        lambda s: s.images.append(Image("b", np.zeros((1, 1, 4), np.uint8), "LINEAR")),
        lambda s: s.meshes.__setitem__(0, copy.deepcopy(s.meshes[0])),  # large: only the same one is equal
    ],
)
def test_every_difference_is_seen(scene, change):
    other = again(scene)
    change(other)
    shared = share(scene, other)
    assert shared is not scene
    assert share(shared, again(shared)) is shared


def test_lists_that_are_known_are_not_walked(scene):
    """The cost of drawing a viewport does not grow with the scene."""

    class Counted(list):
        walks = 0

        def __iter__(self):
            Counted.walks += 1
            return super().__iter__()

    scene.instances = Counted(scene.instances)
    moved = dataclasses.replace(scene, camera=dataclasses.replace(scene.camera, width=3))
    assert share(scene, moved).instances is scene.instances and Counted.walks == 0
