# SPDX-License-Identifier: GPL-3.0-or-later
"""Nothing that a file uses is left out in silence."""

import re
from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from blender_scenes import add_light, add_mesh, add_object, depsgraph, export
from support.media.vdb_files import write_vdb

import rppm_addon
from rppm_addon.blender.export import export_scene, omissions
from rppm_addon.blender.export.updates.sync import SceneSync
from tests.parity.features.report import NAMED, not_rendered


def warnings_about(scene, title):
    return [text for text in export(scene).warnings if text.startswith(title)]


@pytest.fixture
def lit(scene):
    """A scene with a mesh and a light."""
    add_mesh(scene)
    add_light(scene, "AREA", energy=10.0)
    return scene


def the(scene, kind):
    return next(found for found in scene.objects if found.type == kind)


def see_through(scene):
    scene.render.film_transparent = scene.cycles.film_transparent_glass = True


def catch_shadows(scene):
    the(scene, "MESH").is_shadow_catcher = True


def step(scene):
    if not hasattr(scene.cycles, "volume_biased"):
        pytest.skip("this Blender has one way alone")
    scene.cycles.volume_biased = True
    scene.update_tag()


def of_cycles(name, value=True):
    def use(scene):
        setattr(scene.cycles, name, value)
        scene.update_tag()  # as an edit in the window does

    return use


def fix_threads(scene):
    scene.render.threads_mode = "FIXED"


def add_cloud(scene):
    random = np.random.default_rng(1)
    grids = {"density": random.random((3, 3, 3)), "velocity": random.random((3, 3, 3, 3))}
    volume = bpy.data.volumes.new("Cloud")
    volume.filepath = str(write_vdb(Path(bpy.app.tempdir) / "blown.vdb", np.eye(4), **grids))
    add_object(scene, "Cloud", volume)
    return volume


def clip(scene):
    add_cloud(scene).render.clipping = 0.1


USES = {
    "Clipping": clip,
    "Fast GI Approximation": of_cycles("use_fast_gi"),
    "Sample Subset": of_cycles("use_sample_subset"),
    "Sampling Pattern": of_cycles("sampling_pattern", "BLUE_NOISE"),
    "Threads": fix_threads,
    "Shadow Catcher": catch_shadows,
    "Biased volumes": step,
    "Transparent Glass": see_through,
}
ALL = (*omissions.OF_OBJECTS, *omissions.OF_SCENES)


@pytest.mark.parametrize("omission", ALL, ids=lambda omission: omission.title)
def test_what_is_used_is_named_once(lit, omission):
    assert not warnings_about(lit, omission.title)
    USES[omission.title](lit)
    (text,) = warnings_about(lit, omission.title)
    assert omission.consequence in text


def test_previews_name_nothing(lit):
    """Their scene is Blender's own, and none of the user's doing."""
    catch_shadows(lit)
    lit.view_layers[0].update()
    engine = SimpleNamespace(is_preview=True, test_break=lambda: False, update_stats=lambda *_: None)
    scene = export_scene(depsgraph(), engine)
    assert len(scene.lights) == 1 and not scene.warnings


def test_many_objects_make_one_line(scene):
    for _ in range(5):
        add_mesh(scene).is_shadow_catcher = True
    (text,) = warnings_about(scene, "Shadow Catcher")
    assert '"Mesh", "Mesh.001", "Mesh.002" and 2 more' in text


def test_passes_that_are_missing(lit):
    lit.view_layers[0].use_pass_shadow = lit.view_layers[0].cycles.pass_render_time = True
    (text,) = warnings_about(lit, "Passes that RPPM does not have")
    assert "Shadow, Render Time" in text


def test_passes_that_are_on_for_cycles_only(lit):
    """Cycles keeps such switches where no other engine looks."""
    layer = lit.view_layers[0]
    layer.cycles.denoising_store_passes = layer.cycles.pass_debug_sample_count = True
    (text,) = warnings_about(lit, "Passes that are on for Cycles only")
    assert "Denoising Data, Debug Sample Count;" in text and "Copy from Cycles" in text
    layer.rppm.use_pass_denoising_data = layer.rppm.use_pass_debug_sample_count = True
    assert not warnings_about(lit, "Passes that are on for Cycles only")


def test_settings_of_view_layers_that_differ_from_those_of_cycles(lit):
    """They are named where they count, and no more once they are copied."""
    layer = lit.view_layers[0]
    layer.cycles.use_denoising, lit.cycles.use_layer_samples = False, "BOUNDED"
    assert not export(lit).warnings
    lit.rppm.use_denoising, layer.samples = True, 5
    denoising, samples = export(lit).warnings
    assert (
        denoising.startswith("Denoising of the view layer is off for Cycles only") and "Copy from Cycles" in denoising
    )
    assert samples.startswith("Layer Samples is Bounded for Cycles and Use for RPPM")
    lit.cycles.use_denoising = True
    lit.update_tag()
    bpy.ops.rppm.copy_from_cycles()
    assert not export(lit).warnings and not export(lit).settings.use_denoising


def test_a_viewport_follows_edits(lit):
    sync, camera = SceneSync(), export(lit).camera
    title = "Shadow Catcher"

    def told():
        lit.view_layers[0].update()
        return any(text.startswith(title) for text in sync.update(depsgraph(), camera).warnings)

    assert not told()
    the(lit, "MESH").is_shadow_catcher = True
    assert told()
    the(lit, "MESH").is_shadow_catcher = False
    assert not told()


def test_the_page_lists_them():
    page = (Path(__file__).parents[3] / "docs" / "compatibility.md").read_text(encoding="utf-8")
    assert not_rendered() in page
    assert all(f"| {omission.title} | {omission.consequence} |" in page for omission in ALL)


def test_a_warning_names_each_row_of_the_page():
    """The texts are in the code; the tests of each feature show that it gives them."""
    folder = Path(rppm_addon.__file__).parent
    code = "\n".join(path.read_text(encoding="utf-8") for path in sorted(folder.rglob("*.py")))
    joined = re.sub(r'"\n\s*f?"', "", code)  # texts of several lines
    assert not [fragment for _, _, fragment in NAMED if fragment not in joined]
