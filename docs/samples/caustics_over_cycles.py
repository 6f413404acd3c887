# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes caustics_over_cycles.blend: Cycles renders all but caustics, RPPM the caustics, and the compositor adds them.

Run with Python and the bpy module: python caustics_over_cycles.py OUT.blend
Both scenes show the same objects. F12 in the scene Picture renders both. Lengths are meters.
"""

import math

import bpy
from sample_scene import add_faces, color_world, material, save, set_up_pictures, surface_of_revolution

from mathutils import Vector  # isort: skip


def build_table():
    wood, _ = material("Table", "ShaderNodeBsdfDiffuse", Color=(0.62, 0.58, 0.52, 1))
    wall, _ = material("Wall", "ShaderNodeBsdfDiffuse", Color=(0.42, 0.50, 0.56, 1))
    add_faces("Table", [(-2, -2, 0), (2, -2, 0), (2, 1.2, 0), (-2, 1.2, 0)], [(0, 1, 2, 3)], wood)
    add_faces("Wall", [(-2, 1.2, 0), (2, 1.2, 0), (2, 1.2, 2), (-2, 1.2, 2)], [(0, 1, 2, 3)], wall)


def build_things():
    glass, _ = material("Glass", "ShaderNodeBsdfGlass", Color=(0.98, 1.0, 0.99, 1), Roughness=0.0, IOR=1.5)
    gold, _ = material("Gold", "ShaderNodeBsdfAnisotropic", Color=(1.0, 0.72, 0.30, 1), Roughness=0.05)
    clay, _ = material("Clay", "ShaderNodeBsdfDiffuse", Color=(0.70, 0.16, 0.10, 1))
    steps = [math.pi * k / 48 for k in range(49)]
    half_circle = [(math.sin(t) if 0 < k < 48 else 0.0, -math.cos(t)) for k, t in enumerate(steps)]
    ball = surface_of_revolution("Glass Ball", [(0.28 * r, 0.28 * z) for r, z in half_circle], glass)
    ball.location = (-0.42, 0.0, 0.281)
    ball = surface_of_revolution("Clay Ball", [(0.2 * r, 0.2 * z) for r, z in half_circle], clay)
    ball.location = (0.05, 0.55, 0.201)
    band = [(0.34, 0.001), (0.34, 0.16), (0.325, 0.16), (0.325, 0.001)]
    ring = surface_of_revolution("Gold Ring", band, gold)
    ring.data.shade_flat()
    ring.location = (0.55, -0.1, 0.0)


def build_light_and_camera(scene):
    data = bpy.data.lights.new("Lamp", "AREA")
    data.energy, data.shape, data.size, data.color = 60.0, "DISK", 0.12, (1.0, 0.95, 0.86)
    lamp = bpy.data.objects.new("Lamp", data)
    lamp.location = (1.3, 0.7, 1.9)
    lamp.rotation_euler = (Vector((0.0, 0.0, 0.0)) - lamp.location).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(lamp)
    data = bpy.data.cameras.new("Camera")
    data.lens = 42.0
    camera = bpy.data.objects.new("Camera", data)
    camera.location = (-0.1, -2.4, 1.5)
    camera.rotation_euler = (Vector((0.02, 0.0, 0.14)) - camera.location).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(camera)
    scene.camera = camera


def render_with_cycles(scene):
    """All but caustics. What is not filtered and not clamped is what RPPM renders, too."""
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.caustics_reflective = cycles.caustics_refractive = False
    cycles.blur_glossy = cycles.sample_clamp_indirect = cycles.sample_clamp_direct = 0.0
    cycles.samples, cycles.use_denoising = 256, True
    cycles.max_bounces = cycles.transmission_bounces = cycles.glossy_bounces = cycles.diffuse_bounces = 8


def render_with_rppm(scene):
    """The caustics, of which the view layer has a pass."""
    scene.render.engine = "RPPM"
    scene.view_layers[0].rppm.use_pass_caustics = True
    settings = scene.rppm
    settings.samples, settings.photons, settings.radius_scale = 64, 131072, 12.0
    settings.max_camera_bounces = settings.max_photon_bounces = 8


def add_up(scene, caustics):
    """The scene's picture and the caustics, in its compositor."""
    if bpy.app.version < (5, 0):
        scene.use_nodes = True
        tree = scene.node_tree
        tree.nodes.clear()
        output = tree.nodes.new("CompositorNodeComposite")
    else:
        tree = scene.compositing_node_group = bpy.data.node_groups.new("Add Caustics", "CompositorNodeTree")
        tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
        output = tree.nodes.new("NodeGroupOutput")
    layers = []
    for of, height in ((scene, 200), (caustics, -200)):
        layers.append(tree.nodes.new("CompositorNodeRLayers"))
        layers[-1].scene, layers[-1].location = of, (-400, height)
    legacy = bpy.app.version < (5, 0)
    added = tree.nodes.new("CompositorNodeMixRGB" if legacy else "ShaderNodeMix")
    if not legacy:
        added.data_type = "RGBA"
    added.blend_type = "ADD"
    colors = [socket for socket in added.inputs if socket.type == "RGBA"]
    factor = next(socket for socket in added.inputs if socket.type == "VALUE")
    factor.default_value = 1.0
    tree.links.new(layers[0].outputs["Image"], colors[0])
    tree.links.new(layers[1].outputs["Caustics"], colors[1])
    tree.links.new(next(socket for socket in added.outputs if socket.type == "RGBA"), output.inputs[0])
    output.location = (300, 0)


def build(scene):
    scene.name = "Picture"
    set_up_pictures(scene)
    color_world(scene, (0.55, 0.65, 0.80), 0.25)
    build_table()
    build_things()
    build_light_and_camera(scene)
    bpy.ops.scene.new(type="LINK_COPY")
    caustics = bpy.context.scene
    caustics.name = "Caustics"
    render_with_rppm(caustics)
    render_with_cycles(scene)
    bpy.context.window.scene = scene
    add_up(scene, caustics)


if __name__ == "__main__":
    save(build)
