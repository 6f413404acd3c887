# SPDX-License-Identifier: GPL-3.0-or-later
"""Outdoor scenes: hills, water, trees of leaf cards, haze; and low-poly islands."""

import math

import bpy
import numpy as np

from . import materials
from .draws import Draws
from .graphs import Graph, finish, geometry_nodes, material
from .scenes import add, camera, collection, cylinder, instance, kind, lamp, modifier, shape, world


def _terrain(draws: Draws, size: float) -> bpy.types.Object:
    """A hill field by a Displace modifier, or by displacement in its material."""
    paint = draws.pick((materials.procedural, materials.plain, _slopes))(draws)
    ground = add("Terrain", shape("grid", paint, True, x_segments=40, y_segments=40, size=size / 2))
    texture = bpy.data.textures.new("Hills", draws.pick(("CLOUDS", "MUSGRAVE", "VORONOI")))
    texture.noise_scale = draws.between(2.0, 4.0)
    modifier(ground, "DISPLACE", texture=texture, strength=draws.between(1.0, 3.0), texture_coords="GLOBAL")
    if draws.maybe(0.4):
        modifier(ground, "DECIMATE", ratio=0.3)
        ground.data.shade_flat()
    return ground


def _slopes(draws: Draws) -> bpy.types.Material:
    """Grass where it is level and rock where it is steep, bumped."""
    made, graph = material("Slopes")
    up = graph.node("SeparateXYZ", None, {0: graph.node("NewGeometry").outputs["Normal"]}).outputs[2]
    level = graph.ramp(up, [(0.7, draws.color(0.3)), (0.85, draws.color(0.8))])
    noise = graph.node("TexNoise", Scale=3.0, Vector=graph.node("TexCoord").outputs["Object"])
    color = graph.mixed(0.5, level, noise.outputs["Color"], "MULTIPLY")
    bump = graph.node("Bump", Height=noise, Strength=0.4, Distance=0.2)
    finish(graph, graph.node("BsdfPrincipled", Base_Color=color, Roughness=0.8, Normal=bump))
    return made


def _tree(draws: Draws) -> bpy.types.Collection:
    """A trunk with leaf cards, or cones of a low-poly fir."""
    bark = materials.procedural(draws) if draws.maybe() else materials.plain(draws)
    parts = [add("Trunk", cylinder(bark, 0.08, 1.0, 8), (0, 0, 0.5))]
    if draws.maybe(0.3):
        green = materials.plain(draws)
        for at in range(3):
            cone = shape("cone", green, segments=7, radius1=0.5 - 0.12 * at, depth=0.6)
            parts.append(add("Fir", cone, (0, 0, 0.8 + 0.35 * at)))
        return collection("Fir", parts)
    card = shape("grid", materials.leaf(draws))
    count = draws.randint(30, 80)
    for _ in range(count):
        away, angle, up = draws.between(0.1, 0.6), draws.between(0, 6.3), draws.between(0.7, 1.7)
        at = (away * math.cos(angle), away * math.sin(angle), up)
        size = draws.between(0.2, 0.4)
        parts.append(add("Leaf", card, at, draws.vector(0, 3), (size, size, size)))
    return collection("Tree", parts)


def _rocks(draws: Draws, ground: bpy.types.Object) -> None:
    rock = add("Rock", shape("icosphere", materials.procedural(draws), radius=0.15, subdivisions=2), (0, 0, -20))
    texture = bpy.data.textures.new("Rock", "VORONOI")
    modifier(rock, "DISPLACE", texture=texture, strength=0.1)
    graph, given, output = geometry_nodes(ground)
    points = graph.node("DistributePointsOnFaces", None, {0: given}, Density=draws.between(0.3, 1.0))
    info = graph.node("ObjectInfo", None, {0: rock}, As_Instance=True).outputs["Geometry"]
    size = graph.tree.nodes.new("FunctionNodeRandomValue")
    size.inputs[2].default_value, size.inputs[3].default_value = 0.3, 1.6
    inputs = {0: points, "Instance": info, "Scale": size.outputs[1], "Rotation": points.outputs["Rotation"]}
    rocks = graph.node("InstanceOnPoints", None, inputs)
    joined = graph.node("JoinGeometry", None, {0: rocks})
    graph.tree.links.new(given.outputs[0], joined.inputs[0])
    graph.tree.links.new(joined.outputs[0], output.inputs[0])


def _water(draws: Draws) -> None:
    """An ocean, or a plane with waves of a bump."""
    made, graph = material("Water")
    bump = graph.node("Bump", Height=graph.node("TexNoise", Scale=20.0), Strength=0.2, Distance=0.1)
    color = draws.color(0.7, (0.05, 0.3))
    inputs = {"Base_Color": color, "Roughness": draws.between(0.05, 0.25), "IOR": 1.33, "Normal": bump}
    finish(graph, graph.node("BsdfPrincipled", **inputs))
    sea = add("Sea", shape("grid", made, True), (0, 0, draws.between(0.1, 0.6)), scale=(30, 30, 1))
    if draws.maybe():
        modifier(sea, "OCEAN", resolution=5, spatial_size=30, wave_scale=0.4, choppiness=0.8, size=1.0)
        sea.scale, sea.location.x, sea.location.y = (1, 1, 1), 0, 0


