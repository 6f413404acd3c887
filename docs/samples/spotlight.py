# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes spotlight.blend: a glass hare under a moving spotlight, two seconds, after the paper's Fig. 15 (right).

Run with Python and the bpy module: python spotlight.py OUT.blend
The hare is of metaballs, subdivided when it is rendered. The spot goes round it, its caustics and its shadow go
round on the floor, and the camera passes by. Lengths are meters.
"""

import math

import bpy
from sample_scene import add_faces, color_world, material, save, set_up_frames

from mathutils import Vector  # isort: skip

BALLS = (
    # center, radius, half-axes
    ((0.00, 0.00, 0.34), 0.36, (1.00, 1.15, 0.95)),  # body
    ((0.00, -0.26, 0.62), 0.25, (0.95, 1.00, 0.95)),  # head
    ((0.00, -0.42, 0.57), 0.15, (0.90, 1.00, 0.75)),  # muzzle
    ((0.00, 0.38, 0.30), 0.14, (1.00, 1.00, 1.00)),  # tail
    ((0.16, -0.26, 0.14), 0.14, (0.80, 1.50, 0.80)),  # forepaws
    ((-0.16, -0.26, 0.14), 0.14, (0.80, 1.50, 0.80)),
    ((0.22, 0.12, 0.18), 0.22, (0.80, 1.40, 0.90)),  # haunches
    ((-0.22, 0.12, 0.18), 0.22, (0.80, 1.40, 0.90)),
)
EARS = ((0.12, 0.22), (-0.12, -0.14))
"""Where an ear begins across the head, and how far it leans out."""
FRAMES = 48


def hare_mesh():
    """One closed smooth mesh."""
    data = bpy.data.metaballs.new("Hare")
    data.resolution = data.render_resolution = 0.055
    data.threshold = 0.35

    def add(center, radius, axes=(1.0, 1.0, 1.0)):
        ball = data.elements.new(type="ELLIPSOID")
        ball.co, ball.radius = center, 1.6 * radius
        ball.size_x, ball.size_y, ball.size_z = axes

    for center, radius, axes in BALLS:
        add(center, radius, axes)
    for across, lean in EARS:
        for k in range(7):
            t = k / 6
            add((across + lean * t * t, -0.18 + 0.16 * t * t, 0.78 + 0.42 * t), 0.10 + 0.03 * math.sin(math.pi * t))
    balls = bpy.data.objects.new("Metaballs", data)
    bpy.context.collection.objects.link(balls)
    bpy.context.view_layer.update()
    mesh = bpy.data.meshes.new_from_object(balls.evaluated_get(bpy.context.evaluated_depsgraph_get()))
    bpy.data.objects.remove(balls)
    bpy.data.metaballs.remove(data)
    return mesh


def build_hare():
    mesh = hare_mesh()
    mesh.name = "Hare"
    mesh.shade_smooth()
    mesh.materials.clear()
    glass, _ = material("Glass", "ShaderNodeBsdfGlass", Color=(0.96, 0.99, 0.97, 1), Roughness=0.0, IOR=1.5)
    mesh.materials.append(glass)
    hare = bpy.data.objects.new("Hare", mesh)
    bpy.context.collection.objects.link(hare)
    hare.location.z = 0.002 - min(vertex.co.z for vertex in mesh.vertices)
    hare.rotation_euler.z = math.radians(-35.0)
    smooth = hare.modifiers.new("Smooth", "CORRECTIVE_SMOOTH")
    smooth.iterations, smooth.use_only_smooth = 12, True
    finer = hare.modifiers.new("Finer", "SUBSURF")
    finer.levels = finer.render_levels = 1


def build_room():
    floor, _ = material("Floor", "ShaderNodeBsdfDiffuse", Color=(0.72, 0.70, 0.66, 1))
    wall, _ = material("Wall", "ShaderNodeBsdfDiffuse", Color=(0.33, 0.42, 0.50, 1))
    add_faces("Floor", [(-3, -3, 0), (3, -3, 0), (3, 2, 0), (-3, 2, 0)], [(0, 1, 2, 3)], floor)
    add_faces("Wall", [(-3, 2, 0), (3, 2, 0), (3, 2, 3), (-3, 2, 3)], [(0, 1, 2, 3)], wall)
    add_faces("Side", [(-3, -3, 0), (-3, 2, 0), (-3, 2, 3), (-3, -3, 3)], [(0, 1, 2, 3)], wall)


def look_at(thing, place, target, frame):
    """Keyframes of a place and of the rotation that looks at a target from there."""
    turn = (Vector(target) - Vector(place)).to_track_quat("-Z", "Y")
    if frame > 1:
        turn.make_compatible(thing.rotation_quaternion)
    thing.location, thing.rotation_quaternion = place, turn
    for name in ("location", "rotation_quaternion"):
        thing.keyframe_insert(name, frame=frame)


def build_light_and_camera(scene):
    data = bpy.data.lights.new("Spot", "SPOT")
    data.energy, data.spot_size, data.spot_blend, data.color = 420.0, math.radians(40.0), 0.25, (1.0, 0.95, 0.86)
    data.shadow_soft_size = 0.02
    spot = bpy.data.objects.new("Spot", data)
    data = bpy.data.cameras.new("Camera")
    data.lens = 38.0
    camera = bpy.data.objects.new("Camera", data)
    for thing in (spot, camera):
        thing.rotation_mode = "QUATERNION"
        scene.collection.objects.link(thing)
    scene.camera = camera
    for frame in range(1, FRAMES + 1, 6):
        t = (frame - 1) / FRAMES
        turn = math.radians(150.0 + 120.0 * t)
        look_at(spot, (2.1 * math.cos(turn), 2.1 * math.sin(turn) + 0.2, 2.3), (0.0, 0.0, 0.4), frame)
        look_at(camera, (0.9 - 0.7 * t, -3.0 + 0.15 * t, 1.45 - 0.2 * t), (0.1, 0.05, 0.42), frame)


def set_up_render(scene):
    set_up_frames(scene, FRAMES)
    color_world(scene, (0.10, 0.12, 0.16), 0.35)
    settings = scene.rppm
    settings.samples, settings.photons, settings.radius_scale = 32, 65536, 12.0


def build(scene):
    build_room()
    build_hare()
    build_light_and_camera(scene)
    set_up_render(scene)


if __name__ == "__main__":
    save(build)
