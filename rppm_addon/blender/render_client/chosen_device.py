# SPDX-License-Identifier: GPL-3.0-or-later
"""Which device this Blender renders on: of the environment, or of the user's preferences for this machine."""

import contextlib
import json
import os
import platform
from typing import NamedTuple

import bpy

from .denoising_libraries import root_package

VARIABLE = "RPPM_DEVICE"


class ChosenDevice(NamedTuple):
    """A device of the preferences: how it is found again, and what the menu calls it."""

    identity: str
    name: str


def device_of_environment() -> str:
    """Return the device that RPPM_DEVICE or --rppm-device names; "" where neither names one."""
    return os.environ.get(VARIABLE, "")


def chosen_device() -> str:
    """The device, as RPPM_DEVICE takes it; "" is RPPM's choice. Main thread only.

    Without the preferences' device another will do: they may be of a time when it was there.
    """
    addon = bpy.context.preferences.addons.get(root_package())
    preferences = None if addon is None else addon.preferences
    chosen = None if preferences is None else device_here(preferences.devices)
    return device_of_environment() or ("" if chosen is None else f"{chosen.identity}?{chosen.name}")


def device_here(devices: str) -> ChosenDevice | None:
    """Return this machine's device in ``devices``, devices by machine as JSON; None where they name none."""
    chosen = _by_machine(devices).get(platform.node())
    match chosen:
        case [str(identity), str(name)] if identity:
            return ChosenDevice(identity, name)
    return None


def with_device_here(devices: str, chosen: ChosenDevice | None) -> str:
    """``devices`` with another device for this machine; None is RPPM's choice."""
    kept = {machine: device for machine, device in _by_machine(devices).items() if machine != platform.node()}
    return json.dumps(kept | ({platform.node(): chosen} if chosen else {}))


def _by_machine(devices: str) -> dict[str, object]:
    with contextlib.suppress(ValueError):
        found = json.loads(devices)
        if isinstance(found, dict):
            return found
    return {}
