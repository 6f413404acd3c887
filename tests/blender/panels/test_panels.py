# SPDX-License-Identifier: GPL-3.0-or-later
"""Contents of the panels in each context; all that they show exists."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from blender_scenes import add_light, add_mesh, add_object, set_world
from drawing import RecordingLayout, context_of, drawn, drawn_panels, identifiers
from node_trees import new_material

from rppm_addon.blender import panels, reports
from rppm_addon.blender.export.view_layer.settings import export_settings
from rppm_addon.blender.panels import viewport_header
from rppm_addon.blender.panels.base import RppmPanel
from rppm_addon.blender.panels.render_tab import presets
from rppm_addon.blender.panels.switches import SUGGESTIONS
from rppm_addon.blender.reports import RenderKind, RenderReport
from rppm_addon.integrator.density_estimation.radii import shrinkage
from rppm_addon.integrator.lights.sources import ENVIRONMENT, SURFACES, source_name
from rppm_addon.integrator.memory import expected_memory
from rppm_addon.scene import RenderSettings
from rppm_addon.scene.common.quantities import bytes_text
from rppm_addon.session.client.client import ProcessState
from rppm_addon.session.render.results import PhotonStatistics, Progress

OF_SWITCH = {
    "adaptive_min_samples": "RPPM_PT_sampling_final",
    "preview_adaptive_min_samples": "RPPM_PT_sampling_viewport",
    "time_limit": "RPPM_PT_sampling_final",
    "photons": "RPPM_PT_sampling_final",
    "preview_photons": "RPPM_PT_sampling_viewport",
    "radius_minimum": "RPPM_PT_developer",
    "radius_maximum": "RPPM_PT_developer",
    "cubemap_resolution": "RPPM_PT_developer",
}
"""The panel that shows a setting with its switch."""
PANELS = [cls for cls in panels.CLASSES if issubclass(cls, RppmPanel)]


def report(kind=RenderKind.FINAL, iterations=8, photons=8000, warnings=(), **statistics):
    """A report of a render of 64x32 pixels, with values of PhotonStatistics."""
    settings = RenderSettings(iterations=8, photons=1000)
    progress = Progress(iterations, 8, 5.0, photons, memory_bytes=200 << 20, build_seconds=1.0)
    photon_statistics = PhotonStatistics(0.012, **statistics)
    return RenderReport(kind, 64, 32, settings, progress, photon_statistics, "Device", 12, warnings)


def test_panels_show_every_setting(scene):
    records = drawn_panels(PANELS, context_of(scene))
    shown = {name for record in records.values() for name in record.properties}
    for name, value in SUGGESTIONS.items():  # shown where they are other than 0
        switch_and_value = 1 + (getattr(scene.rppm, name) != 0)
        assert name in shown and records[OF_SWITCH[name]].properties.count(name) == switch_and_value
        setattr(scene.rppm, name, value)
        again = drawn(next(cls for cls in PANELS if cls.__name__ == OF_SWITCH[name]), context_of(scene))
        assert again.properties.count(name) == 2
    properties = {item.identifier for item in scene.rppm.bl_rna.properties} - {"rna_type", "name"}
    of_blender = {"film_transparent", "use_persistent_data", "preview_pixel_size", "use_pass_z", "use_pass_normal"}
    assert shown >= properties | of_blender
    # Nothing has been rendered: no statistics and no warnings.
    assert not set(records) & {"RPPM_PT_status", "RPPM_PT_warnings", "RPPM_PT_last_renders"}
    assert records["RPPM_PT_sampling"].popovers == ["RPPM_PT_presets"]


def test_panels_are_named_and_shown_for_this_engine_only(scene):
    reports.record(scene.session_uid, report(warnings=("something",)))
    contexts = dict.fromkeys(("light", "camera", "volume", "material", "world", "object"))
    contexts |= {"world": set_world(scene), "material": new_material(), "object": add_mesh(scene)}
    scene.render.engine = "CYCLES"
    assert not drawn_panels(PANELS, context_of(scene, **contexts))
    scene.render.engine = "RPPM"
    names = [cls.__name__ for cls in panels.CLASSES]
    assert all(name.startswith(("RPPM_PT_", "RPPM_OT_")) for name in names) and len(set(names)) == len(names)
    parents = {cls.bl_parent_id for cls in PANELS if getattr(cls, "bl_parent_id", "")}
    assert all(hasattr(bpy.types, parent) for parent in parents)
    assert len(drawn_panels(PANELS, context_of(scene, **contexts))) >= 20


def test_other_engines_add_themselves_to_a_panel(scene):
    scene.render.engine = "CYCLES"
    panel = panels.render.RPPM_PT_film
    panel.COMPAT_ENGINES.add("CYCLES")
    try:
        assert [cls.__name__ for cls in PANELS if cls.poll(context_of(scene))] == ["RPPM_PT_film"]
    finally:
        panel.COMPAT_ENGINES.remove("CYCLES")


def test_settings_of_developers_show_with_developer_extras_alone(scene):
    def shown(extras):
        context = context_of(scene)
        context.preferences.view.show_developer_ui = extras
        records = drawn_panels(PANELS, context)
        return {name for record in records.values() for name in record.properties}

    assert shown(True) - shown(False) == {
        "density_estimation", "first_camera_hits", "first_photon_hits", "cubemap_resolution", "cubemap_center_object",
        "radius_minimum", "radius_maximum",
    }  # fmt: skip


@pytest.mark.parametrize("kind", ["POINT", "SPOT", "SUN", "AREA"])
def test_light_panels(scene, kind):
    light = bpy.data.lights.new("Light", kind)
    records = drawn_panels(panels.data.CLASSES, context_of(scene, light=light))
    shown = {name for record in records.values() for name in record.properties}
    assert {"energy", "color", "photon_weight", "use_nodes"} <= shown
    assert ("spot_size" in shown) == (kind == "SPOT") and ("spread" in shown) == (kind == "AREA")
    assert ("use_soft_falloff" in shown) == (kind in {"POINT", "SPOT"})
    light.use_nodes = True
    socket = drawn(panels.data.RPPM_PT_light_nodes, context_of(scene, light=light)).templates[0]
    assert (socket.node.type, socket.identifier) == ("OUTPUT_LIGHT", "Surface")
    assert not drawn_panels(panels.data.CLASSES, context_of(scene))


def test_the_panorama_panel(scene):
    camera = scene.camera.data
    panel, context = panels.data.RPPM_PT_panorama, context_of(scene, camera=camera)
    assert not panel.poll(context)
    camera.type = "PANO"
    assert panel.poll(context)
    expected = {"EQUIRECTANGULAR": "latitude_min", "FISHEYE_EQUISOLID": "fisheye_lens", "MIRRORBALL": "panorama_type"}
    for kind, name in expected.items():
        camera.panorama_type = kind
        assert name in drawn(panel, context).properties


def test_motion_blur_panels(scene):
    records = drawn_panels(panels.motion.CLASSES, context_of(scene))
    shown = {name for record in records.values() for name in record.properties}
    rolling = {"rolling_shutter_type", "rolling_shutter_duration"}
    of_blender = {"use_motion_blur", "motion_blur_position", "motion_blur_shutter", "motion_blur_shutter_curve"}
    assert shown == of_blender | rolling
    assert len(records["RPPM_PT_motion_blur_curve"].operators) == 6
    panel = panels.motion.RPPM_PT_object_motion_blur
    context = context_of(scene, object=add_mesh(scene))
    assert drawn(panel, context).properties == ["use_motion_blur", "motion_steps", "use_deform_motion"]
    for seen in (scene.camera, add_light(scene, "SUN")):
        context = context_of(scene, object=seen)
        assert panel.poll(context) and drawn(panel, context).properties == ["use_motion_blur", "motion_steps"]
    assert not panel.poll(context_of(scene, object=add_object(scene, "Empty", None)))
    assert not panel.poll(context_of(scene))


def test_material_and_world_panels_edit_the_output_that_is_exported(scene):
    material = new_material()
    tree = material.node_tree
    tree.nodes["Output"].target = "EEVEE"
    ours = tree.nodes.new("ShaderNodeOutputMaterial")
    ours.target = "CYCLES"
    records = drawn_panels(panels.shading.CLASSES, context_of(scene, material=material))
    shown = [socket for record in records.values() for socket in record.templates]
    assert [socket.identifier for socket in shown] == ["Surface", "Volume", "Displacement"]
    assert all(socket.node == ours for socket in shown)
    assert records["RPPM_PT_material_settings"].properties == [
        "pass_index", "displacement_method", "use_transparent_shadow", "use_bump_map_correction",
        "use_dispersion", "abbe_number",
    ]  # fmt: skip
    assert records["RPPM_PT_material_displacement"].labels == []
    tree.nodes.clear()
    record = drawn(panels.shading.RPPM_PT_material_surface, context_of(scene, material=material))
    assert record.labels == ["No output node"]
    world = set_world(scene)
    records = drawn_panels(panels.shading.CLASSES, context_of(scene, world=world))
    assert records["RPPM_PT_world_surface"].templates[0].node.type == "OUTPUT_WORLD"
    assert records["RPPM_PT_world_preview"].templates == [world]


def test_ray_visibility(scene):
    panel = panels.shading.RPPM_PT_ray_visibility

    def shown(thing):
        return drawn(panel, context_of(scene, object=thing)).properties

    of_mesh = shown(add_mesh(scene))
    assert of_mesh[-3:] == ["visible_shadow", "is_holdout", "is_shadow_catcher"]
    rays = [f"visible_{ray}" for ray in ("camera", "diffuse", "glossy", "transmission", "volume_scatter")]
    assert shown(add_light(scene, "POINT")) == of_mesh[:5] == rays
    assert not panel.poll(context_of(scene, object=add_object(scene, "Empty", None)))


def test_the_radius_is_that_of_equations_2_and_3(scene):
    """A first disk over as many pixels as the square of the scale has, that alpha shrinks."""
    scene.render.resolution_x = scene.render.resolution_y = 2048  # twice the side of a megapixel
    scene.rppm.radius_scale, scene.rppm.alpha, scene.rppm.samples = 12.0, 0.5, 40
    scene.rppm.preview_samples = 10
    first = 24.0 / np.sqrt(np.pi)
    ratio = np.prod([np.sqrt((k + 0.5) / (k + 1)) for k in range(1, 40)])
    labels = drawn(panels.render.RPPM_PT_radius, context_of(scene)).labels
    assert f"{first:.2f} pixels" in labels
    assert f"{first * ratio:.2f} pixels ({ratio:.0%})" in labels
    assert f"{shrinkage(10, 0.5):.0%} after 10" in labels
    scene.unit_settings.system = "METRIC"
    reports.record(scene.session_uid, report(RenderKind.VIEWPORT))
    labels = drawn(panels.render.RPPM_PT_radius, context_of(scene)).labels
    assert labels[-2:] == ["Rendered", "1.2 cm in sample 8"]
    scene.unit_settings.scale_length = 0.001  # units of a millimeter
    assert drawn(panels.render.RPPM_PT_radius, context_of(scene)).labels[-1] == "12 µm in sample 8"
    scene.unit_settings.system = "NONE"
    assert drawn(panels.render.RPPM_PT_radius, context_of(scene)).labels[-1] == "0.012 units in sample 8"


def test_samples_come_first(scene):
    """The panels inside show samples and noise threshold; how light is estimated comes below."""
    names = [cls.__name__ for cls in panels.CLASSES if getattr(cls, "bl_parent_id", "") == "RPPM_PT_sampling"]
    assert drawn(panels.sampling.RPPM_PT_sampling, context_of(scene)).properties == []
    assert names == [
        f"RPPM_PT_{name}" for name in ("sampling_viewport", "sampling_final", "light_estimation", "advanced")
    ]
    for panel in (panels.sampling.RPPM_PT_sampling_viewport, panels.sampling.RPPM_PT_sampling_final):
        shown = drawn(panel, context_of(scene)).properties
        assert [name.removeprefix("preview_") for name in shown[1:3]] == ["adaptive_threshold", "samples"]


def test_expected_memory(scene):
    """The closed form, and beside it what the scene took in the last render beyond its closed form."""
    panel = panels.performance.RPPM_PT_performance
    set_border(scene)
    scene.rppm.photons, scene.rppm.max_photon_bounces = 5000, 2
    layer = bpy.context.view_layer
    layer.use_pass_z = layer.use_pass_normal = True  # as those of the report
    expected = expected_memory(16, 32, 5000, 3)
    labels = drawn(panel, context_of(scene)).labels
    assert labels[-1] == bytes_text(expected.total_bytes) and "once rendered" in labels
    reports.record(scene.session_uid, report())
    beside = (200 << 20) - expected_memory(64, 32, 1000, 8).total_bytes
    labels = drawn(panel, context_of(scene)).labels
    assert labels[-1] == bytes_text(expected.total_bytes + beside)
    scene.render.border_max_x = 0.0
    assert drawn(panel, context_of(scene)).labels  # a border without pixels is no reason not to draw


def set_border(scene):
    """The left half of the picture."""
    render = scene.render
    render.use_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.0, 0.5, 0.0, 1.0


def test_automatic_photons_are_told(scene):
    panel, render = panels.sampling.RPPM_PT_sampling_final, scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = 400, 300, 50
    set_border(scene)
    assert "Automatic: 15.0 k" in drawn(panel, context_of(scene)).labels
    scene.rppm.photons = 5000
    assert drawn(panel, context_of(scene)).labels == ["Automatic: 64", "No limit"]


def test_rates_and_the_last_renders(scene):
    viewport = report(
        RenderKind.VIEWPORT, iterations=4, photons=1000, density_estimation="GRID", first_photon_hits="TRACED"
    )
    reports.record(scene.session_uid, viewport)
    for number in range(1, 4):
        reports.record(scene.session_uid, report(photons=8000 * number, warnings=("a", "b")))
    status = drawn(panels.performance.RPPM_PT_status, context_of(scene)).labels
    assert status.index("Viewport") < status.index("Final")
    once = ("1 samples/s", "250 photons/s", "2 samples/s", "6.00 k photons/s", "3.00 k a sample", "250 a sample")
    for text in (*once, "Density", "Photon Grid", "First Hits", "Traced"):
        assert status.count(text) == 1, text
    assert "8 of 8" in status and "200.0 MiB" in status
    table = drawn(panels.performance.RPPM_PT_last_renders, context_of(scene)).labels
    start = table.index("Photons")
    assert table[start : start + 4] == ["Photons", "24.0 k", "16.0 k", "8.00 k"]
    assert table[-4:] == ["Warnings", "2", "2", "2"]


def test_shares_of_lights(scene):
    """An eighth by weight, the rest by power times weight, as they are now; lights that no render knows come last."""
    point = add_light(scene, "POINT", "Light")
    add_light(scene, "SUN", "Late")
    point.data.rppm.photon_weight = 3.0
    watts = {source_name("Light"): 10.0, source_name("Gone"): 10.0, SURFACES: 20.0, ENVIRONMENT: 60.0}
    photons = {source_name("Light"): 500, source_name("Gone"): 0, SURFACES: 250, ENVIRONMENT: 250}
    panel = panels.lights.RPPM_PT_photon_allocation
    record = drawn(panel, context_of(scene))
    assert record.properties == ["photon_weight"] * 2 and "once the scene was rendered" in record.labels[-1]
    reports.record(scene.session_uid, report(source_watts=watts, source_photons=photons))
    rows = panels.lights.source_rows(scene)
    assert [row.name for row in rows] == ["World", "Light", SURFACES, "Gone", "Late"]
    by_power, by_weight = np.array([60, 30, 20, 10]) / 120, np.array([1, 3, 1, 1]) / 6
    assert [row.allocated for row in rows[:4]] == pytest.approx(7 / 8 * by_power + by_weight / 8)
    assert rows[4].allocated is None
    assert [row.sent for row in rows[:4]] == [0.25, 0.5, 0.25, 0.0]
    assert [row.light for row in rows] == [None, point.data, None, None, bpy.data.lights["Late"]]
    labels = drawn(panel, context_of(scene)).labels
    assert "25.0%" in labels and "50.0%" in labels
    # A later report of a viewport that knows no powers hides nothing.
    reports.record(scene.session_uid, report(RenderKind.VIEWPORT))
    assert panels.lights.source_rows(scene) == rows


def test_many_lights_are_cut_short(scene):
    for number in range(40):
        add_light(scene, "POINT", f"Light {number}")
    record = drawn(panels.lights.RPPM_PT_photon_allocation, context_of(scene))
    assert len(record.properties) == panels.lights.LIGHTS_SHOWN and "and 16 more" in record.labels


def test_velocities_of_volume_objects_are_shown(scene):
    """Blender's own Render panel, above, has Space alone."""
    volume = bpy.data.volumes.new("Smoke")
    records = drawn_panels(PANELS, context_of(scene, volume=volume))
    assert records["RPPM_PT_volume_velocity"].properties == ["velocity_grid", "velocity_unit", "velocity_scale"]
    above = getattr(bpy.types, panels.data.RPPM_PT_volume_velocity.bl_parent_id)
    assert drawn(above, context_of(scene, volume=volume)).properties == ["space"]
    assert "RPPM_PT_volume_velocity" not in drawn_panels(PANELS, context_of(scene))
    scene.render.engine = "CYCLES"
    assert "RPPM_PT_volume_velocity" not in drawn_panels(PANELS, context_of(scene, volume=volume))


