# SPDX-License-Identifier: GPL-3.0-or-later
"""Ray visibility of objects and lights, nodes that change a light's falloff, and emission that varies over a mesh."""

import math

import pytest

from ..comparison import CONVERGED, compare
from ..engines import compare_with_cycles, render_cycles_over, render_rppm
from ..net import Net
from ..scenes import DIFFUSE, GLOSSY, ball, box, camera, light, material, new_scene, place, plane

PATHS = {"photon_path_length": 6, "camera_path_length": 6}
RAYS = PATHS | {"direct_light": "RAYS", "photons": 8192, "iterations": 10}
MODES = {"RAYS": RAYS, "PHOTONS": PATHS | {"direct_light": "PHOTONS", "photons": 32768, "iterations": 8}}
OBJECTS = [
    ("visible_camera", "RAYS"),
    pytest.param("visible_diffuse", "RAYS", marks=pytest.mark.long),
    pytest.param("visible_glossy", "RAYS", marks=pytest.mark.long),
    ("visible_shadow", "RAYS"),
    pytest.param("visible_shadow", "PHOTONS", marks=pytest.mark.long),
]


@pytest.mark.parametrize(("flag", "mode"), OBJECTS)
def test_objects_that_some_rays_do_not_see(renderer, flag, mode):
    """A red ball between a gray floor and a mirror."""
    new_scene()
    plane(3.0, material(DIFFUSE, Color=(0.7, 0.7, 0.7)))
    plane(3.0, material(GLOSSY, Color=(0.9, 0.9, 0.9), Roughness=0.0), place(at=(0.0, 1.5, 1.0), turn=(90.0, 0.0, 0.0)))
    seen = ball(0.5, material(DIFFUSE, Color=(0.8, 0.2, 0.1)), place(at=(0.0, 0.0, 0.6)), segments=32)
    setattr(seen, flag, False)
    light("AREA", 60.0, place(at=(0.8, -1.0, 2.5), turn=(20.0, 15.0, 0.0)), shape="SQUARE", size=0.8)
    camera((0.0, -4.0, 2.2), (0.0, 0.0, 0.5), 40.0)
    compare_with_cycles(renderer, f"object_{flag}_{mode.lower()}", 512, **MODES[mode])


@pytest.mark.parametrize("flag", ["visible_diffuse", "visible_glossy"])
def test_lights_that_do_not_light_all(renderer, flag):
    """A rough metal ball on a floor. In so few samples as the other tests have, which all seeds take at the same places
    of a pixel, its highlight, as large as a block, is 4 % low."""
    new_scene(world=0.1)
    plane(3.0, material(DIFFUSE, Color=(0.7, 0.7, 0.7)))
    ball(0.7, material(GLOSSY, "GGX", Color=(0.9, 0.6, 0.3), Roughness=0.4), place(at=(0.0, 0.0, 0.7)))
    made = light("AREA", 60.0, place(at=(0.8, -1.0, 2.5), turn=(20.0, 15.0, 0.0)), shape="SQUARE", size=0.8)
    setattr(made, flag, False)
    camera((0.0, -4.0, 2.2), (0.0, 0.0, 0.5), 40.0)
    compare_with_cycles(renderer, f"light_{flag}", 512, **RAYS | {"iterations": 40})


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize(("kind", "output"), [("POINT", "Linear"), ("AREA", "Constant"), ("SPOT", "Quadratic")])
def test_falloff_of_lights(renderer, kind, output, mode):
    new_scene()
    plane(3.0, material(DIFFUSE, Color=(0.8, 0.7, 0.6)))
    camera((0.0, -1.0, 6.0), (0.0, 0.0, 0.0), 30.0)
    made = light(kind, 40.0, place(at=(0.3, 0.2, 2.0)))
    if made.data.node_tree is None:
        made.data.use_nodes = True
    net = Net(made.data.node_tree)
    net.set(net.find("EMISSION").inputs["Strength"], net.out("LightFalloff", output, {"Strength": 0.8}))
    compare_with_cycles(renderer, f"falloff_{kind.lower()}_{mode.lower()}", 256, **MODES[mode])


