# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of the scripted scenes, as vertices and faces of one number of corners."""

import bpy
import numpy as np

Shape = tuple[np.ndarray, np.ndarray]
"""Vertices (n, 3) in meters, and faces (m, 3) or (m, 4), whose quads are two triangles each."""


def leaves(count: int, seed: int) -> Shape:
    """A tree's crown: so many small triangles in a cloud above the ground."""
    rng = np.random.default_rng(seed)
    centers = rng.normal(size=(count, 1, 3)) * [0.5, 0.5, 1.0] + [0.0, 0.0, 2.0]
    vertices = centers + rng.normal(size=(count, 3, 3)) * 0.03
    return vertices.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3)


def _grid(across: int, up: int) -> Shape:
    """A square of quads, from 0 to 1 along x and y."""
    x, y = np.meshgrid(np.linspace(0, 1, across + 1), np.linspace(0, 1, up + 1))
    vertices = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    first = (np.arange(up)[:, None] * (across + 1) + np.arange(across)).ravel()
    return vertices, np.stack([first, first + 1, first + across + 2, first + across + 1], axis=1)


def building(rng: np.random.Generator) -> Shape:
    """A tower of quads, wider below, of which every other sill stands out."""
    sides, floors = int(rng.integers(8, 21)), int(rng.integers(10, 31))
    width, height = rng.uniform(5.0, 9.0), 3.0 * floors
    vertices, faces = _grid(sides, floors)
    angle, level = 2.0 * np.pi * vertices[:, 0], vertices[:, 1]
    radius = width * (1.0 - 0.3 * level**3) * (1.0 + 0.02 * (np.round(level * floors) % 2))
    # Nearly square: the radius to a square's side, rounded.
    radius /= (np.abs(np.cos(angle)) ** 8 + np.abs(np.sin(angle)) ** 8) ** 0.125
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), height * level], axis=1), faces


def window(rng: np.random.Generator) -> Shape:
    """A pane that bulges, in a frame."""
    across = int(rng.integers(8, 17))
    vertices, faces = _grid(across, across)
    x, z = 2.0 * vertices[:, 0] - 1.0, 2.0 * vertices[:, 1] - 1.0
    rim = np.maximum(np.abs(x), np.abs(z))
    depth = np.where(rim > 0.85, 0.1, 0.04 * (1.0 - rim) * rng.uniform(-1.0, 1.0))
    return np.stack([rng.uniform(0.4, 0.9) * x, depth, rng.uniform(0.6, 1.2) * z], axis=1), faces


def car(rng: np.random.Generator) -> Shape:
    """A body of some thousand triangles, flat below."""
    around, along = int(rng.integers(24, 41)), int(rng.integers(24, 41))
    vertices, faces = _grid(around, along)
    angle, length = 2.0 * np.pi * vertices[:, 0], 2.0 * vertices[:, 1] - 1.0
    profile = np.sqrt(np.maximum(1.0 - length**4, 0.0)) * (0.7 + 0.3 * np.exp(-((3.0 * length) ** 2)))
    x, y = 0.9 * profile * np.cos(angle), rng.uniform(1.9, 2.4) * length
    return np.stack([x, y, np.maximum(0.8 * profile * np.sin(angle) + 0.5, 0.15)], axis=1), faces


def lamp(rng: np.random.Generator) -> Shape:
    """A post."""
    vertices, faces = _grid(12, 20)
    angle, height = 2.0 * np.pi * vertices[:, 0], vertices[:, 1]
    radius = 0.08 + 0.25 * np.exp(-(((height - 0.95) * 20.0) ** 2))
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), rng.uniform(4.0, 7.0) * height], axis=1), faces


def mesh_of(name: str, shape: Shape, material: bpy.types.Material) -> bpy.types.Mesh:
    """Blender's mesh of a shape."""
    vertices, faces = shape
    count, corners = faces.shape
    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(len(vertices))
    mesh.vertices.foreach_set("co", vertices.astype(np.float32).ravel())
    mesh.loops.add(faces.size)
    mesh.loops.foreach_set("vertex_index", faces.astype(np.int32).ravel())
    mesh.polygons.add(count)
    mesh.polygons.foreach_set("loop_start", np.arange(count, dtype=np.int32) * corners)
    mesh.update(calc_edges=True)
    mesh.materials.append(material)
    return mesh
