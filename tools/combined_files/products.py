# SPDX-License-Identifier: GPL-3.0-or-later
"""Things on a table: product shots and donuts."""

import math

import bpy
import numpy as np

from . import materials
from .draws import Draws
from .graphs import geometry_nodes
from .rooms import sky
from .scenes import add, camera, cylinder, kind, lamp, modifier, shape, text, world


def backdrop(paint: bpy.types.Material, size: float = 8.0) -> bpy.types.Object:
    """A floor that bends up to a wall."""
    made = bpy.data.meshes.new("Backdrop")
    angles = np.linspace(0.0, math.pi / 2, 9)
    profile = [
        (-size / 2, 0.0),
        *((size / 4 + math.sin(a), 1.0 - math.cos(a)) for a in angles),
        (size / 4 + 1.0, size / 2),
    ]
    corners = [(x, y, z) for y, z in profile for x in (-size, size)]
    faces = [(2 * at, 2 * at + 1, 2 * at + 3, 2 * at + 2) for at in range(len(profile) - 1)]
    made.from_pydata(corners, [], faces)
    made.shade_smooth()
    made.materials.append(paint)
    return add("Backdrop", made)


def studio(draws: Draws) -> None:
    """Two or three soft lights around the origin."""
    for at in range(draws.randint(2, 3)):
        angle = draws.between(0.0, 1.5) + 2.1 * at
        place = (2.5 * math.cos(angle), 2.0 * math.sin(angle) - 1.0, draws.between(1.5, 3.0))
        form = draws.pick(("SQUARE", "RECTANGLE", "DISK", "ELLIPSE"))
        one = lamp("AREA", place, draws.between(30, 120), (0, 0, 0.3), shape=form, size=draws.between(0.4, 1.2))
        one.data.size_y, one.data.color = draws.between(0.5, 1.5), draws.color(0.2, (0.8, 1.0))[:3]
        one.data.spread = draws.pick((math.pi, math.pi, 1.5))


@kind
def product(draws: Draws) -> None:
    """Bottles, boxes and words with layered materials before a backdrop, in depth of field."""
    if draws.maybe(0.7):
        backdrop(materials.plain(draws) if draws.maybe(0.6) else materials.procedural(draws))
    else:
        add("Table", shape("grid", materials.lacquer(draws)), scale=(12, 12, 1))
    for at in range(draws.randint(12, 24)):
        angle, away = 2.4 * at, 0.28 * math.sqrt(at)
        x, y = away * math.cos(angle), away * math.sin(angle)
        tall = draws.between(0.2, 0.6)
        choice = draws.pick(("bottle", "box", "ball", "monkey", "screw"))
        paint = draws.pick(
            (materials.lacquer, materials.lacquer, materials.glass, materials.metal, materials.textured)
        )(draws)
        if choice == "bottle":
            made = add("Bottle", cylinder(paint, 0.1, tall), (x, y, tall / 2 + 0.004))
            modifier(made, "BEVEL", width=0.02, segments=3, limit_method="ANGLE")
            made.data.shade_smooth()
            add("Cap", cylinder(materials.plain(draws), 0.05, 0.06), (x, y, tall + 0.037))
        elif choice == "box":
            made = add("Box", shape("cube", paint), (x, y, tall / 2 + 0.004), (0, 0, draws.random()), (0.2, 0.2, tall))
            modifier(made, "BEVEL", width=0.015, segments=3)
        elif choice == "screw":
            made = add(
                "Ring", shape("cone", paint, True, radius1=0.1, radius2=0.12, depth=0.1, cap_ends=False), (x, y, 0.06)
            )
            modifier(made, "SOLIDIFY", thickness=0.02)
            modifier(made, "SUBSURF", levels=1, render_levels=2)
        else:
            made = add(choice, shape("uvsphere" if choice == "ball" else "monkey", paint, True), (x, y, 0.13))
            made.scale = (0.25, 0.25, 0.25) if choice == "ball" else (0.12, 0.12, 0.12)
    words = text(draws.pick(("RPPM", "Sale", "No. 5", "new")), materials.lacquer(draws), (-0.6, 0.5, 0.02), size=0.35)
    words.data.extrude, words.data.bevel_depth, words.data.bevel_resolution = 0.03, 0.006, 2
    sky(draws)
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value *= 0.5
    studio(draws)
    data = camera((draws.between(-1.0, 1.0), -2.3, draws.between(0.6, 1.2)), (0, 0.1, 0.25), draws.between(40, 60))
    if draws.maybe(0.7):
        data.dof.use_dof, data.dof.focus_distance = True, 2.3
        data.dof.aperture_fstop, data.dof.aperture_blades = draws.between(0.8, 4.0), draws.pick((0, 6))


