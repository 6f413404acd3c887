# SPDX-License-Identifier: GPL-3.0-or-later
"""Exports that are kept while a viewport shows another shading."""

import random

import bpy
import edits
import pytest
from blender_scenes import CAMERA, add_object, depsgraph
from edits import EDITS, do, fresh, same

from rppm_addon.blender.engine import kept_exports
from rppm_addon.blender.export.instances import mesh_table
from rppm_addon.blender.export.updates.sync import SceneSync


@pytest.fixture
def kept(edited):
    """Kept export of a viewport that was switched to Solid; the engine's own handlers note what changes."""
    sync = SceneSync()
    sync.update(depsgraph(), CAMERA)
    keep(sync)
    yield sync
    kept_exports.forget()


def keep(sync: SceneSync) -> None:
    kept_exports.keep(kept_exports.key_of(depsgraph()), sync)


def switch_back() -> SceneSync | None:
    """Return the export that a viewport finds when it is switched to Rendered, or None."""
    bpy.context.view_layer.update()
    return kept_exports.take(depsgraph())


def edit_in_edit_mode():
    """Enter edit mode, move a vertex, and stay there."""
    do(lambda: edits.in_edit_mode("Cube"))
    edits.pull()


def edit_and_leave_edit_mode():
    do(edit_in_edit_mode)
    edits.in_object_mode()


@pytest.mark.parametrize("edit", [*EDITS, edits.add_same_place, edit_in_edit_mode, edit_and_leave_edit_mode])
def test_what_changes_in_another_shading_is_seen_after_switching_back(kept, edit):
    edit()
    found = switch_back()
    assert found is kept
    graph = depsgraph()
    assert len(graph.updates) == 0
    assert same(found.update(graph, CAMERA), fresh())


@pytest.mark.parametrize("seed", range(2))
def test_many_edits_in_another_shading_are_seen_after_switching_back(kept, seed):
    generator = random.Random(seed)
    for edit in generator.sample([*EDITS, edits.add_same_place], 8):
        if edit not in {edits.move_twin, edits.hide} or "Twin" in bpy.data.objects:
            do(edit)
    assert same(switch_back().update(depsgraph(), CAMERA), fresh())


@pytest.mark.parametrize(
    "edit, exported", [(edits.move, []), (edits.paint, []), (edits.brighten, []), (edits.edit_other_mesh, ["Other"])]
)
def test_switching_back_exports_what_has_changed(kept, monkeypatch, edit, exported):
    names, export_mesh = [], mesh_table.export_mesh
    monkeypatch.setattr(
        mesh_table, "export_mesh", lambda mesh, name, *more: names.append(name) or export_mesh(mesh, name, *more)
    )
    before = kept.scene
    assert switch_back().update(depsgraph(), CAMERA) is before
    keep(kept)
    edit()
    assert switch_back().update(depsgraph(), CAMERA) is not before
    assert names == exported


def test_nothing_is_kept_beyond_undo_another_file_or_another_view_layer(kept, monkeypatch):
    other = bpy.context.scene.view_layers.new("Other")
    other.update()
    assert kept_exports.take(other.depsgraph) is None
    monkeypatch.setattr(kept_exports, "key_of", lambda graph: "any")  # a depsgraph may be where another was
    for what in (lambda: bpy.ops.ed.undo(), lambda: bpy.ops.wm.read_factory_settings(use_empty=True)):
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.ed.undo_push(message="after")
        keep(kept)
        what()
        assert kept_exports.take(depsgraph()) is None


def test_what_takes_too_much_memory_or_changes_all_at_once_is_not_kept(kept, monkeypatch):
    crowd = [add_object(bpy.context.scene, "One", bpy.data.meshes["Cube"]) for _ in range(1100)]
    bpy.context.view_layer.update()
    kept.update(depsgraph(), CAMERA)
    keep(kept)
    for member in crowd:
        member.location.x += 1.0
    assert switch_back() is None
    monkeypatch.setattr(kept_exports, "MOST_BYTES", 100)
    keep(kept)
    assert switch_back() is None
