# SPDX-License-Identifier: GPL-3.0-or-later
"""Collections, particles and geometry nodes that place what others place seldom: lamps, hair, text, volumes."""

from .. import materials
from ..draws import Draws
from ..graphs import finish, geometry_nodes, material
from ..scenes import Place, add, collection, curve, cylinder, instance, lamp, modifier, shape, text
from .parts import matte, part


@part
def mixed_collection(draws: Draws, at: Place) -> None:
    """Instances of a collection with an offset that holds text, a curve, a metaball, a lamp and an empty."""
    paint = matte(draws.color(0.9))
    things = [
        text("abc", paint, (0.0, 0.0, 0.25), size=0.15, extrude=0.02),
        curve([(0, 0, 0), (0.1, 0, 0.1), (0.2, 0.1, 0.05)], matte(draws.color(0.9)), 0.02),
        add("Empty", None),
        lamp("POINT", (0.1, -0.2, 0.3), 3.0, shadow_soft_size=0.02),
        add("Cube", shape("cube", paint), (0.05, 0, 0.1), scale=(0.1, 0.1, 0.15)),
    ]
    held = collection("Mixed", things)
    held.instance_offset = (0.1, 0.0, 0.0)
    for number in range(3):
        turned = (0, 0, draws.between(-0.5, 0.5))
        instance(held, (at[0] + 0.3 * (number - 1), at[1], 0.05), turned, (draws.pick((1, -1)), 1, 1.2))


@part
def overridden(draws: Draws, at: Place) -> None:
    """Copies that share a mesh, with other materials, modifiers, colors and visibility."""
    mesh = shape("icosphere", matte(draws.color(0.9)), radius=0.15)
    for number in range(4):
        copy = add("Copy", mesh, (at[0] + 0.25 * (number - 1.5), at[1] + 0.1 * number, 0.2))
        if number == 1:
            copy.material_slots[0].link = "OBJECT"
            copy.material_slots[0].material = matte(draws.color(0.9))
        elif number == 2:
            modifier(copy, "BUILD" if draws.maybe() else "SUBSURF")
        elif number == 3:
            copy.visible_camera, copy.visible_shadow = draws.pick(((True, False), (False, True)))
            copy.material_slots[0].link = "OBJECT"


@part
def furry_instances(draws: Draws, at: Place) -> None:
    """Instances of a ball that has hair of its own."""
    ball = add("Furry", shape("icosphere", matte(draws.color(0.9)), True, radius=0.12))
    settings = modifier(ball, "PARTICLE_SYSTEM").particle_system.settings
    settings.type, settings.count, settings.hair_length, settings.root_radius = "HAIR", 80, 0.12, 1.0
    settings.radius_scale = 0.02
    held = collection("Fur", [ball])
    for number in range(3):
        instance(held, (at[0] + 0.32 * (number - 1), at[1], 0.25), (0, 0, number), (1, 1, 0.7 + 0.3 * number))


@part
def emitted(draws: Draws, at: Place) -> None:
    """Particles of an emitter, some of them dead, which are shown as objects that turn."""
    flake = add("Flake", shape("cone", matte(draws.color(0.9)), segments=6), (0, 0, -5), scale=(0.3, 0.3, 0.6))
    source = add("Source", shape("grid", materials.plain(draws)), (at[0], at[1], 0.6), scale=(0.6, 0.6, 1))
    settings = modifier(source, "PARTICLE_SYSTEM").particle_system.settings
    settings.count, settings.frame_start, settings.frame_end, settings.lifetime = 30, 1, 2, 8
    settings.normal_factor, settings.factor_random, settings.size_random = -0.5, 0.4, 0.5
    settings.render_type, settings.instance_object, settings.particle_size = "OBJECT", flake, 0.15
    settings.use_rotations, settings.use_scale_instance = True, draws.maybe()
    settings.use_dead = draws.maybe()
    source.show_instancer_for_render = draws.maybe()


@part
def lamps_on_points(draws: Draws, at: Place) -> None:
    """A lamp instanced on the vertices or the faces of a mesh."""
    parent = add("Bar", shape("grid", matte(draws.color(0.5)), x_segments=2, y_segments=1), (at[0], at[1], 0.8))
    parent.scale, parent.rotation_euler = (0.6, 0.2, 1), (0.1, 0.2, 0)
    child = lamp(draws.pick(("POINT", "SPOT", "AREA")), (0, 0, -0.1), 2.0)
    child.parent, parent.instance_type = parent, draws.pick(("VERTS", "FACES"))
    if child.data.type == "AREA":
        child.data.size = 0.1
    add("Lit", shape("icosphere", matte(draws.color(0.9)), radius=0.2), (at[0], at[1], 0.25))


