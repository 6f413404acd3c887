# SPDX-License-Identifier: GPL-3.0-or-later
"""What the scripts that make the gallery's scenes do alike. Lengths are meters."""

import math
import sys
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parents[1] / "samples"))

from mathutils import Matrix, Vector
from sample_scene import add_faces, color_world, material, save, set_up_pictures, surface_of_revolution

__all__ = [
    "Matrix",
    "Vector",
    "add_faces",
    "aim",
    "ball",
    "block",
    "camera",
    "color_world",
    "diffuse",
    "glass",
    "lathe",
    "light",
    "material",
    "metal",
    "plate",
    "save",
    "set_up",
    "slit",
    "sun",
    "torus",
    "varnished",
    "wood",
]  # fmt: skip


def diffuse(name, color, roughness=0.0):
    """A matt surface."""
    return material(name, "ShaderNodeBsdfDiffuse", Color=(*color, 1), Roughness=roughness)[0]


def glass(name, color=(1.0, 1.0, 1.0), ior=1.5, roughness=0.0):
    """A clear or tinted dielectric."""
    return material(name, "ShaderNodeBsdfGlass", Color=(*color, 1), Roughness=roughness, IOR=ior)[0]


def metal(name, color, roughness=0.05):
    """A mirror of a color."""
    return material(name, "ShaderNodeBsdfAnisotropic", Color=(*color, 1), Roughness=roughness)[0]


def varnished(name, color, roughness=0.15):
    """A plastic or varnished surface."""
    made, _ = material(name, "ShaderNodeBsdfPrincipled", Base_Color=(*color, 1), Roughness=roughness)
    return made


def wood(name, dark, light, roughness=0.35, turn=0.0, scale=1.0):
    """Varnished wood whose grain runs along X, or so many degrees beside it; scale: 1 for a table of 2 m."""
    made, shader = material(name, "ShaderNodeBsdfPrincipled", Roughness=roughness)
    tree = made.node_tree
    place, grain, noise, colors = (
        tree.nodes.new(f"ShaderNode{kind}") for kind in ("TexCoord", "Mapping", "TexNoise", "ValToRGB")
    )
    grain.inputs["Rotation"].default_value[2] = math.radians(turn)
    grain.inputs["Scale"].default_value = (1.6 * scale, 26.0 * scale, 1.0)
    noise.inputs["Scale"].default_value, noise.inputs["Detail"].default_value = 1.0, 5.0
    for stop, position, color in zip(colors.color_ramp.elements, (0.32, 0.68), (dark, light)):
        stop.position, stop.color = position, (*color, 1)
    for output, socket in (
        (place.outputs["Object"], grain.inputs["Vector"]),
        (grain.outputs["Vector"], noise.inputs["Vector"]),
        (noise.outputs[0], colors.inputs[0]),
        (colors.outputs["Color"], shader.inputs["Base Color"]),
    ):
        tree.links.new(output, socket)
    return made


def aim(thing, target):
    """Turn an object so that it looks at a point."""
    thing.rotation_euler = (Vector(target) - thing.location).to_track_quat("-Z", "Y").to_euler()
    return thing


def camera(place, target, lens, f_number=None):
    """The scene's camera; f_number: of a lens that is focused on the target."""
    data = bpy.data.cameras.new("Camera")
    data.lens, data.clip_start = lens, 0.001
    made = bpy.data.objects.new("Camera", data)
    made.location = place
    bpy.context.collection.objects.link(made)
    bpy.context.scene.camera = aim(made, target)
    if f_number is not None:
        data.dof.use_dof, data.dof.aperture_fstop = True, f_number
        data.dof.focus_distance = (Vector(target) - Vector(place)).length
    return made


def light(kind, name, place, target, watts, color=(1.0, 1.0, 1.0), **values):
    """A light that shines at a point; values: attributes of its data."""
    data = bpy.data.lights.new(name, kind)
    data.energy, data.color = watts, color
    for key, value in values.items():
        setattr(data, key, value)
    made = bpy.data.objects.new(name, data)
    made.location = place
    bpy.context.collection.objects.link(made)
    return aim(made, target)


