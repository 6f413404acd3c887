# SPDX-License-Identifier: GPL-3.0-or-later
"""The renderers and the methods of theirs that are compared, each at its best settings."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Method:
    """One way to render a scene."""

    name: str
    label: str
    adapter: str
    """The module below adapters/ and the environment it runs in."""
    options: dict[str, object] = field(default_factory=dict)
    why: str = ""
    """What it is good for, in a few words."""


OWN = "rppm"
"""The method whose wins and losses are told."""

METHODS = {
    method.name: method
    for method in (
        Method(OWN, "RPPM", "rppm", why="the defaults of the add-on"),
        Method("cycles", "Cycles", "cycles", why="path tracing; clamping and adaptive sampling off"),
        Method(
            "cycles_caustics",
            "Cycles, shadow caustics",
            "cycles",
            {"shadow_caustics": True},
            "manifold next-event estimation from the glass to all lights; reflected caustics are beyond it",
        ),
        Method(
            "cycles_denoised",
            "Cycles, denoised",
            "cycles",
            {"denoise": True},
            "OpenImageDenoise by albedo and normal, its time included",
        ),
    )
}
"""By name, in the order of tables and legends."""


def chosen(names: list[str] | None) -> list[Method]:
    """The methods of these names, or all; KeyError where there is none."""
    return list(METHODS.values()) if not names else [METHODS[name] for name in names]


REFERENCES = {
    "glass_box": ("rppm", "cycles"),
    "mirror_ring": ("rppm", "cycles"),
    "pool": ("rppm", "cycles"),
    "interior": ("rppm", "cycles"),
    "hall": ("rppm", "cycles"),
    "window_room": ("rppm", "cycles"),
    "gray_world": ("rppm", "cycles"),
}
"""The two independent methods whose long runs are a scene's reference."""
