# SPDX-License-Identifier: GPL-3.0-or-later
"""Stages that draw random numbers of their own."""

import enum

from ....gl.buffers.constants import Constants


@enum.unique
class RandomStage(enum.IntEnum):
    """Purposes of random numbers. The numbers of one stage are independent of those of another."""

    EMISSION = 1
    PHOTONS = 2
    IMPORTONS = 3
    DIRECT_LIGHT = 4
    RESOLVE = 5
    SPLATTING = 6
    GATHERING = 7
    CAMERA = 8
    SHADOW_CATCHER = 9
    WAVELENGTH = 10
    SUBSURFACE = 11
    SUBSURFACE_PHOTONS = 12
    NODE_RAYS = 13
    COVERAGE = 14
    MEDIA = 15
    IN_SCATTERING = 16
    MEDIUM_PHOTONS = 17
    AMBIENT_OCCLUSION = 18
    CAMERA_SCATTERING = 19


Constants("RandomStages", STAGE=RandomStage)