@kind
def landscape(draws: Draws) -> None:
    """Hills with rocks and trees that are collection instances, water, a sun and sometimes haze."""
    size = 16.0
    ground = _terrain(draws, size)
    if draws.maybe(0.7):
        _rocks(draws, ground)
    if draws.maybe(0.6):
        _water(draws)
    trees = [_tree(draws) for _ in range(draws.randint(1, 2))]
    for _ in range(draws.randint(8, 30)):
        at = (draws.between(-5, 5), draws.between(-2, 6), draws.between(0.2, 0.8))
        grown = draws.between(0.6, 1.6)
        instance(draws.pick(trees), at, (0, 0, draws.between(0, 6)), (grown, grown, grown * draws.between(0.8, 1.3)))
    tree = world(draws.color(0.5, (0.3, 0.8)), 1.0)
    graph, output = Graph(tree), tree.nodes["World Output"]
    if draws.maybe():
        settings = {"sky_type": draws.pick(("MULTIPLE_SCATTERING", "SINGLE_SCATTERING", "PREETHAM", "HOSEK_WILKIE"))}
        sky = graph.node("TexSky", settings)
        sky.sun_elevation, sky.sun_rotation, sky.sun_disc = draws.between(0.15, 1.0), draws.between(0, 6), draws.maybe()
        tree.links.new(sky.outputs[0], tree.nodes["Background"].inputs["Color"])
        scattered = "SCATTERING" in settings["sky_type"]
        tree.nodes["Background"].inputs["Strength"].default_value = 0.1 if scattered else 0.3
    if draws.maybe(0.4):
        haze = graph.node("VolumeScatter", Color=draws.color(0.2, (0.7, 1.0)), Density=draws.between(0.003, 0.02))
        haze.inputs["Anisotropy"].default_value = draws.pick((0.0, 0.4))
        tree.links.new(haze.outputs[0], output.inputs["Volume"])
    lamp("SUN", (0, 0, 9), draws.between(1.0, 4.0), (draws.between(-4, 4), 4, 3), angle=draws.between(0.005, 0.1))
    camera((draws.between(-2, 2), -8.5, draws.between(3.6, 5.0)), (0, 2, 0.8), draws.between(28, 45))


def _painted(draws: Draws, mesh: bpy.types.Mesh) -> bpy.types.Mesh:
    """A color for each face or corner, which its material shows."""
    domain = draws.pick(("CORNER", "POINT"))
    layer = mesh.color_attributes.new("Color", draws.pick(("BYTE_COLOR", "FLOAT_COLOR")), domain)
    colors = np.ones((len(layer.data), 4), np.float32)
    colors[:, :3] = np.random.default_rng(draws.randint(0, 999)).uniform(0.1, 0.9, (len(layer.data), 3))
    layer.data.foreach_set("color", colors.ravel())
    return mesh


def _vertex_colored(draws: Draws) -> bpy.types.Material:
    made, graph = material("Vertex Colors")
    node = graph.node(
        *draws.pick((("VertexColor", {"layer_name": "Color"}), ("Attribute", {"attribute_name": "Color"})))
    )
    shaders = ("BsdfDiffuse", "BsdfToon", "BsdfAnisotropic")
    shader = draws.pick(shaders)
    inputs = {"Roughness": draws.between(0.3, 0.6)} if shader == "BsdfAnisotropic" else {}
    finish(graph, graph.node(shader, Color=node.outputs[0], **inputs))
    return made


@kind
def low_poly(draws: Draws) -> None:
    """Flat shaded things with vertex colors on an island, under many lamps."""
    island = shape("icosphere", _vertex_colored(draws), subdivisions=3, radius=4.0)
    add("Island", _painted(draws, island), (0, 0, -0.6), scale=(1, 1, 0.15))
    kinds = ("cube", "cone", "icosphere", "uvsphere", "monkey")
    meshes = []
    for form in kinds:
        options = (
            {"segments": 5} if form == "cone" else {"u_segments": 8, "v_segments": 5} if form == "uvsphere" else {}
        )
        options = {"subdivisions": 1} if form == "icosphere" else options
        meshes.append(_painted(draws, shape(form, _vertex_colored(draws), draws.maybe(0.2), **options)))
    for at in range(draws.randint(15, 60)):
        angle, away = 2.4 * at, 0.4 * math.sqrt(at)
        size = draws.between(0.2, 0.7)
        thing = add("Thing", draws.pick(meshes), (away * math.cos(angle), away * math.sin(angle), 0.3))
        thing.rotation_euler = draws.vector(-0.5, 0.5) if draws.maybe(0.3) else (0, 0, draws.between(0, 6))
        thing.scale = (size * draws.pick((1, 1, -1)), size, size * draws.between(0.8, 2.0))
        if draws.maybe(0.2):
            modifier(thing, draws.pick(("BEVEL", "WIREFRAME", "TRIANGULATE")))
    for _ in range(draws.randint(3, 20)):
        place = (draws.between(-3, 3), draws.between(-3, 3), draws.between(1.2, 3))
        size = draws.between(0.0, 0.2)
        lamp("POINT" if draws.maybe(0.7) else "SPOT", place, draws.between(5, 40), shadow_soft_size=size,
             color=draws.color(0.8, (0.7, 1.0))[:3])  # fmt: skip
    world(draws.color(0.5, (0.05, 0.5)))
    data = camera((3.5, -5.0, 3.5), (0, 0, 0.2), 35.0)
    if draws.maybe():
        data.type, data.ortho_scale = "ORTHO", 6.0
