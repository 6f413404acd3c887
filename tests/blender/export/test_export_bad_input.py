# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that are wrong: a picture where one makes sense, one clear error otherwise."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_light, add_mesh, depsgraph, export

from rppm_addon.blender.export import ExportStopped, export_scene
from rppm_addon.scene.errors import SettingsError


def test_empty_scene(scene):
    exported = export(scene)
    assert exported.meshes == [] and exported.instances == [] and exported.lights == []
    assert exported.warnings == [] and exported.triangle_count == 0


def test_vertices_that_are_not_finite(scene):
    vertices = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (5, 5, 5), (6, 5, 5)]
    broken = add_mesh(scene, "Broken", vertices, [(0, 1, 2, 3), (0, 4, 5)])
    broken.data.vertices[4].co = (float("nan"), 0.0, 0.0)
    exported = export(scene)
    (mesh,) = exported.meshes
    assert mesh.triangle_count == 2 and np.isfinite(mesh.positions).all() and np.isfinite(mesh.corner_normals).all()
    assert any('"Broken"' in text and "not finite" in text for text in exported.warnings)


def test_all_vertices_not_finite(scene):
    broken = add_mesh(scene, "Broken", [(0, 0, 0), (1, 0, 0), (1, 1, 0)], [(0, 1, 2)])
    for vertex in broken.data.vertices:
        vertex.co = (float("inf"),) * 3  # which Blender makes the greatest float
    exported = export(scene)
    assert exported.instances == [] and any('"Broken"' in text for text in exported.warnings)


def test_triangles_without_area_have_usable_normals(scene):
    vertices = [(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0)]
    flat = add_mesh(scene, "Flat", vertices, [(0, 1, 2), (0, 1, 3)])
    point = add_mesh(scene, "Point", [(1, 1, 1)] * 3, [(0, 1, 2)])
    for source in (flat, point):
        source.data.shade_smooth()
    for mesh in export(scene).meshes:
        np.testing.assert_allclose(np.linalg.norm(mesh.corner_normals, axis=1), 1.0, atol=1e-3)


def test_a_material_index_beyond_the_slots(scene):
    source = add_mesh(scene)
    source.data.polygons[0].material_index = 77
    exported = export(scene)
    assert exported.meshes[0].triangle_slots.min() >= 0 and exported.instances[0].materials == [0]


def test_lights_far_away_or_nowhere(scene):
    add_light(scene, "POINT", "Nowhere").location = (float("nan"), 0.0, 0.0)
    exported = export(scene)
    assert exported.lights == [] and any('"Nowhere"' in text for text in exported.warnings)


def test_settings_that_cannot_be_used(scene):
    scene.rppm.cubemap_resolution = 100
    with pytest.raises(SettingsError, match="cubemap_resolution is 100.*power of two"):
        export(scene)


def test_the_export_can_be_stopped(scene):
    for index in range(5):
        add_mesh(scene, f"Mesh{index}")
    asked = []

    def should_stop():
        asked.append(True)
        return len(asked) > 3

    with pytest.raises(ExportStopped):
        export_scene(depsgraph(), should_stop=should_stop)
    assert len(asked) == 4


@pytest.mark.parametrize("lost", ["file", "object"])
def test_what_is_missing_of_linked_files_is_named(scene, tmp_path, lost):
    library, main = tmp_path / "library.blend", tmp_path / "main.blend"
    chair, table = (bpy.data.objects.new(name, None) for name in ("Chair", "Table"))
    bpy.data.libraries.write(str(library), {chair, table})
    bpy.data.libraries.write(str(tmp_path / "other.blend"), {chair})
    for member in (chair, table):
        bpy.data.objects.remove(member)
    with bpy.data.libraries.load(str(library), link=True) as (_, wanted):
        wanted.objects = ["Chair", "Table"]
    for linked in wanted.objects:
        scene.collection.objects.link(linked)
    bpy.ops.wm.save_as_mainfile(filepath=str(main))
    library.unlink()
    if lost == "object":
        (tmp_path / "other.blend").rename(library)
    bpy.ops.wm.open_mainfile(filepath=str(main))
    (warning,) = export(bpy.context.scene).warnings
    expected = {
        "file": 'library.blend" is missing: "Chair", "Table" left out',
        "object": 'library.blend" does not have all that is linked: "Table" left out',
    }
    assert expected[lost] in warning
