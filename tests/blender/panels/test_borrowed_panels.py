# SPDX-License-Identifier: GPL-3.0-or-later
"""Every panel that Cycles shows has a counterpart for RPPM, or a reason why there is none."""

import bpy
import pytest
from blender_scenes import add_mesh, export
from drawing import context_of

from rppm_addon.blender.panels import borrowed

OF_CYCLES = "is about how Cycles works"

ALIKE = {
    ("CYCLES_MATERIAL_PT_", "RPPM_PT_material_"): "displacement settings surface volume",
    ("CYCLES_RENDER_PT_", "RPPM_PT_"): """
        bake bake_influence bake_output bake_output_margin bake_selected_to_active curves film
        light_paths light_paths_caustics light_paths_clamping light_paths_max_bounces motion_blur
        motion_blur_curve performance sampling sampling_viewport simplify simplify_culling
        simplify_render simplify_viewport subdivision filter passes
    """,
    ("CYCLES_WORLD_PT_", "RPPM_PT_world_"): "mist preview ray_visibility surface volume",
}
"""Endings of the names of panels of Cycles that have the same endings here, by both beginnings."""
COUNTERPARTS = {
    "CYCLES_CAMERA_PT_dof": "DATA_PT_camera_dof",
    "CYCLES_CAMERA_PT_dof_aperture": "DATA_PT_camera_dof_aperture",
    "CYCLES_LIGHT_PT_beam_shape": "RPPM_PT_light_beam",
    "CYCLES_LIGHT_PT_light": "RPPM_PT_light",
    "CYCLES_LIGHT_PT_nodes": "RPPM_PT_light_nodes",
    "CYCLES_LIGHT_PT_preview": "DATA_PT_preview",
    "CYCLES_MATERIAL_PT_preview": "MATERIAL_PT_preview",
    "CYCLES_MATERIAL_PT_settings_surface": "RPPM_PT_material_settings",
    "CYCLES_PT_context_material": "EEVEE_MATERIAL_PT_context_material",
    "CYCLES_OBJECT_PT_visibility_culling": "RPPM_PT_object_culling",
    "CYCLES_OBJECT_PT_lightgroup": "RPPM_PT_object_light_group",
    "CYCLES_OBJECT_PT_motion_blur": "RPPM_PT_object_motion_blur",
    "CYCLES_OBJECT_PT_visibility": "OBJECT_PT_visibility",
    "CYCLES_OBJECT_PT_visibility_ray_visibility": "RPPM_PT_ray_visibility",
    "CYCLES_PT_integrator_presets": "RPPM_PT_presets",
    "CYCLES_PT_performance_presets": "RPPM_PT_presets",
    "CYCLES_PT_sampling_presets": "RPPM_PT_presets",
    "CYCLES_PT_viewport_sampling_presets": "RPPM_PT_presets",
    "CYCLES_RENDER_PT_film_pixel_filter": "RPPM_PT_film",
    "CYCLES_RENDER_PT_film_transparency": "RPPM_PT_film",
    "CYCLES_RENDER_PT_performance_acceleration_structure": "RPPM_PT_acceleration_structure",
    "CYCLES_RENDER_PT_performance_memory": "RPPM_PT_performance",
    "CYCLES_RENDER_PT_sampling_advanced": "RPPM_PT_advanced",
    "CYCLES_RENDER_PT_sampling_lights": "RPPM_PT_photon_allocation",
    "CYCLES_RENDER_PT_sampling_render": "RPPM_PT_sampling_final",
    "CYCLES_VIEW3D_PT_simplify_greasepencil": "RPPM_PT_simplify_greasepencil",
    "CYCLES_PT_post_processing": "RENDER_PT_post_processing",
    "CYCLES_RENDER_PT_passes_lightgroups": "RPPM_PT_passes_light_groups",
    "VIEWLAYER_PT_layer_passes_lightgroups": "RPPM_PT_passes_light_groups",
    "CYCLES_RENDER_PT_passes_aov": "RPPM_PT_passes_aov",
    "CYCLES_RENDER_PT_passes_crypto": "RPPM_PT_passes_cryptomatte",
    "CYCLES_RENDER_PT_passes_data": "RPPM_PT_passes",
    "CYCLES_RENDER_PT_passes_light": "RPPM_PT_passes",
    "OBJECT_PT_shadow_terminator": "RPPM_PT_shadow_terminator",
}
"""Panels of Cycles, and those that stand in their place."""
COUNTERPARTS |= {theirs + name: ours + name for (theirs, ours), names in ALIKE.items() for name in names.split()}

