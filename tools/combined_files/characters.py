# SPDX-License-Identifier: GPL-3.0-or-later
"""Characters: armatures, shape keys, eyes with a cornea, skin and hair."""

import math

import bpy
import numpy as np

from . import images, materials
from .draws import Draws
from .graphs import finish, material
from .products import backdrop, studio
from .rooms import sky
from .scenes import add, camera, cylinder, kind, lamp, modifier, shape


def _body(draws: Draws, paint: bpy.types.Material) -> None:
    """A cylinder of rings that two bones bend, smoothed by Subdivision Surface."""
    rig = bpy.data.armatures.new("Rig")
    holder = add("Rig", rig)
    bpy.context.view_layer.objects.active = holder
    bpy.ops.object.mode_set(mode="EDIT")
    lower, upper = rig.edit_bones.new("Lower"), rig.edit_bones.new("Upper")
    lower.head, lower.tail = (0, 0, 0), (0, 0, 0.5)
    upper.head, upper.tail, upper.parent = (0, 0, 0.5), (0, 0, 1.0), lower
    bpy.ops.object.mode_set(mode="OBJECT")
    holder.pose.bones["Upper"].rotation_mode = "XYZ"
    holder.pose.bones["Upper"].rotation_euler = (draws.between(-0.3, 0.3), 0, draws.between(-0.3, 0.3))
    body = add(
        "Body", shape("uvsphere", paint, True, u_segments=16, v_segments=12), (0, 0, 0.45), scale=(0.7, 0.5, 1.0)
    )
    below = body.vertex_groups.new(name="Lower")
    above = body.vertex_groups.new(name="Upper")
    for vertex in body.data.vertices:
        weight = float(np.clip(vertex.co.z + 0.5, 0.0, 1.0))
        above.add([vertex.index], weight, "REPLACE")
        below.add([vertex.index], 1.0 - weight, "REPLACE")
    body.parent = holder
    modifier(body, "ARMATURE", object=holder)
    modifier(body, "SUBSURF", levels=1, render_levels=1)


def _head(draws: Draws, paint: bpy.types.Material) -> bpy.types.Object:
    head = add("Head", shape("uvsphere", paint, True), (0, 0, 1.25), scale=(0.75, 0.75, 0.8))
    head.shape_key_add(name="Basis")
    smile = head.shape_key_add(name="Smile")
    for point in smile.data:
        if point.co.y < -0.2 and point.co.z < 0.0:
            point.co.y -= 0.1
    smile.value = draws.random()
    if draws.maybe():
        driver = smile.driver_add("value").driver
        driver.type, driver.expression = "SCRIPTED", f"{draws.random():.2f} + 0.1 * frame"
    modifier(head, "SUBSURF", levels=1, render_levels=1)
    return head


def _eyes(draws: Draws) -> None:
    """Balls with a painted iris inside balls of glass."""
    made, graph = material("Eye")
    radius = graph.node("TexGradient", {"gradient_type": "RADIAL"})
    spread = graph.node("SeparateXYZ", None, {0: graph.node("TexCoord").outputs["Generated"]}).outputs[1]
    stops = [(0.0, (0.01, 0.01, 0.01, 1)), (0.05, draws.color(0.9)), (0.15, (0.9, 0.9, 0.88, 1))]
    color = graph.mixed(0.1, graph.ramp(spread, stops, "CONSTANT"), radius.outputs[0])
    finish(graph, graph.node("BsdfPrincipled", Base_Color=color, Roughness=0.4))
    cornea = materials.glass(draws, 0.0)
    for x in (-0.14, 0.14):
        add("Eye", shape("uvsphere", made, True, radius=0.09), (x, -0.31, 1.32))
        if draws.maybe(0.8):
            add("Cornea", shape("uvsphere", cornea, True, radius=0.1), (x, -0.31, 1.32))