@part
def nodes_of_many_kinds(draws: Draws, at: Place) -> None:
    """Geometry nodes that give a mesh, curves, points, instances and a volume at once."""
    thing = add("Many", shape("grid", matte(draws.color(0.9)), x_segments=3, y_segments=3), (at[0], at[1], 0.02))
    thing.scale = (0.8, 0.8, 1)
    graph, given, output = geometry_nodes(thing)
    paint, other = matte(draws.color(0.9)), matte(draws.color(0.9))
    points = graph.node("DistributePointsOnFaces", None, {0: given}, Density=20.0)
    sized = graph.node("SetPointRadius", None, {0: graph.node("MeshToPoints", None, {0: given})}, Radius=0.06)
    dots = graph.node("SetMaterial", None, {0: sized}, Material=paint)
    string = graph.node("StringToCurves", None, {"String": "xy"}, Size=0.3)
    filled = graph.node("FillCurve", None, {0: string})
    upright = graph.node("Transform", None, {0: filled, "Translation": (-0.2, 0, 0.3), "Rotation": (1.5, 0, 0)})
    letters = graph.node("SetMaterial", None, {0: graph.node("RealizeInstances", None, {0: upright})}, Material=other)
    cones = graph.node("InstanceOnPoints", None, {0: points.outputs[0], "Instance": graph.node("MeshCone"),
                                                 "Scale": (0.06, 0.06, 0.2)})  # fmt: skip
    joined = graph.node("JoinGeometry")
    for one in (given, dots, letters, cones):
        graph.tree.links.new(one.outputs[0], joined.inputs[0])
    graph.tree.links.new(joined.outputs[0], output.inputs[0])


@part
def nested_instances(draws: Draws, at: Place) -> None:
    """Instances on instances by geometry nodes, with Object Info of an object that has children and modifiers."""
    small = add("Small", shape("cube", matte(draws.color(0.9))), (0.0, 0.0, -5.0), (0.3, 0, 0), (0.3, 0.3, 0.6))
    modifier(small, "BEVEL", width=0.1, segments=2)
    thing = add("Host", shape("icosphere", None, subdivisions=1), (at[0], at[1], 0.45), scale=(0.5,) * 3)
    graph, given, output = geometry_nodes(thing)
    info = graph.node("ObjectInfo", {"transform_space": draws.pick(("ORIGINAL", "RELATIVE"))}, {0: small})
    info.inputs["As Instance"].default_value = draws.maybe()
    line = graph.node("MeshLine", None, {0: 3}, Offset=(0, 0, 0.6))
    placed = {0: line, "Instance": info.outputs["Geometry"], "Scale": (0.5,) * 3}
    inner = graph.node("InstanceOnPoints", None, placed)
    normal = graph.tree.nodes.new("GeometryNodeInputNormal")
    turn = graph.tree.nodes.new("FunctionNodeAlignRotationToVector")
    graph.tree.links.new(normal.outputs[0], turn.inputs["Vector"])
    outer = graph.node("InstanceOnPoints", None, {0: given, "Instance": inner, "Scale": (0.3,) * 3,
                                                 "Rotation": turn.outputs[0]})  # fmt: skip
    graph.tree.links.new(outer.outputs[0], output.inputs[0])


@part
def instanced_smoke(draws: Draws, at: Place) -> None:
    """Two instances of a box of even fog, one of them scaled."""
    made, graph = material("Fog")
    finish(graph, volume=graph.node("VolumePrincipled", Density=4.0, Color=draws.color(0.3, (0.6, 1.0))))
    held = collection("Puff", [add("Puff", shape("cube", made), scale=(0.3, 0.3, 0.3))])
    instance(held, (at[0] - 0.2, at[1], 0.3))
    instance(held, (at[0] + 0.25, at[1], 0.35), (0, 0, 0.5), (1.2, 1.2, 2.0))


@part
def strands(draws: Draws, at: Place) -> None:
    """Hair with children, kink, a vertex group, tapering radii and no emitter."""
    ball = add("Head", shape("uvsphere", matte(draws.color(0.9)), True, radius=0.25), (at[0], at[1], 0.4))
    group = ball.vertex_groups.new(name="Top")
    group.add([v.index for v in ball.data.vertices if v.co.z > 0], 1.0, "REPLACE")
    hair = matte(draws.color(0.9))
    ball.data.materials.append(hair)
    system = modifier(ball, "PARTICLE_SYSTEM").particle_system
    system.vertex_group_density = "Top"
    settings = system.settings
    settings.type, settings.count, settings.hair_length, settings.material = "HAIR", 60, 0.25, 2
    settings.child_type = draws.pick(("NONE", "SIMPLE", "INTERPOLATED"))
    settings.rendered_child_count, settings.kink = 4, draws.pick(("NO", "CURL", "WAVE", "BRAID"))
    settings.root_radius, settings.tip_radius, settings.radius_scale = 1.0, draws.pick((0.0, 1.0)), 0.015
    settings.shape, settings.use_close_tip = draws.between(-0.5, 0.5), draws.maybe()
    ball.show_instancer_for_render = draws.maybe(0.7)


@part
def portals_of_alpha(draws: Draws, at: Place) -> None:
    """Many transparent cards behind each other, instanced by an array with an object offset."""
    made, graph = material("Sheet")
    clear, lit = (
        graph.node("BsdfTransparent", Color=draws.color(0.3, (0.8, 1.0))),
        graph.node("BsdfDiffuse", Color=draws.color()),
    )
    finish(graph, graph.node("MixShader", None, {0: 0.2, 1: clear, 2: lit}))
    card = add("Card", shape("grid", made), (at[0] - 0.2, at[1] - 0.3, 0.4), (1.5, 0, 0.2), (0.6, 0.6, 1))
    step = add("Step", None, (at[0] - 0.18, at[1] - 0.27, 0.4), (1.5, 0.02, 0.2), (0.6, 0.6, 1))
    modifier(card, "ARRAY", count=12, use_relative_offset=False, use_object_offset=True, offset_object=step)
    add("Pole", cylinder(matte(draws.color(0.9)), 0.06, 0.8), (at[0], at[1] + 0.3, 0.42))
