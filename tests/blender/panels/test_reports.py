# SPDX-License-Identifier: GPL-3.0-or-later
"""Reports that final renders leave for the panels, against what was rendered."""

import math
import sys
import time
from types import SimpleNamespace

import bpy
import pytest
from blender_scenes import add_light, add_mesh, export, set_world
from drawing import context_of, drawn, identifiers
from node_trees import add_node, link, new_material, surface

from rppm_addon.blender import panels, reports
from rppm_addon.blender.export.view_layer.settings import export_settings
from rppm_addon.blender.operators import RPPM_OT_select_subject
from rppm_addon.blender.readings import memory_reading, photon_allocation, radius_reading
from rppm_addon.blender.reports import RenderKind, RenderReport, viewport_report
from rppm_addon.blender.subjects import SubjectKind, select
from rppm_addon.blender.warning_groups import grouped, lines_of
from rppm_addon.integrator.lights.sources import ENVIRONMENT, SURFACES, source_name
from rppm_addon.scene import RenderSettings
from rppm_addon.session.client.client import RendererProcess
from rppm_addon.session.render.results import Progress
from rppm_addon.session.transport.sessions import SessionKind, SessionStatus


@pytest.fixture
def facing(scene):
    """A white quad that an orthographic camera faces and that fills the picture, 2 m across."""
    scene.camera.data.type, scene.camera.data.ortho_scale = "ORTHO", 2.0
    add_mesh(scene, "Quad")
    scene.rppm.samples, scene.rppm.photons, scene.rppm.max_photon_bounces = 1, 4000, 0
    scene.rppm.filter_width, scene.rppm.use_final_gather = 0.0, False
    set_world(scene)
    return scene


def rendered(scene) -> RenderReport:
    bpy.ops.render.render()
    return reports.reports_of(scene.session_uid).finals[0]


def test_the_radius_that_is_shown_is_the_one_that_is_used(facing):
    """All surfaces face the camera: r_max is Eq. 3's radius, as wide as the panel's pixels are on the quad."""
    add_light(facing, "SUN")
    facing.rppm.samples, facing.rppm.photons, facing.rppm.alpha = 7, 64, 0.6
    facing.rppm.radius_scale = 90.0  # of a megapixel: 2.8 pixels of these
    report = rendered(facing)
    shown = radius_reading(export_settings(facing), 32, 32)
    assert report.photon_statistics.radius_meters == pytest.approx(shown.last * 2.0 / 32, rel=1e-4)
    assert shown.first == pytest.approx(90.0 * 32 / 1024 / math.sqrt(math.pi))


def test_the_shares_that_are_shown_are_those_that_are_emitted(facing):
    """Lights of all kinds, one of them with nodes, a glowing quad and a sky, with factors."""
    factors = {"POINT": 1.0, "SPOT": 2.5, "SUN": 0.25, "AREA": 1.0}
    for kind, factor in factors.items():
        light = add_light(facing, kind, f"The {kind}", energy=3.0 if kind == "SUN" else 40.0)
        light.data.rppm.photon_weight = factor
    tree = bpy.data.objects["The AREA"].data
    tree.use_nodes = True
    tree.node_tree.nodes["Emission"].inputs["Strength"].default_value = 2.0
    glow, _ = surface("ShaderNodeEmission", Strength=5.0)
    add_mesh(facing, "Glowing", location=(0.0, 0.0, -1.0), material=glow)
    set_world(facing, (0.3, 0.3, 0.3))
    report = rendered(facing)
    names = {source_name(f"The {kind}") for kind in factors} | {SURFACES, ENVIRONMENT}
    statistics = report.photon_statistics
    assert set(statistics.source_watts) == set(statistics.source_photons) == names
    assert sum(statistics.source_photons.values()) == 4000
    shares = {row.name: row for row in panels.lights.source_rows(facing)}
    for name, row in shares.items():
        sent = statistics.source_photons[name if name in names else source_name(name)]
        assert row.sent == sent / 4000
        assert 4000 * row.allocated == pytest.approx(sent, abs=1.0) and sent > 10, name
    # Other factors change the shares before anything is rendered again, and the next render agrees.
    bpy.data.lights["The SUN"].rppm.photon_weight = 4.0
    expected = {row.name: row.allocated for row in panels.lights.source_rows(facing)}
    assert expected["The SUN"] > 2 * shares["The SUN"].allocated
    rendered(facing)
    for row in panels.lights.source_rows(facing):
        assert row.sent == pytest.approx(expected[row.name], abs=1.0 / 4000)