@kind
def donut(draws: Draws) -> None:
    """The donut of the tutorial: frosting with sprinkles of geometry nodes or particles, on a plate."""
    bpy.ops.mesh.primitive_torus_add(major_radius=0.5, minor_radius=0.25, major_segments=28, minor_segments=12)
    dough = bpy.context.object
    dough.location.z = 0.33
    dough.data.materials.append(materials.skin(draws) if draws.maybe() else materials.procedural(draws))
    dough.data.shade_smooth()
    modifier(dough, "SUBSURF", levels=1, render_levels=draws.randint(1, 2))
    icing = _icing(draws, dough)
    sprinkles = [_sprinkle(draws) for _ in range(draws.randint(1, 4))]
    if draws.maybe(0.6):
        _scatter(draws, icing, sprinkles)
    else:
        _particles(draws, icing, sprinkles)
    plate = add("Plate", cylinder(materials.lacquer(draws), 1.0, 0.06, 32), (0, 0, 0.035))
    modifier(plate, "BEVEL", width=0.02, segments=3, limit_method="ANGLE")
    add("Table", shape("grid", materials.textured(draws, 3.0)), scale=(10, 10, 1))
    if draws.maybe():
        cup = shape("cone", materials.glass(draws) if draws.maybe() else materials.lacquer(draws), True, cap_ends=False)
        thing = add("Cup", cup, (-1.1, 0.9, 0.47), (math.pi, 0, 0), (0.7, 0.7, 0.9))
        modifier(thing, "SOLIDIFY", thickness=0.06)
    world(draws.color(0.3, (0.1, 0.6)))
    lamp("POINT", (2.0, -1.2, 2.6), draws.between(100, 300), shadow_soft_size=draws.between(0.1, 0.5))
    if draws.maybe():
        lamp("SUN", (0, 0, 5), 2.0, (1.0, 1.0, 0.0), angle=0.1)
    data = camera((0, -2.6, draws.between(1.4, 2.2)), (0, 0, 0.25), 45.0)
    data.dof.use_dof, data.dof.focus_distance, data.dof.aperture_fstop = draws.maybe(), 2.8, 1.4


def _icing(draws: Draws, dough: bpy.types.Object) -> bpy.types.Object:
    """The upper half of the dough, thickened."""
    made = add("Icing", dough.data.copy(), (0, 0, 0.335))
    made.data.materials.clear()
    made.data.materials.append(materials.skin(draws) if draws.maybe(0.7) else materials.lacquer(draws))
    cut = bpy.data.meshes.new("Icing")
    kept = [face for face in made.data.polygons if face.center.z > 0.02]
    used = sorted({vertex for face in kept for vertex in face.vertices})
    place = {vertex: at for at, vertex in enumerate(used)}
    corners = [made.data.vertices[vertex].co * 1.0 for vertex in used]
    cut.from_pydata(corners, [], [[place[vertex] for vertex in face.vertices] for face in kept])
    cut.materials.append(made.data.materials[0])
    cut.shade_smooth()
    made.data = cut
    modifier(made, "SOLIDIFY", thickness=0.05, offset=1.0)
    modifier(made, "SUBSURF", levels=1, render_levels=2)
    return made


def _sprinkle(draws: Draws) -> bpy.types.Object:
    made = add(
        "Sprinkle", cylinder(draws.pick((materials.plain, materials.lacquer))(draws), 0.012, 0.07, 8), (0, 0, -5)
    )
    made.rotation_euler = (0, math.pi / 2, 0)
    made.data.shade_smooth()
    return made


def _scatter(draws: Draws, icing: bpy.types.Object, sprinkles: list[bpy.types.Object]) -> None:
    graph, given, output = geometry_nodes(icing)
    points = graph.node("DistributePointsOnFaces", None, {0: given}, Density=draws.between(40, 150))
    points.inputs["Seed"].default_value = draws.randint(0, 99)
    holder = bpy.data.collections.new("Sprinkles")
    for sprinkle in sprinkles:
        holder.objects.link(sprinkle)
    info = graph.node("CollectionInfo", None, {0: holder}, Separate_Children=True, Reset_Children=True)
    random = graph.tree.nodes.new("FunctionNodeRandomValue")
    random.data_type = "FLOAT_VECTOR"
    random.inputs[1].default_value = (6.0, 6.0, 6.0)
    size = graph.tree.nodes.new("FunctionNodeRandomValue")
    size.inputs[2].default_value, size.inputs[3].default_value = 0.6, 1.3
    inputs = {0: points.outputs[0], "Instance": info, "Pick Instance": True, "Rotation": random.outputs[0]}
    made = graph.node("InstanceOnPoints", None, inputs)
    graph.tree.links.new(size.outputs[1], made.inputs["Scale"])
    if draws.maybe(0.3):
        made = graph.node("RealizeInstances", None, {0: made})
    joined = graph.node("JoinGeometry", None, {0: made})
    graph.tree.links.new(given.outputs[0], joined.inputs[0])
    graph.tree.links.new(joined.outputs[0], output.inputs[0])


def _particles(draws: Draws, icing: bpy.types.Object, sprinkles: list[bpy.types.Object]) -> None:
    settings = modifier(icing, "PARTICLE_SYSTEM").particle_system.settings
    settings.type, settings.use_advanced_hair = "HAIR", True
    settings.count = draws.randint(60, 200)
    settings.render_type, settings.instance_object = "OBJECT", sprinkles[0]
    settings.particle_size, settings.size_random, settings.use_rotations = draws.between(0.25, 0.5), 0.4, True
    settings.rotation_factor_random, settings.phase_factor_random = 1.0, 2.0
