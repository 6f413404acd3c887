# SPDX-License-Identifier: GPL-3.0-or-later
# A quarter of the default's iterations; wide disks hide that photons are few.
import bpy

settings = bpy.context.scene.rppm

settings.iterations = 32
settings.photons = 0
settings.direct_light = "RAYS"
settings.final_gather = True
settings.camera_path_length = 6
settings.photon_path_length = 6
settings.radius_scale = 15.0
settings.alpha = 0.7
