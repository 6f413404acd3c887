# SPDX-License-Identifier: GPL-3.0-or-later
"""A light object as a row of the lights' table, and its power."""

import math

import numpy as np

from ...scene.lights import Light, LightKind
from .light_records import LIGHT, LightFlag, LightShape


def spot_solid_angle(cosine_cone: float, blend: float) -> float:
    """Power of a spot over its axial intensity: integral of its falloff over solid angle, sr."""
    cosine = np.linspace(cosine_cone, 1.0, 4097)
    x = np.clip((cosine - cosine_cone) / max((1 - cosine_cone) * blend, 1e-9), 0, 1)
    return float(2 * math.pi * np.mean(x * x * (3 - 2 * x)) * (1 - cosine_cone))


def spread_constants(spread: float) -> tuple[float, float]:
    """Tangent of half the spread and the factor of Cycles' falloff; (0, 1) for a diffuse light."""
    half = 0.5 * spread
    if half >= 0.5 * math.pi - 1e-4:
        return 0.0, 1.0
    half = max(half, 1e-3)
    return math.tan(half), 1.0 / (math.tan(half) - half)


def spread_integral(tangent: float, scale: float) -> float:
    """Flux of a spread light over radiance times area, sr."""
    if tangent <= 0.0:
        return math.pi
    theta = np.linspace(0.0, math.atan(tangent), 4097)
    values = np.maximum(0.0, (tangent - np.tan(theta)) * scale) * np.cos(theta) * np.sin(theta)
    return float(2 * math.pi * np.mean(values) * math.atan(tangent))


def _unit(vector: np.ndarray) -> np.ndarray:
    size = np.linalg.norm(vector)
    return vector / size if size > 0 else np.array([0.0, 0.0, 1.0])


def _spot_cone(axes: np.ndarray, cosine: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """Cycles' cone of a spot with the axes (3, 3) of its matrix, which may be scaled and sheared.

    What a direction has along the three vectors (3,) is what it is in the light's own space, where the cone is round,
    times one factor; the third has length 1. Photons go out in the round cone about it that holds that of the spot: the
    cosine of half its angle.
    """
    lengths = np.maximum(np.linalg.norm(axes, axis=0), 1e-9)
    units = axes / lengths
    # Without shear, and where there is no inverse, both follow in closed form.
    if np.abs(units.T @ units - np.eye(3)).max() < 1e-5 or abs(np.linalg.det(units)) < 1e-6:
        widest = math.atan(math.tan(min(math.acos(cosine), 1.57)) * max(1.0, max(lengths[:2]) / lengths[2]))
        holding = math.cos(widest) if cosine > 1e-3 else 0.0
        u, v = (units[:, axis] * (lengths[2] / lengths[axis]) for axis in (0, 1))
        return u, v, -_unit(axes[:, 2]), holding
    inverse = np.linalg.inv(axes)
    u, v, beam = inverse / np.linalg.norm(inverse[2])
    turn, sine = np.linspace(0.0, 2.0 * math.pi, 257), math.sqrt(1.0 - cosine * cosine)
    rim = axes @ np.stack([sine * np.cos(turn), sine * np.sin(turn), np.full_like(turn, -cosine)])
    holding = float((-beam @ rim / np.linalg.norm(rim, axis=0)).min())
    return u, v, -beam, max(holding - 1e-3 * (1.0 - holding), 0.0) if cosine > 1e-3 else 0.0


def light_entry(light: Light, scene_radius: float) -> tuple[np.ndarray, np.ndarray]:
    """A light's record and its power, (3,) W, within the scene."""
    entry = LIGHT.zeros(1)[0]
    axes = np.asarray(light.matrix, np.float64)[:3, :3]
    entry["position"] = light.matrix[:3, 3]
    normal = -_unit(axes[:, 2])
    entry["normal"] = normal
    entry["strength"] = strength = np.asarray(light.strength, np.float64)
    entry["radius"] = max(light.radius, 0.0)
    soft = light.soft_falloff and light.radius > 0 and light.kind in (LightKind.POINT, LightKind.SPOT)
    entry["flags"] = (
        int(light.visibility) | (LightFlag.SOFT if soft else 0) | (0 if light.casts_shadow else LightFlag.SHADOWLESS)
    )
    entry["max_bounces"] = light.max_bounces
    if light.kind is LightKind.POINT:
        entry["kind"] = LightShape.POINT
        return entry, 4 * math.pi * strength
    if light.kind is LightKind.SPOT:
        cosine = math.cos(0.5 * min(light.spot_angle, math.pi))
        entry["kind"] = LightShape.SPOT
        entry["axis_u"], entry["axis_v"], entry["normal"], holding = _spot_cone(axes, cosine)
        entry["cosine_cone"], entry["blend"] = cosine, np.clip(light.spot_blend, 0.0, 1.0)
        entry["spread_scale"] = 1.0 - holding
        return entry, strength * spot_solid_angle(cosine, light.spot_blend)
    if light.kind is LightKind.SUN:
        entry["kind"] = LightShape.SUN
        cosine = math.cos(0.5 * min(max(light.sun_angle, 0.0), math.pi))
        entry["axis_u"], entry["axis_v"] = _unit(axes[:, 0]), _unit(axes[:, 1])
        # The irradiance counts cosines over the disk; GLSL takes radiance times its solid angle.
        entry["cosine_cone"], entry["strength"] = cosine, strength * 2.0 / (1.0 + cosine)
        return entry, entry["strength"] * math.pi * scene_radius**2
    width, height = light.size if light.shape in ("RECTANGLE", "ELLIPSE") else (light.size[0], light.size[0])
    entry["axis_u"], entry["axis_v"] = 0.5 * width * axes[:, 0], 0.5 * height * axes[:, 1]
    round_shape = light.shape in ("DISK", "ELLIPSE")
    entry["kind"] = LightShape.ELLIPSE if round_shape else LightShape.RECTANGLE
    spanned = np.linalg.norm(np.cross(entry["axis_u"], entry["axis_v"]))
    area = (math.pi if round_shape else 4.0) * spanned
    if spanned <= 0:
        return entry, np.zeros(3)
    normal = _unit(np.cross(entry["axis_u"], entry["axis_v"]).astype(np.float64))
    entry["normal"] = -normal if np.dot(normal, axes[:, 2]) > 0 else normal
    entry["area"] = area
    tangent, scale = spread_constants(light.spread)
    entry["spread_tangent"], entry["spread_scale"] = tangent, scale
    entry["cosine_cone"] = math.cos(math.atan(tangent))
    return entry, strength * area * spread_integral(tangent, scale)
