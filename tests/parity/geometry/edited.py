# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes with objects in the modes in which people edit them. Objects are called by their case, which tells scenes
apart in which Blender's properties of a window alone differ."""

import bmesh
import bpy

from ..net import Net
from ..scenes import EMISSION, camera, link_object, material, mesh_object, new_scene

BOX = (
    [(x, y, z) for x in (-0.7, 0.7) for y in (-0.5, 0.5) for z in (-0.4, 0.6)],
    [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)],
)


def glowing_normals() -> bpy.types.Material:
    """Glows by its shading normal: half of it and a half."""
    made = material(EMISSION)
    net = Net(made.node_tree)
    net.set(net.find("EMISSION").inputs["Color"], net.scaled(net.out("NewGeometry", "Normal"), 0.5, 0.5))
    return made


def look() -> None:
    """An empty scene and its camera."""
    new_scene()
    camera((1.5, -4.0, 2.5), (0.2, 0.0, 0.1), 40.0)


def begin(case: str) -> bpy.types.Object:
    """A scene with a box, which is returned."""
    look()
    return add(case, BOX)


def add(name: str, shape: tuple[list, list], at: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> bpy.types.Object:
    made = mesh_object(*shape, glowing_normals(), name=name)
    made.location = at
    return made


def link(name: str, data: bpy.types.ID | None, at: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> bpy.types.Object:
    made = link_object(data, name=name)
    made.location = at
    return made


def enter(*objects: bpy.types.Object, mode: str = "EDIT") -> None:
    """The mode of the first object; the others enter it as well, as those that are selected do."""
    bpy.context.view_layer.update()
    for each in bpy.context.view_layer.objects:
        each.select_set(each in objects)
    bpy.context.view_layer.objects.active = objects[0]
    bpy.ops.object.mode_set(mode=mode)


def subdivide(box: bpy.types.Object) -> bpy.types.SubsurfModifier:
    modifier = box.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels, modifier.render_levels = 1, 2
    return modifier


def subdivided(case: str, **shown: bool) -> None:
    """shown: where the modifier is shown."""
    box = begin(case)
    modifier = subdivide(box)
    for name, value in shown.items():
        setattr(modifier, name, value)
    enter(box)


def multiplied(case: str, multiplies: str, edited: str) -> None:
    """A square or an empty multiplies a small box; one of them is in Edit Mode."""
    box = begin(case)
    box.scale = (0.3, 0.4, 0.5)
    if multiplies == "COLLECTION":
        collection = bpy.data.collections.new(case)
        collection.objects.link(box)
        empty = link(f"{case} empty", None, (1.0, 0.0, 0.0))
        empty.instance_type, empty.instance_collection = multiplies, collection
        enter(box)
        return
    square = add(f"{case} square", ([(-1, -1, 0), (1, -1, 0), (1, 1, 0.2), (-1, 1, 0.3)], [(0, 1, 2, 3)]))
    if multiplies in {"VERTS", "FACES"}:
        box.parent, square.instance_type = square, multiplies
    else:
        _multiply_on_points(square, box, multiplies == "NODES")
    enter({"box": box, "square": square}[edited])


def _multiply_on_points(owner: bpy.types.Object, multiplied: bpy.types.Object, as_instance: bool) -> None:
    tree = bpy.data.node_groups.new("Points", "GeometryNodeTree")
    for way in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    kinds = ("NodeGroupInput", "GeometryNodeInstanceOnPoints", "GeometryNodeObjectInfo", "NodeGroupOutput")
    before, multiply, info, after = (tree.nodes.new(kind) for kind in kinds)
    info.inputs["Object"].default_value, info.inputs["As Instance"].default_value = multiplied, as_instance
    tree.links.new(before.outputs[0], multiply.inputs["Points"])
    tree.links.new(info.outputs["Geometry"], multiply.inputs["Instance"])
    tree.links.new(multiply.outputs[0], after.inputs[0])
    owner.modifiers.new("Points", "NODES").node_group = tree


def shape_key(case: str, active: int, applied: bool) -> None:
    """active: the key under edit; applied: whether the others show in Edit Mode."""
    box = begin(case)
    box.shape_key_add(name="Basis")
    key = box.shape_key_add(name="Long")
    for point in key.data:
        point.co.z *= 2.0
    key.value, box.active_shape_key_index, box.use_shape_key_edit_mode = 0.5, active, applied
    enter(box)


def several(case: str) -> None:
    box = begin(case)
    other = add(f"{case} other", BOX, (1.2, 0.5, 0.5))
    subdivide(other)
    enter(box, other)


def shared(case: str) -> None:
    """Another object has the same mesh, and modifiers of its own."""
    box = begin(case)
    subdivide(link(f"{case} other", box.data, (1.2, 0.5, 0.5)))
    enter(box)


def under_edit(case: str) -> None:
    """Faces have come that the mesh itself does not have yet."""
    box = begin(case)
    enter(box)
    mesh = bmesh.from_edit_mesh(box.data)
    mesh.faces.ensure_lookup_table()
    bmesh.ops.delete(mesh, geom=[mesh.faces[1]], context="FACES")
    bmesh.ops.create_cube(mesh, size=0.7)
    bmesh.update_edit_mesh(box.data)


def deformed(case: str, kind: str, edited: str) -> None:
    """An armature or a lattice bends the box; one of the two is in Edit Mode. Of a lattice under edit Blender tells
    places that are none."""
    box = begin(case)
    data = bpy.data.armatures.new(case) if kind == "ARMATURE" else bpy.data.lattices.new(case)
    frame = link(f"{case} frame", data)
    if kind == "ARMATURE":
        enter(frame)
        bone = frame.data.edit_bones.new("Bone")
        bone.tail = (0.0, 0.0, 1.0)
        bpy.ops.object.mode_set(mode="OBJECT")
        pose = frame.pose.bones[0]
        pose.rotation_mode, pose.rotation_euler = "XYZ", (1.0, 0.0, 0.0)
        box.vertex_groups.new(name="Bone").add(range(8), 1.0, "ADD")
    else:
        frame.scale = (2.0, 2.0, 2.0)
        for point in frame.data.points:
            point.co_deform.x *= 1.5
    box.modifiers.new("Bent", kind).object = frame
    enter({"box": box, "frame": frame}[edited])


def converted(case: str, kind: str) -> None:
    """A curve, text, surface or metaball in Edit Mode."""
    look()
    if kind == "SURFACE":
        bpy.ops.surface.primitive_nurbs_surface_sphere_add(radius=0.7)
        bpy.context.object.name = case
        bpy.context.object.data.materials.append(glowing_normals())
        enter(bpy.context.object)
        return
    if kind == "META":
        data = bpy.data.metaballs.new(case)
        data.elements.new().co.x = 0.5
        data.elements.new().co.x = -0.5
    else:
        data = bpy.data.curves.new(case, kind)
        if kind == "FONT":
            data.body, data.extrude, data.size = "Ab", 0.1, 1.5
        else:
            data.bevel_depth = 0.2
            spline = data.splines.new("BEZIER")
            spline.bezier_points.add(2)
            for place, point in enumerate(spline.bezier_points):
                point.co, point.handle_left_type, point.handle_right_type = (place - 1, 0.3 * place, 0), "AUTO", "AUTO"
    data.materials.append(glowing_normals())
    enter(link(case, data))


def painted(case: str, mode: str) -> None:
    box = begin(case)
    subdivide(box)
    enter(box, mode=mode)


def sculpted(case: str) -> None:
    box = begin(case)
    bpy.context.view_layer.objects.active = box
    box.modifiers.new("Multires", "MULTIRES")
    bpy.ops.object.multires_subdivide(modifier="Multires")
    enter(box, mode="SCULPT")


def hairy(case: str, mode: str) -> None:
    """Cycles shows hair in most modes, but not in those that edit what it grows on, or itself."""
    box = begin(case)
    box.modifiers.new("Hair", "PARTICLE_SYSTEM")
    settings = box.particle_systems[0].settings
    for owner in (box.particle_systems[0], settings.force_field_1, settings.force_field_2):
        owner.seed = 1  # Blender takes another one each time
    settings.type, settings.count, settings.root_radius = "HAIR", 40, 20.0
    enter(box, mode=mode)


WARNINGS = {"hair": "hair", "combed hair": "hair", "mesh of nodes": "Edit Mode"}
"""A word of the one warning that each of these gives."""
CASES = {
    "plain": lambda case: enter(begin(case)),
    "subdivided": subdivided,
    "subdivided outside": lambda case: subdivided(case, show_in_editmode=False),
    "subdivided on cage": lambda case: subdivided(case, show_on_cage=True),
    "subdivided in renders": lambda case: subdivided(case, show_viewport=False),
    "box of a collection": lambda case: multiplied(case, "COLLECTION", "box"),
    "box on vertices": lambda case: multiplied(case, "VERTS", "box"),
    "faces below boxes": lambda case: multiplied(case, "FACES", "square"),
    "box of nodes": lambda case: multiplied(case, "NODES", "box"),
    "points of nodes": lambda case: multiplied(case, "NODES", "square"),
    "several": several,
    "shared": shared,
    "under edit": under_edit,
    "first shape key": lambda case: shape_key(case, 0, False),
    "second shape key": lambda case: shape_key(case, 1, False),
    "shape keys applied": lambda case: shape_key(case, 1, True),
    "armature": lambda case: deformed(case, "ARMATURE", "frame"),
    "on an armature": lambda case: deformed(case, "ARMATURE", "box"),
    "on a lattice": lambda case: deformed(case, "LATTICE", "box"),
    "curve": lambda case: converted(case, "CURVE"),
    "surface": lambda case: converted(case, "SURFACE"),
    "text": lambda case: converted(case, "FONT"),
    "metaball": lambda case: converted(case, "META"),
    "sculpted": sculpted,
    "hair": lambda case: hairy(case, "EDIT"),
    "combed hair": lambda case: hairy(case, "PARTICLE_EDIT"),
    "mesh of nodes": lambda case: multiplied(case, "MESHES", "box"),
    **{mode: lambda case: painted(case, case) for mode in ("SCULPT", "VERTEX_PAINT", "WEIGHT_PAINT", "TEXTURE_PAINT")},
}
"""Functions that make a scene, by its name, which they are called with."""
