# SPDX-License-Identifier: GPL-3.0-or-later
"""Ray portals: windows to another place, seen straight, in a mirror and by diffuse surfaces."""

from collections.abc import Callable

import bpy

from ...net import Net, Socket, diffuse, socket
from ...net import material as net_material
from ...scenes import DIFFUSE, GLOSSY, background, ball, camera, light, material, place, plane
from .. import stage
from ..rows import Kind, Row, add, lit

GROUP = "Ray Portal"
AWAY = (20.0, 0.0, 0.0)
"""From the window to the other place."""
TINT = {"Color": (0.5, 0.8, 1.0)}
_FRONT = {"at": (0.0, -2.0, 0.5), "turn": (90.0, 0.0, 0.0)}


def moved(way: tuple[float, float, float] = AWAY) -> Socket:
    """The place of a hit, moved."""
    return socket("VectorMath", inputs={0: socket("NewGeometry", "Position"), 1: way}, operation="ADD")


def portal(inputs: dict | None = None, way: tuple[float, float, float] = AWAY) -> Socket:
    """A ray portal that moves paths by a way."""
    return socket("BsdfRayPortal", inputs={"Position": moved(way)} | (inputs or {}))


def surface(shader: Socket) -> bpy.types.Material:
    """A material of a shader."""
    made, net = net_material("Portal")
    net.output(shader(net))
    return made


def furniture(at: tuple[float, float, float] = AWAY) -> None:
    """A ball on a floor below a lamp, at the other place."""
    x, y, z = at
    plane(3.0, diffuse("Floor", (0.8, 0.7, 0.6)), place(at=at))
    ball(0.5, diffuse("Ball", (0.3, 0.6, 0.8)), place(at=(x + 0.3, y, z + 0.5)))
    light("POINT", 200.0, place(at=(x - 1.0, y - 1.0, z + 3.0)), shadow_soft_size=0.2)


def window(name: str, shader: Socket, world: float = 0.0, **members: object) -> None:
    """A row of a window before the camera, which leads to the other place."""

    def build() -> None:
        stage.empty()
        background().inputs["Strength"].default_value = world
        furniture()
        plane(2.0, surface(shader), place(**_FRONT))
        camera((0.1, -6.0, 1.2), (0.0, 0.0, 0.4), 30.0)

    add(Row(GROUP, name, build, **members))


_straight = socket("VectorMath", inputs={0: socket("NewGeometry", "Incoming"), 3: -1.0}, operation="SCALE")
_turned = socket("VectorRotate", inputs={"Vector": _straight, "Angle": 0.3}, rotation_type="Z_AXIS")


def _mixed(shader: Socket) -> Socket:
    return socket("MixShader", inputs={1: portal(TINT), 2: shader})


lit(GROUP, "nothing linked", socket("BsdfRayPortal"), effort=2)
window("to another place", portal())
window("tinted", portal(TINT))
window("turned", portal({"Direction": _turned}, (21.0, 0.0, 0.0)))
window("half diffuse", _mixed(socket("BsdfDiffuse", inputs={"Color": (0.2, 0.8, 0.3)})), 0.5)
window("half a mirror", _mixed(socket("BsdfAnisotropic", inputs={"Color": (0.9, 0.8, 0.3), "Roughness": 0.0})), 0.5)
window("to the world", portal(TINT, (0.0, 0.0, 20.0)), 0.7)


def _in_a_mirror() -> None:
    """A window beside the camera, seen in a mirror before it."""
    stage.empty()
    furniture()
    plane(
        2.0, material(GLOSSY, Color=(0.9, 0.9, 0.9), Roughness=0.0), place(at=(0.0, 0.0, 0.5), turn=(90.0, 0.0, 20.0))
    )
    plane(2.0, surface(portal(way=(16.0, 2.0, 0.0))), place(at=(2.5, -2.0, 0.5), turn=(90.0, 0.0, 90.0)))
    camera((0.1, -6.0, 1.2), (0.0, 0.0, 0.4), 30.0)


