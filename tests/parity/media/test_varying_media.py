# SPDX-License-Identifier: GPL-3.0-or-later
"""Media that vary from place to place."""

import bpy
import pytest

from ..comparison import Tolerance
from ..engines import compare_with_cycles
from ..net import Net, diffuse, material
from ..scenes import box, camera, light, new_scene, place, plane

PATHS = {"photons": 16384, "iterations": 24, "max_bounces": 32, "transparent_max_bounces": 32}
NEAR = Tolerance(mean=0.015, block=0.04, mode=0.015)


def cloud(net: Net) -> bpy.types.NodeSocket:
    """A density by noise, with holes in it."""
    place_in_object = net.out("TexCoord", "Object")
    noise = net.out("TexNoise", inputs={"Vector": place_in_object, "Scale": 1.5, "Detail": 2.0})
    return net.out("MapRange", inputs={"Value": noise, "From Min": 0.45, "From Max": 0.7, "To Max": 4.0})


def absorbing(net: Net, density: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
    return net.out("VolumeAbsorption", inputs={"Color": (0.7, 0.4, 0.2), "Density": density})


def absorbing_cloud() -> None:
    """A cloud over a floor, lit by the world and a lamp whose light passes through it."""
    made, net = material("Cloud")
    net.output(Volume=absorbing(net, cloud(net)))
    box((1.0, 1.0, 1.0), made, place(at=(0.0, 0.0, 1.2)))
    light("AREA", 150.0, place(at=(1.0, -1.0, 5.0)), shape="SQUARE", size=1.0)
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.4


def shining_cloud() -> None:
    """A cloud that is the only light, and absorbs."""
    made, net = material("Fire")
    density = cloud(net)
    emission = net.out("Emission", inputs={"Color": (1.0, 0.5, 0.2), "Strength": density})
    net.output(Volume=net.out("AddShader", inputs={0: absorbing(net, density), 1: emission}))
    box((1.0, 1.0, 1.0), made, place(at=(0.0, 0.0, 1.2)))


def volume_of_nodes() -> None:
    """A volume object that geometry nodes make, a ball whose density falls off, turned and stretched; it absorbs."""
    made, net = material("Ball")
    net.output(Volume=net.out("VolumePrincipled", inputs={"Color": (0.0, 0.0, 0.0), "Density": 1.5}))
    ball_of_nodes(made)


def volume_without_a_material() -> None:
    """The same ball without a material, which scatters as Principled Volume does by itself."""
    ball_of_nodes(None)


def ball_of_nodes(made: bpy.types.Material | None) -> None:
    """A volume of geometry nodes whose density falls from the middle of a box on."""
    source = box((1.0, 1.0, 1.0), made, place(at=(0.0, 0.0, 1.2), turn=(0.0, 0.0, 30.0)))
    source.scale = (1.2, 1.0, 0.9)
    tree = bpy.data.node_groups.new("Ball", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    nodes = {name: tree.nodes.new(kind) for name, kind in (
        ("out", "NodeGroupOutput"), ("cube", "GeometryNodeVolumeCube"), ("at", "GeometryNodeInputPosition"),
        ("length", "ShaderNodeVectorMath"), ("density", "ShaderNodeMapRange"), ("slot", "GeometryNodeSetMaterial"),
    )}  # fmt: skip
    nodes["length"].operation = "LENGTH"
    nodes["density"].inputs["To Min"].default_value, nodes["density"].inputs["To Max"].default_value = 3.0, 0.0
    nodes["slot"].inputs["Material"].default_value = made
    for axis in "XYZ":
        nodes["cube"].inputs[f"Resolution {axis}"].default_value = 24
    for first, second in (
        (nodes["at"].outputs[0], nodes["length"].inputs[0]),
        (nodes["length"].outputs["Value"], nodes["density"].inputs["Value"]),
        (nodes["density"].outputs[0], nodes["cube"].inputs["Density"]),
        (nodes["cube"].outputs[0], nodes["slot"].inputs[0]),
        (nodes["slot"].outputs[0], nodes["out"].inputs[0]),
    ):
        tree.links.new(first, second)
    source.modifiers.new("Ball", "NODES").node_group = tree
    light("AREA", 150.0, place(at=(1.0, -1.0, 5.0)), shape="SQUARE", size=1.0)


BUILDS = [
    pytest.param(absorbing_cloud, marks=pytest.mark.long),
    shining_cloud,
    volume_of_nodes,
    volume_without_a_material,
]


@pytest.mark.parametrize("build", BUILDS, ids=lambda build: build.__name__)
def test_media_that_vary_look_as_in_cycles(renderer, build):
    new_scene()
    plane(4.0, diffuse("Floor", (0.6, 0.55, 0.5)))
    camera((0.0, -6.0, 2.6), (0.0, 0.0, 1.0), 38.0)
    build()
    compare_with_cycles(renderer, f"varying_{build.__name__}", 256, NEAR, **PATHS)
