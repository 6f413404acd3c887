# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes made of arrays, without Blender."""

import dataclasses
from collections.abc import Iterable

import numpy as np
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import Camera, Image, Instance, Light, LightKind, Material, Mesh, RenderSettings, Scene, World
from rppm_addon.self_test.meshes import box_sides, looking, placed, rectangle, sphere
from rppm_addon.self_test.meshes import polygons as polygons


def diffuse(*color: float) -> Material:
    return material("diffuse", Lobe(LobeKind.DIFFUSE, color=color))


def square(name: str, half: float, z: float = 0.0) -> Mesh:
    """A level square around the z axis that faces up."""
    return rectangle(name, (-half, -half, z), (half, -half, z), (half, half, z), (-half, half, z))


def box(name: str, half: float = 1.0) -> Mesh:
    """A cube around the origin whose faces look outward."""
    corners = half * np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], np.float32)
    return polygons(name, corners, [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])


def inside_out(mesh: Mesh) -> Mesh:
    turned = np.ascontiguousarray(mesh.triangle_corners[:, ::-1])
    return dataclasses.replace(mesh, triangle_corners=turned, corner_normals=-mesh.corner_normals)


def camera(eye: tuple, target: tuple, half: float, size: int, orthographic: bool = False) -> Camera:
    """A camera of square pictures whose window is 2 half wide, at 1 m or where it is orthographic everywhere."""
    return Camera(looking(eye, target), (-half, half, -half, half), size, size, orthographic)


def sky_with_a_sun(rows: int, size: float) -> Image:
    """A gray sky of so many rows that shines around one direction, over a part of its height squared."""
    v, u = np.meshgrid((np.arange(rows) + 0.5) / rows, (np.arange(2 * rows) + 0.5) / (2 * rows), indexing="ij")
    glow = 0.2 + 20 * np.exp(-((u - 0.5) ** 2 + (v - 0.75) ** 2) / size)
    return Image("sky", np.stack([glow, glow, glow, np.ones_like(u)], -1).astype(np.float32))


def floor_places(camera: Camera) -> np.ndarray:
    """(H, W, 3) places that the middles of pixels of a perspective camera see of the plane z = 0."""
    left, right, bottom, top = camera.window
    x = left + (right - left) * (np.arange(camera.width) + 0.5) / camera.width
    y = bottom + (top - bottom) * (np.arange(camera.height) + 0.5) / camera.height
    rays = np.stack(np.broadcast_arrays(x, y[:, None], -1.0), -1) @ camera.matrix[:3, :3].T
    return camera.matrix[:3, 3] - rays * (camera.matrix[2, 3] / rays[..., 2:])


def scene_of(
    camera: Camera,
    *parts: tuple[Mesh, Material],
    lights: Iterable[Light] = (),
    world: World | None = None,
    **settings: object,
) -> Scene:
    """Each mesh where its vertices are, with its material."""
    return Scene(
        camera, [mesh for mesh, _ in parts], [Instance(number, np.eye(4), [number]) for number in range(len(parts))],
        [surface for _, surface in parts], list(lights), world or World(), settings=RenderSettings(**settings),
    )  # fmt: skip


def add(scene: Scene, mesh: Mesh, surface: Material, matrix: np.ndarray | None = None, **members: object) -> None:
    """Put another mesh into a scene, with a material of its own; members: further ones of its instance."""
    place, number = np.eye(4) if matrix is None else matrix, len(scene.materials)
    scene.instances.append(Instance(len(scene.meshes), place, [number], **members))
    scene.meshes.append(mesh)
    scene.materials.append(surface)


def room(size: int = 32, **settings: object) -> Scene:
    """An open box of side 2 with a glass and a mirror sphere and an area light below the ceiling."""
    meshes = [*box_sides()[:5], sphere("ball")]
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


def dull_crowded_room(size: int = 24, **settings: object) -> Scene:
    """The crowded room without a shining ball: instances that glow share a light tree, and give other noise than
    expanded ones."""
    scene = crowded_room(size, **settings)
    glow = [each.name for each in scene.materials].index("glow")
    scene.materials[glow] = diffuse(0.2, 0.2, 0.2)
    return scene