EXCLUDED = {
    "CYCLES_CAMERA_PT_lens_custom_parameters": "custom cameras are rendered in perspective",
    "CYCLES_LIGHT_PT_settings": "RPPM_PT_light shows bounces, shadows and portals",
    "CYCLES_MATERIAL_PT_settings_volume": OF_CYCLES,
    "CYCLES_OBJECT_PT_shading_caustics": "caustics need no switch",
    "CYCLES_OBJECT_PT_shading_gi_approximation": OF_CYCLES,
    "CYCLES_RENDER_PT_curves_viewport_display": "Blender's own viewports draw so",
    "CYCLES_RENDER_PT_debug": OF_CYCLES,
    "CYCLES_RENDER_PT_light_paths_fast_gi": OF_CYCLES,
    "CYCLES_RENDER_PT_performance_final_render": "persistent data is not kept",
    "CYCLES_RENDER_PT_performance_threads": "the graphics device renders",
    "CYCLES_RENDER_PT_performance_viewport": "the viewport finds its resolution itself",
    "CYCLES_RENDER_PT_sampling_advanced_sample_subset": OF_CYCLES,
    "CYCLES_RENDER_PT_volumes": OF_CYCLES,
}
"""Panels of Cycles that RPPM has nothing for, and why."""
OLDER = {
    "CYCLES_OBJECT_PT_light_linking": OF_CYCLES,
    "CYCLES_OBJECT_PT_shading": OF_CYCLES,
    "CYCLES_OBJECT_PT_shading_shadow_terminator": OF_CYCLES,
    "CYCLES_OBJECT_PT_shadow_linking": OF_CYCLES,
    "CYCLES_RENDER_PT_override": "RPPM_PT_override shows it",
}
"""Panels that Cycles had before Blender 5, and why RPPM has nothing for them."""
EXCLUDED_BEGINNINGS = {
    "CYCLES_RENDER_PT_performance_compositor": "is the compositor's, which needs no engine",
    "CYCLES_RENDER_PT_sampling_path_guiding": OF_CYCLES,
    "CYCLES_RENDER_PT_sampling_render_denoise": "RPPM_PT_sampling shows it",
    "CYCLES_RENDER_PT_sampling_viewport_denoise": "RPPM_PT_sampling shows it",
    "CYCLES_WORLD_PT_settings": OF_CYCLES,
}


def shown(engine):
    """Names of the registered panels of the Properties editor that say that they are for an engine."""
    pending, found = [bpy.types.Panel], set()
    while pending:
        classes = pending.pop().__subclasses__()
        pending += classes
        found |= {cls for cls in classes if getattr(cls, "bl_space_type", "") == "PROPERTIES"}
    return {
        cls.__name__
        for cls in found
        if engine in getattr(cls, "COMPAT_ENGINES", ()) and hasattr(bpy.types, cls.__name__)
    }


def test_every_panel_of_cycles_has_a_counterpart_or_a_reason(scene):
    ours = shown("RPPM")
    missing = {
        name
        for name in shown("CYCLES") - ours - set(borrowed.UNFIT) - set(COUNTERPARTS) - set(EXCLUDED) - set(OLDER)
        if not name.startswith(tuple(EXCLUDED_BEGINNINGS))
    }
    assert not missing
    assert not (set(COUNTERPARTS) | set(EXCLUDED)) & ours and not set(COUNTERPARTS) & set(EXCLUDED)
    for name in set(COUNTERPARTS.values()):
        assert hasattr(bpy.types, name) and (name in ours or name.startswith("RPPM_PT_")), name


