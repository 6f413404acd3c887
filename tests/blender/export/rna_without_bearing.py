# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties of Blender and Cycles that RPPM does not read, for they have no bearing on its picture.

By RNA type or, of what Cycles adds, by where it is found. test_omissions.py holds that what is in none of these lists
is either read by the export or named by it (export/omissions.py).
"""

_OBJECT_EVALUATED_BY_BLENDER = """
bound_box parent_type parent_vertices parent_bone use_parent_final_indices use_camera_lock_parent track_axis up_axis
rotation_quaternion rotation_axis_angle rotation_euler rotation_mode dimensions delta_location delta_rotation_euler
delta_rotation_quaternion delta_scale lock_location lock_rotation lock_rotation_w lock_rotations_4d lock_scale
matrix_local matrix_basis matrix_parent_inverse constraints vertex_groups add_rest_position_attribute collision
soft_body rigid_body rigid_body_constraint use_simulation_cache hide_viewport hide_select hide_render
show_instancer_for_render show_instancer_for_viewport use_instance_vertices_rotation use_instance_faces_scale
instance_faces_scale show_only_shape_key use_shape_key_edit_mode active_shape_key active_shape_key_index
is_from_instancer is_from_set
"""
_SHOWN_IN_WINDOWS_ONLY = """
active_material empty_display_type empty_display_size empty_image_offset empty_image_depth
show_empty_image_perspective show_empty_image_orthographic show_empty_image_only_axis_aligned use_empty_image_alpha
empty_image_side hide_surface_pick display_type show_bounds display_bounds_type show_name show_axis
show_texture_space show_wire show_all_edges show_transparent show_in_front use_dynamic_topology_sculpting display
use_mesh_mirror_x use_mesh_mirror_y use_mesh_mirror_z animation_data animation_visualization motion_path
selection_sets active_selection_set
"""
_OTHER_ENGINES = "shader_effects hide_probe_volume hide_probe_sphere hide_probe_plane use_grease_pencil_lights lineart"
_LIGHT = """
specular_factor diffuse_factor transmission_factor volume_factor use_custom_distance cutoff_distance animation_data
shadow_buffer_clip_start shadow_filter_radius shadow_maximum_resolution use_shadow_jitter shadow_jitter_overblur
use_absolute_resolution shadow_cascade_max_distance shadow_cascade_count shadow_cascade_exponent shadow_cascade_fade
use_square show_cone
"""
_SAMPLING_OF_CYCLES = """
shading_system denoising_use_gpu use_preview_denoising preview_denoiser preview_denoising_prefilter
preview_denoising_quality preview_denoising_input_passes preview_denoising_use_gpu use_sample_subset sample_offset
sample_subset_length sampling_pattern scrambling_distance preview_scrambling_distance auto_scrambling_distance
use_layer_samples light_sampling_threshold use_preview_adaptive_sampling preview_adaptive_threshold
direct_light_sampling_type use_light_tree min_light_bounces min_transparent_bounces use_guiding
use_deterministic_guiding guiding_distribution_type guiding_directional_sampling_type use_surface_guiding
surface_guiding_probability use_volume_guiding guiding_training_samples volume_guiding_probability
use_guiding_direct_light use_guiding_mis_weights guiding_roughness_threshold debug_bvh_type debug_use_spatial_splits
debug_use_hair_bvh debug_use_compact_bvh debug_bvh_time_steps bake_type use_auto_tile tile_size debug_use_cpu_avx2
debug_use_cpu_sse42 debug_bvh_layout debug_use_cuda_adaptive_compile debug_use_optix_debug
debug_use_hip_adaptive_compile debug_use_metal_adaptive_compile
"""
_CYCLES_TRADES_TRUTH_FOR_NOISE = """
caustics_reflective caustics_refractive  sample_clamp_direct sample_clamp_indirect use_fast_gi
fast_gi_method ao_bounces ao_bounces_render diffuse_bounces glossy_bounces transmission_bounces
"""
_OF_WHAT_IS_NAMED = """
max_subdivisions dicing_camera offscreen_dicing_scale film_transparent_roughness
rolling_shutter_duration volume_bounces volume_step_rate
volume_preview_step_rate volume_max_steps
"""

WITHOUT_BEARING = {
    "Object": f"{_OBJECT_EVALUATED_BY_BLENDER} {_SHOWN_IN_WINDOWS_ONLY} {_OTHER_ENGINES} "
    # Volumes are named where they are exported; rays leave surfaces of RPPM by an offset of its own.
    "shadow_terminator_normal_offset",
    "PointLight": _LIGHT,
    "SpotLight": _LIGHT,
    "SunLight": _LIGHT,
    "AreaLight": _LIGHT,
    "World": """
        animation_data use_eevee_finite_volume probe_resolution sun_threshold sun_angle
        use_sun_shadow sun_shadow_maximum_resolution sun_shadow_filter_radius use_sun_shadow_jitter
        sun_shadow_jitter_overblur
    """,
    "WorldMistSettings": "use_mist",
    "Material": """
        surface_render_method blend_method alpha_threshold use_transparency_overlap show_transparent_back
        use_backface_culling use_backface_culling_shadow use_backface_culling_lightprobe_volume use_raytrace_refraction
        use_screen_refraction use_sss_translucency refraction_depth thickness_mode use_thickness_from_shadow
        volume_intersection_method max_vertex_displacement preview_render_type use_preview_world animation_data
        texture_paint_images texture_paint_slots paint_active_slot paint_clone_slot specular_color roughness
        specular_intensity metallic line_color line_priority is_grease_pencil lineart
    """,
    "Camera": """
        passepartout_alpha angle_x angle_y display_size show_limits show_mist show_passepartout show_safe_areas
        show_safe_center show_name show_sensor show_background_images lens_unit composition_guide_color
        show_composition_center show_composition_center_diagonal show_composition_thirds show_composition_golden
        show_composition_golden_tria_a show_composition_golden_tria_b show_composition_harmony_tri_a
        show_composition_harmony_tri_b background_images animation_data
    """
    # Fisheye Polynomial is read by power; a camera of one's own code is refused.
    + "".join(f" fisheye_polynomial_k{power}" for power in range(5))
    + " custom_filepath custom_shader custom_mode custom_bytecode custom_bytecode_hash cycles_custom",
    "CameraDOFSettings": "",
    "ViewLayer": """
        eevee active_aov active_aov_index active_lightgroup active_lightgroup_index
        use_pass_cryptomatte_accurate use_ao use_strand use_grease_pencil
        active_layer_collection has_export_collections use_freestyle freestyle_settings
    """,
    "RenderSettings": """
        image_settings ppm_factor ppm_base ffmpeg frame_map_old frame_map_new dither_intensity filter_size use_freestyle
        threads_mode hair_type hair_subdiv use_high_quality_normals use_crop_to_border use_placeholder use_overwrite
        use_compositing use_sequencer use_file_extension file_extension use_lock_interface use_render_cache
        use_stamp_frame_range use_stamp_lens use_stamp_marker use_stamp_sequencer_strip use_stamp_render_time use_stamp
        use_stamp_labels metadata_input use_stamp_memory use_stamp_hostname stamp_font_size stamp_foreground
        stamp_background sequencer_gl_preview use_sequencer_override_scene_strip use_single_layer stereo_views
        views_format has_multiple_engines use_spherical_stereo simplify_subdivision
        simplify_child_particles simplify_subdivision_render simplify_child_particles_render simplify_volumes
        use_simplify_normals simplify_gpencil simplify_gpencil_onplay simplify_gpencil_antialiasing
        simplify_gpencil_view_fill simplify_gpencil_modifier simplify_gpencil_shader_fx simplify_gpencil_tint
        line_thickness_mode line_thickness bake compositor_device compositor_precision compositor_denoise_device
        compositor_denoise_preview_quality compositor_denoise_final_quality
    """,
    "LayerCollection": "exclude hide_viewport is_visible",
    "ObjectLightLinking": "",
    "object.cycles": "ao_distance is_caustics_caster is_caustics_receiver",
    "light.cycles": "use_multiple_importance_sampling is_caustics_light",
    "world.cycles": """
        is_caustics_light sampling_method sample_map_resolution volume_sampling volume_interpolation volume_step_size
    """,
    "world.cycles_visibility": "",
    "material.cycles": """
        emission_sampling volume_sampling volume_interpolation volume_step_rate
    """,
    "scene.cycles": f"{_SAMPLING_OF_CYCLES} {_CYCLES_TRADES_TRUTH_FOR_NOISE} {_OF_WHAT_IS_NAMED}",
    "scene.cycles_curves": "subdivisions",
    "view_layer.cycles": "",
}
