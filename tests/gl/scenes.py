# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes made of arrays, without Blender."""

import numpy as np
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import Camera, Instance, Light, LightKind, Material, Mesh, RenderSettings, Scene, World


def polygons(name: str, positions: np.ndarray, faces: list[tuple[int, ...]], smooth: bool = False) -> Mesh:
    """A mesh of convex faces; smooth normals point away from the origin."""
    positions = np.asarray(positions, np.float32)
    corners, normals, triangles = [], [], []
    for face in faces:
        a, b, c = (positions[face[k]].astype(float) for k in range(3))
        normal = np.cross(b - a, c - a)
        first = len(corners)
        corners += face
        normals += [normal / np.linalg.norm(normal)] * len(face)
        triangles += [(first, first + k, first + k + 1) for k in range(1, len(face) - 1)]
    corners = np.array(corners, np.int32)
    normals = np.array(normals, np.float32)
    if smooth:
        normals = positions[corners] / np.linalg.norm(positions[corners], axis=1, keepdims=True)
    return Mesh(name, positions, corners, normals, np.array(triangles, np.int32), np.zeros(len(triangles), np.int32))


def rectangle(name: str, *corners: tuple[float, float, float]) -> Mesh:
    return polygons(name, np.array(corners), [(0, 1, 2, 3)])


def sphere(name: str, columns: int = 32, rows: int = 16) -> Mesh:
    """A unit sphere of quads with smooth normals."""
    theta, phi = np.pi * np.arange(rows + 1) / rows, 2 * np.pi * np.arange(columns) / columns
    s, c = np.sin(theta)[:, None], np.cos(theta)[:, None]
    points = np.stack([s * np.cos(phi), s * np.sin(phi), c * np.ones(columns)], -1).reshape(-1, 3)
    faces = []
    for j in range(rows):
        for i in range(columns):
            a, b = j * columns + i, j * columns + (i + 1) % columns
            d, e = a + columns, b + columns
            faces.append((a, d, e) if j == 0 else (a, d, b) if j == rows - 1 else (a, d, e, b))
    return polygons(name, points, faces, smooth=True)


def placed(x: float, y: float, z: float, scale: float = 1.0) -> np.ndarray:
    matrix = np.diag([scale, scale, scale, 1.0])
    matrix[:3, 3] = x, y, z
    return matrix


def looking(position: tuple[float, float, float], target: tuple[float, float, float]) -> np.ndarray:
    """Camera matrix that looks from a position to a target, Z up."""
    forward = np.subtract(target, position).astype(float)
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, [0, 0, 1] if abs(forward[2]) < 0.999 else [0, 1, 0])
    right /= np.linalg.norm(right)
    matrix = np.eye(4)
    matrix[:3, :4] = np.stack([right, np.cross(right, forward), -forward, position], 1)
    return matrix


def diffuse(*color: float) -> Material:
    return material("diffuse", Lobe(LobeKind.DIFFUSE, color=color))


def room(size: int = 32, **settings: object) -> Scene:
    """An open box of side 2 with a glass and a mirror sphere and an area light below the ceiling."""
    meshes = [
        rectangle("floor", (-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1)),
        rectangle("ceiling", (-1, -1, 1), (-1, 1, 1), (1, 1, 1), (1, -1, 1)),
        rectangle("back", (-1, 1, -1), (1, 1, -1), (1, 1, 1), (-1, 1, 1)),
        rectangle("left", (-1, -1, -1), (-1, 1, -1), (-1, 1, 1), (-1, -1, 1)),
        rectangle("right", (1, -1, -1), (1, -1, 1), (1, 1, 1), (1, 1, -1)),
        sphere("ball"),
    ]
    materials = [
        diffuse(0.75, 0.75, 0.75), diffuse(0.7, 0.1, 0.1), diffuse(0.1, 0.6, 0.1),
        material("glass", Lobe(LobeKind.GLASS, ior=1.5)),
        material("mirror", Lobe(LobeKind.GLOSSY, color=(0.9, 0.9, 0.9))),
    ]  # fmt: skip
    instances = [Instance(index, np.eye(4), [material]) for index, material in enumerate((0, 0, 0, 1, 2))]
    instances += [Instance(5, placed(-0.4, -0.1, -0.6, 0.35), [3]), Instance(5, placed(0.45, 0.3, -0.6, 0.35), [4])]
    light = Light("light", LightKind.AREA, placed(0, 0, 0.98), np.full(3, 12.0), size=(0.5, 0.5))
    camera = Camera(looking((0, -3.6, 0), (0, 0, 0)), (-0.4, 0.4, -0.4, 0.4), size, size)
    return Scene(camera, meshes, instances, materials, [light], settings=RenderSettings(**settings))


def crowded_room(size: int = 24, **settings: object) -> Scene:
    """The room with a glass, a mirror and a shining ball, rough metal, a varnished floor, a pane with a hole in it that
    casts half a shadow, a translucent sheet, fog, and a world that comes in by the open front."""
    scene = room(size, **settings)
    scene.world = World(np.array([0.3, 0.4, 0.6]))
    scene.materials += [
        material("varnish", Lobe(LobeKind.PRINCIPLED, color=(0.5, 0.3, 0.2), roughness=0.05)),
        material("metal", Lobe(LobeKind.PRINCIPLED, color=(0.9, 0.4, 0.0), roughness=0.5, metallic=1.0)),
        material("rough glass", Lobe(LobeKind.GLASS, roughness=0.5)),
        material("pane", Lobe(LobeKind.TRANSPARENT, 0.5), Lobe(LobeKind.DIFFUSE, 0.5, (0.0, 0.8, 0.8))),
        material("sheet", Lobe(LobeKind.TRANSLUCENT, 0.5), Lobe(LobeKind.REFRACTION, 0.5, roughness=0.5)),
        material("glow", Lobe(LobeKind.EMISSION, color=(1.0, 0.5, 0.2)), Lobe(LobeKind.DIFFUSE, color=(0.2, 0.2, 0.2))),
        material("amber", Lobe(LobeKind.GLASS), absorption=np.array([0.2, 1.0, 3.0])),
    ]
    varnish = len(scene.materials) - 7
    scene.instances[0].materials[:] = [varnish]
    scene.meshes.append(rectangle("pane", (-0.9, -0.7, -0.9), (0.2, -0.7, -0.9), (0.2, -0.7, 0), (-0.9, -0.7, 0)))
    scene.instances += [
        Instance(5, placed(0.1, 0.5, 0.1, 0.25), [varnish + 1]),
        Instance(5, placed(-0.6, 0.5, 0.2, 0.25), [varnish + 2]),
        Instance(6, np.eye(4), [varnish + 3]),
        Instance(6, placed(0.75, 0.3, 0.9), [varnish + 4]),
        Instance(5, placed(0.7, -0.2, 0.2, 0.1), [varnish + 5]),
        Instance(5, placed(0.1, -0.5, -0.8, 0.15), [varnish + 6]),
    ]
    scene.lights.append(Light("sun", LightKind.SUN, looking((0, -3, 2), (0, 0, 0)), np.full(3, 0.5)))
    return scene
