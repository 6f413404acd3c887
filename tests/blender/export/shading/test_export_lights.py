# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights in radiometric quantities. The factors are those of Cycles, measured on a diffuse plane."""

import math

import bpy
import numpy as np
import pytest
from blender_scenes import add_light, add_mesh, collect, depsgraph, export, set_world, show_collection
from cycles_light import cycles_radiance
from emission import light_strength
from node_trees import add_node, link, surface

from rppm_addon.blender.export.updates.sync import SceneSync
from rppm_addon.materials.traits.emitted import light_variation
from rppm_addon.scene import LightKind
from rppm_addon.scene.meshes import RayVisibility


def exported_light(scene, kind, **values):
    scale = values.pop("scale", (1.0, 1.0, 1.0))
    add_light(scene, kind, **values).scale = scale
    (light,) = export(scene).lights
    return light


@pytest.mark.parametrize("kind", ["POINT", "SPOT"])
def test_point_and_spot(scene, kind):
    light = exported_light(scene, kind, energy=100.0, color=(1.0, 0.5, 0.25), shadow_soft_size=0.2, scale=(3, 3, 3))
    assert light.kind is LightKind[kind] and light.name == "Light"
    np.testing.assert_allclose(light.strength, 100.0 / (4.0 * math.pi) * np.array([1.0, 0.5, 0.25]))
    assert light.radius == pytest.approx(0.2)  # not scaled, as in Cycles
    np.testing.assert_allclose(light.matrix[:3, 3], (0.0, 0.0, 3.0))
    np.testing.assert_allclose(np.linalg.norm(light.matrix[:3, 0]), 3.0)


def test_soft_falloff(scene):
    added = add_light(scene, "POINT")
    assert export(scene).lights[0].soft_falloff
    added.data.use_soft_falloff = False
    assert not export(scene).lights[0].soft_falloff


def test_spot_cone(scene):
    light = exported_light(scene, "SPOT", spot_size=1.2, spot_blend=0.4)
    assert (light.spot_angle, light.spot_blend) == pytest.approx((1.2, 0.4))


def test_sun(scene):
    light = exported_light(scene, "SUN", energy=3.0, angle=0.3)
    np.testing.assert_allclose(light.strength, [3.0] * 3)
    assert light.sun_angle == pytest.approx(0.3)


@pytest.mark.parametrize(
    ("shape", "area"), [("SQUARE", 4.0), ("RECTANGLE", 1.0), ("DISK", math.pi), ("ELLIPSE", math.pi / 4)]
)
@pytest.mark.parametrize("scale", [(1, 1, 1), (2, 3, 5)])
def test_area_radiance(scene, shape, area, scale):
    light = exported_light(scene, "AREA", energy=10.0, shape=shape, size=2.0, size_y=0.5, spread=1.0, scale=scale)
    world_area = area * scale[0] * scale[1]
    np.testing.assert_allclose(light.strength, [10.0 / (math.pi * world_area)] * 3, rtol=1e-6)
    assert light.size == ((2.0, 0.5) if shape in {"RECTANGLE", "ELLIPSE"} else (2.0, 2.0))
    assert light.shape == shape and light.spread == pytest.approx(1.0)


def test_photon_share_and_visibility(scene):
    added = add_light(scene, "POINT")
    added.data.rppm.photon_weight = 2.5
    added.visible_camera = True
    (light,) = export(scene).lights
    assert light.photon_weight == 2.5 and RayVisibility.CAMERA in light.visibility
    added.visible_camera = False
    assert RayVisibility.CAMERA not in export(scene).lights[0].visibility


def test_instanced_lights(scene):
    collection = collect(scene, add_light(scene, "POINT"))
    for x in (1.0, 2.0):
        show_collection(scene, collection, location=(x, 0.0, 0.0))
    assert sorted(light.matrix[0, 3] for light in export(scene).lights) == [1.0, 2.0]


def with_nodes(scene, kind, **values):
    """The data of a light with nodes, the tree, and its Emission node."""
    data = add_light(scene, kind, **values).data
    data.use_nodes = True
    return data.node_tree, data.node_tree.nodes["Emission"]


def test_light_nodes_multiply(scene):
    tree, emission = with_nodes(scene, "POINT", energy=4.0 * math.pi)
    emission.inputs["Color"].default_value = (0.5, 1.0, 0.0, 1.0)
    emission.inputs["Strength"].default_value = 3.0
    np.testing.assert_allclose(light_strength(export(scene)), (1.5, 3.0, 0.0))
    noise = add_node(tree, "ShaderNodeTexNoise", "Flicker")
    link(tree, noise.outputs["Fac" if bpy.app.version < (5, 0) else "Factor"], emission.inputs["Strength"])
    exported = export(scene)
    assert not exported.warnings and light_variation(exported.lights[0].graph).place
    assert 0.0 < light_strength(exported)[1] < 1.0


