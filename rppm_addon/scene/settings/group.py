# SPDX-License-Identifier: GPL-3.0-or-later
"""Base class of settings: validation, and values by name as users give them."""

import dataclasses
import enum
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

from ..errors import SettingsError
from .setting_info import settings_of


@dataclass
class SettingGroup:
    """Base of dataclasses whose fields are settings (scene/settings/setting_info.py)."""

    def validate(self) -> None:
        """Raise SettingsError naming the first setting that cannot be used, and its range."""
        for name, info in settings_of(type(self)).items():
            if not info.accepts(getattr(self, name)):
                raise SettingsError(f"{info.shown(name, getattr(self, name))}; set it to {info.range_text}")

    def with_values(self, **values: object) -> Self:
        """A copy with some fields replaced; enumerations may be given by name.

        Raises SettingsError for an unknown name or a value of the wrong kind.
        """
        known = settings_of(type(self))
        for name in values:
            if name not in known:
                raise SettingsError(f"there is no setting {name}; the settings are {', '.join(known)}")
        changed = {name: _converted(name, type(getattr(self, name)), value) for name, value in values.items()}
        return dataclasses.replace(self, **changed)

    def with_properties(self, values: Mapping[str, object]) -> Self:
        """A copy with some settings replaced by the names that users know them by; values may be text, as from the
        command line.

        Raises SettingsError for an unknown name or a value of the wrong kind.
        """
        fields = {info.property_of(name): (name, info) for name, info in settings_of(type(self)).items()}
        converted: dict[str, Any] = {}
        for given, value in values.items():
            if given not in fields:
                raise SettingsError(f"there is no setting {given}; the settings are {', '.join(fields)}")
            name, info = fields[given]
            converted[name] = _converted(given, type(getattr(self, name)), value, info.property_offset)
        return dataclasses.replace(self, **converted)


def _converted(name: str, kind: type[Any], value: Any, offset: int = 0) -> Any:
    """A value, perhaps text, as the field has it; ``offset``: what users see more."""
    try:
        if kind is bool and isinstance(value, str):
            return {"true": True, "1": True, "false": False, "0": False}[value.lower()]
        if kind is tuple:
            names = value.split(",") if isinstance(value, str) else value
            return tuple(text for item in names if (text := item.strip()))
        if issubclass(kind, enum.Enum):
            return value if isinstance(value, kind) else kind[str(value).upper()]
        return kind(value) - offset if offset else kind(value)
    except (KeyError, ValueError, TypeError, AttributeError, OverflowError) as error:
        raise SettingsError(f"{name} cannot be {value!r}; it takes a {kind.__name__}") from error
