# SPDX-License-Identifier: GPL-3.0-or-later
# The defaults.
import bpy

settings = bpy.context.scene.rppm

settings.iterations = 128
settings.photons = 0
settings.direct_light = "RAYS"
settings.final_gather = True
settings.camera_path_length = 8
settings.photon_path_length = 8
settings.radius_scale = 10.0
settings.alpha = 0.7
