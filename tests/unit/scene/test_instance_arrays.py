# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances that lie in arrays."""

import dataclasses

import numpy as np
import pytest
from support.floor import floor_scene
from support.full_scene import full_scene

from rppm_addon.scene import Instance, InstanceArray, Particle, Scene
from rppm_addon.scene.cryptomatte import OBJECTS, names_in
from rppm_addon.scene.errors import SceneError
from rppm_addon.scene.storage.sharing import same_members, share


def row(*places: int, name: str = "many") -> InstanceArray:
    """An array without particles, of which each instance has its place as x."""
    matrices = np.tile(np.eye(4, dtype=np.float32)[:3], (len(places), 1, 1))
    matrices[:, 0, 3] = places
    first = Instance(0, np.eye(4), [0], name)
    return InstanceArray(first, np.array(places, np.int32), matrices, 0.25 * np.array(places))


def scene_of(*arrays: InstanceArray, names: str = "") -> Scene:
    scene = floor_scene()
    alone = [dataclasses.replace(scene.instances[0], object_name=name) for name in names]
    return dataclasses.replace(scene, instances=alone, instance_arrays=list(arrays))


def test_instances_of_arrays_come_in_their_places():
    scene = scene_of(row(1, 4), row(3, name="few"), names="abc")
    expanded = scene.expanded()
    assert [instance.object_name for instance in expanded.instances] == ["a", "many", "b", "few", "many", "c"]
    assert expanded.instance_arrays == [] and expanded.instances[0] is scene.instances[0]
    placed = expanded.instances[4]
    assert placed.matrix.dtype == np.float64 and placed.random == 1.0 and placed.particle is None
    np.testing.assert_array_equal(placed.matrix, [[1, 0, 0, 4], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    assert scene.instance_count == expanded.instance_count == len(expanded.instances) == 6
    assert scene.triangle_count == expanded.triangle_count == 12


def test_each_instance_has_its_own_particle_and_attributes():
    scene = full_scene()
    (array,) = scene.instance_arrays
    for place, instance in zip(array.places, array.instances(), strict=True):
        number = place // 2
        assert instance is scene.expanded().instances[place]
        assert instance.particle == array.particles[number] and isinstance(instance.particle, Particle)
        assert instance.particle.age == array.particles.age[number]
        assert instance.particle.location == tuple(array.particles.location[number].tolist())
        assert instance.attributes == {"a": tuple(array.attributes["a"][number].tolist())}


def test_a_scene_without_arrays_is_what_it_was():
    scene = floor_scene()
    assert scene.expanded() is scene


def test_scenes_that_share_arrays_share_their_instances():
    still, before = row(0, 1), row(2, 3)
    scene = scene_of(still, before)
    moved = dataclasses.replace(scene, instance_arrays=[still, dataclasses.replace(before)])
    first, second = scene.expanded().instances, moved.expanded().instances
    assert same_members(first, scene.expanded().instances) and same_members(first[:2], second[:2])
    assert first[2] is not second[2]
    assert share(scene, moved) is scene  # whose numbers are the same
    moved.instance_arrays[1].matrices = before.matrices + 1.0
    shared = share(scene, moved)
    assert shared.instance_arrays[0] is still and shared.instance_arrays[1] is moved.instance_arrays[1]


@pytest.mark.parametrize(("places", "message"), [((1, 2), "none of 2"), ((0, 0), "the same place")])
def test_places_that_are_none(places, message):
    with pytest.raises(SceneError, match=message):
        scene_of(row(*places)).expanded()


def test_cryptomatte_has_the_names_of_arrays():
    assert names_in(OBJECTS, scene_of(row(1, 2), names="ab")) == ["a", "b", "many"]


def test_an_edited_array_shares_the_instances_that_say_the_same():
    before = scene_of(row(1, 2, 3, 4), names="a")
    (array,) = before.instance_arrays
    matrices = array.matrices.copy()
    matrices[2, 1, 3] = 5.0
    after = dataclasses.replace(before, instance_arrays=[dataclasses.replace(array, matrices=matrices)])
    old, new = before.expanded().instances, after.expanded(before).instances
    assert [a is b for a, b in zip(old, new, strict=True)] == [True, True, True, False, True]
    assert new[3].matrix[1, 3] == 5.0 and new[3].random == old[3].random


@pytest.mark.parametrize(
    "members", [{"object_index": 7}, {"color": (1.0, 0.5, 1.0, 1.0)}, {"materials": [1]}, {"attributes": {"a": (1.0,)}}]
)
def test_an_array_whose_instances_share_something_else_shares_none(members):
    before = scene_of(row(1, 2, 3, 4), names="a")
    (array,) = before.instance_arrays
    first = dataclasses.replace(array.first, **members)
    after = dataclasses.replace(before, instance_arrays=[dataclasses.replace(array, first=first)])
    (name, value) = next(iter(members.items()))
    before.expanded()
    assert all(getattr(instance, name) == value for instance in after.expanded(before).instances[1:])