def test_presets_set_what_they_say(scene):
    folder = bpy.utils.preset_paths("rppm")
    files = {path.stem: path for path in (presets.FOLDER / "presets" / "rppm").glob("*.py")}
    assert str(presets.FOLDER / "presets" / "rppm") in folder and set(files) == {"Draft", "Balanced", "Final"}
    iterations = {}
    for name, path in files.items():
        for setting in presets.SETTINGS:
            scene.rppm.property_unset(setting)
        scene.rppm.samples, scene.rppm.seed = 3, 7
        bpy.ops.script.execute_preset(filepath=str(path), menu_idname="RPPM_PT_presets")
        settings = export_settings(scene)
        settings.validate()
        written = {line.split(" = ")[0] for line in path.read_text().splitlines() if line.startswith("settings.")}
        assert written == set(presets.RPPM_OT_preset_add.preset_values)
        assert settings.seed == 7
        iterations[name] = settings.iterations
        assert settings.photons == RenderSettings().photons
        if name == "Balanced":
            for setting in presets.SETTINGS:
                stored = RenderSettings().with_properties({setting: getattr(scene.rppm, setting)})
                for field, expected in vars(RenderSettings()).items():
                    near = pytest.approx(expected, rel=1e-6) if isinstance(expected, float) else expected
                    assert getattr(stored, field) == near, field
    assert iterations["Draft"] * 4 == iterations["Balanced"] == iterations["Final"] // 4


