# SPDX-License-Identifier: GPL-3.0-or-later
"""The uniform block Iteration for programs that are run by themselves."""

import moderngl

from rppm_addon.gl.context.context import Context
from rppm_addon.integrator.device_scene.iteration_parameters import ITERATION_PARAMETERS
from rppm_addon.scene.lights import UNLIMITED_BOUNCES

_UNLIMITED = ("max_bounces", "transparent_max_bounces", "camera_bounces", "photon_bounces")


def iteration_buffer(context: Context, **values: object) -> moderngl.Buffer:
    """A buffer of IterationParameters with these values, no limits of bounces, and 0 for the rest."""
    given = dict.fromkeys((member.name for member in ITERATION_PARAMETERS.members), 0)
    return context.moderngl.buffer(
        ITERATION_PARAMETERS.pack({**given, **dict.fromkeys(_UNLIMITED, UNLIMITED_BOUNCES), **values})
    )
