# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's lights to radiometric quantities, with Cycles' factors (measured, see tests)."""

import math

import bpy
import numpy as np

from .....materials.traits.emitted import Emits, emits, light_variation
from .....scene import UNLIMITED_BOUNCES, Light, LightKind, NodeGraph
from ...common.report import Report
from ...context import ExportContext
from ...view_layer.layers import light_group_of
from ...view_layer.visibility import visibility_of
from ..nodes.graphs import GraphExporter
from ..nodes.inlining import readable_tree


def export_light(light_object: bpy.types.Object, matrix: np.ndarray, context: ExportContext) -> Light | None:
    """A light object placed by ``matrix`` (4, 4); None when it gives no light."""
    report = context.report
    data = light_object.data
    name = light_object.name
    if data.type == "AREA" and getattr(getattr(data, "cycles", None), "is_portal", False):
        return _portal(name, data, matrix)
    power = _power(data, name, report)
    if not power.any():
        return None
    graph = _graph(data, name, context)
    if graph is not None and emits(graph) is Emits.NOTHING:
        return None
    light = Light(
        name=name,
        kind=LightKind[data.type],
        matrix=matrix,
        strength=power,
        visibility=visibility_of(light_object),
        graph=graph,
        photon_weight=data.rppm.photon_weight if hasattr(data, "rppm") else 1.0,
        light_group=light_group_of(light_object),
        casts_shadow=_casts_shadow(data),
        max_bounces=max_bounces_of(data),
    )
    normalize = getattr(data, "normalize", True)
    if light.kind in {LightKind.POINT, LightKind.SPOT}:
        _fill_sphere(light, data, normalize)
    elif light.kind is LightKind.SUN:
        light.sun_angle = data.angle
        if not normalize and data.angle > 0.0:
            # The power is then the disk's radiance.
            light.strength = power * math.pi * math.sin(0.5 * data.angle) ** 2
    else:
        _fill_area(light, data, normalize)
        if not light.strength.any():
            report.warn(f'Light "{name}": its area is 0, so it gives no light; give it a size and a scale')
            return None
    return light


def _portal(name: str, data: bpy.types.AreaLight, matrix: np.ndarray) -> Light:
    """Return the portal of an area light, which tells where the world's light comes in and gives no light itself."""
    light = Light(name, LightKind.AREA, matrix, np.ones(3), is_portal=True)
    _fill_area(light, data, True)
    light.strength, light.spread = np.zeros(3), math.pi
    return light


def max_bounces_of(data: bpy.types.Light | bpy.types.World) -> int:
    """Cycles' limit of how often light is scattered; none where Cycles is switched off."""
    return min(getattr(getattr(data, "cycles", None), "max_bounces", UNLIMITED_BOUNCES), UNLIMITED_BOUNCES)


def _casts_shadow(data: bpy.types.Light) -> bool:
    # Once it was a property of Cycles, and the other one EEVEE's.
    return bool(getattr(getattr(data, "cycles", None), "cast_shadow", data.use_shadow))


def _fill_sphere(light: Light, data: bpy.types.Light, normalize: bool) -> None:
    light.radius = data.shadow_soft_size
    light.soft_falloff = getattr(data, "use_soft_falloff", True)
    if normalize:
        light.strength = light.strength / (4.0 * math.pi)
    elif light.radius > 0.0:
        # The power is then the flux of a square meter: radiance is power / pi, seen as a disk.
        light.strength = light.strength * light.radius**2
    else:
        light.strength = light.strength / math.pi
    if light.kind is LightKind.SPOT:
        light.spot_angle = data.spot_size
        light.spot_blend = data.spot_blend


def _fill_area(light: Light, data: bpy.types.Light, normalize: bool) -> None:
    light.shape = data.shape
    oblong = data.shape in {"RECTANGLE", "ELLIPSE"}
    light.size = (data.size, data.size_y if oblong else data.size)
    light.spread = data.spread
    width = light.size[0] * np.linalg.norm(light.matrix[:3, 0])
    height = light.size[1] * np.linalg.norm(light.matrix[:3, 1])
    area = width * height * (math.pi / 4.0 if data.shape in {"DISK", "ELLIPSE"} else 1.0)
    if area <= 0.0:
        light.strength = np.zeros(3)
    else:
        light.strength = light.strength / (math.pi * (area if normalize else 1.0))


def _power(data: bpy.types.Light, name: str, report: Report) -> np.ndarray:
    """Energy times color, temperature and exposure; (3,) float64."""
    power = data.energy * np.array(data.color, np.float64) * 2.0 ** getattr(data, "exposure", 0.0)
    if getattr(data, "use_temperature", False):
        power = power * np.array(data.temperature_color, np.float64)
    if not np.isfinite(power).all():
        report.warn(f'Light "{name}": its power is not finite and counts as 0')
        return np.zeros(3)
    return power


def _graph(data: bpy.types.Light, name: str, context: ExportContext) -> NodeGraph | None:
    """Return the graph of a light's nodes, whose emission is a factor of the light's power; None without nodes."""
    if not data.use_nodes or data.node_tree is None:
        return None
    tree = readable_tree(data)
    exporter = GraphExporter(f'Light "{name}"', context, tree)
    if tree.output is not None:
        exporter.graph.surface = exporter.surface()
    if exporter.graph.surface is None:
        return exporter.graph
    varies = light_variation(exporter.graph)
    sphere = data.type in {"POINT", "SPOT"} and data.shadow_soft_size > 0.0 and not data.use_soft_falloff
    by_place = varies.place or (varies.uv and data.type != "SPOT")
    by_direction = varies.direction or (varies.uv and data.type == "SPOT")
    if by_place and by_direction and (sphere or data.type == "AREA"):
        kept = "they are rendered by place only"
        context.report.warn(f'Light "{name}": its nodes vary by place and by direction; {kept}')
    return exporter.graph
