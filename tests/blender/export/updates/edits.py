# SPDX-License-Identifier: GPL-3.0-or-later
"""Edits of a scene, as users make them, and whether a scene that followed them is that which is exported anew."""

import bmesh
import bpy
from blender_scenes import CAMERA, add_mesh, depsgraph, show_collection

from rppm_addon.blender.export.updates.sync import SceneSync
from rppm_addon.scene import Instance, Scene
from rppm_addon.scene.storage.documents import field_names
from rppm_addon.scene.storage.sharing import equal

FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def add_box(name: str, size: float = 1.0) -> bpy.types.Object:
    points = [(size * x, size * y, size * z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    return add_mesh(bpy.context.scene, name, points, FACES)


def principled(name: str) -> bpy.types.Node:
    return bpy.data.materials[name].node_tree.nodes["Principled BSDF"]


def do(*edits) -> None:
    """Make edits, with an update after each."""
    for edit in edits:
        edit()
        bpy.context.view_layer.update()


def move():
    bpy.data.objects["Cube"].location.x += 0.25


def move_twin():
    bpy.data.objects["Twin"].rotation_euler.z += 0.5


def edit_mesh():
    mesh = bpy.data.meshes["Cube"]
    mesh.vertices[0].co.x -= 0.3
    mesh.update()


def edit_other_mesh():
    mesh = bpy.data.meshes["Other"]
    mesh.vertices[3].co.z += 0.3
    mesh.update()


def paint():
    principled("Red").inputs["Base Color"].default_value[0] += 0.1


def paint_unused():
    principled("Blue").inputs["Roughness"].default_value *= 0.9


def use_blue():
    bpy.data.objects["Other"].data.materials.append(bpy.data.materials["Blue"])


def swap_slot():
    bpy.data.objects["Cube"].material_slots[0].material = bpy.data.materials["Blue"]


def ask_for_generated():
    tree = bpy.data.materials["Red"].node_tree
    tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs[0], principled("Red").inputs["Base Color"])


def displace():
    material = bpy.data.materials["Red"]
    tree = material.node_tree
    height = tree.nodes.new("ShaderNodeDisplacement")
    tree.links.new(height.outputs[0], tree.nodes["Material Output"].inputs["Displacement"])
    material.displacement_method = "BOTH"


def subdivide_adaptively():
    modifier = bpy.data.objects["Cube"].modifiers.new("Subdivision", "SUBSURF")
    if hasattr(modifier, "use_adaptive_subdivision"):  # Blender 5
        modifier.use_adaptive_subdivision = True


def brighten():
    bpy.data.lights["Light"].energy += 50.0


def move_light():
    bpy.data.objects["Light"].location.z += 1.0


def recolor_world():
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value += 0.3


def hide():
    twin = bpy.data.objects["Twin"]
    twin.hide_viewport = not twin.hide_viewport


def hide_from_camera():
    bpy.data.objects["Other"].visible_camera ^= True


def subdivide():
    bpy.data.objects["Cube"].modifiers.new("Bevel", "BEVEL").segments = 2


def remove():
    twin = bpy.data.objects.get("Twin")
    if twin is not None:
        bpy.data.objects.remove(twin)


def add():
    add_box("Added", 0.3)


def add_same_place():
    """Exchange a mesh, the memory of which may be used for the next one."""
    bpy.data.meshes.remove(bpy.data.meshes["Other"])
    add_box("New", 0.7)


def exchange_data():
    bpy.data.objects["Other"].data = bpy.data.meshes["Cube"]


def instance_collection():
    group = bpy.data.collections.new("Group")
    group.objects.link(bpy.data.objects["Other"])
    show_collection(bpy.context.scene, group, location=(0.0, 0.0, 4.0))


def parent():
    bpy.data.objects["Other"].parent = bpy.data.objects["Cube"]


def other_settings():
    bpy.context.scene.rppm.alpha = 0.6
    bpy.context.scene.update_tag()


def next_frame():
    bpy.context.scene.frame_set(bpy.context.scene.frame_current + 1)


EDITS = (
    move, move_twin, edit_mesh, edit_other_mesh, paint, paint_unused, use_blue, swap_slot, ask_for_generated, brighten,
    move_light, recolor_world, hide, hide_from_camera, subdivide, remove, add, exchange_data, instance_collection,
    parent, other_settings, next_frame,
)  # fmt: skip


def in_edit_mode(*names: str) -> None:
    for source in bpy.context.view_layer.objects:
        source.select_set(source.name in names)
    bpy.context.view_layer.objects.active = bpy.data.objects[names[0]]
    bpy.ops.object.mode_set(mode="EDIT")


def in_object_mode() -> None:
    bpy.ops.object.mode_set(mode="OBJECT")


def mesh_under_edit():
    mesh = bmesh.from_edit_mesh(bpy.data.meshes["Cube"])
    mesh.verts.ensure_lookup_table()
    mesh.faces.ensure_lookup_table()
    return mesh


def pull() -> None:
    """A vertex of the mesh under edit moves."""
    mesh_under_edit().verts[0].co.x -= 0.3
    bmesh.update_edit_mesh(bpy.data.meshes["Cube"])


def cut() -> None:
    """Edges of the mesh under edit are divided, and a face goes."""
    mesh = mesh_under_edit()
    bmesh.ops.subdivide_edges(mesh, edges=mesh.edges[:], cuts=1)
    mesh.faces.ensure_lookup_table()
    bmesh.ops.delete(mesh, geom=[mesh.faces[0]], context="FACES")
    bmesh.update_edit_mesh(bpy.data.meshes["Cube"])


def assign() -> None:
    """A face of the mesh under edit takes the second material."""
    bpy.data.meshes["Cube"].materials.append(bpy.data.materials["Blue"])
    mesh_under_edit().faces[1].material_index = 1
    bmesh.update_edit_mesh(bpy.data.meshes["Cube"])


def fresh() -> Scene:
    return SceneSync().update(depsgraph(), CAMERA)


def same(a: Scene, b: Scene) -> bool:
    """Whether two scenes say the same, however their meshes and materials are numbered."""

    def told(scene: Scene) -> list:
        instances = [
            (
                scene.meshes[instance.mesh],
                [scene.materials[material] for material in instance.materials],
                *(getattr(instance, name) for name in field_names(Instance) if name not in {"mesh", "materials"}),
            )
            for instance in scene.instances
        ]
        return [instances, scene.lights, scene.world, scene.settings, scene.exposure, sorted(scene.warnings)]

    return equal(told(a), told(b))
