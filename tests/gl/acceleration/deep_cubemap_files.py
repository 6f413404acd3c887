# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles of scene files, (n, 3, 3) float32 in world space."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from rppm_addon.scene import load_scene

ROOT = Path(__file__).resolve().parents[3]
FOLDER = ROOT.parent / "shared" / "scenes"


def ply_triangles(name: str) -> np.ndarray:
    """Return the triangles of a PLY file in ASCII with triangles only."""
    path = FOLDER / f"{name}.ply"
    if not path.exists():
        pytest.skip(f"{path.name} is not here ({FOLDER})")
    lines = path.read_text().splitlines()
    end = lines.index("end_header")
    counts = {words[1]: int(words[2]) for words in map(str.split, lines[:end]) if words[0] == "element"}
    first_face = end + 1 + counts["vertex"]
    vertices = np.array([line.split()[:3] for line in lines[end + 1 : first_face]], np.float32)
    faces = np.array([line.split() for line in lines[first_face : first_face + counts["face"]]], np.int64)
    assert np.all(faces[:, 0] == 3)
    return vertices[faces[:, 1:]]


def blend_triangles(name: str, folder: Path, most: int | None = None) -> np.ndarray:
    """Return the first ``most`` triangles of a .blend file, instance by instance.

    A process of its own exports the file to ``folder``.
    """
    path, saved = FOLDER / f"{name}.blend", folder / f"{name}.npz"
    if not path.exists():
        pytest.skip(f"{path.name} is not here ({FOLDER})")
    if importlib.util.find_spec("bpy") is None:
        pytest.skip(f"without the bpy module {path.name} cannot be exported")
    command = [sys.executable, "-m", "rppm_addon", "export", str(path), "-o", str(saved)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=200)
    assert done.returncode == 0, done.stderr
    scene = load_scene(saved)
    saved.unlink()
    found, number = [], 0
    for instance in scene.instances:
        mesh = scene.meshes[instance.mesh]
        matrix = np.asarray(instance.matrix, float)
        world = mesh.positions.astype(float) @ matrix[:3, :3].T + matrix[:3, 3]
        found.append(world.astype(np.float32)[mesh.corner_vertices[mesh.triangle_corners]])
        number += len(found[-1])
        if most is not None and number >= most:
            break
    return np.concatenate(found)[:most]