def test_the_memory_that_is_expected_is_the_one_that_is_used(facing):
    """With the same settings exactly; with others, lists of photons grow that only a render can tell the length of."""
    add_light(facing, "SUN")
    report = rendered(facing)
    assert memory_reading(export_settings(facing), 32, 32, report).total_bytes == report.progress.memory_bytes
    facing.rppm.photons, facing.render.resolution_x = 8000, 64
    expected = memory_reading(export_settings(facing), 64, 32, report).total_bytes
    assert expected == pytest.approx(rendered(facing).progress.memory_bytes, rel=0.05)


def test_what_a_final_render_reports(facing):
    add_light(facing, "SUN")
    facing.rppm.samples = 3
    report = rendered(facing)
    assert report.kind is RenderKind.FINAL and (report.width, report.height) == (32, 32)
    progress = report.progress
    assert (progress.iteration, progress.photons, report.triangles) == (3, 12000, 2)
    assert 0.0 < progress.build_seconds < progress.elapsed_seconds and report.settings == export_settings(facing)
    assert progress.photons_per_second == pytest.approx(4000 * progress.iterations_per_second)
    assert progress.photons_per_second * (progress.elapsed_seconds - progress.build_seconds) == pytest.approx(12000)
    assert report.device in drawn(panels.performance.RPPM_PT_status, context_of(facing)).labels
    second = rendered(facing)
    kept = reports.reports_of(facing.session_uid)
    assert kept.finals == (second, report) and kept.latest is second and kept.viewport is None


def test_an_error_is_shown_until_a_render_succeeds(facing):
    light = add_light(facing, "SUN")
    light.data.rppm.photon_weight = 0.0
    with pytest.raises(RuntimeError, match="photon weight of 0"):
        bpy.ops.render.render()
    panel, context = panels.performance.RPPM_PT_status, context_of(facing)
    assert not panels.warnings.RPPM_PT_warnings.poll(context)
    assert panel.poll(context) and "all lights have a photon weight of 0" in " ".join(drawn(panel, context).labels)
    light.data.rppm.photon_weight = 1.0
    rendered(facing)
    assert "photon weight of 0" not in " ".join(drawn(panel, context).labels)


def test_warnings_name_what_can_be_selected(facing):
    """Real warnings of an export: of a node of a material on two objects, a light, an object and the world."""
    material = new_material("Odd")
    tree = material.node_tree
    shade = add_node(tree, "ShaderNodeShaderToRGB", "Shade")
    surface("ShaderNodeBsdfDiffuse", material=material, Color=shade.outputs["Color"])
    first, second = (add_mesh(facing, name, location=(0, 0, -1)) for name in ("First", "Second"))
    first.data.materials.append(new_material("Other"))
    first.data.materials.append(material)
    first.data.polygons[0].material_index = 1
    second.data.materials.append(material)
    add_light(facing, "AREA", "Flat", size=0.0)
    world = set_world(facing)
    sky = add_node(world.node_tree, "ShaderNodeTexEnvironment", "Sky")  # without an image
    link(world.node_tree, sky.outputs[0], world.node_tree.nodes["Background"].inputs["Color"])
    rendered(facing)
    buttons = drawn(panels.warnings.RPPM_PT_warnings, context_of(facing)).operators
    named = {(button.kind, button.name): button.node for button in buttons}
    assert named == {("MATERIAL", "Odd"): "Shade", ("OBJECT", "Flat"): "", ("WORLD", world.name): "Sky"}
    tree.nodes.active = tree.nodes["Output"]
    assert bpy.ops.rppm.select_subject(kind="MATERIAL", name="Odd", node="Shade") == {"FINISHED"}
    assert set(bpy.context.selected_objects) == {first, second}
    assert bpy.context.view_layer.objects.active.active_material == material
    assert tree.nodes.active.name == "Shade" and tree.nodes["Shade"].select and not tree.nodes["Output"].select
    bpy.ops.rppm.select_subject(kind="OBJECT", name="Flat")
    assert [thing.name for thing in bpy.context.selected_objects] == ["Flat"]
    for kind in ("OBJECT", "MATERIAL", "WORLD"):  # something that was removed since
        assert bpy.ops.rppm.select_subject(kind=kind, name="Gone") == {"FINISHED"}
    assert [thing.name for thing in bpy.context.selected_objects] == ["Flat"]


def report(kind=RenderKind.FINAL, photons=1, **values):
    return RenderReport(kind, 1, 1, RenderSettings(), Progress(1, 1, 1.0, photons), **values)


def test_little_is_kept():
    for scene in range(reports.SCENES_KEPT + 3):
        for number in range(reports.FINALS_KEPT + 3):
            reports.record(scene, report(photons=number, warnings=tuple(map(str, range(1000)))))
        reports.record(scene, report(RenderKind.VIEWPORT))
    assert reports.reports_of(0) == reports.reports_of(2) == reports.SceneReports()
    kept = reports.reports_of(scene)
    assert [final.progress.photons for final in kept.finals] == [7, 6, 5, 4, 3]
    assert len(kept.finals[0].warnings) == reports.WARNINGS_KEPT and kept.finals[0].warning_count == 1000
    assert kept.latest is kept.viewport


