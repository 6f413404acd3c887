# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties that change no picture of RPPM and no warning, by the reason why nobody misses them.

Those of other engines, and those that nothing reads, change no picture of Cycles either, which test_audit.py shows.
"""

EVALUATED = (
    "Blender has evaluated them in what engines are given, or they are other ways to say what is listed as rendered"
)
WINDOWS = "they are of windows, of editing, or of what is selected"
OTHER_ENGINES = "they are of EEVEE, Workbench, Grease Pencil or Freestyle"
OUTPUT = "Blender handles them once a picture is rendered, or before"
NOISE = "they have Cycles find the same light with less noise, in less time or with less memory"
APPROXIMATED = "they have Cycles approximate what RPPM renders as it is"
OF_NAMED = "they count only with a feature that a warning names"
WINDOWS_OF_SCENES = "they are of playback, sound and simulation, or of an animation as a whole"
UNREAD = "Cycles itself does not read them, or there is nothing that they could act on"

WITHOUT_EFFECT = {
    EVALUATED: """
        Camera.angle_x Camera.angle_y CameraDOFSettings.focus_subtarget LayerCollection.exclude
        MaterialSlot.link Object.add_rest_position_attribute Object.data Object.delta_rotation_quaternion
        CyclesObjectSettings.shadow_terminator_geometry_offset CyclesObjectSettings.shadow_terminator_offset
        Object.instance_faces_scale Object.matrix_basis Object.matrix_local Object.matrix_parent_inverse
        Object.matrix_world Object.parent_bone Object.parent_type Object.parent_vertices Object.rotation_axis_angle
        Object.rotation_quaternion Object.show_only_shape_key Object.track_axis Object.up_axis
        Object.use_instance_faces_scale Object.use_parent_final_indices Object.use_simulation_cache Image.pixels
        Image.use_multiview Image.views_format Image.use_deinterlace Image.generated_color Image.generated_height
        Image.generated_type Image.generated_width Image.use_generated_float Image.filepath_raw
        RenderSettings.simplify_volumes ViewLayer.use Volume.frame_duration Volume.frame_offset Volume.frame_start
        Volume.is_sequence Volume.sequence_mode VolumeRender.precision Curves.surface Curves.surface_uv_map
    """,
    WINDOWS: """
        Camera.composition_guide_color Camera.display_size Camera.lens_unit Camera.passepartout_alpha
        Camera.show_background_images Camera.show_composition_center Camera.show_composition_center_diagonal
        Camera.show_composition_golden Camera.show_composition_golden_tria_a Camera.show_composition_golden_tria_b
        Camera.show_composition_harmony_tri_a Camera.show_composition_harmony_tri_b Camera.show_composition_thirds
        Camera.show_limits Camera.show_mist Camera.show_name Camera.show_passepartout Camera.show_safe_areas
        Camera.show_safe_center Camera.show_sensor Curves.selection_domain Curves.surface_collision_distance
        Curves.use_mirror_x Curves.use_mirror_y Curves.use_mirror_z Curves.use_sculpt_collision
        CyclesRenderSettings.preview_dicing_rate CyclesRenderSettings.preview_pause CyclesRenderSettings.texture_limit
        CyclesRenderSettings.volume_preview_step_rate Image.display_aspect Image.file_format Image.resolution
        Image.seam_margin Image.use_half_precision Image.use_view_as_render LayerCollection.hide_viewport
        Material.paint_active_slot Material.paint_clone_slot Material.preview_render_type Material.use_preview_world
        Material.diffuse_color Material.metallic Material.roughness Material.specular_color Material.specular_intensity
        Material.use_nodes Object.active_material Object.active_material_index Object.active_selection_set
        Object.active_shape_key_index Object.display_bounds_type Object.display_type Object.empty_display_size
        Object.empty_display_type Object.empty_image_depth Object.empty_image_offset Object.empty_image_side
        Object.hide_select Object.hide_surface_pick Object.hide_viewport Object.lock_location Object.lock_rotation
        Object.lock_rotation_w Object.lock_rotations_4d Object.lock_scale Object.show_all_edges Object.show_axis
        Object.show_bounds Object.show_empty_image_only_axis_aligned Object.show_empty_image_orthographic
        Object.show_empty_image_perspective Object.show_in_front Object.show_instancer_for_viewport Object.show_name
        Object.show_texture_space Object.show_transparent Object.show_wire Object.use_camera_lock_parent
        Object.use_empty_image_alpha Object.use_mesh_mirror_x Object.use_mesh_mirror_y Object.use_mesh_mirror_z
        Object.use_shape_key_edit_mode RenderSettings.preview_pixel_size RenderSettings.simplify_child_particles
        RenderSettings.simplify_subdivision RenderSettings.use_simplify_normals SpotLight.show_cone
        ViewLayer.active_aov_index ViewLayer.active_layer_collection ViewLayer.active_lightgroup_index World.color
        World.use_nodes WorldMistSettings.height WorldMistSettings.intensity WorldMistSettings.use_mist
    """,
    OTHER_ENGINES: """
        AreaLight.shadow_buffer_clip_start AreaLight.shadow_filter_radius AreaLight.shadow_maximum_resolution
        AreaLight.shadow_soft_size AreaLight.use_absolute_resolution AreaLight.use_shadow_jitter
        AreaLight.shadow_jitter_overblur Light.cutoff_distance Light.diffuse_factor Light.specular_factor
        Light.transmission_factor Light.use_custom_distance Light.volume_factor Material.alpha_threshold
        Material.blend_method Material.line_color Material.line_priority Material.max_vertex_displacement
        Material.refraction_depth Material.show_transparent_back Material.surface_render_method Material.thickness_mode
        Material.use_backface_culling Material.use_backface_culling_lightprobe_volume
        Material.use_backface_culling_shadow Material.use_raytrace_refraction Material.use_screen_refraction
        Material.use_sss_translucency Material.use_thickness_from_shadow Material.use_transparency_overlap
        Material.volume_intersection_method Object.hide_probe_plane Object.hide_probe_sphere Object.hide_probe_volume
        Object.shadow_terminator_normal_offset Object.use_grease_pencil_lights PointLight.shadow_buffer_clip_start
        PointLight.shadow_filter_radius PointLight.shadow_jitter_overblur PointLight.shadow_maximum_resolution
        PointLight.use_absolute_resolution PointLight.use_shadow_jitter RenderSettings.filter_size
        RenderSettings.hair_subdiv RenderSettings.hair_type RenderSettings.line_thickness
        RenderSettings.line_thickness_mode RenderSettings.simplify_gpencil
        RenderSettings.simplify_gpencil_antialiasing RenderSettings.simplify_gpencil_modifier
        RenderSettings.simplify_gpencil_onplay RenderSettings.simplify_gpencil_shader_fx
        RenderSettings.simplify_gpencil_tint RenderSettings.simplify_gpencil_view_fill RenderSettings.use_freestyle
        RenderSettings.use_high_quality_normals SpotLight.shadow_buffer_clip_start SpotLight.shadow_filter_radius
        SpotLight.shadow_jitter_overblur SpotLight.shadow_maximum_resolution SpotLight.use_absolute_resolution
        SpotLight.use_shadow_jitter SpotLight.use_square SunLight.shadow_buffer_clip_start
        SunLight.shadow_cascade_count SunLight.shadow_cascade_exponent SunLight.shadow_cascade_fade
        SunLight.shadow_cascade_max_distance SunLight.shadow_filter_radius SunLight.shadow_jitter_overblur
        SunLight.shadow_maximum_resolution SunLight.shadow_soft_size SunLight.use_shadow_jitter ViewLayer.use_ao
        ViewLayer.use_freestyle ViewLayer.use_grease_pencil ViewLayer.use_pass_cryptomatte_accurate
        ViewLayer.use_pass_combined World.probe_resolution World.sun_angle World.sun_shadow_filter_radius
        World.sun_shadow_jitter_overblur World.sun_shadow_maximum_resolution World.sun_threshold
        World.use_eevee_finite_volume World.use_sun_shadow World.use_sun_shadow_jitter WorldLighting.ao_factor
    """,
    WINDOWS_OF_SCENES: """
        Scene.active_clip Scene.annotation Scene.audio_distance_model Scene.audio_doppler_factor
        Scene.audio_doppler_speed Scene.audio_volume Scene.frame_end Scene.frame_float Scene.frame_preview_end
        Scene.frame_preview_start Scene.frame_start Scene.frame_step Scene.gravity Scene.lock_frame_selection_to_range
        Scene.show_keys_from_selected_only Scene.show_subframe Scene.simulation_frame_end Scene.simulation_frame_start
        Scene.sync_mode Scene.time_jump_delta Scene.time_jump_unit Scene.use_audio Scene.use_audio_scrub
        Scene.use_custom_simulation_range Scene.use_gravity Scene.use_preview_range
    """,
    UNREAD: """
        CyclesVisibilitySettings.shadow CyclesWorldSettings.volume_interpolation
    """,
    OUTPUT: """
        Scene.compositing_node_group Scene.use_nodes Scene.use_stamp_note
        RenderSettings.compositor_denoise_device RenderSettings.compositor_denoise_final_quality
        RenderSettings.compositor_denoise_preview_quality RenderSettings.compositor_device
        RenderSettings.compositor_precision RenderSettings.dither_intensity RenderSettings.engine
        RenderSettings.filepath RenderSettings.fps RenderSettings.metadata_input RenderSettings.ppm_base
        RenderSettings.ppm_factor RenderSettings.sequencer_gl_preview RenderSettings.stamp_background
        RenderSettings.stamp_font_size RenderSettings.stamp_foreground RenderSettings.stamp_note_text
        RenderSettings.use_compositing RenderSettings.use_crop_to_border RenderSettings.use_file_extension
        RenderSettings.use_lock_interface RenderSettings.use_overwrite RenderSettings.use_persistent_data
        RenderSettings.use_placeholder RenderSettings.use_render_cache RenderSettings.use_sequencer
        RenderSettings.use_sequencer_override_scene_strip RenderSettings.use_single_layer RenderSettings.use_stamp
        RenderSettings.use_stamp_frame_range RenderSettings.use_stamp_hostname RenderSettings.use_stamp_labels
        RenderSettings.use_stamp_lens RenderSettings.use_stamp_marker RenderSettings.use_stamp_memory
        RenderSettings.use_stamp_note RenderSettings.use_stamp_render_time RenderSettings.use_stamp_sequencer_strip
        SceneRenderView.camera_suffix SceneRenderView.file_suffix
    """,
    NOISE: """
        CyclesLightSettings.use_multiple_importance_sampling CyclesMaterialSettings.emission_sampling
        CyclesMaterialSettings.volume_sampling CyclesRenderSettings.auto_scrambling_distance
        CyclesRenderSettings.debug_bvh_layout CyclesRenderSettings.debug_bvh_time_steps
        CyclesRenderSettings.debug_bvh_type CyclesRenderSettings.debug_use_compact_bvh
        CyclesRenderSettings.debug_use_cpu_avx2 CyclesRenderSettings.debug_use_cpu_sse42
        CyclesRenderSettings.debug_use_cuda_adaptive_compile CyclesRenderSettings.debug_use_hair_bvh
        CyclesRenderSettings.debug_use_hip_adaptive_compile CyclesRenderSettings.debug_use_metal_adaptive_compile
        CyclesRenderSettings.debug_use_optix_debug CyclesRenderSettings.debug_use_spatial_splits
        CyclesRenderSettings.denoiser CyclesRenderSettings.denoising_use_gpu CyclesRenderSettings.device
        CyclesRenderSettings.direct_light_sampling_type CyclesRenderSettings.guiding_directional_sampling_type
        CyclesRenderSettings.guiding_distribution_type CyclesRenderSettings.guiding_roughness_threshold
        CyclesRenderSettings.guiding_training_samples CyclesRenderSettings.light_sampling_threshold
        CyclesRenderSettings.min_light_bounces CyclesRenderSettings.min_transparent_bounces
        CyclesRenderSettings.preview_denoiser CyclesRenderSettings.preview_denoising_use_gpu
        CyclesRenderSettings.preview_scrambling_distance CyclesRenderSettings.scrambling_distance
        CyclesRenderSettings.shading_system CyclesRenderSettings.surface_guiding_probability
        CyclesRenderSettings.tile_size CyclesRenderSettings.use_auto_tile
        CyclesRenderSettings.use_deterministic_guiding CyclesRenderSettings.use_guiding
        CyclesRenderSettings.use_guiding_direct_light CyclesRenderSettings.use_guiding_mis_weights
        CyclesRenderSettings.use_light_tree CyclesRenderSettings.use_surface_guiding
        CyclesRenderSettings.use_volume_guiding CyclesRenderSettings.volume_guiding_probability
        CyclesWorldSettings.sample_map_resolution CyclesWorldSettings.sampling_method
        CyclesWorldSettings.volume_sampling CyclesRenderSettings.bake_type
    """,
    APPROXIMATED: """
        CyclesLightSettings.is_caustics_light CyclesMaterialSettings.volume_step_rate
        CyclesObjectSettings.is_caustics_caster CyclesObjectSettings.is_caustics_receiver
        CyclesRenderSettings.volume_max_steps
        CyclesRenderSettings.volume_step_rate CyclesWorldSettings.is_caustics_light
        CyclesWorldSettings.volume_step_size VolumeRender.step_size
    """,
    OF_NAMED: """
        Camera.custom_bytecode Camera.custom_bytecode_hash Camera.custom_filepath Camera.custom_mode
        Camera.custom_shader CameraStereoData.pole_merge_angle_from CameraStereoData.pole_merge_angle_to
        CameraStereoData.use_pole_merge CyclesObjectSettings.ao_distance CyclesRenderSettings.ao_bounces
        CyclesRenderSettings.ao_bounces_render CyclesRenderSettings.fast_gi_method
        CyclesRenderSettings.film_transparent_roughness
        CyclesRenderSettings.sample_offset CyclesRenderSettings.sample_subset_length RenderSettings.threads
        WorldLighting.distance
    """,
}

PARTS_OF_NODES = {
    "texture_mapping": "mapping max min use_max use_min",
    "color_mapping": "blend_color blend_factor blend_type brightness contrast saturation use_color_ramp",
    "image_user": "frame_current frame_duration frame_offset frame_start tile use_auto_refresh use_cyclic",
    "color_ramp": "hue_interpolation",
    "mapping": "black_level clip_max_x clip_max_y clip_min_x clip_min_y tone use_clip white_level",
}
"""Properties of structs of shader nodes that neither engine reads, that count for movies and sequences only, or that
Blender has evaluated in the curves."""
KINDS_OF_NODES = {
    "ShaderNodeEeveeSpecular": "black, as in Cycles, and named",
    "ShaderNodeScript": "Cycles runs them with Open Shading Language only; what they feed is named",
    "ShaderNodeShaderToRGB": "EEVEE's; what it feeds is named",
    "ShaderNodeSqueeze": "Blender's own panels do not offer it; what it feeds is named",
    "ShaderNodeTexSky": "rendered; a sky takes seconds to compute, and tests/parity/skies compares them by value",
    "ShaderNodeUVAlongStroke": "Freestyle's",
}
"""Shader nodes whose properties are not changed one by one, and why."""
PROPERTIES_OF_NODES = "ShaderNodeMixRGB.use_alpha"
"""Properties that Cycles does not read either."""
