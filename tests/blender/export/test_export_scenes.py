# SPDX-License-Identifier: GPL-3.0-or-later
"""Real files: everything is exported, consistent, and what is left out is named."""

from pathlib import Path

import bpy
import numpy as np
import pytest
from blender_scenes import export

from rppm_addon.materials.compiler.compiled_graph import Resource
from rppm_addon.materials.compiler.compiler import compile_graph

SCENES = Path(__file__).resolve().parents[4] / "shared" / "scenes"

# Triangles as counted in Blender's evaluated meshes, materials that are in use, lights, images.
EXPECTED = {
    "cornell_box_tm": (81956, 6, 0, 0),
    "glass_caustics": (8648, 3, 1, 0),
    "causticcube": (18436, 3, 0, 0),
    "pool": (41564, 2, 1, 0),
    "diamond_ring": (7278, 8, 1, 0),
    "water_caustic_cornell": (103487, 9, 0, 0),
    "fireplace_room": (143163, 19, 0, 5),
    "bmw27": (699800, 23, 0, 4),
    "bathroom": (380290, 30, 0, 6),
    "mirror_room": (38544, 4, 2, 1),
    "grass_instances": (5644514, 2, 1, 0),
    "bseed_duplis_dupli_lights": (42, 1, 9, 0),
    "bseed_duplis_dupli_verts": (98336, 4, 1, 0),
    "bseed_cameras_camera_shift": (30, 1, 0, 0),
    "gltfio_22_node_groups": (72, 6, 1, 2),
}


@pytest.fixture
def opened(registered):
    """Opens a sample scene and exports it."""

    def opened(name):
        path = SCENES / f"{name}.blend"
        if not path.exists():
            pytest.skip(f"the sample scenes are not here ({SCENES})")
        try:
            bpy.ops.wm.open_mainfile(filepath=str(path))
        except RuntimeError as error:
            if bpy.app.version < (5, 0) and "not a blend file" in str(error):
                pytest.skip("Blender 5 wrote this file in a way that this one cannot read")
            raise
        return export(bpy.context.scene)

    return opened


@pytest.mark.parametrize("name", EXPECTED)
def test_export_of_a_real_file(opened, name):
    exported = opened(name)
    found = (exported.triangle_count, len(exported.materials), len(exported.lights), len(exported.images))
    assert found == EXPECTED[name]
    for mesh in exported.meshes:
        corners = len(mesh.corner_vertices)
        assert np.isfinite(mesh.positions).all() and mesh.corner_normals.shape == (corners, 3)
        assert mesh.corner_vertices.min() >= 0 and mesh.corner_vertices.max() < len(mesh.positions)
        assert mesh.triangle_corners.min() >= 0 and mesh.triangle_corners.max() < corners
        lengths = np.linalg.norm(mesh.corner_normals, axis=1)
        np.testing.assert_allclose(lengths[lengths > 0.0], 1.0, atol=2e-3)  # those of flat faces are 0
        assert mesh.corner_uv is None or mesh.corner_uv.shape == (corners, 2)
    for instance in exported.instances:
        assert instance.materials and max(instance.materials) < len(exported.materials)
        assert np.isfinite(np.linalg.inv(instance.matrix)).all()
    for material in exported.materials:
        compiled = compile_graph(material.graph)
        numbers = [constant for constant in compiled.constants if not isinstance(constant, Resource)]
        assert np.isfinite(numbers).all()
        assert all(-1 <= node.image < len(exported.images) for node in material.graph.nodes)
    for warning in exported.warnings:
        assert warning.split(" ")[0] in {"Material", "Object", "World", "Light", "Camera"}, warning


def test_glass_of_the_caustic_scenes_is_glass(opened):
    exported = opened("glass_caustics")
    (glass,) = (material for material in exported.materials if material.name == "glass_accurate")
    assert {"bsdf_refraction", "bsdf_glossy", "fresnel"} <= {node.kind for node in glass.graph.nodes}