def test_shares_without_any_weight():
    assert photon_allocation({}, {}) == {}
    assert photon_allocation({"a": 1.0}, {"a": 0.0}) == {"a": 0.0}
    assert photon_allocation({"a": 1.0, "b": 3.0}, {"a": 3.0}) == {"a": 0.53125, "b": 0.46875}


def test_nothing_that_is_reported_is_saved(facing, tmp_path):
    reports.record(facing.session_uid, report(warnings=("a warning that is nowhere in the file",)))
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "saved.blend"), compress=False, copy=True)
    assert b"nowhere in the file" not in (tmp_path / "saved.blend").read_bytes()


def missing_image(material, image):
    return (
        f'Material "{material}": node "Image Texture" needs image "{image}", which is missing (//{image}); find it '
        "with File > External Data > Find Missing Files; magenta stands in"
    )


def test_missing_images_are_one_line_with_one_remedy(facing):
    texts = [missing_image(f"M{k}", f"{k % 12}.png") for k in range(30)]
    (group,) = grouped(texts)
    assert group.title == "12 missing images" and group.count == 30
    assert [thing.label for thing in group.things] == [f"{k}.png" for k in range(12)]
    assert group.things[0].name == "M0" and group.things[0].node == "Image Texture"
    assert group.sentence == (
        "the node needs image ..., which is missing; find it with File > External Data > Find Missing Files; magenta "
        "stands in"
    )
    reports.record(facing.session_uid, report(warnings=tuple(texts)))
    record = drawn(panels.warnings.RPPM_PT_warnings, context_of(facing))
    assert record.labels[:2] == ["30 ", "12 missing images"]
    assert identifiers(record) == ["file.find_missing_files", *["rppm.select_subject"] * 12]
    assert grouped(texts[:1])[0].title == "1 missing image"
    assert lines_of([*texts, "3 % are lost"]) == [
        '12 missing images ("0.png", "1.png", "10.png" and 9 more); find it with File > External Data > Find Missing '
        "Files; magenta stands in",
        "3 % are lost",
    ]


def test_warnings_that_differ_in_names_and_numbers_are_one_group():
    found = grouped(
        [
            'Material "Glass "A"": node "Noise.001" (Noise Texture) is not rendered yet; 0 is used',
            'Object "Cloud": volumes are not rendered yet; it is left out',
            "3.00% of the photons' flux was lost in tracing",
            'Object "A": 5 placements have no extent (scale 0) or are not finite and were left out; scale them',
            'Object "B": 17 placements have no extent (scale 0) or are not finite and were left out; scale them',
            'World "Sky": node "Sky" (Sky Texture) is not rendered yet; 0 is used',
            'Material "M": node "Image Texture" has no image and counts as magenta; choose one',
            'Material "M": node "Image Texture.001" has no image and counts as magenta; choose one',
        ]
    )
    assert [group.title for group in found] == [
        "The node is not rendered yet (2)",
        "Cloud: volumes are not rendered yet",
        "3.00% of the photons' flux was lost in tracing",
        "... placements have no extent (scale 0) or are not finite and were left out (2)",
        "2 textures without an image",
    ]
    things = [[(thing.kind, thing.name, thing.node) for thing in group.things] for group in found]
    assert things == [
        [(SubjectKind.MATERIAL, 'Glass "A"', "Noise.001"), (SubjectKind.WORLD, "Sky", "Sky")],
        [(SubjectKind.OBJECT, "Cloud", "")],
        [],
        [(SubjectKind.OBJECT, "A", ""), (SubjectKind.OBJECT, "B", "")],
        [(SubjectKind.MATERIAL, "M", "Image Texture"), (SubjectKind.MATERIAL, "M", "Image Texture.001")],
    ]
    assert found[0].things[0].label == 'Glass "A", Noise.001' and found[1].things[0].label == "Cloud"


def test_many_warnings_are_cut_short_and_counted(facing):
    sentences = ["".join(chr(ord("a") + int(digit)) for digit in str(k)) for k in range(30)]
    texts = [f'Material "M{k}": warns of {text}' for text in sentences for k in range(3)]
    reports.record(facing.session_uid, report(warnings=tuple(texts)))
    reports.record(facing.session_uid, report(RenderKind.VIEWPORT, warnings=tuple(texts)))
    record = drawn(panels.warnings.RPPM_PT_warnings, context_of(facing))
    assert record.labels[0] == "90 " and record.labels[-1] == "30 more are in the log"
    assert len(record.operators) == 3 * panels.warnings.GROUPS_SHOWN and "M0" in record.labels
    popover = drawn(panels.warnings.RPPM_PT_viewport_warnings, context_of(facing))
    assert len(popover.labels) == panels.warnings.LINES_OF_POPOVER + 1
    assert popover.labels[0] == "Warns of a (3)" and popover.labels[-1].startswith("18 more")