def test_a_preset_of_the_users_own(scene, tmp_path, monkeypatch):
    monkeypatch.setattr(bpy.utils, "user_resource", lambda kind, path="", create=False: str(tmp_path))
    scene.rppm.photons, scene.rppm.direct_light = 777, "PHOTONS"
    assert bpy.ops.rppm.preset_add(name="mine") == {"FINISHED"}
    (saved,) = tmp_path.glob("*.py")
    scene.rppm.photons, scene.rppm.direct_light = 5, "RAYS"
    bpy.ops.script.execute_preset(filepath=str(saved), menu_idname="RPPM_PT_presets")
    assert (scene.rppm.photons, scene.rppm.direct_light) == (777, "PHOTONS")


def test_the_pause_button_shows_in_rendered_viewports(scene):
    def shown(engine, shading):
        header = SimpleNamespace(layout=RecordingLayout())
        space = SimpleNamespace(type="VIEW_3D", shading=SimpleNamespace(type=shading))
        viewport_header.draw_header(header, context_of(scene, engine=engine, space_data=space))
        return header.layout.record

    assert shown("RPPM", "RENDERED").properties == ["preview_pause"]
    assert shown("RPPM", "SOLID").properties == shown("CYCLES", "RENDERED").properties == []
    # Warnings of the viewport, not of a final render, are behind a button; an error is too.
    reports.record(scene.session_uid, report(RenderKind.FINAL, warnings=("a",)))
    assert shown("RPPM", "RENDERED").popovers == []
    reports.record(scene.session_uid, report(RenderKind.VIEWPORT, warnings=('Material "M": is odd', "b")))
    assert shown("RPPM", "RENDERED").popovers == ["RPPM_PT_viewport_warnings"] and not shown("RPPM", "SOLID").popovers
    listed = drawn(panels.warnings.RPPM_PT_viewport_warnings, context_of(scene))
    assert listed.labels == ["M: is odd", "B", "Names are in the render tab: Warnings"] and len(listed.operators) == 1
    reports.forget()
    reports.record_viewport_error(scene.session_uid, "no lights")
    assert shown("RPPM", "RENDERED").popovers == ["RPPM_PT_viewport_warnings"]
    assert drawn(panels.warnings.RPPM_PT_viewport_warnings, context_of(scene)).labels == ["no lights"]


