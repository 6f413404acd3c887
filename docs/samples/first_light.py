# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes first_light.blend: glass, water, gold and a mirror in a room with one small area light.

Run with Python and the bpy module: python first_light.py OUT.blend
The picture shows caustics on the floor, caustics seen through glass and water, and in a mirror.
Lengths are meters. Surfaces are closed, so that every dielectric has an inside.
"""

import math

import bpy
from sample_scene import color_world, material, save, set_up_pictures

import bmesh  # isort: skip
from mathutils import Matrix, Vector  # isort: skip

HALF_WIDTH, FRONT, BACK, HEIGHT = 1.9, -2.7, 1.45, 2.3
TANK = Vector((0.62, 0.42, 0.0))
TANK_HALF = Vector((0.44, 0.34, 0.0))
TANK_BASE, TANK_HEIGHT, WALL = 0.06, 0.42, 0.012
WATER_LEVEL, WATER_GAP = 0.32, 0.001
WAVE_CELLS = 96


def add_mesh(name, mesh, surface, smooth=False, location=(0, 0, 0), rotation=(0, 0, 0)):
    """An object of a bmesh, which is used up."""
    if smooth is not None:
        for face in mesh.faces:
            face.smooth = smooth
    bmesh.ops.recalc_face_normals(mesh, faces=mesh.faces)
    data = bpy.data.meshes.new(name)
    mesh.to_mesh(data)
    mesh.free()
    data.materials.append(surface)
    made = bpy.data.objects.new(name, data)
    made.location, made.rotation_euler = location, rotation
    bpy.context.collection.objects.link(made)
    return made


def box(low, high):
    mesh = bmesh.new()
    bmesh.ops.create_cube(mesh, size=1.0)
    low, high = Vector(low), Vector(high)
    bmesh.ops.transform(
        mesh, matrix=Matrix.Translation((low + high) / 2) @ Matrix.Diagonal((high - low).to_4d()), verts=mesh.verts
    )
    return mesh


def quad(*corners):
    mesh = bmesh.new()
    mesh.faces.new([mesh.verts.new(corner) for corner in corners])
    return mesh


def torus(major, minor, around=128, across=40):
    """A ring in the XY plane."""
    mesh = bmesh.new()
    rings = []
    for i in range(around):
        u = math.tau * i / around
        ring = []
        for j in range(across):
            v = math.tau * j / across
            reach = major + minor * math.cos(v)
            ring.append(mesh.verts.new((reach * math.cos(u), reach * math.sin(u), minor * math.sin(v))))
        rings.append(ring)
    for i in range(around):
        for j in range(across):
            here, there = rings[i], rings[(i + 1) % around]
            mesh.faces.new((here[j], there[j], there[(j + 1) % across], here[(j + 1) % across]))
    return mesh


def band(radius, thickness, height, around=192):
    """A flat ring standing on the floor: a strip of metal bent round."""
    mesh = bmesh.new()
    loops = []
    for i in range(around):
        u = math.tau * i / around
        loops.append(
            [
                mesh.verts.new((r * math.cos(u), r * math.sin(u), z))
                for r, z in ((radius, 0), (radius + thickness, 0), (radius + thickness, height), (radius, height))
            ]
        )
    for i in range(around):
        here, there = loops[i], loops[(i + 1) % around]
        for j in range(4):
            face = mesh.faces.new((here[j], there[j], there[(j + 1) % 4], here[(j + 1) % 4]))
            face.smooth = j in (1, 3)
    for edge in mesh.edges:  # the strip's rims stay sharp
        edge.smooth = all(face.smooth for face in edge.link_faces)
    return mesh


def crystal(radius, height, sides=8):
    """A cut stone: a prism with a point above and a flat table below."""
    mesh = bmesh.new()
    profile = ((0.55, 0.0), (1.0, 0.30), (0.92, 0.72))
    loops = [
        [
            mesh.verts.new(
                (
                    radius * scale * math.cos(math.tau * (i + 0.5 * level) / sides),
                    radius * scale * math.sin(math.tau * (i + 0.5 * level) / sides),
                    height * z,
                )
            )
            for i in range(sides)
        ]
        for level, (scale, z) in enumerate(profile)
    ]
    top = mesh.verts.new((0, 0, height))
    mesh.faces.new(loops[0][::-1])
    for low, high in zip(loops, loops[1:]):
        for i in range(sides):
            mesh.faces.new((low[i], low[(i + 1) % sides], high[i]))
            mesh.faces.new((low[(i + 1) % sides], high[(i + 1) % sides], high[i]))
    for i in range(sides):
        mesh.faces.new((loops[-1][i], loops[-1][(i + 1) % sides], top))
    return mesh


def wave(x, y):
    """Height of the water above its mean level: gentle ripples from several sides."""
    ripples = (
        (56.0, 18.0, 0.0, 0.0028),
        (-31.0, 57.0, 1.3, 0.0026),
        (44.0, -47.0, 2.1, 0.0020),
        (12.0, 79.0, 4.0, 0.0009),
    )
    return sum(height * math.sin(kx * x + ky * y + phase) for kx, ky, phase, height in ripples)


def water():
    """A closed body: a wavy top, sides just inside the glass, a bottom inside the base."""
    inner = TANK_HALF - Vector((WALL + WATER_GAP, WALL + WATER_GAP, 0))
    mesh = bmesh.new()
    n = WAVE_CELLS
    top = []
    for j in range(n + 1):
        row = []
        for i in range(n + 1):
            x, y = inner.x * (2 * i / n - 1), inner.y * (2 * j / n - 1)
            row.append(mesh.verts.new((x, y, WATER_LEVEL + wave(x, y))))
        top.append(row)
    for j in range(n):
        for i in range(n):
            mesh.faces.new((top[j][i], top[j][i + 1], top[j + 1][i + 1], top[j + 1][i])).smooth = True
    rim = top[0][:-1] + [row[-1] for row in top[:-1]] + top[-1][:0:-1] + [row[0] for row in top[:0:-1]]
    foot = [mesh.verts.new((vertex.co.x, vertex.co.y, TANK_BASE - 0.05)) for vertex in rim]
    for k in range(len(rim)):
        after = (k + 1) % len(rim)
        mesh.faces.new((rim[k], foot[k], foot[after], rim[after])).smooth = False
    mesh.faces.new(foot[::-1]).smooth = False
    return mesh


def tank_walls():
    """One closed piece of glass: four walls that reach into the base."""
    mesh = bmesh.new()
    low, high = TANK_BASE - 0.02, TANK_HEIGHT

    def loop(half_x, half_y, z):
        return [mesh.verts.new((sx * half_x, sy * half_y, z)) for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))]

    outer = (TANK_HALF.x, TANK_HALF.y)
    inner = (TANK_HALF.x - WALL, TANK_HALF.y - WALL)
    rings = [loop(*outer, low), loop(*outer, high), loop(*inner, high), loop(*inner, low)]
    for k in range(4):
        here, there = rings[k], rings[(k + 1) % 4]
        for i in range(4):
            mesh.faces.new((here[i], here[(i + 1) % 4], there[(i + 1) % 4], there[i]))
    return mesh


def build_room():
    x, f, b, z = HALF_WIDTH, FRONT, BACK, HEIGHT
    plaster, _ = material("Plaster", "ShaderNodeBsdfDiffuse", Color=(0.60, 0.57, 0.52, 1))
    floor, _ = material("Floor", "ShaderNodeBsdfDiffuse", Color=(0.42, 0.36, 0.30, 1))
    terracotta, _ = material("Terracotta", "ShaderNodeBsdfDiffuse", Color=(0.62, 0.20, 0.11, 1))
    teal, _ = material("Teal", "ShaderNodeBsdfDiffuse", Color=(0.07, 0.33, 0.38, 1))
    add_mesh("Floor", quad((-x, f, 0), (x, f, 0), (x, b, 0), (-x, b, 0)), floor)
    add_mesh("Ceiling", quad((-x, f, z), (-x, b, z), (x, b, z), (x, f, z)), plaster)
    add_mesh("Back Wall", quad((-x, b, 0), (x, b, 0), (x, b, z), (-x, b, z)), plaster)
    add_mesh("Front Wall", quad((-x, f, 0), (-x, f, z), (x, f, z), (x, f, 0)), plaster)
    add_mesh("Left Wall", quad((-x, f, 0), (-x, b, 0), (-x, b, z), (-x, f, z)), terracotta)
    add_mesh("Right Wall", quad((x, f, 0), (x, f, z), (x, b, z), (x, b, 0)), teal)


def build_objects():
    glass, _ = material("Glass", "ShaderNodeBsdfGlass", Color=(1, 1, 1, 1), Roughness=0.0, IOR=1.5)
    crystal_glass, _ = material("Crystal", "ShaderNodeBsdfGlass", Color=(0.93, 0.97, 1, 1), Roughness=0.0, IOR=1.7)
    water_surface, _ = material("Water", "ShaderNodeBsdfGlass", Color=(0.96, 0.99, 1, 1), Roughness=0.0, IOR=1.333)
    gold, _ = material("Gold", "ShaderNodeBsdfAnisotropic", Color=(0.95, 0.70, 0.32, 1), Roughness=0.0)
    silver, _ = material("Mirror", "ShaderNodeBsdfAnisotropic", Color=(0.93, 0.94, 0.95, 1), Roughness=0.0)
    wood, _ = material("Frame", "ShaderNodeBsdfPrincipled", Base_Color=(0.055, 0.03, 0.018, 1), Roughness=0.5)
    tile, _ = material("Tank Base", "ShaderNodeBsdfDiffuse", Color=(0.72, 0.70, 0.62, 1))

    sphere = bmesh.new()
    bmesh.ops.create_icosphere(sphere, subdivisions=5, radius=0.30)
    add_mesh("Glass Ball", sphere, glass, smooth=True, location=(-0.40, -0.20, 0.301))
    add_mesh(
        "Glass Ring", torus(0.24, 0.075), glass, smooth=True, location=(-0.86, 0.48, 0.313), rotation=(1.45, 0, 0.25)
    )
    add_mesh("Crystal", crystal(0.13, 0.30), crystal_glass, location=(0.26, -0.60, 0.001), rotation=(0, 0, 0.35))
    add_mesh("Gold Band", band(0.19, 0.012, 0.11), gold, smooth=None, location=(-0.62, -0.78, 0.001))

    x, y = TANK_HALF.x + 0.03, TANK_HALF.y + 0.03
    turn = (0, 0, -0.2)
    add_mesh("Tank Base", box((-x, -y, 0.001), (x, y, TANK_BASE)), tile, location=TANK, rotation=turn)
    add_mesh("Tank Walls", tank_walls(), glass, location=TANK, rotation=turn)
    add_mesh("Water", water(), water_surface, smooth=None, location=TANK, rotation=turn)

    lean = Matrix.Translation((-0.42, BACK - 0.24, 0.0)) @ Matrix.Rotation(math.radians(-8), 4, "X")
    add_mesh("Mirror", box((-0.62, -0.004, 0.06), (0.62, 0.0, 1.00)), silver).matrix_world = lean
    add_mesh("Mirror Frame", box((-0.68, 0.002, 0.0), (0.68, 0.04, 1.06)), wood).matrix_world = lean
    for name, low, high in (
        ("Frame Left", (-0.68, -0.02, 0.0), (-0.622, 0.001, 1.06)),
        ("Frame Right", (0.622, -0.02, 0.0), (0.68, 0.001, 1.06)),
        ("Frame Foot", (-0.622, -0.02, 0.0), (0.622, 0.001, 0.058)),
        ("Frame Head", (-0.622, -0.02, 1.002), (0.622, 0.001, 1.06)),
    ):
        add_mesh(name, box(low, high), wood).matrix_world = lean


def build_light_and_camera(scene):
    data = bpy.data.lights.new("Lamp", "AREA")
    data.shape, data.size, data.energy, data.color = "SQUARE", 0.13, 62.0, (1.0, 0.93, 0.84)
    lamp = bpy.data.objects.new("Lamp", data)
    lamp.location = (-1.3, -0.75, 1.62)
    lamp.rotation_euler = (Vector((0.1, 0.1, 0.0)) - lamp.location).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(lamp)

    data = bpy.data.cameras.new("Camera")
    data.lens = 33.0
    camera = bpy.data.objects.new("Camera", data)
    camera.location = (0.15, -2.35, 1.4)
    camera.rotation_euler = (Vector((-0.06, 0.15, 0.27)) - camera.location).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(camera)
    scene.camera = camera


def set_up_render(scene):
    set_up_pictures(scene)
    scene.view_settings.look = "AgX - Medium High Contrast"
    color_world(scene, (0, 0, 0), 1.0)
    scene.rppm.samples = 72
    scene.rppm.time_limit = 50.0  # two slow cores get a picture within a minute
    scene.rppm.photons = 65536
    scene.rppm.radius_scale = 16.0


def build(scene):
    build_room()
    build_objects()
    build_light_and_camera(scene)
    set_up_render(scene)


if __name__ == "__main__":
    save(build)
