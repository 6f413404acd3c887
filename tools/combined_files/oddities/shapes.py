# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves, text, surfaces, meshes with faults, and deformations."""

import math

import bpy
from mathutils import Vector

from .. import materials
from ..draws import Draws
from ..graphs import finish, material
from ..scenes import Place, add, curve, modifier, shape, text
from .parts import matte, part


@part
def tapered(draws: Draws, at: Place) -> None:
    """A bevelled curve with a taper object, radii, tilt, and a part of its length."""
    x, y, _ = at
    path = curve([(x - 0.4, y, 0.2), (x - 0.1, y + 0.2, 0.6), (x + 0.1, y - 0.2, 0.3), (x + 0.4, y, 0.7)],
                 matte(draws.color(0.9)), draws.between(0.05, 0.1))  # fmt: skip
    taper = curve([(0, 0.2, 0), (0.5, 1.0, 0), (1, 0.1, 0)], matte((1, 1, 1, 1)), 0.0)
    taper.location, taper.hide_render = (0, 0, -5), True
    path.data.taper_object = taper if draws.maybe() else None
    path.data.bevel_factor_start, path.data.bevel_factor_end = draws.between(0, 0.2), draws.between(0.7, 1)
    path.data.bevel_factor_mapping_end = draws.pick(("RESOLUTION", "SEGMENTS", "SPLINE"))
    for number, point in enumerate(path.data.splines[0].bezier_points):
        point.radius, point.tilt = 0.5 + 0.4 * (number % 2), 0.6 * number
    path.data.fill_mode = draws.pick(("FULL", "HALF", "FRONT", "BACK"))
    path.data.bevel_resolution = draws.randint(0, 4)
    path.data.splines[0].use_smooth = draws.maybe()


@part
def flat_curve(draws: Draws, at: Place) -> None:
    """Closed 2D curves, one within another, extruded with a bevel, as an SVG import gives them."""
    data = bpy.data.curves.new("SVG", "CURVE")
    data.dimensions, data.extrude, data.bevel_depth = "2D", 0.06, draws.pick((0.0, 0.02))
    data.fill_mode = draws.pick(("BOTH", "FRONT", "NONE"))
    data.offset = draws.pick((0.0, 0.02))
    data.materials.append(matte(draws.color(0.9)))
    data.materials.append(matte(draws.color(0.9)))
    for number, (radius, corners) in enumerate(((0.4, 5), (0.2, 4), (0.08, 3))):
        spline = data.splines.new(draws.pick(("POLY", "BEZIER")))
        points = spline.points if spline.type == "POLY" else spline.bezier_points
        points.add(corners - 1)
        spline.use_cyclic_u, spline.material_index = True, number % 2
        for index, point in enumerate(points):
            turn = 2 * math.pi * index / corners
            place = (radius * math.cos(turn), radius * math.sin(turn), 0.0)
            if spline.type == "POLY":
                point.co = (*place, 1.0)
            else:
                point.co, point.handle_left_type, point.handle_right_type = place, "AUTO", "AUTO"
    add("SVG", data, (at[0], at[1], 0.5), (1.2, 0, 0.2))


@part
def lettered(draws: Draws, at: Place) -> None:
    """Text whose characters have materials, styles and sizes of their own, in lines."""
    thing = text("Abc\nxyZ 12", matte(draws.color(0.9)), (at[0] - 0.4, at[1], 0.5), size=0.35, extrude=0.02)
    thing.data.materials.append(matte(draws.color(0.9)))
    for number, letter in enumerate(thing.data.body_format):
        letter.material_index = number % 2
        letter.use_underline, letter.use_small_caps = number % 3 == 0, number % 4 == 1
        letter.kerning = 5.0 * (number % 2)
    thing.data.align_x, thing.data.shear = draws.pick(("LEFT", "CENTER", "JUSTIFY")), draws.between(-0.3, 0.3)
    thing.data.offset_x, thing.data.space_line = 0.05, 0.9
    thing.data.bevel_depth = draws.pick((0.0, 0.01))
    thing.data.fill_mode = draws.pick(("BOTH", "FRONT"))