def test_a_renderer_that_has_stopped_can_be_started_where_it_is_missed(scene, process):
    process.state, process.error = ProcessState.FAILED, "The renderer process was ended by SIGKILL"
    reports.record_error(scene.session_uid, process.error)
    space = SimpleNamespace(type="VIEW_3D", shading=SimpleNamespace(type="RENDERED"))
    header = SimpleNamespace(layout=RecordingLayout())
    context = context_of(scene, space_data=space)
    viewport_header.draw_header(header, context)
    status = drawn(panels.performance.RPPM_PT_status, context)
    popover = drawn(panels.warnings.RPPM_PT_viewport_warnings, context)
    for record in (header.layout.record, status, popover):
        assert identifiers(record) == ["rppm.start_renderer"]
        assert record is header.layout.record or " ".join(record.labels).count("SIGKILL") == 1
    assert not panels.warnings.RPPM_PT_warnings.poll(context)
    process.state = ProcessState.RUNNING
    reports.forget()
    assert not panels.performance.RPPM_PT_status.poll(context)


def test_switches_of_settings_that_may_be_automatic(scene):
    assert not scene.rppm_switches.photons and scene.rppm_switches.preview_photons
    for name, value in SUGGESTIONS.items():
        setattr(scene.rppm_switches, name, False)
        assert getattr(scene.rppm, name) == 0
        setattr(scene.rppm_switches, name, True)
        assert getattr(scene.rppm, name) == pytest.approx(value)
    scene.rppm.photons = 777
    scene.rppm_switches.photons = True
    assert scene.rppm.photons == 777
    export_settings(scene).validate()


