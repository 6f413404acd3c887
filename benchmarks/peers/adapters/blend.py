# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene as a .blend file, for RPPM and Cycles alike. Arguments: NAME FILE.blend, several times."""

import sys
from pathlib import Path

import bpy
import mathutils
import numpy as np

from ..description import (
    AreaLight,
    Diffuse,
    Glass,
    Light,
    Material,
    Mesh,
    Mirror,
    Scene,
    SphereLight,
    SpotLight,
    SunLight,
    frame_of,
)
from ..scenes import make_scene


def build(scene: Scene, path: Path) -> None:
    """Write the file."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    blender_scene = bpy.context.scene
    materials: dict[Material, bpy.types.Material] = {}
    for mesh in scene.meshes:
        if mesh.material not in materials:
            materials[mesh.material] = _material(mesh.material)
        _add_mesh(mesh, materials[mesh.material])
    for light in scene.lights:
        _add_light(light)
    _add_camera(scene)
    world = blender_scene.world = bpy.data.worlds.new("World")
    world.use_nodes = True
    background = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (scene.world, scene.world, scene.world, 1.0)
    background.inputs["Strength"].default_value = 1.0
    bpy.context.preferences.filepaths.save_version = 0
    bpy.ops.wm.save_as_mainfile(filepath=str(path.resolve()), compress=True)


def _material(material: Material) -> bpy.types.Material:
    made = bpy.data.materials.new(type(material).__name__)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    match material:
        case Diffuse(color):
            node = tree.nodes.new("ShaderNodeBsdfDiffuse")
            node.inputs["Color"].default_value = (*color, 1.0)
        case Glass(ior):
            node = tree.nodes.new("ShaderNodeBsdfGlass")
            node.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
            node.inputs["Roughness"].default_value = 0.0
            node.inputs["IOR"].default_value = ior
        case Mirror(color):
            node = tree.nodes.new("ShaderNodeBsdfAnisotropic")
            node.inputs["Color"].default_value = (*color, 1.0)
            node.inputs["Roughness"].default_value = 0.0
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return made


def _add_mesh(mesh: Mesh, material: bpy.types.Material) -> None:
    data = bpy.data.meshes.new(mesh.name)
    data.from_pydata(mesh.vertices.tolist(), [], mesh.triangles.tolist())
    data.materials.append(material)
    if mesh.normals is not None:
        data.shade_smooth()
        data.normals_split_custom_set_from_vertices(mesh.normals.tolist())
    bpy.context.collection.objects.link(bpy.data.objects.new(mesh.name, data))


def _add_light(light: Light) -> None:
    kinds = {AreaLight: "AREA", SphereLight: "POINT", SpotLight: "SPOT", SunLight: "SUN"}
    data = bpy.data.lights.new(light.name, kinds[type(light)])
    data.color = light.color
    if isinstance(light, SunLight):
        data.energy, data.angle = light.irradiance, light.angle
    else:
        data.energy = light.power
    if isinstance(light, AreaLight):
        data.shape, data.size = "SQUARE", light.size
    if isinstance(light, SphereLight | SpotLight):
        data.shadow_soft_size, data.use_soft_falloff = light.radius, False
    if isinstance(light, SpotLight):
        data.spot_size, data.spot_blend = light.angle, light.blend
    made = bpy.data.objects.new(light.name, data)
    made.visible_camera = True
    if not isinstance(light, SphereLight):
        x, y, z = frame_of(tuple(-np.array(light.direction)))  # lights shine along -Z
        made.matrix_world = mathutils.Matrix(np.stack([x, y, z], axis=1).tolist()).to_4x4()
    if not isinstance(light, SunLight):
        made.location = light.position
    bpy.context.collection.objects.link(made)


def _add_camera(scene: Scene) -> None:
    data = bpy.data.cameras.new("Camera")
    data.lens_unit, data.angle = "FOV", scene.camera.angle
    data.clip_start, data.clip_end = 0.01, 1000.0
    made = bpy.data.objects.new("Camera", data)
    made.matrix_world = mathutils.Matrix(np.stack(scene.camera.frame, axis=1).tolist()).to_4x4()
    made.location = scene.camera.position
    bpy.context.collection.objects.link(made)
    bpy.context.scene.camera = made


if __name__ == "__main__":
    for name, file in zip(sys.argv[1::2], sys.argv[2::2]):
        build(make_scene(name), Path(file))
