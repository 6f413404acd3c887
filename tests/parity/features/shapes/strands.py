# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair curves, hair of particle systems and point clouds."""

from collections.abc import Callable

import bpy
import numpy as np

from ...net import Net, material, socket
from ...scenes import background, camera, link_object
from .. import stage
from ..rows import Kind, Row, add, ground_material

CURVES, POINTS, HAIR = "Hair Curves", "Point Cloud", "Particle Hair"
GROUPS = CURVES, POINTS, HAIR, "Hair Info", "Point Info"
OUTLINES = "strands are tubes of few sides, points spheres of triangles: outlines are Cycles' in the mean"
DEEP = {"camera_path_length": 6}
"""Light goes from strand to strand."""


def _linked(data: bpy.types.ID, surface: bpy.types.Material) -> bpy.types.Object:
    data.materials.append(surface)
    return link_object(data)


def _attribute(data: bpy.types.ID, name: str, kind: str, domain: str, values: np.ndarray) -> None:
    made = data.attributes.get(name) or data.attributes.new(name, kind, domain)
    field = {"FLOAT": "value", "FLOAT_VECTOR": "vector", "FLOAT2": "vector", "FLOAT_COLOR": "color"}[kind]
    made.data.foreach_set(field, np.ascontiguousarray(values, np.float32).reshape(-1))


def tuft(surface: bpy.types.Material, curl: float = 0.0, count: int = 1200, keys: int = 8, radius: float = 0.01,
         tip: float = 1.0) -> bpy.types.Object:  # fmt: skip
    """Strands that stand on a disk and lean outward; ``curl``: the radius of their helices; ``tip``: of the radius."""
    random = np.random.default_rng(3)
    around, away = random.uniform(0.0, 2.0 * np.pi, count), np.sqrt(random.uniform(0.0, 1.0, count))
    along = np.linspace(0.0, 1.0, keys)
    lean = 0.35 + 0.5 * along
    x, y = ((away[:, None] * lean * way(around)[:, None]) for way in (np.cos, np.sin))
    z = 1.7 * along * (1.0 - 0.25 * away[:, None] ** 2)
    turn = around[:, None] + 2.5 * 2.0 * np.pi * along
    places = np.stack([x + curl * along * np.cos(turn), y + curl * along * np.sin(turn), z], axis=-1)
    data = bpy.data.hair_curves.new("Tuft")
    data.add_curves([keys] * count)
    _attribute(data, "position", "FLOAT_VECTOR", "POINT", places)
    _attribute(data, "radius", "FLOAT", "POINT", np.tile(radius * (1.0 + (tip - 1.0) * along), count))
    _attribute(data, "surface_uv_coordinate", "FLOAT2", "CURVE", 0.5 + 0.5 * away[:, None] * np.stack(
        [np.cos(around), np.sin(around)], axis=1))  # fmt: skip
    _attribute(data, "tint", "FLOAT_COLOR", "CURVE", random.uniform(0.2, 1.0, (count, 4)))
    return _linked(data, surface)


def cloud(surface: bpy.types.Material, count: int = 300) -> bpy.types.Object:
    """Points of different size in a ball."""
    random = np.random.default_rng(5)
    places = random.normal(size=(count, 3))
    places *= (0.9 * random.uniform(0.0, 1.0, count) ** (1 / 3) / np.linalg.norm(places, axis=1))[:, None]
    data = bpy.data.meshes.new("Cloud")
    data.from_pydata(places + [0.0, 0.0, 1.0], [], [])
    _attribute(data, "size", "FLOAT", "POINT", random.uniform(0.02, 0.1, count))
    _attribute(data, "tint", "FLOAT_COLOR", "POINT", random.uniform(0.2, 1.0, (count, 4)))
    made = _linked(data, surface)
    tree = bpy.data.node_groups.new("Points", "GeometryNodeTree")
    for way in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    start, end, points, size, paint = (
        tree.nodes.new(kind)
        for kind in ("NodeGroupInput", "NodeGroupOutput", "GeometryNodeMeshToPoints", "GeometryNodeInputNamedAttribute",
                     "GeometryNodeSetMaterial")
    )  # fmt: skip
    size.data_type, size.inputs["Name"].default_value = "FLOAT", "size"
    paint.inputs["Material"].default_value = surface
    tree.links.new(start.outputs[0], points.inputs["Mesh"])
    tree.links.new(size.outputs["Attribute"], points.inputs["Radius"])
    tree.links.new(points.outputs[0], paint.inputs["Geometry"])
    tree.links.new(paint.outputs[0], end.inputs[0])
    made.modifiers.new("Points", "NODES").node_group = tree
    return made


def haired(surface: bpy.types.Material) -> bpy.types.Object:
    """A ball with hair that has children."""
    made = stage.ball(surface)
    made.modifiers.new("Hair", "PARTICLE_SYSTEM")
    settings = made.particle_systems[0].settings
    settings.type, settings.count, settings.hair_length = "HAIR", 80, 0.5
    settings.hair_step = 4
    settings.display_step = settings.render_step = 3
    settings.child_type, settings.child_percent, settings.rendered_child_count = "INTERPOLATED", 20, 20
    settings.brownian_factor = 0.05
    settings.radius_scale, settings.root_radius, settings.tip_radius = 0.03, 1.0, 0.3
    for owner in (made.particle_systems[0], settings.force_field_1, settings.force_field_2):
        owner.seed = 1  # Blender takes another one each time
    return made