def test_the_popover_stays_on_the_screen(facing):
    reports.record_viewport_error(facing.session_uid, "a word " * 1000)
    lines = drawn(panels.warnings.RPPM_PT_viewport_warnings, context_of(facing)).labels
    assert len(lines) == panels.warnings.LINES_OF_POPOVER and lines[-1].endswith(" ...")


def test_warnings_are_below_the_samples(facing):
    names = [cls.__name__ for cls in panels.CLASSES]
    assert names.index("RPPM_PT_sampling") < names.index("RPPM_PT_warnings") < names.index("RPPM_PT_status")
    assert "DEFAULT_CLOSED" in panels.warnings.RPPM_PT_warnings.bl_options


def test_a_hidden_object_is_said_to_be_hidden(facing):
    hidden = add_mesh(facing, "Hidden")
    hidden.hide_set(True)
    assert "hidden" in select(bpy.context, SubjectKind.OBJECT, "Hidden")
    bpy.context.view_layer.objects.active = bpy.data.objects["Quad"]
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.rppm.select_subject(kind="OBJECT", name="Quad") == {"FINISHED"}
    assert bpy.context.mode == "OBJECT"


@pytest.mark.parametrize("kind", SubjectKind)
def test_selecting_shows_the_tab_where_the_editor_lets_it(facing, kind):
    """A Properties editor refuses a tab until it has been drawn with an object that has one."""
    material, world = new_material("Odd"), set_world(facing)
    bpy.data.objects["Quad"].data.materials.append(material)
    names = {SubjectKind.OBJECT: "Quad", SubjectKind.MATERIAL: "Odd", SubjectKind.WORLD: world.name}

    class Editor:
        type = "PROPERTIES"
        refuses, tab = False, "RENDER"

        @property
        def context(self):
            return self.tab

        @context.setter
        def context(self, tab):
            if self.refuses:
                raise TypeError(f'enum "{tab}" not found')
            self.tab = tab

    editor = Editor()
    bpy.context.view_layer.update()
    context = SimpleNamespace(mode="OBJECT", view_layer=bpy.context.view_layer, space_data=editor)
    said = []
    button = SimpleNamespace(kind=kind.name, name=names[kind], node="", report=lambda *words: said.append(words))
    assert RPPM_OT_select_subject.execute(button, context) == {"FINISHED"} and not said
    assert editor.context == kind.name
    editor.refuses, editor.tab = True, "RENDER"
    assert RPPM_OT_select_subject.execute(button, context) == {"FINISHED"} and editor.context == "RENDER"


def test_a_viewport_session_reports_what_the_panels_show(facing, tmp_path):
    """Its status, as it comes from the renderer process, once it has settled."""
    add_light(facing, "SUN", "Sun")
    exported = export(facing)
    process = RendererProcess([sys.executable], sys.path, tmp_path / "renderer.log")
    try:
        session = process.open(SessionKind.VIEWPORT)
        session.show(exported, 1, False)
        end = time.monotonic() + 90.0
        while not session.status.settled and time.monotonic() < end:
            time.sleep(0.02)
        status = session.status
    finally:
        process.close()
    assert status.settled and not status.error
    reported = viewport_report(status, exported)
    reports.record(facing.session_uid, reported)
    kept = reports.reports_of(facing.session_uid)
    assert kept.viewport == kept.latest == reported and kept.finals == ()
    assert reported.progress == status.progress and reported.progress.photons_per_second > 0.0
    assert [(row.name, row.allocated, row.sent) for row in panels.lights.source_rows(facing)] == [("Sun", 1.0, 1.0)]
    final, viewport = rendered(facing).photon_statistics, reported.photon_statistics
    assert final.source_watts == viewport.source_watts and final.source_photons == viewport.source_photons
    assert final.radius_meters == pytest.approx(viewport.radius_meters, rel=1e-6)
    assert {final.density_estimation, viewport.density_estimation} <= {"GRID", "RASTERIZED"}
    shown = drawn(panels.performance.RPPM_PT_status, context_of(facing)).labels
    assert shown.index("Viewport") < shown.index("Final")


def test_a_viewport_that_has_nothing_yet(facing):
    reported = viewport_report(SessionStatus(), export(facing))
    assert reported.progress.iteration == 0 and reported.progress.photons_per_second == 0.0
