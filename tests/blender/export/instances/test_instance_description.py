# SPDX-License-Identifier: GPL-3.0-or-later
"""Descriptions of instances, and what is made of them."""

import numpy as np
import pytest
from blender_scenes import add_mesh, collect, export, show_collection
from node_trees import new_material

from rppm_addon.blender.export.common.report import Report
from rppm_addon.blender.export.instances.instance_description import InstanceDescription, Instancer
from rppm_addon.blender.export.instances.placements import Placements
from rppm_addon.scene import Instance, LightLinking, Particle, RayVisibility

CAMERA, SHADOW = RayVisibility.CAMERA, RayVisibility.SHADOW


def description(**members) -> InstanceDescription:
    values = {
        "mesh": 3, "materials": [1, 2], "object_name": "Leaf", "object_index": 7, "color": (0.1, 0.2, 0.3, 0.4),
        "random": 0.75, "visibility": RayVisibility.ALL, "holdout": True, "shadow_catcher": False,
        "attributes": {"OBJECT:heat": (0.5,)}, "light_group": "", "linking": LightLinking(1, 2, 3, 4),
        "terminator_geometry_offset": 0.25, "terminator_shading_offset": 0.5,
    }  # fmt: skip
    return InstanceDescription(**values | members)


def instancer(**members) -> Instancer:
    values = {
        "uid": 5, "color": (0.5, 0.6, 0.7, 0.8), "visibility": RayVisibility.ALL,
        "layer_visibility": RayVisibility.ALL, "holdout": False, "shadow_catcher": False, "light_group": "",
        "linking": None, "has_particles": False,
    }  # fmt: skip
    return Instancer(**values | members)


def test_a_description_cannot_be_changed():
    with pytest.raises(AttributeError):
        description().holdout = False


def test_every_member_of_an_instance_is_placed():
    matrix, described = np.eye(4), description()
    placed = described.place(matrix)
    assert placed.matrix is matrix and placed.particle is None
    for name in InstanceDescription._fields:
        assert getattr(placed, name) is getattr(described, name), name


def test_an_instance_has_its_own_random_number_particle_and_attributes():
    particle = Particle(1.0)
    placed = description().place(np.eye(4), 0.0, particle, {})
    assert placed.random == 0.0 and placed.particle is particle and placed.attributes == {}


@pytest.mark.parametrize(
    ("own", "passed_on", "expected"),
    [
        ({"visibility": ~CAMERA}, {"layer_visibility": ~SHADOW}, {"visibility": ~CAMERA & ~SHADOW}),
        ({"holdout": True}, {"holdout": False}, {"holdout": False}),
        ({"holdout": False}, {"holdout": True}, {"holdout": True}),
        ({}, {"shadow_catcher": True}, {"shadow_catcher": True}),
        ({"shadow_catcher": True}, {}, {"shadow_catcher": True}),
        ({"light_group": "Own"}, {"light_group": "Others"}, {"light_group": "Own"}),
        ({"light_group": ""}, {"light_group": "Others"}, {"light_group": "Others"}),
        ({"linking": LightLinking(1, 2, 3, 4)}, {"linking": None}, {"linking": None}),
    ],
)
def test_an_instancer_passes_its_properties_on(own, passed_on, expected):
    described = description(**own)
    multiplied = described.multiplied_by(instancer(**passed_on))
    changed = {"holdout": False, "linking": None, "random": 0.0, "color": (0.5, 0.6, 0.7, 0.8), **expected}
    assert multiplied == described._replace(**changed)


def test_instances_of_a_mesh_share_what_was_read_once(scene):
    host, leaf = add_mesh(scene, "Host"), add_mesh(scene, "Leaf")
    leaf.parent, host.instance_type = host, "VERTS"
    instances = export(scene).instances[1:5]  # between the host and the leaf itself
    assert [instance.object_name for instance in instances] == ["Leaf"] * 4
    assert len({instance.matrix.tobytes() for instance in instances}) == 4
    assert len({instance.random for instance in instances}) == 4
    for name in ("materials", "attributes", "color"):
        assert len({id(getattr(instance, name)) for instance in instances}) == 1, name


def test_each_of_two_instancers_of_one_mesh_passes_on_its_own(scene):
    leaf = add_mesh(scene, "Leaf", material=new_material("Green"), color=(0.5, 0.25, 0.125, 1.0))
    collection = collect(scene, leaf)
    for number in range(6):
        empty = show_collection(scene, collection, location=(0.0, 0.0, float(number)))
        empty.is_holdout, empty.is_shadow_catcher = number % 2 == 1, number == 2
        empty.visible_glossy = number != 4
        empty.color = (0.1 * number, 0.0, 1.0, 1.0)
    exported = export(scene)
    assert len(exported.meshes) == len(exported.materials) == 1 and len(exported.instances) == 6
    for instance in exported.instances:
        number = round(instance.matrix[2, 3])
        assert instance.holdout is (number % 2 == 1) and instance.shadow_catcher is (number == 2)
        assert (RayVisibility.GLOSSY in instance.visibility) is (number != 4)
        assert instance.color == pytest.approx((0.1 * number, 0.0, 1.0, 1.0)) and instance.materials == [0]


def test_instances_on_vertices_have_the_color_of_their_instancer(scene):
    host, leaf = add_mesh(scene, "Host"), add_mesh(scene, "Leaf", color=(0.5, 0.25, 0.125, 1.0))
    leaf.parent, host.instance_type, host.color = host, "VERTS", (0.0, 1.0, 0.0, 1.0)
    colors = {instance.color for instance in export(scene).instances[1:5]}
    assert colors == {(0.0, 1.0, 0.0, 1.0)}


def test_placements_leave_out_what_has_no_extent_and_forget_single_objects_that_are_multiplied():
    placements, report = Placements(identify=True), Report()
    flat, good, multiple = (Instance(0, np.eye(4), object_name=name) for name in ("Flat", "Good", "Multiple"))
    placements.add(flat, np.zeros((4, 4)), 1, (1,))
    placements.add(good, good.matrix, 2, (2,))
    placements.check()
    placements.add(multiple, multiple.matrix, 3, (3,))
    placements.mark_multiple(3)
    placements.check()
    placed = placements.finish(report)
    assert placed.instances == [good, multiple] and placed.single_instances == {2: 0}
    assert placed.identities[id(good)] == (2,) and placed.identities[id(multiple)] == (3,)
    (warning,) = report.warnings
    assert warning.startswith('Object "Flat": 1 placements have no extent')
