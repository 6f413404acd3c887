# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of strangers' files that the other kinds do not have: floats with alpha, sheared lamps, attributes that Cycles
computes, motion within parents, collections in collections."""

import math
from collections.abc import Callable

import bpy
import numpy as np

from .. import images
from ..draws import Draws
from ..graphs import finish, material
from ..scenes import Place, add, camera, collection, cylinder, instance, keyed, kind, lamp, shape, world
from .parts import matte


def _decal(draws: Draws, at: Place) -> None:
    """A card with a packed image of floats, which is read as sRGB; its Color and Alpha are both used."""
    pixels = images.colored(draws, 16)
    pixels = np.concatenate([pixels[..., :3], np.ones((*pixels.shape[:2], 1))], axis=-1)
    pixels[..., 3] = np.linspace(0.0, 1.0, 16)
    kept = bpy.data.images.new("Deep", 16, 16, alpha=True, float_buffer=True)
    kept.colorspace_settings.name = "sRGB"
    kept.pixels.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())
    kept.alpha_mode = draws.pick(("STRAIGHT", "PREMUL", "CHANNEL_PACKED"))
    kept.pack()
    made, graph = material("Deep Decal")
    picture = graph.node("TexImage", {"image": kept, "extension": draws.pick(("REPEAT", "CLIP", "MIRROR"))})
    finish(graph, graph.node("BsdfPrincipled", Base_Color=picture, Alpha=picture.outputs[1], Roughness=0.7))
    add("Deep Decal", shape("grid", made), (at[0], at[1], 0.4), (1.3, 0, draws.between(-0.4, 0.4)), (0.8, 0.8, 1))


def _sheared_lamp(draws: Draws, at: Place) -> None:
    """A spot that turns within a parent of uneven scale, above a post."""
    parent = add("Uneven", None, (at[0], at[1], 1.2), (draws.between(-0.4, 0.4), 0, 0.3), (1.4, 0.7, -1.0))
    made = lamp("SPOT", (0, 0, 0), 15.0, spot_size=draws.between(0.6, 1.4), spot_blend=draws.pick((0.0, 0.4)))
    made.rotation_euler = (math.pi + draws.between(-0.4, 0.4), draws.between(-0.4, 0.4), 0)
    made.parent, made.data.shadow_soft_size = parent, draws.pick((0.0, 0.1))
    add("Post", cylinder(matte(draws.color(0.9)), 0.1, 0.4), (at[0], at[1], 0.21))


def _attributes(draws: Draws, at: Place) -> None:
    """A head colored by attributes that Cycles computes."""
    made, graph = material("Computed")
    given = graph.node("Attribute", {"attribute_name": draws.pick(("generated", "pointiness", "UVMap", "position"))})
    finish(graph, graph.node("BsdfDiffuse", Color=graph.mixed(0.2, given.outputs["Vector"], draws.color(0.9))))
    add("Head", shape("monkey", made, True), (at[0], at[1], 0.4), (0, 0, draws.between(-1, 1)), (0.35, -0.35, 0.35))


def _carousel(draws: Draws, at: Place) -> None:
    """Instances of a collection that hold an instance of another, in a parent that turns while the shutter is open."""
    inner = collection("Inner", [add("Cone", shape("cone", matte(draws.color(0.9))), scale=(0.15, 0.15, 0.3))])
    outer = collection("Outer", [instance(inner, (0.15, 0, 0)), instance(inner, (-0.15, 0, 0), scale=(1, -1, -1))])
    inner.instance_offset = (0.05, 0, 0)
    parent = add("Turning", None, (at[0], at[1], 0.4))
    for turn in range(3):
        angle = 2.0 * math.pi * turn / 3.0
        instance(outer, (0.3 * math.cos(angle), 0.3 * math.sin(angle), 0)).parent = parent
    keyed(parent, "rotation_euler", [(1, (0, 0, 0)), (10, (0, 0.2, draws.between(1, 4)))])


PARTS: tuple[Callable[[Draws, Place], None], ...] = (_decal, _sheared_lamp, _attributes, _carousel)


@kind
def stranger(draws: Draws) -> None:
    """Nine of these parts on a floor, each at least once."""
    add("Floor", shape("grid", matte(draws.color(0.6)), size=6.0))
    chosen = [*PARTS, *(draws.pick(PARTS) for _ in range(9 - len(PARTS)))]
    draws.shuffle(chosen)
    for number, make in enumerate(chosen):
        make(draws, (1.1 * (number % 3 - 1), 1.1 * (number // 3 - 0.5), 0.0))
    world(draws.color(0.3, (0.2, 0.6)))
    lamp("AREA", (-2.0, -1.5, 3.0), 90.0, (0, 0, 0.3), size=draws.between(0.3, 1.2))
    camera((draws.between(-1, 1), -4.2, 2.4), (0, 0.4, 0.2), 40.0)
    scene = bpy.context.scene
    scene.render.use_motion_blur = draws.maybe()
    scene.render.motion_blur_shutter, scene.render.motion_blur_position = 1.0, draws.pick(("START", "CENTER", "END"))
    scene.frame_set(5)
