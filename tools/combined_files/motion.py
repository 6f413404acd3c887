# SPDX-License-Identifier: GPL-3.0-or-later
"""Abstract motion graphics: arrays, tubes, metaballs, blur, view layers and films with alpha."""

import math

import bpy

from . import materials
from .draws import Draws
from .products import backdrop, studio
from .scenes import add, camera, curve, keyed, kind, lamp, modifier, shape, text, world


def _array(draws: Draws) -> None:
    thing = add("Array", shape(draws.pick(("cube", "icosphere", "monkey")), materials.anything(draws), draws.maybe()))
    thing.scale, thing.location = (0.2, 0.2, 0.2), (-1.2, draws.between(0, 1), 0.2)
    pivot = add("Pivot", None, (-0.9, draws.between(0, 0.6), 0.25), (0.1, draws.between(-0.1, 0.1), 0.2), (0.19,) * 3)
    array = modifier(thing, "ARRAY", count=draws.randint(4, 9), use_relative_offset=False)
    if draws.maybe():
        array.use_object_offset, array.offset_object = True, pivot
    else:
        array.use_constant_offset, array.constant_offset_displace = True, (1.5, 0.2, 0.3)
    if draws.maybe():
        modifier(thing, "BEVEL", width=0.05, segments=2)
    if draws.maybe(0.4):
        modifier(thing, "SIMPLE_DEFORM", deform_method=draws.pick(("TWIST", "BEND")), angle=0.8)


def _tubes(draws: Draws) -> None:
    for _ in range(draws.randint(1, 4)):
        radius, up = draws.between(0.3, 1.0), draws.between(0.3, 1.0)
        points = [
            (radius * math.cos(angle), radius * math.sin(angle) + 0.3, up + 0.3 * math.sin(2 * angle))
            for angle in (draws.between(0, 1) + 0.7 * at for at in range(draws.randint(4, 9)))
        ]
        paint = materials.glow(draws, draws.between(2, 10)) if draws.maybe() else materials.anything(draws)
        tube = curve(points, paint, draws.between(0.02, 0.08), draws.pick(("BEZIER", "NURBS")))
        tube.data.bevel_resolution = draws.randint(1, 4)
        tube.data.bevel_factor_end = draws.between(0.6, 1.0)


def _metaballs(draws: Draws) -> None:
    data = bpy.data.metaballs.new("Blob")
    data.render_resolution = data.resolution = 0.08
    data.materials.append(draws.pick((materials.metal, materials.skin, materials.lacquer, materials.glass))(draws))
    for _ in range(draws.randint(3, 8)):
        element = data.elements.new()
        element.co, element.radius = draws.vector(-0.4, 0.4), draws.between(0.2, 0.4)
    add("Blob", data, (draws.between(-0.6, 0.6), 0.2, 0.75))


def _moving(draws: Draws) -> None:
    """Things that fly, turn and grow while the shutter is open."""
    scene = bpy.context.scene
    scene.frame_set(3)
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, draws.between(0.3, 1.0)
    mesh = shape("cube", materials.anything(draws))
    for at in range(draws.randint(3, 10)):
        place = (draws.between(-1.2, 1.2), draws.between(-0.4, 1.0), draws.between(0.2, 1.4))
        thing = add("Moving", mesh, place, draws.vector(0, 3), (0.2, 0.2, 0.2))
        after = [value + draws.between(-0.4, 0.4) for value in place]
        keyed(thing, "location", [(1, place), (6, after)])
        if at % 2:
            keyed(thing, "rotation_euler", [(1, draws.vector(0, 3)), (6, draws.vector(0, 3))])
        if at % 3 == 0:
            keyed(thing, "scale", [(1, (0.1,) * 3), (6, (0.3,) * 3)])
    if draws.maybe(0.3):
        keyed(scene.camera, "location", [(1, scene.camera.location[:]), (8, [v + 0.1 for v in scene.camera.location])])


def _layers(draws: Draws, things: list[bpy.types.Object]) -> None:
    """Holdouts, shadow catchers, hidden objects and exclusions as compositors use them."""
    layer = bpy.context.view_layer
    held = bpy.data.collections.new("Held")
    bpy.context.scene.collection.children.link(held)
    for thing in draws.sample(things, min(len(things), 3)):
        choice = draws.pick(("holdout", "collection", "camera", "shadow", "indirect"))
        if choice == "holdout":
            thing.is_holdout = True
        elif choice == "camera":
            thing.visible_camera = False
        elif choice == "shadow":
            thing.visible_shadow = False
        else:
            bpy.context.scene.collection.objects.unlink(thing)
            held.objects.link(thing)
    shown = layer.layer_collection.children["Held"]
    shown.holdout, shown.indirect_only = draws.pick(((True, False), (False, True), (False, False)))


@kind
def motion(draws: Draws) -> None:
    """Shapes in the air before a backdrop, or in front of nothing with alpha."""
    scene = bpy.context.scene
    open_film = draws.maybe(0.4)
    if open_film:
        scene.render.film_transparent = True
        floor = add("Catcher", shape("grid", materials.plain(draws)), scale=(8, 8, 1))
        floor.is_shadow_catcher = draws.maybe(0.7)
    else:
        backdrop(materials.plain(draws))
    world(draws.color(0.4, (0.1, 0.6)))
    studio(draws)
    camera((draws.between(-1, 1), -3.2, draws.between(0.9, 1.6)), (0, 0.2, 0.5), 40.0)
    parts = [_array, _tubes, _metaballs, _moving]
    for part in draws.sample(parts, draws.randint(2, 4)):
        part(draws)
    words = text(draws.pick(("MOTION", "loop", "24 fps")), materials.glow(draws, 3.0), (-0.8, 1.0, 0.9), size=0.5)
    words.data.extrude = 0.04
    for at in range(draws.randint(0, 6)):
        ring = bpy.ops.mesh.primitive_torus_add(
            location=(0.0, 0.6, 0.7), rotation=draws.vector(0, 3), major_radius=0.3 + 0.12 * at, minor_radius=0.02
        )
        assert ring == {"FINISHED"}
        bpy.context.object.data.materials.append(materials.anything(draws))
    if open_film or draws.maybe(0.3):
        solid = [thing for thing in scene.objects if thing.type == "MESH" and not thing.is_shadow_catcher]
        _layers(draws, [thing for thing in solid if thing.name != "Backdrop"])
    if draws.maybe(0.3):
        lamp(
            "SPOT",
            (1.0, -1.5, 3.0),
            200.0,
            (0, 0.3, 0.4),
            spot_size=0.8,
            spot_blend=draws.random(),
            shadow_soft_size=0.1,
        )
