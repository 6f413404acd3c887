# SPDX-License-Identifier: GPL-3.0-or-later
"""Declarations of settings: the range, unit and texts of each.

Validation, Blender's properties, the command line's help and docs/settings.md follow from it.
"""

import dataclasses
import enum
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

_KEY = "setting"
_SLACK = 2.0**-23
"""Blender's properties are of single precision."""


@dataclass(frozen=True)
class SettingInfo:
    """A setting as users see it."""

    label: str
    """Its name in panels, as Cycles has it where Cycles has the setting."""
    description: str
    """Its tooltip, without a period at the end."""
    minimum: float | None = None
    maximum: float | None = None
    """Range, both ends included; None is no bound."""
    soft_minimum: float | None = None
    soft_maximum: float | None = None
    """Range of Blender's sliders, where narrower."""
    unit: str = ""
    """"m", "s", "pixels", or "fraction" for what is shown as a slider from 0 to 1."""
    zero: str = ""
    """Meaning of the value 0: "automatic", "no limit"."""
    precision: int = 0
    """Digits after the point that Blender shows; 0 is Blender's own."""
    step: int = 0
    """Step of Blender's buttons; 0 is Blender's own."""
    choices: Mapping[enum.Enum, tuple[str, str]] = field(default_factory=dict)
    """Label and description of each member of an enumeration, in the order of the menu."""
    property_name: str = ""
    """Its name in Blender and on the command line, where that is not the field's."""
    property_offset: int = 0
    """Number added to the field's value for users: -1 where a path of 8 segments has 7 bounces."""
    where: str = ""
    """Place of the setting in Blender, or "nowhere", if it is no property of scene.rppm."""

    def property_of(self, name: str) -> str:
        """The name that users know the field ``name`` by."""
        return self.property_name or name

    def shown(self, name: str, value: Any) -> str:
        """Return the text by which messages give the value of the field ``name``, as users see both."""
        seen = value + self.property_offset if self.property_offset else value
        return f"{self.property_of(name)} is {seen}"

    @property
    def range_text(self) -> str:
        """Text of the accepted values, for messages and documents: ``0 (automatic) or 1 to 4194304``."""
        low, high = (bound if bound is None else bound + self.property_offset for bound in (self.minimum, self.maximum))
        special = f"0 ({self.zero})" if self.zero else ""
        if special and low == 0:
            low = None if high is None else 1
        unit = {"": "", "fraction": "", "m": " meters", "s": " seconds"}.get(self.unit, f" {self.unit}")
        if low is not None and high is not None:
            text = f"{low:g} to {_plain(high)}{unit}"
        elif low is not None:
            text = f"{low:g}{unit} or more"
        else:
            text = unit.strip() or "any number"
        return f"{special} or {text}" if special else text

    def accepts(self, value: object) -> bool:
        """Whether a value is finite and in the range, or as near to it as single precision has its ends."""
        if isinstance(value, bool) or not isinstance(value, int | float):
            return True
        low = -math.inf if self.minimum is None else self.minimum - _SLACK * abs(self.minimum)
        high = math.inf if self.maximum is None else self.maximum + _SLACK * abs(self.maximum)
        return math.isfinite(value) and low <= value <= high


def _plain(value: float) -> str:
    return str(int(value)) if float(value).is_integer() else f"{value:g}"


def setting(default: Any, label: str, description: str, **more: Any) -> Any:
    """A dataclass field that is a setting; arguments as SettingInfo's."""
    return dataclasses.field(default=default, metadata={_KEY: SettingInfo(label, description, **more)})


def settings_of(owner: type) -> dict[str, SettingInfo]:
    """All settings of a dataclass by name, in their order."""
    return {entry.name: entry.metadata[_KEY] for entry in dataclasses.fields(owner) if _KEY in entry.metadata}