def sun(direction, strength, color=(1.0, 0.95, 0.86)):
    """The sun as small as it is, shining in a direction."""
    return light("SUN", "Sun", (0, 0, 5), Vector((0, 0, 5)) + Vector(direction), strength, color, angle=0.0093)


def slit(name, place, direction, watts, color, width, height, reach, spread=0.5):
    """A lamp whose flat beam slides along the floor: a line of light of one brightness, so many meters long."""
    along = Vector((*direction, 0.0)).normalized()
    start = Vector((*place, 0.51 * height))
    return light("AREA", name, start, start + along * reach - Vector((0, 0, height)), watts, color,
                 shape="RECTANGLE", size=width, size_y=height, spread=math.radians(spread))  # fmt: skip


def plate(name, x, y, width, depth, z, surface):
    """A level rectangle about a middle, facing up."""
    a, b = width / 2, depth / 2
    return add_faces(
        name, [(x - a, y - b, z), (x + a, y - b, z), (x + a, y + b, z), (x - a, y + b, z)], [(0, 1, 2, 3)], surface
    )


def block(name, low, high, surface, bevel=0.0):
    """A box between two corners, with rounded edges where ``bevel`` is a width."""
    (a, b, c), (d, e, f) = low, high
    points = [(x, y, z) for z in (c, f) for x, y in ((a, b), (d, b), (d, e), (a, e))]
    faces = [(3, 2, 1, 0), (4, 5, 6, 7), *((k, (k + 1) % 4, (k + 1) % 4 + 4, k + 4) for k in range(4))]
    made = add_faces(name, points, faces, surface)
    if bevel:
        rounding = made.modifiers.new("Bevel", "BEVEL")
        rounding.width, rounding.segments = bevel, 4
        made.data.shade_smooth()
        made.modifiers.new("Weighted Normals", "WEIGHTED_NORMAL").keep_sharp = False
    return made


def lathe(name, profile, surface, around=128):
    """Round the Z axis and smooth; profile: a closed line of (radius, height)."""
    return surface_of_revolution(name, profile, surface, around)


def ball(name, center, radius, surface, rings=48):
    """A smooth ball."""
    half = [
        (math.sin(math.pi * k / rings) if 0 < k < rings else 0.0, -math.cos(math.pi * k / rings))
        for k in range(rings + 1)
    ]
    made = lathe(name, [(radius * r, radius * z) for r, z in half], surface, 2 * rings)
    made.location = center
    return made


def torus(name, radius, thickness, surface, around=160, across=40):
    """A ring about the Z axis."""
    turns = [math.tau * k / across for k in range(across)]
    return lathe(name, [(radius + thickness * math.cos(t), thickness * math.sin(t)) for t in turns], surface, around)


def smooth_line(points, steps=8):
    """A Catmull-Rom line through points of two coordinates."""
    line = []
    for k in range(len(points) - 1):
        p0, p1, p2, p3 = (points[min(max(k + j, 0), len(points) - 1)] for j in (-1, 0, 1, 2))
        for step in range(steps):
            t = step / steps
            line.append(
                tuple(
                    0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t + (3 * b - a - 3 * c + d) * t**3)
                    for a, b, c, d in zip(p0, p1, p2, p3)
                )
            )
    return [*line, points[-1]]


def set_up(scene, width=960, height=540, bounces=8, look="AgX - Medium High Contrast", exposure=0.0):
    """How the picture is rendered, with as many bounces by Cycles, which else keeps Blender's own settings."""
    set_up_pictures(scene)
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.view_settings.look, scene.view_settings.exposure = look, exposure
    scene.rppm.samples, scene.rppm.use_denoising = 512, True
    scene.rppm.max_camera_bounces = scene.rppm.max_photon_bounces = bounces
    scene.cycles.max_bounces = scene.cycles.transmission_bounces = scene.cycles.glossy_bounces = bounces
    scene.cycles.diffuse_bounces = bounces
    scene.cycles.use_denoising = True
