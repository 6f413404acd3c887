# SPDX-License-Identifier: GPL-3.0-or-later
"""Media inside closed surfaces: around the camera, around lamps, within each other, and such as shine."""

import itertools
import math
from collections.abc import Callable

import bmesh
import bpy

from ...net import diffuse, material
from ...scenes import camera, light, mesh_object, place
from .. import stage
from ..lighting.lights import ABOVE
from ..rows import Row, add, ground_material

GROUP = "Media"
WATER, AMBER = ((0.55, 0.8, 0.9), 0.4), ((0.9, 0.6, 0.2), 0.8)
"""Color and density of absorption."""
PATHS = {"camera_path_length": 48, "photon_path_length": 48, "photons": 8192}
BALL = {"at": (0.1, 0.0, 0.95)}


def body(name: str, absorption: tuple | None, ior: float | None = None, glow: tuple | None = None):
    """A material that is a medium; ior: of its smooth surface, which is not there without."""
    made, net = material(name)
    parts = []
    if absorption is not None:
        parts.append(net.out("VolumeAbsorption", inputs=dict(zip(("Color", "Density"), absorption))))
    parts += [] if glow is None else [net.emission(*glow)]
    volume = parts[0]
    for part in parts[1:]:
        volume = net.out("AddShader", inputs={0: volume, 1: part})
    surface = None if ior is None else net.out("BsdfGlass", inputs={"Color": 1.0, "Roughness": 0.0, "IOR": ior})
    net.output(surface, Volume=volume)
    return made


def block(surface: bpy.types.Material, low: tuple, high: tuple) -> bpy.types.Object:
    """A closed box between two corners, seen from outside."""
    corners = [(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return mesh_object(corners, faces, surface, name="Block")


def _row(name: str, prepare: Callable[[], bpy.types.Material], world: float = 0.1, **members: object) -> None:
    """prepare: adds what is around, and gives the material of the ball."""

    def build() -> None:
        stage.empty()
        plain, ground = diffuse("Plain", (0.6, 0.55, 0.5)), ground_material()
        made = stage.set_up(plain, world, ground)
        ball = made[0].data
        made[0].matrix_world = place(**BALL)
        ball.materials[0] = prepare() or plain

    add(Row(GROUP, name, build, settings=PATHS, **members))


def _camera_within() -> None:
    stage.area_light()
    block(body("Water", WATER, 1.0), (-6.0, -6.0, -1.0), (6.0, 6.0, 6.0))


def _lamp_in_a_bulb() -> bpy.types.Material:
    light("POINT", 60.0, place(**BALL), shadow_soft_size=0.02)
    return body("Amber", AMBER)


def _lit_from_outside() -> None:
    stage.area_light()
    block(body("Water", WATER), (-3.0, -3.0, -1.0), (3.0, 3.0, 2.0))


def _nested() -> bpy.types.Material:
    _camera_within()
    return body("Amber", AMBER)


def _camera_half_within() -> None:
    stage.area_light()
    block(body("Water", WATER), (-6.0, -4.0, -1.0), (6.0, 6.0, 2.0))
    camera((0.4, -4.6, 2.3), (0.1, 0.0, 0.62), 34.0)
    bpy.context.scene.camera.data.clip_start = 0.65


def _absorbing_ball() -> bpy.types.Material:
    light("AREA", 60.0, place(**ABOVE), size=2.5)
    return body("Amber", AMBER, 1.5)


def lathe(surface: bpy.types.Material, profile: list, name: str, columns: int = 32) -> bpy.types.Object:
    """A flat-shaded solid by its profile (radius, height), from the axis and back to it, counterclockwise."""
    angles = [2.0 * math.pi * k / columns for k in range(columns)]
    rings = [
        [(0.0, 0.0, z)] if r == 0.0 else [(r * math.cos(angle), r * math.sin(angle), z) for angle in angles]
        for r, z in profile
    ]
    mesh = bmesh.new()
    rows = [[mesh.verts.new(point) for point in ring] for ring in rings]
    for low, high in itertools.pairwise(rows):
        for k in range(columns):
            at = [low[k % len(low)], low[(k + 1) % len(low)], high[(k + 1) % len(high)], high[k % len(high)]]
            mesh.faces.new(list(dict.fromkeys(at)))
    return stage.mesh_object(mesh, name, surface, {"at": (0.0, 0.0, 0.0)})


WALL, INNER = 0.04, 0.56
"""Thickness and inner radius of a tumbler, m."""
LIQUIDS = {"with a gap": -0.005, "overlapping": 0.5 * WALL}
"""Distances by which a drink reaches into the glass, m. Where it ends at the glass's own faces, Cycles' rays that leave
one of two faces meet the other, and RPPM's do not: neither is right (docs/materials.md)."""


def tumbler(reach: float) -> None:
    """A drink of amber in a glass; reach: how far beyond the glass's inner surface."""
    glass, net = material("Glass")
    net.output(net.out("BsdfGlass", inputs={"Color": 1.0, "Roughness": 0.0, "IOR": 1.5}))
    foot, outer, bottom = 0.01, INNER + WALL, 0.08
    lathe(glass, [(0.0, foot), (outer, foot), (outer, 1.4), (INNER, 1.4), (INNER, bottom), (0.0, bottom)], "Tumbler")
    r, z = INNER + reach, bottom - reach
    lathe(body("Drink", AMBER, 1.33), [(0.0, z), (r, z), (r, 1.0), (0.0, 1.0)], "Drink")


def _liquid(reach: float) -> Callable[[], None]:
    def prepare() -> None:
        light("AREA", 60.0, place(**ABOVE), size=1.5)
        bpy.data.objects.remove(bpy.data.objects["Ball"])
        tumbler(reach)

    return prepare


_row("camera in a body", _camera_within)
_row("lamp in a tinted bulb", _lamp_in_a_bulb, 0.0)
_row("lit from outside", _lit_from_outside)
_row("nested", _nested)
_row("camera half in a body", _camera_half_within)
_row("caustic of an absorbing ball", _absorbing_ball, 0.0, effort=4)
_row("body that shines", lambda: body("Fire", None, None, ((1.0, 0.4, 0.2), 1.5)), 0.0)
_row("glass that shines", lambda: body("Fire", AMBER, 1.5, ((1.0, 0.4, 0.2), 1.5)), 0.0)
for way, reach in LIQUIDS.items():
    _row(f"liquid in a glass, {way}", _liquid(reach), 0.5, effort=2)
