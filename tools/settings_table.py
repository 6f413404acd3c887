# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the table of docs/settings.md anew from what RenderSettings says of its fields."""

import enum
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "settings.md"
BEGIN, END = "<!-- begin: tools/settings_table.py -->", "<!-- end -->"
sys.path.insert(0, str(ROOT))

from rppm_addon.scene import RenderSettings  # noqa: E402
from rppm_addon.scene.settings.setting_info import SettingInfo, settings_of  # noqa: E402


def table() -> str:
    """The settings by the names of users, with defaults, ranges and tooltips, in Markdown."""
    lines = ["| setting | `scene.rppm.` and `--set rppm.` | default | values | what it does |", "|---|---|---|---|---|"]
    defaults = RenderSettings()
    for name, info in settings_of(RenderSettings).items():
        default = getattr(defaults, name)
        lines.append(
            f"| {info.label} | {_place(name, info)} | {_default(default, info)} | {_values(default, info)} "
            f"| {info.description} |"
        )
    return "\n".join(lines)


def _place(name: str, info: SettingInfo) -> str:
    return f"`{info.property_of(name)}`" + (f"; in Blender {info.where}" if info.where else "")


def _default(value: object, info: SettingInfo) -> str:
    if isinstance(value, enum.Enum):
        return info.choices[value][0]
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, tuple):
        return ", ".join(value)
    if not value and info.zero:
        return info.zero
    return f"{value + info.property_offset:g}"


def _values(default: object, info: SettingInfo) -> str:
    if info.choices:
        return ", ".join(f"`{member.name}`" for member in info.choices)
    if isinstance(default, bool):
        return "`true`, `false`"
    return "names, with commas between" if isinstance(default, tuple) else info.range_text


def page(text: str) -> str:
    """The page with the table put in between the two marks."""
    before, rest = text.split(BEGIN)
    _, after = rest.split(END)
    return f"{before}{BEGIN}\n{table()}\n{END}{after}"


if __name__ == "__main__":
    PAGE.write_text(page(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
