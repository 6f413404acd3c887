# SPDX-License-Identifier: GPL-3.0-or-later
# Four times the default's iterations, and paths through several glasses in a row.
import bpy

settings = bpy.context.scene.rppm

settings.samples = 512
settings.photons = 0
settings.direct_light = "RAYS"
settings.use_final_gather = True
settings.max_bounces = 64
settings.transparent_max_bounces = 16
settings.max_camera_bounces = 1024
settings.max_photon_bounces = 1024
settings.radius_scale = 10.0
settings.alpha = 0.7
