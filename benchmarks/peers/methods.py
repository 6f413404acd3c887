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
    """Purpose that the method is good for, in a few words."""
    leaves_out: tuple[str, ...] = ()
    """Scenes that it cannot be given as they are."""


OWN = "rppm"
"""The method whose wins and losses are told."""

METHODS = {
    method.name: method
    for method in (
        Method(OWN, "RPPM", "rppm", why="the defaults of the add-on"),
        Method(
            "rppm_denoised",
            "RPPM, denoised",
            "rppm",
            {"use_denoising": True},
            "Open Image Denoise by albedo and normal, its time included",
        ),
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
        Method(
            "luxcore_photongi",
            "LuxCore, PhotonGI",
            "luxcore",
            {"engine": "photongi"},
            "path tracing with a caustic cache that is renewed as it goes",
        ),
        Method(
            "luxcore_light_tracing",
            "LuxCore, light tracing",
            "luxcore",
            {"engine": "light_tracing"},
            "path tracing, with light tracing for caustics",
        ),
        Method("mitsuba_path", "Mitsuba, path", "mitsuba", {"integrator": "path"}, "path tracing"),
        Method(
            "mitsuba_ptracer",
            "Mitsuba, particle tracer",
            "mitsuba",
            {"integrator": "ptracer"},
            "light tracing alone: what is seen through glass or mirrors stays black; it has no sun with an extent",
            leaves_out=("window_room",),
        ),
    )
}
"""By name, in the order of tables and legends."""


def chosen(names: list[str] | None) -> list[Method]:
    """The methods of these names, or all; KeyError where there is none."""
    return list(METHODS.values()) if not names else [METHODS[name] for name in names]


REFERENCES = {
    "glass_box": (OWN, "mitsuba_path"),
    "mirror_ring": (OWN, "luxcore_light_tracing"),
    "pool": (OWN, "mitsuba_path"),
    "interior": ("cycles", "mitsuba_path"),
    "hall": ("cycles", "mitsuba_path"),
    "window_room": ("cycles", "mitsuba_path"),
    "gray_world": ("cycles", "mitsuba_path"),
}
"""The two independent methods whose long runs are a scene's reference; RPPM only where paths alone would take days."""
