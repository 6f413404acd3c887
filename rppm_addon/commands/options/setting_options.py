# SPDX-License-Identifier: GPL-3.0-or-later
"""Options of the rppm program that follow from the declarations of the render settings."""

import argparse
import enum
from collections.abc import Callable
from typing import Any

from ...scene import RenderSettings
from ...scene.errors import SettingsError
from ...scene.settings.setting_info import SettingInfo, settings_of

_DEFAULTS = RenderSettings()
_INFOS = settings_of(RenderSettings)
_APART = {"denoising_start_sample", "iterations"}
"""Fields without an option, as viewports alone have them, or with one among others of which one can be given."""


def add_settings(command: argparse.ArgumentParser) -> None:
    """An option for each setting: --max-camera-bounces N, --use-final-gather, --no-use-final-gather."""
    group = command.add_argument_group("render settings", "in place of the file's; docs/settings.md lists them")
    for name in _INFOS:
        if name not in _APART:
            add_setting(group, name)


def add_setting(group: Any, name: str) -> None:
    """The option of the setting that is the field ``name`` of RenderSettings, in a group of argparse."""
    info, default = _INFOS[name], getattr(_DEFAULTS, name)
    shown = info.property_of(name)
    option, text = f"--{shown.replace('_', '-')}", info.description.replace("%", "%%")
    if isinstance(default, bool):
        group.add_argument(option, action=argparse.BooleanOptionalAction, default=None, help=text)
        return
    group.add_argument(option, type=_reader(shown), metavar=_metavar(default, info), help=text)


def _metavar(default: object, info: SettingInfo) -> str:
    if isinstance(default, enum.Enum):
        return "|".join(member.name for member in info.choices)
    if isinstance(default, tuple):
        return "NAME,NAME,..."
    return {"s": "SECONDS", "m": "METERS"}.get(info.unit, "N")


def _reader(shown: str) -> Callable[[str], str]:
    """An argparse type that leaves text as it is, once it is a value of the setting."""

    def read(text: str) -> str:
        try:
            RenderSettings().with_properties({shown: text}).validate()
        except SettingsError as error:
            raise argparse.ArgumentTypeError(str(error)) from error
        return text

    return read


def given_settings(options: argparse.Namespace) -> dict[str, object]:
    """By the names that users know settings by, those that options gave, most of them as text. Who gives a noise
    threshold wants it to be used."""
    shown = (info.property_of(name) for name, info in _INFOS.items())
    given = {name: value for name in shown if (value := getattr(options, name, None)) is not None}
    return {"use_adaptive_sampling": True, **given} if "adaptive_threshold" in given else given