@part
def surface(draws: Draws, at: Place) -> None:
    """A NURBS surface with its points moved."""
    bpy.ops.surface.primitive_nurbs_surface_surface_add(location=(at[0], at[1], 0.3), radius=0.35)
    thing = bpy.context.object
    thing.data.materials.append(matte(draws.color(0.9)))
    for point in thing.data.splines[0].points:
        point.co.z += draws.between(-0.3, 0.3)
    thing.data.splines[0].use_smooth = draws.maybe()


@part
def metaballs_apart(draws: Draws, at: Place) -> None:
    """A family of metaball objects that melt together, one of them negative."""
    paint = matte(draws.color(0.9))
    for number in range(3):
        data = bpy.data.metaballs.new("Ball")
        data.resolution = data.render_resolution = 0.1
        data.materials.append(paint)
        element = data.elements.new(type=draws.pick(("BALL", "CUBE", "CAPSULE", "ELLIPSOID")))
        element.radius, element.use_negative = 0.3, number == 2
        place = (at[0] + 0.2 * (number - 1), at[1], 0.4 + 0.1 * number)
        add("Family" if number == 0 else f"Family.{number:03}", data, place, (0, 0.3 * number, 0))


@part
def broken_mesh(draws: Draws, at: Place) -> None:
    """A mesh with a bent polygon, a face without area, faces that overlap, loose edges, and a UV of nan."""
    corners = [(-0.4, 0, 0), (0.4, 0, 0), (0.4, 0, 0.7), (0, 0.1, 0.3), (-0.4, 0, 0.7), (0, 0.3, 0), (0.1, 0.3, 0.2)]
    corners += [(0.0, 0.3, 0.9), (0.1, 0.3, 0.2)]
    faces = [(0, 1, 2, 3, 4), (5, 6, 5 + 2), (6, 8, 5), (5, 7, 6)]
    made = bpy.data.meshes.new("Broken")
    made.from_pydata(corners, [(0, 7)], faces)
    made.materials.append(matte(draws.color(0.9)))
    add("Broken", made, (at[0], at[1], 0.05), (0, 0, draws.random()))
    if draws.maybe():
        uv = made.uv_layers.new(name="UVMap")
        uv.uv[0].vector = (float("nan"), 0.0)


@part
def shape_keys(draws: Draws, at: Place) -> None:
    """Shape keys, relative to one another, muted, in a vertex group, and driven; on a mesh, a curve or a lattice."""
    thing = add("Keyed", shape("uvsphere", matte(draws.color(0.9)), True), (at[0], at[1], 0.41), scale=(0.8,) * 3)
    group = thing.vertex_groups.new(name="Upper")
    group.add([v.index for v in thing.data.vertices if v.co.z > 0], 0.7, "REPLACE")
    thing.shape_key_add(name="Basis")
    wide, tall = thing.shape_key_add(name="Wide"), thing.shape_key_add(name="Tall")
    for point in wide.data:
        point.co.x *= 1.4
    for point in tall.data:
        point.co.z *= 1.4
    wide.value, wide.vertex_group = 0.8, "Upper"
    tall.value, tall.mute = 1.0, draws.maybe()
    if draws.maybe():
        tall.relative_key = wide
    driver = wide.driver_add("value").driver
    driver.expression = "0.5 + 0.1 * sin(frame)"
    if draws.maybe():
        modifier(thing, "CORRECTIVE_SMOOTH", iterations=3)


@part
def lattice(draws: Draws, at: Place) -> None:
    """A monkey in a lattice, with Hooks to an empty."""
    cage = bpy.data.lattices.new("Cage")
    cage.points_u, cage.points_v, cage.points_w = 2, 2, 3
    holder = add("Cage", cage, (at[0], at[1], 0.45), scale=(0.9, 0.9, 0.9))
    for point in cage.points:
        point.co_deform.x += draws.between(-0.3, 0.3)
    thing = add("Bent", shape("monkey", matte(draws.color(0.9))), (at[0], at[1], 0.45), scale=(0.35,) * 3)
    modifier(thing, "LATTICE", object=holder, strength=0.8)
    pull = add("Pull", None, (at[0] + 0.2, at[1], 0.8))
    hook = modifier(thing, "HOOK", object=pull, strength=0.5)
    hook.vertex_indices_set(list(range(40)))