def test_the_lists_name_nothing_that_is_not_there(scene):
    if bpy.app.version[:2] == (5, 0):  # other versions have other panels
        everything = shown("CYCLES") | shown("BLENDER_RENDER") | shown("BLENDER_EEVEE")
        assert set(COUNTERPARTS) | set(EXCLUDED) | set(borrowed.UNFIT) <= everything | {
            "NODE_DATA_PT_light", "NODE_DATA_PT_spot", "DATA_PT_falloff_curve",
        }  # fmt: skip
        assert everything >= borrowed.FITTING
        for beginning in EXCLUDED_BEGINNINGS:
            assert any(name.startswith(beginning) for name in everything), beginning


@pytest.mark.parametrize(
    ("tab", "names"),
    {
        "camera": {"DATA_PT_lens", "DATA_PT_camera", "DATA_PT_camera_dof", "DATA_PT_camera_dof_aperture",
                   "DATA_PT_camera_safe_areas",
                   "DATA_PT_camera_background_image", "DATA_PT_camera_display"},
        "object": {"OBJECT_PT_visibility", "OBJECT_PT_shading"},
        "particle": {"PARTICLE_PT_render_object", "PARTICLE_PT_render_collection", "PARTICLE_PT_emission"},
        "texture": {"TEXTURE_PT_image", "TEXTURE_PT_context"},
        "output": {"RENDER_PT_format", "RENDER_PT_frame_range", "RENDER_PT_output", "RENDER_PT_encoding",
                   "RENDER_PT_stamp", "RENDER_PT_post_processing"},
        "render": {"RENDER_PT_color_management", "RENDER_PT_gpencil"},
        "mesh": {"DATA_PT_uv_texture", "DATA_PT_vertex_colors", "DATA_PT_customdata", "DATA_PT_mesh_attributes"},
        "world": {"WORLD_PT_context_world"},
        "light and material": {"DATA_PT_context_light", "EEVEE_MATERIAL_PT_context_material"},
        "view_layer": {"VIEWLAYER_PT_layer", "VIEWLAYER_PT_freestyle", "VIEWLAYER_PT_freestyle_linestyle_color"},
        "freestyle": {"RENDER_PT_freestyle", "MATERIAL_PT_freestyle_line"},
        "volume": {"DATA_PT_volume_render", "DATA_PT_volume_file"},
    }.items(),
)  # fmt: skip
def test_tabs_have_what_users_look_for(scene, tab, names):
    assert names <= shown("RPPM")
    assert not shown("RPPM") & {"DATA_PT_light", "RENDER_PT_eevee_sampling"}


def test_panels_without_a_place_do_not_show(scene):
    """A panel in another one that is left out would hang in the air."""
    ours = shown("RPPM")
    for name in ours:
        parent = getattr(getattr(bpy.types, name), "bl_parent_id", "")
        if parent and hasattr(getattr(bpy.types, parent), "COMPAT_ENGINES"):
            assert parent in ours, name


def test_simplify_which_the_panel_offers_counts(scene):
    cube = add_mesh(scene, "Quad")
    modifier = cube.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = modifier.render_levels = 3
    assert export(scene).triangle_count == 2 * 4**3
    scene.render.use_simplify, scene.render.simplify_subdivision = True, 1
    assert export(scene).triangle_count == 2 * 4


def test_borrowed_panels_poll(scene):
    """Blender's own poll functions let them show."""
    cube = add_mesh(scene, "Quad")
    context = context_of(scene, object=cube, mesh=cube.data, camera=scene.camera.data, world=None)
    for name in ("OBJECT_PT_visibility", "DATA_PT_uv_texture", "DATA_PT_camera_dof", "RENDER_PT_format"):
        assert getattr(bpy.types, name).poll(context), name
    context.engine = "NO ENGINE"
    assert not bpy.types.OBJECT_PT_visibility.poll(context)
