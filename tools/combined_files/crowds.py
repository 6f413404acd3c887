# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances of instances: on vertices and faces, of collections, particles and geometry nodes, each of its color."""

import math

import bpy

from . import images, materials
from .draws import Draws
from .graphs import finish, geometry_nodes, material
from .rooms import sky
from .scenes import add, camera, collection, cylinder, instance, kind, lamp, modifier, shape


def tinted(draws: Draws) -> bpy.types.Material:
    """A color of each instance: by its random number, its object's color or an attribute of the instancer."""
    made, graph = material("Tinted")
    info = graph.node("ObjectInfo")
    choice = draws.pick(("random", "color", "attribute", "location", "texture"))
    stops = [(0.0, draws.color(0.9)), (0.5, draws.color(0.9)), (1.0, draws.color(0.9))]
    if choice == "random":
        color = graph.ramp(info.outputs["Random"], stops, "CONSTANT").outputs[0]
    elif choice == "color":
        color = info.outputs["Color"]
    elif choice == "attribute":
        color = graph.node("Attribute", {"attribute_type": "INSTANCER", "attribute_name": "Tint"}).outputs[0]
    elif choice == "location":
        color = graph.node("VectorMath", {"operation": "FRACTION"}, {0: info.outputs["Location"]}).outputs[0]
    else:
        picture = images.image("Picture", images.colored(draws))
        origin = graph.node("TexCoord", {"from_instancer": True}).outputs["UV"]
        color = graph.node("TexImage", {"image": picture}, Vector=origin).outputs[0]
    kind = draws.pick(("BsdfPrincipled", "BsdfDiffuse", "BsdfPrincipled"))
    finish(graph, graph.node(kind, None, {0: color}))
    return made


def _figure(draws: Draws) -> list[bpy.types.Object]:
    """The parts of a small person, the head of which is a child of the body."""
    paint = tinted(draws)
    body = add("Body", cylinder(paint, 0.08, 0.25, 10), (0, 0, 0.13))
    head = add(
        "Head", shape("uvsphere", draws.pick((tinted, materials.skin, materials.lacquer))(draws), True, radius=0.08)
    )
    head.parent, head.location = body, (0, 0, 0.2)
    hat = add("Hat", shape("cone", paint, radius1=0.1, depth=0.12, segments=8), (0, 0, 0.47), (0.1, 0, 0))
    hat.color = draws.color(0.9)
    return [body, head, hat]


def _on_mesh(draws: Draws, child: bpy.types.Object) -> None:
    """Copies of an object on the vertices or the faces of its parent."""
    parent = add("Parent", shape("grid", materials.plain(draws), x_segments=4, y_segments=3), (-1.0, 0.8, 0.02))
    child.parent = parent
    parent.scale = (1.4, 1.2, 1.0)
    parent.instance_type = draws.pick(("VERTS", "FACES"))
    parent.use_instance_vertices_rotation = draws.maybe(0.3)
    parent.use_instance_faces_scale, parent.instance_faces_scale = draws.maybe(), draws.between(0.8, 2.0)
    parent.show_instancer_for_render = draws.maybe()


def _scattered(draws: Draws, ground: bpy.types.Object, of: bpy.types.Collection) -> None:
    """Instances of a collection by geometry nodes, with a color stored on each."""
    graph, given, output = geometry_nodes(ground)
    points = graph.node("DistributePointsOnFaces", None, {0: given}, Density=draws.between(0.8, 2.5))
    random = graph.tree.nodes.new("FunctionNodeRandomValue")
    random.data_type = "FLOAT_VECTOR"
    info = graph.node("CollectionInfo", None, {0: of})
    made = graph.node("InstanceOnPoints", None, {0: points.outputs[0], "Instance": info})
    turn = graph.node("RotateInstances", None, {0: made, "Rotation": (0, 0, draws.between(0, 3))})
    settings = {"data_type": "FLOAT_COLOR", "domain": "INSTANCE"}
    store = graph.node("StoreNamedAttribute", settings, {0: turn}, Name="Tint")
    graph.tree.links.new(random.outputs[0], store.inputs["Value"])
    joined = graph.node("JoinGeometry", None, {0: store})
    graph.tree.links.new(given.outputs[0], joined.inputs[0])
    graph.tree.links.new(joined.outputs[0], output.inputs[0])


def _particles(draws: Draws, ground: bpy.types.Object, of: bpy.types.Collection) -> None:
    settings = modifier(ground, "PARTICLE_SYSTEM").particle_system.settings
    settings.type, settings.use_advanced_hair, settings.count = "HAIR", True, draws.randint(10, 50)
    settings.render_type, settings.instance_collection = "COLLECTION", of
    settings.use_whole_collection, settings.particle_size = draws.maybe(), 0.25
    settings.size_random, settings.use_rotation_instance = draws.between(0, 0.5), draws.maybe()


@kind
def crowd(draws: Draws) -> None:
    """People as instances in three ways on a square, with duplicates whose materials are their objects'."""
    ground = add("Ground", shape("grid", materials.textured(draws, 5.0)), scale=(8, 8, 1))
    people = collection("People", _figure(draws))
    group = collection("Group", [instance(people, (0.3 * at, 0.1 * at, 0), (0, 0, at)) for at in range(3)])
    for _ in range(draws.randint(3, 8)):
        turn = draws.between(0, 6)
        instance(
            group,
            (draws.between(-1.5, 1.5), draws.between(-1.2, 0.5), 0.004),
            (0, 0, turn),
            (draws.pick((1, -1)), 1, 1),
        )
    place = draws.pick((_scattered, _particles))
    place(draws, ground, draws.pick((people, group)))
    _on_mesh(draws, add("Child", shape("icosphere", tinted(draws), draws.maybe(), radius=0.07), (0, 0, 0.08)))
    shared = shape("cube", tinted(draws))
    for at in range(draws.randint(5, 15)):
        angle = 0.7 * at
        pillar = add(
            "Pillar", shared, (2.2 * math.cos(angle), 1.2 + math.sin(angle), 0.31), (0, 0, angle), (0.2, 0.2, 0.6)
        )
        pillar.color = draws.color(0.9)
        if draws.maybe(0.4):
            pillar.material_slots[0].link = "OBJECT"
            pillar.material_slots[0].material = materials.anything(draws)
        if draws.maybe(0.2):
            pillar.scale.x *= -1
    sky(draws)
    lamp("SUN", (0, 0, 5), draws.between(1.0, 3.0), (draws.between(-3, 3), 2, 0), angle=0.05)
    camera((draws.between(-1, 1), -3.6, draws.between(1.4, 2.4)), (0, 0.2, 0.2), 38.0)
