# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects as they are scaled, parented, copied, hidden, put into collections and placed."""

import functools
import math
from collections.abc import Callable

import bpy
from mathutils import Matrix

from .files import ball, cube, file, monkey, plain, scaled, select, start

SCALES = {
    "unapplied": (1.4, 0.7, 0.4),
    "zero_in_z": (1.0, 1.0, 0.0),
    "zero": (0.0, 0.0, 0.0),
    "negative": (-1.0, -1.0, -1.0),
    "mirrored": (-1.0, 1.0, 1.0),
    "mirrored_thin": (1.2, -0.6, 0.01),
    "tiny": (1e-4, 1e-4, 1e-4),
}


def _scale(smooth: bool, scale: tuple[float, float, float]) -> None:
    start()
    thing = monkey()
    if smooth:
        bpy.ops.object.shade_smooth()
    thing.scale = scale


for name, scale in SCALES.items():
    file(f"scale_{name}", functools.partial(_scale, False, scale))
    file(f"scale_{name}_smooth", functools.partial(_scale, True, scale))


def _parented(kind: str) -> None:
    start()
    bpy.ops.object.empty_add(scale=(2.0, 0.6, 1.0))
    parent = bpy.context.object
    parent.scale = (2.0, 0.6, 1.0) if kind != "negative" else (-1.5, 1.0, 0.7)
    child = monkey() if kind != "lamp" else bpy.data.objects["Light"]
    child.parent = parent
    child.rotation_euler = (0.3, 0.4, 0.9)
    if kind == "camera":
        bpy.context.scene.camera.parent = parent
    elif kind == "bone":
        bpy.ops.object.armature_add()
        child.parent, child.parent_type, child.parent_bone = bpy.context.object, "BONE", "Bone"
    elif kind == "vertex":
        other = cube(0.3)
        child.parent, child.parent_type, child.parent_vertices = other, "VERTEX", (0, 0, 0)


for kind in ("sheared", "negative", "lamp", "camera", "bone", "vertex"):
    file(f"parent_{kind}", functools.partial(_parented, kind))


def _area_lamp_scaled(scale: tuple[float, float, float]) -> None:
    start()
    monkey()
    lamp = bpy.data.objects["Light"]
    lamp.data.type = "AREA"
    lamp.scale = scale
    lamp.rotation_euler = (0.5, 0.4, 0.0)


for name, scale in {"uneven": (3.0, 0.5, 1.0), "negative": (-1.0, -1.0, -1.0), "zero": (0.0, 0.0, 0.0)}.items():
    file(f"scale_area_lamp_{name}", functools.partial(_area_lamp_scaled, scale))


def _copies(kind: str) -> None:
    start()
    thing = monkey()
    thing.scale = (0.5, 0.5, 0.5)
    for number, scale in enumerate(((0.5, 0.5, 0.5), (-0.5, 0.5, 0.5), (0.5, 0.9, 0.3))):
        other = thing.copy()
        if kind == "full":
            other.data = thing.data.copy()
        other.location, other.scale = (1.3 * math.cos(2.1 * number), 1.3 * math.sin(2.1 * number), 0.2), scale
        if kind == "materials":
            other.material_slots[0].link = "OBJECT"
            other.material_slots[0].material = plain((0.1, 0.2 * number, 0.7))
        if kind == "modifiers" and number:
            other.modifiers.new("Subdivision", "SUBSURF")
        bpy.context.scene.collection.objects.link(other)


for kind in ("linked", "full", "materials", "modifiers"):
    file(f"copies_{kind}", functools.partial(_copies, kind))


def _instancer(kind: str) -> None:
    start()
    bpy.ops.mesh.primitive_ico_sphere_add(radius=1.2, subdivisions=2)
    instancer = bpy.context.object
    instancer.instance_type = kind.partition("_")[0].upper()
    instancer.use_instance_faces_scale = True
    bpy.ops.mesh.primitive_cone_add(radius1=0.15, depth=0.4)
    child = bpy.context.object
    child.data.materials.append(plain((0.8, 0.3, 0.1)))
    child.parent = instancer
    if kind.endswith("hidden"):
        instancer.show_instancer_for_render = False
    if kind.endswith("rotated"):
        instancer.use_instance_vertices_rotation = True


for kind in ("verts", "verts_rotated", "faces", "faces_hidden"):
    file(f"instances_{kind}", functools.partial(_instancer, kind))


def _hidden(change: Callable[[bpy.types.Object], None]) -> None:
    start()
    ball(plain((0.2, 0.6, 0.2))).location = (0.9, 0.9, 0.0)
    change(select(cube(1.2)))


def _set(name: str, value: object) -> Callable[[bpy.types.Object], None]:
    return lambda thing: setattr(thing, name, value)


for name, change in {
    "viewport": _set("hide_viewport", True),
    "eye": lambda thing: thing.hide_set(True),
    "render": _set("hide_render", True),
    "as_bounds": _set("display_type", "BOUNDS"),
    "as_wire": _set("display_type", "WIRE"),
    "camera_rays": _set("visible_camera", False),
    "shadow_rays": _set("visible_shadow", False),
    "diffuse_rays": _set("visible_diffuse", False),
    "holdout": _set("is_holdout", True),
    "shadow_catcher": _set("is_shadow_catcher", True),
}.items():
    file(f"hidden_{name}", functools.partial(_hidden, change))