add(Row(GROUP, "in a mirror", _in_a_mirror))


def _skylight(shine: Callable[[], object], floor: bpy.types.Material | None = None) -> Callable[[], None]:
    """A ball on a floor below a window that leads to a light, which nothing else lets in."""

    def build() -> None:
        stage.empty()
        plain = diffuse("Floor", (0.8, 0.7, 0.6))
        plane(3.0, plain, place())
        ball(0.5, plain, place(at=(0.3, 0.0, 0.5)))
        plane(2.5, surface(portal({"Color": (1.0, 0.9, 0.7)})), place(at=(0.0, 0.0, 2.0)))
        shine()
        camera((0.1, -6.0, 1.2), (0.0, 0.0, 0.4), 36.0)

    return build


def _lamp() -> None:
    light("AREA", 500.0, place(at=(20.0, 0.0, 3.0)), size=4.0)


def _point() -> None:
    light("POINT", 2000.0, place(at=(20.0, 0.0, 4.5)), shadow_soft_size=2.0, use_soft_falloff=False)


def _wall() -> None:
    """A wall that a lamp lights."""
    plane(3.0, material(DIFFUSE, Color=(0.9, 0.8, 0.9)), place(at=(20.0, 0.0, 5.0), turn=(180.0, 0.0, 0.0)))
    light("POINT", 400.0, place(at=(20.0, 0.0, 3.5)), shadow_soft_size=0.0)


def _glow() -> None:
    plane(2.5, material("ShaderNodeEmission", Strength=3.0), place(at=(20.0, 0.0, 4.0)))


def _sky() -> None:
    background().inputs["Strength"].default_value = 0.5


def _fog() -> None:
    """A lamp of no size in a world of fog: what is lit is the fog alone, and what it lights."""
    light("POINT", 900.0, place(at=(20.0, 0.0, 3.0)), shadow_soft_size=0.0)
    net = Net(bpy.context.scene.world.node_tree)
    net.set(net.find("OUTPUT_WORLD").inputs["Volume"], net.out("VolumeScatter", inputs={"Density": 0.1}))


for _name, _light, _effort in (
    ("an area light through it", _lamp, 8),
    ("a lamp through it", _point, 8),
    ("a lit wall through it", _wall, 6),
    ("what glows through it", _glow, 6),
    ("the world through it", _sky, 2),
    ("fog through it", _fog, 20),
):
    add(Row(GROUP, _name, _skylight(_light), effort=_effort, settings={"photons": 512}))


def _lengths() -> None:
    """A wall that shows lengths and depths, behind two windows and a transparent pane."""
    stage.empty()
    shown, net = net_material("Depths")
    length = _scaled(net, "Ray Length", 0.1)
    depths = (length, _scaled(net, "Portal Depth", 0.25), _scaled(net, "Transparent Depth", 0.2))
    net.output(net.emission(net.out("CombineXYZ", inputs=dict(enumerate(depths)))))
    onward, clear = portal(way=(20.0, -0.5, 0.0)), socket("BsdfTransparent")
    for x, y, shader in ((0.0, 0.0, onward), (20.0, 0.0, onward), (40.0, 0.0, clear), (40.0, 2.0, clear)):
        plane(3.0, surface(shader), place(at=(x, y, 0.0), turn=(90.0, 0.0, 0.0)))
    plane(5.0, shown, place(at=(40.0, 3.0, 0.0), turn=(90.0, 0.0, 10.0)))
    camera((0.03, -3.0, 0.07), (0.01, 1.0, 0.02), 30.0)


def _scaled(net: Net, output: str, scale: float) -> bpy.types.NodeSocket:
    return net.out("Math", inputs={0: socket("LightPath", output), 1: scale}, operation="MULTIPLY")


_LONG = {"camera_path_length": 8, "max_bounces": 8}
add(Row(GROUP, "lengths and depths behind two", _lengths, Kind.VALUES, settings=_LONG))