def _hair(draws: Draws, head: bpy.types.Object) -> None:
    """Particle hair, or hair curves with a Principled Hair BSDF."""
    made, graph = material("Hair")
    if draws.maybe():
        node = graph.node("BsdfHairPrincipled", {"model": draws.pick(("CHIANG", "HUANG"))})
        node.inputs["Color"].default_value = draws.color(0.6, (0.1, 0.6))
        finish(graph, node)
    else:
        tip = graph.node("HairInfo").outputs["Intercept"]
        color = graph.ramp(tip, [(0.0, draws.color(0.5, (0.05, 0.3))), (1.0, draws.color(0.7))])
        finish(graph, graph.node("BsdfPrincipled", Base_Color=color, Roughness=0.5))
    if draws.maybe():
        head.data.materials.append(made)
        settings = modifier(head, "PARTICLE_SYSTEM").particle_system.settings
        settings.type, settings.count, settings.hair_length = "HAIR", draws.randint(200, 500), draws.between(0.1, 0.25)
        settings.material, settings.radius_scale, settings.root_radius = len(head.data.materials), 0.01, 1.0
        group = head.vertex_groups.new(name="Scalp")
        group.add([v.index for v in head.data.vertices if v.co.z > 0.15 or v.co.y > 0.2], 1.0, "REPLACE")
        head.particle_systems[0].vertex_group_density = "Scalp"
        return
    curves = bpy.data.hair_curves.new("Hair")
    count, points = draws.randint(150, 400), 6
    curves.add_curves([points] * count)
    places = np.zeros((count, points, 3), np.float32)
    generator = np.random.default_rng(draws.randint(0, 999))
    turn, up = generator.uniform(0, 2 * math.pi, count), generator.uniform(0.4, 1.0, count)
    flat = np.sqrt(1.0 - up**2)
    out = np.stack([flat * np.cos(turn), flat * np.sin(turn), up], axis=-1)
    for at in range(points):
        places[:, at] = out * (0.39 + 0.05 * at) - np.array((0, 0, 0.012)) * at**2
    curves.points.foreach_set("position", places.ravel())
    radii = np.tile(np.linspace(0.006, 0.001, points, dtype=np.float32), count)
    curves.attributes.new("radius", "FLOAT", "POINT").data.foreach_set("value", radii)
    curves.materials.append(made)
    add("Hair", curves, (0, 0, 1.25))


@kind
def character(draws: Draws) -> None:
    """A figure with a bent body, a face, eyes, limbs, clothes and hair."""
    flesh = materials.skin(draws)
    backdrop(materials.plain(draws))
    _body(draws, draws.pick((materials.textured, materials.plain, materials.lacquer))(draws))
    head = _head(draws, flesh)
    _eyes(draws)
    _hair(draws, head)
    limb = shape("uvsphere", flesh, True)
    for x in (-1, 1):
        add("Arm", limb, (0.5 * x, -0.05, 0.6), (0, 0.5 * x, 0), (0.2 * x, 0.2, 0.6))
        add("Foot", limb, (0.2 * x, -0.12, 0.08), scale=(0.22, 0.4, 0.15))
    add("Nose", shape("cone", flesh, True, radius1=0.06, depth=0.16), (0, -0.42, 1.22), (math.pi / 2, 0, 0))
    if draws.maybe():
        add("Hat", cylinder(materials.anything(draws), 0.3, 0.3), (0, 0.05, 1.72), (0.1, 0, 0))
    paint = materials.leaf(draws) if draws.maybe() else materials.textured(draws)
    sheet = shape("grid", paint, True, x_segments=8, y_segments=8)
    cloth = add("Scarf", sheet, (0.05, -0.33, 0.75), (1.4, 0, 0), (0.3, 0.5, 1))
    modifier(cloth, "SOLIDIFY", thickness=0.01)
    modifier(cloth, "WAVE", height=0.05, width=0.5, narrowness=2.0)
    if draws.maybe(0.4):
        decal = images.image("Decal", images.leaf(draws))
        made, graph = material("Decal")
        picture = graph.node("TexImage", {"image": decal})
        finish(graph, graph.node("BsdfPrincipled", Base_Color=picture, Alpha=picture.outputs[1]))
        add("Decal", shape("grid", made), (0.0, -0.9, 0.01), scale=(0.5, 0.5, 1))
    sky(draws)
    studio(draws)
    if draws.maybe(0.4):
        lamp("POINT", (-1.0, -1.5, 2.0), 40.0, shadow_soft_size=0.2)
    data = camera((draws.between(-0.6, 0.6), -3.4, 1.3), (0, 0, 0.85), 45.0)
    data.dof.use_dof, data.dof.focus_distance, data.dof.aperture_fstop = draws.maybe(0.4), 3.0, 2.0
