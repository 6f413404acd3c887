# SPDX-License-Identifier: GPL-3.0-or-later
# Four times the default's iterations, and paths through several glasses in a row.
import bpy

settings = bpy.context.scene.rppm

settings.iterations = 512
settings.photons = 0
settings.direct_light = "RAYS"
settings.final_gather = True
settings.camera_path_length = 16
settings.photon_path_length = 12
settings.radius_scale = 10.0
settings.alpha = 0.7
