# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of nine parts on a ground, with a scene whose settings are seldom used."""

import bpy

from .. import materials
from ..draws import Draws
from ..scenes import add, camera, keyed, kind, lamp, shape
from . import instanced, lit, shading, shapes  # noqa: F401 (they list their parts)
from .parts import PARTS, matte

COLUMNS, ROWS = 3, 3
SPACING = 1.15


def _scene_settings(draws: Draws) -> str:
    scene = bpy.context.scene
    choice = draws.pick(("none", "simplify", "override", "film", "set", "blur", "cull", "compositor", "exclude"))
    if choice == "simplify":
        scene.render.use_simplify, scene.render.simplify_subdivision_render = True, 1
        scene.render.simplify_child_particles_render = 0.5
        scene.cycles.texture_limit_render = "128"
    elif choice == "override":
        bpy.context.view_layer.material_override = matte((0.5, 0.5, 0.5, 1))
    elif choice == "film":
        scene.render.film_transparent = True
    elif choice == "set":
        other = bpy.data.scenes.new("Set")
        thing = bpy.data.objects.new("Backdrop", shape("cube", matte(draws.color(0.9))))
        thing.location, thing.scale = (0, 3.5, 0.5), (5, 0.1, 1.0)
        other.collection.objects.link(thing)
        scene.background_set = other
    elif choice == "blur":
        scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 0.5
        keyed(scene.camera, "location", [(1, scene.camera.location[:]), (9, [v + 0.3 for v in scene.camera.location])])
    elif choice == "cull":
        scene.render.use_simplify, scene.cycles.use_camera_cull, scene.cycles.camera_cull_margin = True, True, 0.1
        for thing in scene.objects:
            thing.cycles.use_camera_cull = True
    elif choice == "compositor":
        scene.render.use_compositing = True
        scene.view_settings.look = "AgX - Punchy"
        scene.view_settings.exposure = 1.0
    elif choice == "exclude":
        held = bpy.data.collections.new("Extra")
        scene.collection.children.link(held)
        held.objects.link(bpy.data.objects.new("Extra", shape("cube", matte(draws.color(0.9)))))
        layer = bpy.context.view_layer.layer_collection.children["Extra"]
        setattr(layer, draws.pick(("exclude", "holdout", "indirect_only", "hide_viewport")), True)
    return choice


def assemble(draws: Draws, names: list[str]) -> None:
    """Place parts by their names, with a ground, a world, a sun and settings of the scene."""
    add("Ground", shape("grid", materials.plain(draws)), scale=(9, 9, 1))
    world = lit.odd_world(draws)
    if world in {"none", "nishita_sun"} or draws.maybe(0.7):
        lamp(
            "SUN", (0, 0, 5), draws.between(1.0, 3.0), (draws.between(-3, 3), 2, 0), angle=draws.pick((0.0, 0.05, 0.3))
        )
    camera((draws.between(-0.6, 0.6), -4.6, 2.6), (0, 0, 0.25), 40.0)
    for number, name in enumerate(names):
        column, row = number % COLUMNS, number // COLUMNS
        PARTS[name](draws, (SPACING * (column - 1), SPACING * (row - 1), 0.0))
    bpy.context.scene.frame_set(draws.pick((1, 5)))
    setting = _scene_settings(draws)
    bpy.context.scene["made of"] = f"{world}, {setting}: {' '.join(names)}"


@kind
def oddity(draws: Draws) -> None:
    """Nine parts, drawn so that successive seeds have others."""
    names = sorted(PARTS)
    assemble(draws, draws.sample(names, COLUMNS * ROWS))