@pytest.mark.parametrize("kind", ["COMBINED", "NORMAL", "DIFFUSE", "UV"])
def test_panels_of_baking_follow_the_type(scene, kind):
    scene.rppm.bake_type = kind
    records = drawn_panels(PANELS, context_of(scene))
    (button,) = (button for button in records["RPPM_PT_bake"].operators if button._identifier == "object.bake")
    assert button.type == kind
    influence = records["RPPM_PT_bake_influence"].properties if kind != "UV" else []
    shown = [name in influence for name in ("use_pass_emit", "use_pass_color", "normal_space")]
    assert shown == [kind == "COMBINED", kind == "DIFFUSE", kind == "NORMAL"]
    assert ("view_from" in records["RPPM_PT_bake"].properties) == (kind in {"COMBINED", "DIFFUSE"})
    assert ("margin_type" in records["RPPM_PT_bake_output_margin"].properties) == (kind in {"COMBINED", "DIFFUSE"})


@pytest.mark.skipif(bpy.app.version < (5, 0), reason="the settings had other names before Blender 5")
def test_panels_of_baking_show_blenders_own_for_multiresolution(scene):
    scene.render.bake.use_multires, scene.render.bake.type = True, "VECTOR_DISPLACEMENT"
    records = drawn_panels(PANELS, context_of(scene))
    assert identifiers(records["RPPM_PT_bake"]) == ["object.bake_image"]
    assert not records.keys() & {"RPPM_PT_bake_influence", "RPPM_PT_bake_selected_to_active"}
    assert records["RPPM_PT_bake_output"].properties == ["use_clear", "use_lores_mesh", "displacement_space"]
    assert records["RPPM_PT_bake_output_margin"].properties == ["margin"]