@part
def split_normals(draws: Draws, at: Place) -> None:
    """Custom normals as importers write them, a mirrored scale, and sharp edges."""
    thing = add("Imported", shape("icosphere", matte(draws.color(0.9)), draws.maybe()), (at[0], at[1], 0.41))
    thing.scale = (draws.pick((-0.8, 0.8)), 0.8, 0.8)
    mesh = thing.data
    tilted = [vertex.co.normalized() + Vector((0.0, 0.0, draws.pick((0.0, 0.8)))) for vertex in mesh.vertices]
    mesh.normals_split_custom_set_from_vertices(tilted)
    for edge in mesh.edges:
        edge.use_edge_sharp = edge.index % 7 == 0


@part
def physics(draws: Draws, at: Place) -> None:
    """Cloth that falls on a ball, evaluated over some frames."""
    sheet = add("Cloth", shape("grid", matte(draws.color(0.9)), True, x_segments=8, y_segments=8), (at[0], at[1], 0.8),
                scale=(0.8, 0.8, 1))  # fmt: skip
    ball = add("Ball", shape("icosphere", materials.plain(draws), radius=0.25), (at[0], at[1], 0.3))
    ball.modifiers.new("Collision", "COLLISION")
    sheet.modifiers.new("Cloth", draws.pick(("CLOTH", "SOFT_BODY")))
    modifier(sheet, "SUBSURF", levels=1, render_levels=1)


@part
def wire(draws: Draws, at: Place) -> None:
    """Edges by Skin, and a lattice of Wireframe over a copy of the same mesh."""
    made = bpy.data.meshes.new("Twig")
    made.from_pydata([(0, 0, 0), (0, 0, 0.4), (0.2, 0, 0.7), (-0.2, 0.1, 0.8)], [(0, 1), (1, 2), (1, 3)], [])
    made.materials.append(matte(draws.color(0.9)))
    twig = add("Twig", made, (at[0], at[1], 0.02))
    modifier(twig, "SKIN")
    for vertex in made.skin_vertices[0].data:
        vertex.radius = (0.07, 0.05)
    modifier(twig, "SUBSURF", levels=1, render_levels=1)
    other = add("Cage", shape("icosphere", None, subdivisions=1), (at[0], at[1] + 0.3, 0.3), scale=(0.5,) * 3)
    other.data.materials.append(matte(draws.color(0.9)))
    other.data.materials.append(matte(draws.color(0.9)))
    modifier(other, "WIREFRAME", thickness=0.06, use_replace=draws.maybe(), material_offset=1, use_even_offset=False)


@part
def color_attributes(draws: Draws, at: Place) -> None:
    """Painted colors by corner as bytes and by vertex as floats, the rendered one not the active one."""
    made, graph = material("Painted")
    named = draws.pick(("", "Floats", "Bytes", "None such"))
    node = graph.node("VertexColor", {"layer_name": named})
    color = node.outputs[0]
    if draws.maybe():
        color = graph.mixed(node.outputs[1], color, (1, 1, 1, 1), "MULTIPLY")
    finish(graph, graph.node("BsdfDiffuse", Color=color))
    thing = add("Painted", shape("uvsphere", made, True), (at[0], at[1], 0.41), scale=(0.8,) * 3)
    for name, kind, domain in (("Bytes", "BYTE_COLOR", "CORNER"), ("Floats", "FLOAT_COLOR", "POINT")):
        layer = thing.data.color_attributes.new(name, kind, domain)
        for value in layer.data:
            value.color = draws.color(0.9)
    thing.data.color_attributes.active_color_index = 0
    thing.data.color_attributes.render_color_index = 1
    if draws.maybe():
        modifier(thing, "SUBSURF", levels=1, render_levels=1)
