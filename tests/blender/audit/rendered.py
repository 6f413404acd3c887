# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties that RPPM renders by or that a warning names, by the stage in which test_audit.py shows it.

A property of a base type, such as the power of a light that all lights have, is that of the base type.
"""

RENDERED = {
    "lamps": """
        AOV.is_valid AOV.type AreaLight.energy AreaLight.shape AreaLight.size AreaLight.size_y AreaLight.spread
        Camera.angle Camera.clip_end Camera.clip_start Camera.lens Camera.sensor_fit Camera.sensor_width
        Camera.shift_x Camera.shift_y Camera.type CameraDOFSettings.focus_object CameraDOFSettings.use_dof
        CyclesLightSettings.is_portal CyclesLightSettings.max_bounces CyclesRenderLayerSettings.pass_render_time
        CyclesRenderLayerSettings.use_pass_volume_majorant CyclesRenderLayerSettings.use_pass_volume_scatter
        CyclesRenderLayerSettings.use_pass_volume_transmit CyclesRenderSettings.use_fast_gi
        CyclesRenderSettings.use_sample_subset CyclesRenderSettings.volume_biased ViewLayer.pass_alpha_threshold
        CyclesMaterialSettings.use_bump_map_correction
        CyclesRenderSettings.sampling_pattern CyclesVisibilitySettings.camera
        CyclesVisibilitySettings.diffuse CyclesVisibilitySettings.glossy CyclesVisibilitySettings.scatter
        CyclesVisibilitySettings.transmission CyclesWorldSettings.max_bounces Light.color Light.exposure
        Light.normalize Light.type Light.use_nodes Light.use_shadow Light.use_temperature Material.pass_index
        Material.use_transparent_shadow MaterialSlot.material Object.color Object.delta_location
        Object.delta_rotation_euler Object.delta_scale Object.dimensions Object.hide_render Object.is_holdout
        Object.is_shadow_catcher Object.lightgroup Object.location Object.parent Object.pass_index
        Object.rotation_euler Object.rotation_mode Object.scale Object.shadow_terminator_geometry_offset
        Object.shadow_terminator_shading_offset Object.visible_camera Object.visible_diffuse Object.visible_glossy
        Object.visible_shadow Object.visible_transmission Object.visible_volume_scatter
        ObjectLightLinking.blocker_collection ObjectLightLinking.receiver_collection PointLight.energy
        PointLight.shadow_soft_size PointLight.use_soft_falloff RenderSettings.film_transparent
        RenderSettings.fps_base RenderSettings.pixel_aspect_x RenderSettings.pixel_aspect_y
        RenderSettings.resolution_x RenderSettings.resolution_y RenderSettings.threads_mode RenderSettings.use_border
        RenderSettings.use_motion_blur RenderSettings.use_multiview RenderSettings.use_stamp_camera
        RenderSettings.use_stamp_date RenderSettings.use_stamp_filename RenderSettings.use_stamp_frame
        RenderSettings.use_stamp_scene RenderSettings.use_stamp_time Scene.camera Scene.world SpotLight.energy
        SpotLight.shadow_soft_size SpotLight.spot_blend SpotLight.spot_size SpotLight.use_soft_falloff SunLight.angle
        SunLight.energy ViewLayer.material_override ViewLayer.pass_cryptomatte_depth ViewLayer.samples
        ViewLayer.use_pass_ambient_occlusion ViewLayer.use_pass_cryptomatte_asset
        ViewLayer.use_pass_cryptomatte_material ViewLayer.use_pass_cryptomatte_object ViewLayer.use_pass_diffuse_color
        ViewLayer.use_pass_diffuse_direct ViewLayer.use_pass_diffuse_indirect ViewLayer.use_pass_emit
        ViewLayer.use_pass_environment ViewLayer.use_pass_glossy_color ViewLayer.use_pass_glossy_direct
        ViewLayer.use_pass_glossy_indirect ViewLayer.use_pass_grease_pencil ViewLayer.use_pass_material_index
        ViewLayer.use_pass_mist ViewLayer.use_pass_normal ViewLayer.use_pass_object_index ViewLayer.use_pass_position
        ViewLayer.use_pass_shadow ViewLayer.use_pass_subsurface_color ViewLayer.use_pass_subsurface_direct
        ViewLayer.use_pass_subsurface_indirect ViewLayer.use_pass_transmission_color
        ViewLayer.use_pass_transmission_direct ViewLayer.use_pass_transmission_indirect ViewLayer.use_pass_uv
        ViewLayer.use_pass_vector ViewLayer.use_pass_z ViewLayer.use_sky ViewLayer.use_solid World.lightgroup
        WorldMistSettings.depth WorldMistSettings.falloff WorldMistSettings.start
    """,
    "moving": """
        Scene.frame_current Scene.frame_subframe CyclesObjectSettings.motion_steps
        CyclesObjectSettings.use_deform_motion CyclesObjectSettings.use_motion_blur
        CyclesRenderSettings.rolling_shutter_duration CyclesRenderSettings.rolling_shutter_type
        RenderSettings.frame_map_new RenderSettings.frame_map_old
        RenderSettings.motion_blur_position RenderSettings.motion_blur_shutter ViewLayer.use_motion_blur
        Volume.velocity_grid Volume.velocity_scale Volume.velocity_unit
    """,
    "strands": """
        CyclesCurveRenderSettings.shape CyclesCurveRenderSettings.subdivisions Object.instance_type
        Object.show_instancer_for_render ParticleSettings.radius_scale ParticleSettings.render_type
        ParticleSettings.root_radius ParticleSettings.shape ParticleSettings.tip_radius ParticleSettings.use_close_tip
        ViewLayer.use_strand
    """,
    "multiplied": "Object.instance_collection Object.use_instance_vertices_rotation Scene.background_set",
    "lens": """
        Camera.sensor_height CameraDOFSettings.aperture_blades CameraDOFSettings.aperture_fstop
        CameraDOFSettings.aperture_ratio CameraDOFSettings.aperture_rotation CameraDOFSettings.focus_distance
        CyclesRenderLayerSettings.pass_debug_sample_count CyclesRenderLayerSettings.denoising_store_passes
        CyclesRenderLayerSettings.use_pass_shadow_catcher CyclesRenderLayerSettings.use_pass_volume_direct
        CyclesRenderLayerSettings.use_pass_volume_indirect CyclesRenderSettings.film_transparent_glass
        Light.temperature RenderSettings.border_max_x RenderSettings.border_max_y RenderSettings.border_min_x
        RenderSettings.border_min_y RenderSettings.resolution_percentage
    """,
    "eyes": """
        CameraStereoData.convergence_distance CameraStereoData.convergence_mode CameraStereoData.interocular_distance
        CameraStereoData.pivot RenderSettings.views_format SceneRenderView.use
    """,
    "layers": "CyclesRenderLayerSettings.use_denoising CyclesRenderSettings.use_layer_samples ViewLayer.world_override",
    "diced": """
        CyclesRenderSettings.dicing_camera CyclesRenderSettings.dicing_rate CyclesRenderSettings.max_subdivisions
        CyclesRenderSettings.offscreen_dicing_scale Material.displacement_method
    """,
    "orthographic": "Camera.ortho_scale",
    "panoramas": """
        Camera.fisheye_fov Camera.fisheye_lens Camera.fisheye_polynomial_k0 Camera.fisheye_polynomial_k1
        Camera.fisheye_polynomial_k2 Camera.fisheye_polynomial_k3 Camera.fisheye_polynomial_k4 Camera.panorama_type
    """,
    "equirectangular": "Camera.latitude_max Camera.latitude_min Camera.longitude_max Camera.longitude_min",
    "cylinder": """
        Camera.central_cylindrical_radius Camera.central_cylindrical_range_u_max
        Camera.central_cylindrical_range_u_min Camera.central_cylindrical_range_v_max
        Camera.central_cylindrical_range_v_min
    """,
    "panoramic_eyes": "CameraStereoData.use_spherical_stereo",
    "materials": "Image.alpha_mode Image.filepath Image.source LayerCollection.holdout LayerCollection.indirect_only",
    "volumes": """
        CyclesMaterialSettings.volume_interpolation ViewLayer.use_volumes Volume.filepath VolumeRender.clipping
        VolumeRender.space
    """,
    "simplified": """
        CyclesObjectSettings.use_camera_cull CyclesObjectSettings.use_distance_cull
        CyclesRenderSettings.camera_cull_margin CyclesRenderSettings.distance_cull_margin
        CyclesRenderSettings.texture_limit_render CyclesRenderSettings.use_camera_cull
        CyclesRenderSettings.use_distance_cull RenderSettings.use_simplify
        RenderSettings.simplify_child_particles_render RenderSettings.simplify_subdivision_render
    """,
}
