# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures the Principled BSDF's Thin Wall in Cycles and writes thin_wall.json; in a Blender that has it (5.2 on):

    blender --background --factory-startup --python tests/parity/nodes/measure_thin_wall.py

A horizontal plane is looked at. Under a point light without extent and with one sample, its radiance is the BSDF's:
"lit", 4 x 4 of 32 x 32 pixels, as Cycles looks anywhere in a pixel's middle hundredth. Under a sky that is white above
and black below, or the other way round, a smooth plane shows what it reflects and what it passes: "shares", the mean
of 4096 samples.
"""

import json
import math
import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector

SIZE, STEP, ANGLE = 32, 8, 70.0
CAMERAS = {"above": (0.0, -1.6, 1.2), "below": (0.0, -1.6, -1.2)}
LIGHTS = {"above": (0.5, 0.6, 0.9), "below": (0.3, 0.4, -0.9)}
VIEWS = (("above", "above"), ("above", "below"), ("below", "above"))
"""Sides of camera and light."""
COLOR, TINT = (0.8, 0.5, 0.2), (0.4, 0.8, 0.9)
GLASS = {"base_color": COLOR, "transmission_weight": 1.0}
SHEET = {"base_color": COLOR, "subsurface_weight": 1.0}
LIT = {
    "glass": GLASS | {"roughness": 0.5},
    "glass_smoother": GLASS | {"roughness": 0.25},
    "glass_rougher": GLASS | {"roughness": 0.9, "ior": 2.5},
    "glass_low_ior": GLASS | {"roughness": 0.5, "ior": 0.7},
    "glass_tinted": GLASS | {"roughness": 0.6, "specular_tint": TINT},
    "glass_film": GLASS | {"roughness": 0.4, "thin_film_thickness": 400.0, "thin_film_ior": 1.8},
    "half_glass": GLASS | {"roughness": 0.5, "transmission_weight": 0.5},
    "subsurface": SHEET,
    "subsurface_forward": SHEET | {"subsurface_anisotropy": 0.6},
    "half_subsurface": SHEET | {"subsurface_weight": 0.5, "specular_ior_level": 0.0},
    "subsurface_rough": SHEET | {"diffuse_roughness": 0.8},
    "diffuse": {"base_color": COLOR},
    "layers": SHEET | {"metallic": 0.3, "coat_weight": 0.5, "coat_roughness": 0.4, "sheen_weight": 0.5},
}
SHARES = {
    "glass": GLASS,
    "glass_white": GLASS | {"base_color": 1.0},
    "glass_dense": GLASS | {"ior": 2.5},
    "glass_low_ior": GLASS | {"ior": 0.6},  # no pixel is at the critical angle, where the curve is steep
    "glass_without_index": GLASS | {"ior": 1.0},
    "glass_tinted": GLASS | {"specular_tint": TINT, "specular_ior_level": 0.1},
    "glass_film": GLASS | {"thin_film_thickness": 400.0, "thin_film_ior": 1.8},
}


def new_scene(size: int, samples: int, bounces: int) -> bpy.types.Scene:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.device = "CYCLES", "CPU"
    scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "GAUSSIAN", 0.01
    scene.cycles.blur_glossy = scene.cycles.sample_clamp_indirect = 0.0
    scene.cycles.samples, scene.cycles.max_bounces = samples, bounces
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    return scene


def add_plane(scene: bpy.types.Scene, inputs: dict) -> None:
    material = bpy.data.materials.new("Material")
    tree = material.node_tree
    tree.nodes.clear()
    node, output = tree.nodes.new("ShaderNodeBsdfPrincipled"), tree.nodes.new("ShaderNodeOutputMaterial")
    sockets = {socket.identifier.lower().replace(" ", "_"): socket for socket in node.inputs}
    for name, value in inputs.items():
        if sockets[name].type == "RGBA":
            value = (*((value,) * 3 if np.isscalar(value) else value), 1.0)
        sockets[name].default_value = value
    sockets["thin_wall"].default_value = True
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    mesh = bpy.data.meshes.new("Plane")
    # No edge between triangles in sight.
    mesh.from_pydata([(-60, -90, 0), (140, -90, 0), (140, 110, 0), (-60, 110, 0)], [], [(0, 1, 2, 3)])
    mesh.materials.append(material)
    scene.collection.objects.link(bpy.data.objects.new("Plane", mesh))


def look(scene: bpy.types.Scene, at: tuple, step: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 3) of the plane at the middles of the pixels that see it, and their radiance (n, 3)."""
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(camera)
    scene.camera, camera.data.angle = camera, math.radians(ANGLE)
    camera.location, camera.rotation_euler = at, (-Vector(at)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.view_layer.update()
    matrix = np.array(camera.matrix_world)
    chosen = slice(step // 2, None, step)
    across = ((np.arange(scene.render.resolution_x) + 0.5) / scene.render.resolution_x * 2.0 - 1.0)[chosen]
    x, y = np.meshgrid(across, across)
    local = np.stack([x, y, np.full_like(x, -1.0 / math.tan(math.radians(ANGLE) / 2.0))], -1).reshape(-1, 3)
    directions = local @ matrix[:3, :3].T
    distance = -matrix[2, 3] / directions[:, 2]
    points = matrix[:3, 3] + distance[:, None] * directions
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder) / "picture.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(scene.render.filepath)
        image.colorspace_settings.name = "Non-Color"
        radiance = np.array(image.pixels[:]).reshape(*image.size, 4)[chosen, chosen, :3]  # from the lowest row up
    seen = (distance > 0.0) & (distance < 20.0)
    return points[seen], radiance.reshape(-1, 3)[seen]


def lit(inputs: dict, camera: tuple, light_at: tuple) -> tuple[np.ndarray, np.ndarray]:
    scene = new_scene(SIZE, 1, 0)
    add_plane(scene, inputs)
    light = bpy.data.lights.new("Light", "POINT")
    light.energy, light.shadow_soft_size = 4.0 * math.pi, 0.0
    light = bpy.data.objects.new("Light", light)
    light.location = light_at
    scene.collection.objects.link(light)
    return look(scene, camera, STEP)


def shares(inputs: dict, camera: tuple, upper: bool) -> tuple[np.ndarray, np.ndarray]:
    scene = new_scene(4, 4096, 4)
    add_plane(scene, inputs | {"roughness": 0.0})
    scene.world = bpy.data.worlds.new("World")
    tree = scene.world.node_tree
    tree.nodes.clear()
    place, parts = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeSeparateXYZ")
    above, background = tree.nodes.new("ShaderNodeMath"), tree.nodes.new("ShaderNodeBackground")
    output = tree.nodes.new("ShaderNodeOutputWorld")
    above.operation = "GREATER_THAN" if upper else "LESS_THAN"
    above.inputs[1].default_value = 0.0
    tree.links.new(place.outputs["Generated"], parts.inputs[0])
    tree.links.new(parts.outputs["Z"], above.inputs[0])
    tree.links.new(above.outputs[0], background.inputs["Strength"])
    background.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    tree.links.new(background.outputs[0], output.inputs["Surface"])
    return look(scene, camera)


def rounded(values: np.ndarray) -> list:
    return [[float(f"{number:.5g}") for number in row] for row in values]


def main() -> None:
    lit_cases, share_cases, places = [], [], {}
    for name, inputs in LIT.items():
        for camera, light in VIEWS:
            places[camera], radiance = lit(inputs, CAMERAS[camera], LIGHTS[light])
            case = {"name": name, "camera": camera, "light": light, "inputs": inputs}
            lit_cases.append(case | {"radiance": rounded(radiance)})
    for name, inputs in SHARES.items():
        for camera in CAMERAS:
            points, reflected = shares(inputs, CAMERAS[camera], camera == "above")
            away = CAMERAS[camera] - points
            cosines = np.abs(away[:, 2:]) / np.linalg.norm(away, axis=1, keepdims=True)
            _, passed = shares(inputs, CAMERAS[camera], camera == "below")
            case = {"name": name, "camera": camera, "inputs": inputs, "cosines": rounded(cosines)}
            share_cases.append(case | {"reflected": rounded(reflected), "passed": rounded(passed)})
    measured = {
        "blender": [bpy.app.version_string], "cameras": [CAMERAS], "lights": [LIGHTS],
        "points": [{camera: rounded(points) for camera, points in places.items()}],
        "lit": lit_cases, "shares": share_cases,
    }  # fmt: skip
    rows = ",\n".join(f'"{key}": [\n' + ",\n".join(map(json.dumps, rows)) + "\n]" for key, rows in measured.items())
    folder = Path(sys.argv[sys.argv.index("--") + 1]) if "--" in sys.argv else Path(__file__).parent
    (folder / "thin_wall.json").write_text(f"{{{rows}}}\n", encoding="utf-8")


main()
