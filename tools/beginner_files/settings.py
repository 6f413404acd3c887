# SPDX-License-Identifier: GPL-3.0-or-later
"""Render settings, film, color management, cameras, view layers and scenes."""

import functools

import bpy

from rppm_addon.commands.blend_files.data_paths import set_data_path

from .files import ball, cube, file, monkey, plain, start

SETTINGS = {
    "border": {"render.use_border": "true", "render.border_min_x": "0.3", "render.border_max_y": "0.7"},
    "border_cropped": {
        "render.use_border": "true",
        "render.use_crop_to_border": "true",
        "render.border_min_x": "0.3",
        "render.border_max_y": "0.7",
    },
    "percentage": {"render.resolution_percentage": "75"},
    "pixel_aspect": {"render.pixel_aspect_x": "2.0"},
    "pixel_aspect_tall": {"render.pixel_aspect_y": "1.7"},
    "portrait": {"render.resolution_x": "48", "render.resolution_y": "64"},
    "overscan": {"eevee.use_overscan": "true", "eevee.overscan_size": "10"},
    "transparent": {"render.film_transparent": "true"},
    "exposure": {"cycles.film_exposure": "2.5"},
    "view_exposure": {"view_settings.exposure": "2.0"},
    "view_gamma": {"view_settings.gamma": "2.0"},
    "view_standard": {"view_settings.view_transform": "Standard"},
    "view_look": {"view_settings.look": "AgX - Punchy"},
    "display_none": {"display_settings.display_device": "Display P3"},
    "simplify": {"render.use_simplify": "true", "render.simplify_subdivision_render": "0"},
    "motion_blur": {"render.use_motion_blur": "true"},
    "freestyle": {"render.use_freestyle": "true"},
    "stereo": {"render.use_multiview": "true"},
    "high_quality_normals": {"render.use_high_quality_normals": "true"},
    "persistent_data": {"render.use_persistent_data": "true"},
    "fast_gi": {"cycles.use_fast_gi": "true"},
    "light_tree_off": {"cycles.use_light_tree": "false"},
    "frame_50": {"frame_current": "50"},
}


def _settings(values: dict[str, str]) -> None:
    scene = start()
    thing = monkey()
    thing.modifiers.new("Subdivision", "SUBSURF")
    thing.keyframe_insert("location", frame=1)
    thing.location.x += 0.5
    thing.keyframe_insert("location", frame=3)
    scene.frame_set(1)
    for path, value in values.items():
        set_data_path((scene, bpy.data), path, value)


for name, values in SETTINGS.items():
    file(f"render_{name}", functools.partial(_settings, values))

CAMERAS = {
    "orthographic": {"type": "ORTHO"},
    "panorama": {"type": "PANO"},
    "custom": {"type": "CUSTOM"},
    "wide": {"lens": 8.0},
    "long": {"lens": 200.0},
    "shifted": {"shift_x": 0.2, "shift_y": -0.15},
    "vertical_fit": {"sensor_fit": "VERTICAL", "sensor_height": 10.0},
    "clipped": {"clip_start": 4.6, "clip_end": 5.4},
    "focus": {"dof.use_dof": True, "dof.focus_distance": 3.0, "dof.aperture_fstop": 0.3},
    "background_image": {"show_background_images": True},
}


def _camera(values: dict[str, object]) -> None:
    scene = start()
    monkey()
    for path, value in values.items():
        owner = scene.camera.data
        *parts, name = path.split(".")
        for part in parts:
            owner = getattr(owner, part)
        setattr(owner, name, value)


for name, values in CAMERAS.items():
    file(f"camera_{name}", functools.partial(_camera, values))


def _camera_object(kind: str) -> None:
    scene = start()
    monkey()
    if kind == "scaled":
        scene.camera.scale = (3.0, 0.5, 2.0)
    elif kind == "negative":
        scene.camera.scale = (-1.0, 1.0, 1.0)
    elif kind == "empty":
        bpy.ops.object.empty_add(location=scene.camera.location, rotation=scene.camera.rotation_euler)
        scene.camera = bpy.context.object
    elif kind == "lamp":
        scene.camera = bpy.data.objects["Light"]
    elif kind == "missing":
        bpy.data.objects.remove(scene.camera)
    elif kind == "marker":
        other = scene.camera.copy()
        other.location = (0.5, -4.0, 1.0)
        other.rotation_euler = (1.4, 0.0, 0.1)
        scene.collection.objects.link(other)
        scene.timeline_markers.new("Other", frame=1).camera = other
        scene.frame_set(1)
    elif kind == "inside_a_cube":
        thing = cube(20.0)
        thing.data.materials[0] = plain((0.5, 0.5, 0.8))
    elif kind == "focus_object":
        scene.camera.data.dof.use_dof, scene.camera.data.dof.aperture_fstop = True, 0.3
        scene.camera.data.dof.focus_object = bpy.data.objects["Suzanne"]


for kind in ("scaled", "negative", "empty", "lamp", "missing", "marker", "inside_a_cube", "focus_object"):
    file(f"camera_{kind}", functools.partial(_camera_object, kind))


def _layers(kind: str) -> None:
    scene = start()
    thing = monkey()
    ball(plain((0.1, 0.2, 0.8))).location = (1.2, 1.2, 0.0)
    if kind == "scenes":
        bpy.ops.scene.new(type="FULL_COPY")
        bpy.context.scene.objects[0].location.z += 0.5
        return
    if kind == "background_scene":
        other = bpy.data.scenes.new("Set")
        bpy.context.window.scene = other
        cube(1.0).location = (-1.2, -0.6, 0.0)
        bpy.context.window.scene = scene
        scene.background_set = other
        return
    layer = bpy.context.view_layer
    if kind == "material_override":
        layer.material_override = plain((0.1, 0.7, 0.3))
    elif kind == "world_override":
        layer.world_override = bpy.data.worlds.new("Other")
        layer.world_override.color = (0.9, 0.1, 0.1)
    elif kind == "samples":
        layer.samples = 3
    elif kind == "no_solid":
        layer.use_solid = False
    elif kind == "no_sky":
        layer.use_sky = False
    elif kind == "unused":
        layer.use = False
        scene.view_layers.new("Second")
    elif kind == "no_strand":
        layer.use_strand = False
        thing.modifiers.new("Hair", "PARTICLE_SYSTEM")
        bpy.data.particles[0].type = "HAIR"
    elif kind == "second":
        other = scene.view_layers.new("Second")
        other.layer_collection.children[0].exclude = True


for kind in [
    "scenes",
    "background_scene",
    "material_override",
    "world_override",
    "samples",
    "no_solid",
    "no_sky",
    "unused",
    "no_strand",
    "second",
]:
    file(f"layers_{kind}", functools.partial(_layers, kind))
