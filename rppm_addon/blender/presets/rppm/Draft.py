# SPDX-License-Identifier: GPL-3.0-or-later
# A quarter of the default's iterations; wide disks hide that photons are few.
import bpy

settings = bpy.context.scene.rppm

settings.samples = 32
settings.photons = 0
settings.direct_light = "RAYS"
settings.use_final_gather = True
settings.max_bounces = 12
settings.transparent_max_bounces = 8
settings.max_camera_bounces = 1024
settings.max_photon_bounces = 1024
settings.radius_scale = 15.0
settings.alpha = 0.7