def test_light_nodes_of_place_and_direction_at_once(scene):
    """Maps have two axes: an area light whose emission depends on four numbers says what is left out."""
    tree, emission = with_nodes(scene, "AREA")
    geometry, product = (add_node(tree, f"ShaderNode{name}") for name in ("NewGeometry", "VectorMath"))
    link(tree, geometry.outputs["Incoming"], product.inputs[0])
    link(tree, product.outputs[0], emission.inputs["Color"])
    exported = export(scene)
    assert not exported.warnings and light_variation(exported.lights[0].graph).direction
    link(tree, geometry.outputs["Position"], product.inputs[1])
    assert any('Light "Light": its nodes vary by place and by direction' in text for text in export(scene).warnings)


@pytest.mark.parametrize("values", [{"energy": 0.0}, {"color": (0.0, 0.0, 0.0)}])
def test_lights_without_power_are_left_out(scene, values):
    add_light(scene, "POINT", **values)
    assert export(scene).lights == []


@pytest.mark.parametrize("energy", [0.0, 50.0])
def test_portals_give_no_light(scene, energy):
    """They say where the world's comes in, whatever their power, nodes and links."""
    added = add_light(scene, "AREA", energy=energy, shape="ELLIPSE", size=2.0, size_y=0.5, spread=0.3)
    added.data.use_nodes = True
    added.data.cycles.is_portal = True
    added.location = (1.0, 2.0, 3.0)
    exported = export(scene)
    (light,) = exported.lights
    assert light.is_portal and light.kind is LightKind.AREA and light.graph is None and not exported.warnings
    assert not light.strength.any() and light.shape == "ELLIPSE" and light.size == pytest.approx((2.0, 0.5))
    assert light.matrix[:3, 3] == pytest.approx((1.0, 2.0, 3.0))
    assert light.spread == pytest.approx(math.pi)
    added.data.cycles.is_portal = False
    added.data.update_tag()
    assert [light.is_portal for light in export(scene).lights] == [False] * (energy > 0.0)


def test_a_viewport_follows_portals(scene):
    """One that is moved, or no longer is one."""
    sync, camera = SceneSync(), export(scene).camera

    def light():
        scene.view_layers[0].update()
        (light,) = sync.update(depsgraph(), camera).lights
        return light

    added = add_light(scene, "AREA", energy=50.0)
    added.data.cycles.is_portal = True
    for x in (0.0, 2.0):
        added.location.x = x
        assert light().is_portal and light().matrix[0, 3] == x
    added.data.cycles.is_portal = False
    added.data.update_tag()
    assert not light().is_portal and light().strength.all()


def test_area_light_without_area(scene):
    add_light(scene, "AREA").scale = (0.0, 1.0, 1.0)
    exported = export(scene)
    assert exported.lights == [] and any('"Light"' in warning for warning in exported.warnings)


needs_light_units = pytest.mark.skipif(bpy.app.version < (4, 5), reason="this Blender's lights have no exposure")

CYCLES_CASES = [
    pytest.param("POINT", {"shadow_soft_size": 0.02}, id="point"),
    pytest.param("POINT", {"shadow_soft_size": 0.5, "normalize": False}, id="point-radiant", marks=needs_light_units),
    pytest.param("POINT", {"shadow_soft_size": 0.0, "normalize": False}, id="point-zero", marks=needs_light_units),
    pytest.param("SPOT", {"shadow_soft_size": 0.02, "exposure": 1.5}, id="spot-exposure", marks=needs_light_units),
    pytest.param("SUN", {"angle": 0.1}, id="sun"),
    pytest.param("SUN", {"angle": 0.5, "normalize": False}, id="sun-radiance", marks=needs_light_units),
    pytest.param("AREA", {"shape": "SQUARE", "size": 0.1}, id="square"),
    pytest.param("AREA", {"shape": "RECTANGLE", "size": 0.1, "size_y": 0.2}, id="rectangle"),
    pytest.param("AREA", {"shape": "DISK", "size": 0.1}, id="disk"),
    pytest.param("AREA", {"shape": "ELLIPSE", "size": 0.1, "size_y": 0.05}, id="ellipse"),
    pytest.param("AREA", {"shape": "DISK", "size": 0.2, "normalize": False}, id="radiance", marks=needs_light_units),
    pytest.param("POINT", {"use_temperature": True, "temperature": 3000.0}, id="temperature", marks=needs_light_units),
]  # fmt: skip


@pytest.mark.parametrize(("kind", "values"), CYCLES_CASES)
def test_irradiance_agrees_with_cycles(scene, kind, values, tmp_path):
    """The plane below a light, seen straight on, against what the exported quantities say."""
    added = add_light(scene, kind, energy=100.0, **values)
    distance = 10.0
    added.location = (0.0, 0.0, distance)
    set_world(scene)
    white, _ = surface("ShaderNodeBsdfDiffuse", Color=(1.0, 1.0, 1.0, 1.0))
    add_mesh(scene, material=white)
    (light,) = export(scene).lights
    if light.kind is LightKind.SUN:
        expected = light.strength
    elif light.kind is LightKind.AREA:
        round_share = math.pi / 4 if light.shape in {"DISK", "ELLIPSE"} else 1.0
        expected = light.strength * light.size[0] * light.size[1] * round_share / distance**2
    else:
        expected = light.strength / (distance**2 + light.radius**2)  # Cycles' soft falloff: a facing disk
    np.testing.assert_allclose(cycles_radiance(scene, tmp_path) * math.pi, expected, rtol=3e-3)
