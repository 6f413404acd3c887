# SPDX-License-Identifier: GPL-3.0-or-later
"""Which device this Blender renders on: of the environment, or of the user's preferences for this machine."""

import contextlib
import json
import os
import platform

import bpy

from .denoising_libraries import root_package

VARIABLE = "RPPM_DEVICE"


def device_of_environment() -> str:
    """The number that RPPM_DEVICE or --rppm-device say; "" where they say none."""
    return os.environ.get(VARIABLE, "")


def chosen_device() -> str:
    """The number of an EGL device; "" is the driver's default. Main thread only."""
    addon = bpy.context.preferences.addons.get(root_package())
    preferences = None if addon is None else addon.preferences
    return device_of_environment() or ("" if preferences is None else device_here(preferences.devices))


def device_here(devices: str) -> str:
    """What ``devices``, numbers by machine as JSON, say of this one; "" where they say nothing."""
    chosen = _by_machine(devices).get(platform.node(), "")
    return chosen if isinstance(chosen, str) and chosen.isdigit() else ""


def with_device_here(devices: str, number: str) -> str:
    """``devices`` with another number for this machine; "" is none."""
    kept = {machine: chosen for machine, chosen in _by_machine(devices).items() if machine != platform.node()}
    return json.dumps(kept | ({platform.node(): number} if number else {}))


def _by_machine(devices: str) -> dict[str, object]:
    with contextlib.suppress(ValueError):
        found = json.loads(devices)
        if isinstance(found, dict):
            return found
    return {}
