# SPDX-License-Identifier: GPL-3.0-or-later
"""Columns of instances."""

import dataclasses

import numpy as np
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.common.instance_columns import InstanceColumns
from rppm_addon.materials.traits.emitted import glowing_materials
from rppm_addon.scene import Instance, RayVisibility
from rppm_addon.scene.light_linking import LightLinking


def row(count: int) -> list[Instance]:
    return [Instance(number % 3, np.eye(4) * number, [number % 2, 5]) for number in range(count)]


def test_columns_say_what_the_instances_say():
    instances = row(7)
    instances[2].visibility = RayVisibility.SHADOW | RayVisibility.CAMERA
    instances[3].linking = LightLinking(receiver_light_set=3, blocker_shadow_set=2)
    columns = InstanceColumns()
    np.testing.assert_array_equal(columns.follow(instances), np.arange(7))
    np.testing.assert_array_equal(columns.meshes, [0, 1, 2, 0, 1, 2, 0])
    np.testing.assert_array_equal(columns.matrices, [np.eye(4) * number for number in range(7)])
    assert [columns.material_lists[number] for number in columns.materials] == [(0, 5), (1, 5)] * 3 + [(0, 5)]
    assert columns.visibility.tolist() == [63, 63, 17, 63, 63, 63, 63]
    assert columns.sets.tolist() == [0, 0, 0, 3 + (2 << 6), 0, 0, 0]


def test_only_other_objects_are_read_again():
    instances, columns = row(9), InstanceColumns()
    columns.follow(instances)
    edited = list(instances)
    edited[4] = dataclasses.replace(edited[4], mesh=7, materials=[3])
    np.testing.assert_array_equal(columns.follow(edited), [4])
    assert columns.meshes[4] == 7 and columns.material_lists[columns.materials[4]] == (3,)
    assert not len(columns.follow(edited))
    np.testing.assert_array_equal(columns.follow(edited[:3]), [0, 1, 2])
    np.testing.assert_array_equal(columns.follow([]), [])
    assert columns.matrices.shape == (0, 4, 4)


def test_instances_with_any_material_that_emits_glow():
    lobes = Lobe(LobeKind.DIFFUSE), Lobe(LobeKind.EMISSION, color=(1.0, 1.0, 1.0)), Lobe(LobeKind.DIFFUSE)
    columns = InstanceColumns()
    columns.follow([Instance(0, np.eye(4), slots) for slots in ([0, 2], [], [2, 1], [-1, 1], [7])])
    materials = [material(str(number), lobe) for number, lobe in enumerate(lobes)]
    np.testing.assert_array_equal(columns.have(glowing_materials(materials)), [False, False, True, True, False])