def stand(
    surface: bpy.types.Material, make: Callable[[bpy.types.Material], bpy.types.Object], glow: bool = False
) -> None:
    """Place what ``make`` makes before the camera, lit on the ground, or else alone and unlit, in an empty scene."""
    plain = ground_material()
    camera((0.4, -4.6, 2.3), (0.0, 0.0, 0.9), 34.0)
    background().inputs["Strength"].default_value = 0.0 if glow else 0.25
    bpy.context.scene.world.cycles.sampling_method = "MANUAL"
    bpy.context.scene.world.cycles.sample_map_resolution = 256
    make(surface)
    if not glow:
        stage.ground(plain)
        stage.area_light()


def thick_tuft(surface: bpy.types.Material) -> bpy.types.Object:
    """Few strands, wide enough to be seen one by one."""
    return tuft(surface, count=100, radius=0.03, tip=0.3)


def _show(
    group: str,
    name: str,
    make: Callable[[bpy.types.Material], bpy.types.Object],
    give: Callable[[Net], bpy.types.NodeSocket] | None = None,
    glow: bool = False,
    curves: dict | None = None,
    prepare: Callable[[], None] | None = None,
    **members: object,
) -> None:
    """A row of a color on what ``make`` makes, lit, or glowing alone."""

    def build() -> None:
        stage.empty()
        surface, net = material()
        shown = give(net) if give is not None else (0.6, 0.45, 0.3)
        color = {"Color": shown}
        net.output(net.emission(shown) if glow else net.out("BsdfDiffuse", inputs=color))
        stand(surface, make, glow)
        for key, value in (curves or {}).items():
            setattr(bpy.context.scene.cycles_curves, key, value)
        if prepare is not None:
            prepare()

    # Of what glows, the ends of strands are seen, which are no ribbons' straight edges.
    mean, block = (0.02, 0.09) if glow else (0.01, 0.06)
    settings = {} if glow else DEEP
    add(Row(group, name, build, Kind.LIGHT, OUTLINES, mean, block, settings, **members))


def _curly(surface: bpy.types.Material) -> bpy.types.Object:
    return tuft(surface, curl=0.1, count=500, keys=16)


def _tapered(surface: bpy.types.Material) -> bpy.types.Object:
    return tuft(surface, tip=0.1, radius=0.018)


_show(CURVES, "straight", tuft)
_show(CURVES, "curly", _curly)
_show(CURVES, "tapered", _tapered)
_show(CURVES, "3D curves", _curly, curves={"shape": "THICK"})
_show(CURVES, "linear 3D curves", _curly, curves={"shape": "THICK_LINEAR"})
_show(POINTS, "of geometry nodes", cloud)
_show(HAIR, "children on a ball", haired)


def _bright(kind: str, output: str, scale: float, offset: float = 0.0) -> Callable[[Net], bpy.types.NodeSocket]:
    return lambda net: net.scaled(net.out(kind, output), scale, offset)


for _output, _scale, _offset in (
    ("Is Strand", 1.0, 0.0), ("Intercept", 1.0, 0.2), ("Length", 0.5, 0.0), ("Thickness", 5.0, 0.1),
    ("Tangent Normal", 0.5, 0.5), ("Random", 1.0, 0.1),
):  # fmt: skip
    _show("Hair Info", _output, thick_tuft, _bright("HairInfo", _output, _scale, _offset), glow=True)
for _output, _scale, _offset in (("Position", 0.3, 0.5), ("Radius", 8.0, 0.0), ("Random", 1.0, 0.1)):
    _show("Point Info", _output, cloud, _bright("PointInfo", _output, _scale, _offset), glow=True)
_show(CURVES, "Normal of Geometry", thick_tuft, _bright("NewGeometry", "Normal", 0.5, 0.5), glow=True)
_show(CURVES, "Tangent of Geometry", _curly, _bright("NewGeometry", "Tangent", 0.5, 0.5), glow=True)
_show(CURVES, "UV of the surface", thick_tuft, socket("TexCoord", "UV"), glow=True)
_show(CURVES, "an attribute of curves", thick_tuft, socket("Attribute", "Color", attribute_name="tint"), glow=True)
_show(POINTS, "an attribute of points", cloud, socket("Attribute", "Color", attribute_name="tint"), glow=True)
_show(POINTS, "Normal of Geometry", cloud, _bright("NewGeometry", "Normal", 0.5, 0.5), glow=True)
_show(HAIR, "Intercept", haired, _bright("HairInfo", "Intercept", 1.0, 0.2), glow=True)
_show(HAIR, "UV of the surface", haired, socket("TexCoord", "UV"), glow=True)
_show(HAIR, "Generated", haired, _bright("TexCoord", "Generated", 0.3, 0.4), glow=True)