def _in_collection(change: str) -> None:
    scene = start()
    ball(plain((0.2, 0.6, 0.2))).location = (0.9, 0.9, 0.0)
    thing = cube(1.2)
    collection = bpy.data.collections.new("Group")
    scene.collection.children.link(collection)
    collection.objects.link(thing)
    for other in list(thing.users_collection):
        if other != collection:
            other.objects.unlink(thing)
    layer = bpy.context.view_layer.layer_collection.children["Group"]
    if change in {"exclude", "holdout", "indirect_only"}:
        setattr(layer, change, True)
    elif change == "hide_eye":
        layer.hide_viewport = True
    elif change == "excluded_instanced":
        layer.exclude = True
        bpy.ops.object.collection_instance_add(collection="Group", location=(-1.0, -0.4, 0.4))
    elif change == "hidden_instanced":
        collection.hide_render = True
        bpy.ops.object.collection_instance_add(collection="Group", location=(-1.0, -0.4, 0.4))
    else:
        setattr(collection, change, True)


for change in [
    "exclude",
    "holdout",
    "indirect_only",
    "hide_eye",
    "hide_viewport",
    "hide_render",
    "excluded_instanced",
    "hidden_instanced",
]:
    file(f"collection_{change}", functools.partial(_in_collection, change))
for change in ("holdout", "indirect_only"):

    def _over_nothing(change: str = change) -> None:
        _in_collection(change)
        bpy.context.scene.render.film_transparent = True

    file(f"collection_{change}_transparent", _over_nothing)


def _units(length: float, scale: float) -> None:
    """All that is there, ``length`` times as large, with the lamp's power to match."""
    scene = start()
    monkey()
    scene.unit_settings.scale_length = scale
    for thing in scene.objects:
        thing.matrix_world = scaled((length,) * 3) @ thing.matrix_world
    bpy.data.objects["Light"].data.energy *= length * length
    bpy.data.objects["Light"].data.shadow_soft_size *= length
    scene.camera.scale = (1.0, 1.0, 1.0)
    scene.camera.data.clip_start, scene.camera.data.clip_end = 0.01 * length, 1000.0 * length


for name, length, scale in (
    ("millimeters", 0.001, 0.001),
    ("millimeters_as_meters", 1000.0, 0.001),
    ("centimeters", 100.0, 0.01),
    ("kilometers", 1000.0, 1000.0),
    ("unit_scale_only", 1.0, 0.01),
):
    file(f"units_{name}", functools.partial(_units, length, scale))


def _far(distance: float) -> None:
    scene = start()
    monkey()
    for thing in scene.objects:
        thing.matrix_world = Matrix.Translation((distance, -distance, 0.3 * distance)) @ thing.matrix_world


for distance in (100.0, 5000.0):
    file(f"far_{distance:.0f}_m", functools.partial(_far, distance))


def _constrained(kind: str) -> None:
    start()
    thing = monkey()
    target = ball(plain((0.1, 0.2, 0.8)))
    target.location, target.scale = (1.2, -1.2, 0.5), (0.3, 0.3, 0.3)
    constraint = thing.constraints.new(kind)
    constraint.target = target
    if kind == "SHRINKWRAP":
        constraint.distance = 0.3


for kind in [
    "COPY_LOCATION",
    "COPY_ROTATION",
    "COPY_SCALE",
    "COPY_TRANSFORMS",
    "LIMIT_DISTANCE",
    "DAMPED_TRACK",
    "TRACK_TO",
    "LOCKED_TRACK",
    "STRETCH_TO",
    "CHILD_OF",
    "FLOOR",
    "PIVOT",
    "SHRINKWRAP",
    "TRANSFORM",
]:
    file(f"constraint_{kind.lower()}", functools.partial(_constrained, kind))


def _driven(kind: str) -> None:
    scene = start()
    thing = monkey()
    scene.frame_set(12)
    if kind == "location":
        thing.driver_add("location", 2).driver.expression = "0.5 + 0.25 * 2"
    elif kind == "frame":
        thing.driver_add("rotation_euler", 2).driver.expression = "frame / 10"
    elif kind == "lamp":
        bpy.data.objects["Light"].data.driver_add("energy").driver.expression = "40 * frame"
    elif kind == "material":
        principled = thing.data.materials[0].node_tree.nodes["Principled BSDF"]
        principled.inputs["Metallic"].driver_add("default_value").driver.expression = "frame / 12"
    elif kind == "keyed":
        thing.keyframe_insert("location", frame=1)
        thing.location.x += 1.0
        thing.keyframe_insert("location", frame=24)
    elif kind == "shape_key":
        thing.shape_key_add(name="Basis")
        key = thing.shape_key_add(name="Large")
        for point in key.data:
            point.co *= 1.3
        key.value = 0.7


for kind in ("location", "frame", "lamp", "material", "keyed", "shape_key"):
    file(f"driven_{kind}", functools.partial(_driven, kind))
