# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of light paths that change the picture."""

from collections.abc import Callable

import bpy

from ...net import diffuse, socket
from ...net import material as net_material
from ...scenes import EMISSION, GLASS, GLOSSY, ball, camera, light, material, place, plane
from .. import stage
from ..rows import Kind, Row, add
from .lights import ABOVE

BOUNCES, CAUSTICS, CLAMPING = "Bounces by type", "Caustics", "Clamping"


def set_paths(**values: object) -> None:
    """Set properties of the same name of both engines."""
    for name, value in values.items():
        setattr(bpy.context.scene.cycles, name, value)
        setattr(bpy.context.scene.rppm, name, value)


def paths(group: str, name: str, values: dict[str, object], **members: object) -> None:
    """A row with settings of both engines: a ball on the ground beside one of glass, before a mirror and a translucent
    sheet."""

    def build() -> None:
        stage.empty()
        stage.set_up(diffuse("Plain", (0.8, 0.7, 0.6)))
        ball(0.45, material(GLASS, Roughness=0.0, IOR=1.45), place(at=(-0.7, -1.0, 0.5)))
        mirror = material(GLOSSY, Color=(0.8, 0.9, 0.9), Roughness=0.0)
        plane(0.9, mirror, place(at=(-1.0, 1.3, 0.9), turn=(90.0, 0.0, 20.0)))
        sheet = material("ShaderNodeBsdfTranslucent", Color=(0.8, 0.6, 0.7))
        plane(0.5, sheet, place(at=(1.5, 0.2, 0.7), turn=(80.0, 0.0, -30.0)))
        lamp = light("AREA", 80.0, place(**ABOVE), size=0.8)
        lamp.visible_transmission = lamp.visible_glossy = False  # its images are small and bright: noise
        set_paths(**values)

    longer = {"camera_path_length": 17, "photon_path_length": 17, "photons": 8192}
    add(Row(group, name, build, settings=longer, effort=4, **members))


for _kind in ("diffuse", "glossy", "transmission"):
    paths(BOUNCES, f"{_kind.title()} 0", {f"{_kind}_bounces": 0})
paths(
    BOUNCES,
    "Diffuse 1, Glossy 1, Transmission 2",
    {"diffuse_bounces": 1, "glossy_bounces": 1, "transmission_bounces": 2},
)

for _kinds in (("reflective",), ("refractive",), ("reflective", "refractive")):
    paths(CAUSTICS, f"{' and '.join(_kinds)} off", {f"caustics_{kind}": False for kind in _kinds})


paths("Filter Glossy", "1", {"blur_glossy": 1.0})
_MEAN_BLUR = {
    "reason": "photons and the final gather take the mean blur of one diffuse bounce",
    "mean": 0.03,
    "block": 0.1,
}
paths("Filter Glossy", "0.2", {"blur_glossy": 0.2}, **_MEAN_BLUR)


def _clamped(values: dict[str, object], glows: bool) -> Callable[[], None]:
    """A ball and the ground, seen straight and in a mirror: both below a lamp of no size, or a ball that glows on black
    ground. Each path has one light to choose, so that no chance changes what it brings."""

    def build() -> None:
        stage.empty()
        ground = diffuse("Plain", (0.0, 0.0, 0.0) if glows else (0.8, 0.7, 0.6))
        stage.set_up(material(EMISSION, Color=(0.9, 0.5, 0.2), Strength=2.0) if glows else ground, 0.0, ground)
        plane(1.2, material(GLOSSY, Roughness=0.0), place(at=(0.0, 1.8, 0.9), turn=(90.0, 0.0, 0.0)))
        if not glows:
            light("POINT", 300.0, place(**ABOVE), shadow_soft_size=0.0)
        set_paths(**values, max_bounces=1, diffuse_bounces=0)

    return build


_ONCE = {"max_bounces": 1, "use_final_gather": False, "photons": 64}
for _name, _kind, _limit, _glows in (
    ("direct, lamp", "direct", 0.5, False),
    ("indirect, lamp in a mirror", "indirect", 0.4, False),
    ("direct, glowing ball", "direct", 0.5, True),
):
    add(Row(CLAMPING, _name, _clamped({f"sample_clamp_{_kind}": _limit}, _glows), settings=_ONCE))


def _depths() -> None:
    """A wall that shows its depths by type, seen through a pane, in a mirror and through another pane."""
    stage.empty()
    shown, net = net_material("Depths")
    depths = (socket("LightPath", f"{name} Depth") for name in ("Diffuse", "Glossy", "Transmission"))
    net.output(net.emission(net.scaled(socket("CombineXYZ", inputs=dict(enumerate(depths)))(net), 0.2, 0.1)))
    pane = material("ShaderNodeBsdfRefraction", Roughness=0.0, IOR=1.05)
    plane(1.0, pane, place(at=(0.0, -1.0, 0.0), turn=(90.0, 0.0, 0.0)))
    plane(2.0, material(GLOSSY, Color=(1.0, 1.0, 1.0), Roughness=0.0), place((0.0, 1.0, 0.0), (90.0, 0.0, 45.0)))
    plane(1.5, pane, place(at=(1.5, 1.0, 0.0), turn=(90.0, 0.0, 90.0)))
    plane(3.0, shown, place(at=(4.0, 1.0, 0.0), turn=(90.0, 0.0, -90.0)))
    camera((0.03, -3.0, 0.07), (0.01, 1.0, 0.02), 10.0)  # no ray meets the edge between two triangles


_LONG = {"camera_path_length": 6, "max_bounces": 8}
add(Row("Light Path, depths", "by type behind a pane, a mirror and a pane", _depths, Kind.VALUES, settings=_LONG))
