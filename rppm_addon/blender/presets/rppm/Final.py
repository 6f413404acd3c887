# SPDX-License-Identifier: GPL-3.0-or-later
# Four times the default's iterations, and paths through several glasses in a row.
import bpy

settings = bpy.context.scene.rppm

settings.samples = 512
settings.photons = 0
settings.direct_light = "RAYS"
settings.use_final_gather = True
settings.max_camera_bounces = 15
settings.max_photon_bounces = 11
settings.radius_scale = 10.0
settings.alpha = 0.7