@pytest.mark.parametrize("mode", MODES)
def test_emission_that_varies_over_a_mesh(renderer, mode):
    """A square of two triangles with a coarse checker of two colors, which also fades toward grazing angles."""
    new_scene()
    plane(3.0, material(DIFFUSE, Color=(0.8, 0.8, 0.8)))
    camera((0.0, -1.0, 6.0), (0.0, 0.0, 0.0), 30.0)
    glow = material("ShaderNodeEmission", Strength=20.0)
    tree = glow.node_tree
    emission = next(node for node in tree.nodes if node.type == "EMISSION")
    checker, facing = tree.nodes.new("ShaderNodeTexChecker"), tree.nodes.new("ShaderNodeLayerWeight")
    checker.inputs["Color1"].default_value, checker.inputs["Color2"].default_value = (1, 0.1, 0.1, 1), (0.1, 0.2, 1, 1)
    checker.inputs["Scale"].default_value = 2.0
    fade = tree.nodes.new("ShaderNodeMath")
    fade.operation, fade.inputs[0].default_value = "SUBTRACT", 20.0
    scale = tree.nodes.new("ShaderNodeMath")
    scale.operation, scale.inputs[1].default_value = "MULTIPLY", 20.0
    tree.links.new(facing.outputs["Facing"], scale.inputs[0])
    tree.links.new(scale.outputs[0], fade.inputs[1])
    tree.links.new(fade.outputs[0], emission.inputs["Strength"])
    tree.links.new(checker.outputs["Color"], emission.inputs["Color"])
    plane(0.6, glow, place(at=(0.3, 0.0, 1.2), turn=(160.0, 0.0, 30.0)))
    compare_with_cycles(renderer, f"emission_varies_{mode.lower()}", 512, **MODES[mode])


def test_shadow_catchers_show_the_shadow_of_lights(renderer):
    """The shadow is cast by a dark ball, which reflects next to nothing onto the floor.

    Cycles' film is transparent, and its alpha lays the picture over the world. With an opaque film, Cycles weights
    the world behind a catcher by what objects in front leave of the pixel, and by the same a second time: an edge that
    covers half of a pixel shows a quarter of the world, 4 % of a block here.
    """
    world = 0.5
    new_scene(world=world)
    plane(3.0, material(DIFFUSE, Color=(0.7, 0.7, 0.7))).is_shadow_catcher = True
    ball(0.5, material(DIFFUSE, Color=(0.02, 0.02, 0.02)), place(at=(0.0, 0.0, 0.6)), segments=32)
    light("AREA", 60.0, place(at=(0.8, -1.0, 2.5), turn=(20.0, 15.0, 0.0)), shape="SQUARE", size=0.8)
    camera((0.0, -4.0, 2.2), (0.0, 0.0, 0.5), math.degrees(0.7))
    reference = render_cycles_over(world, samples=512)
    compare("shadow_catcher", render_rppm(renderer, seeds=8, **RAYS), reference, CONVERGED)


def test_shadow_catchers_with_a_back_hide_what_is_behind(renderer):
    """A box that catches shadows, with a ball behind it; a weak lamp, since light that goes from ball to box does not
    count."""
    new_scene(world=0.5)
    box((0.6, 0.6, 0.3), material(DIFFUSE), place(at=(0.0, 0.0, 0.3))).is_shadow_catcher = True
    ball(0.4, material(DIFFUSE, Color=(0.02, 0.02, 0.02)), place(at=(0.0, 1.1, 0.4)), segments=32)
    ball(0.15, material(DIFFUSE, Color=(0.02, 0.02, 0.02)), place(at=(0.1, 0.0, 0.9)), segments=32)
    light("AREA", 20.0, place(at=(0.8, -1.0, 2.5), turn=(20.0, 15.0, 0.0)), shape="SQUARE", size=0.8)
    camera((0.0, -4.0, 2.2), (0.0, 0.0, 0.5), math.degrees(0.6))
    reference = render_cycles_over(0.5, samples=512)
    compare("shadow_catcher_box", render_rppm(renderer, seeds=8, **RAYS), reference, CONVERGED)


@pytest.mark.parametrize("lets_pass", [True, False])
def test_transparent_shadows(renderer, lets_pass):
    """Half of the light passes a transparent screen, or none of a light's."""
    new_scene()
    plane(3.0, material(DIFFUSE, Color=(0.7, 0.7, 0.7)))
    half = material("ShaderNodeBsdfPrincipled", Base_Color=(0.2, 0.4, 0.8), Alpha=0.5, Specular_IOR_Level=0.0)
    half.use_transparent_shadow = lets_pass
    plane(0.6, half, place(at=(0.0, 0.0, 0.6)))
    light("AREA", 60.0, place(at=(0.8, -1.0, 2.5), turn=(20.0, 15.0, 0.0)), shape="SQUARE", size=0.3)
    camera((0.0, -4.0, 2.2), (0.0, 0.0, 0.5), 40.0)
    compare_with_cycles(renderer, f"transparent_shadow_{lets_pass}", 512, **RAYS)
