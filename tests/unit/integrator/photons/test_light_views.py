# SPDX-License-Identifier: GPL-3.0-or-later
"""Views of lights: they hold the rays of all photons, within the margin of the texels that these are looked up in."""

import math

import numpy as np
import pytest

from rppm_addon.integrator.lights.light_records import LIGHT, LightShape
from rppm_addon.integrator.photons.light_gbuffer import light_views, views_side

CENTER, RADIUS = np.array([1.0, 2.0, 3.0]), 5.0


def light(kind: int, **values: object) -> np.void:
    record = LIGHT.zeros(1)[0]
    record["kind"], record["normal"], record["position"], record["cosine_cone"] = kind, (0.6, 0.0, -0.8), CENTER, 1.0
    for name, value in values.items():
        record[name] = value
    return record


@pytest.mark.parametrize(
    ("record", "count"),
    [
        (light(LightShape.POINT), 6),
        (light(LightShape.POINT, radius=0.02), 6),
        (light(LightShape.POINT, radius=0.5), 0),
        (light(LightShape.SPOT, spread_scale=1.0 - math.cos(0.4)), 1),
        (light(LightShape.SPOT, spread_scale=1.0 - math.cos(1.2)), 6),
        (light(LightShape.SPOT, spread_scale=1.0), 6),
        (light(LightShape.SUN), 1),
        (light(LightShape.SUN, cosine_cone=math.cos(0.0046)), 1),
        (light(LightShape.SUN, cosine_cone=math.cos(0.1)), 0),
        (light(LightShape.RECTANGLE), 0),
    ],
)
def test_views_by_kind_and_extent(record, count):
    views = light_views(record, CENTER, RADIUS)
    assert len(views) == count
    for view in views:
        axes = np.array([view["right"], view["up"], view["forward"]], np.float64)
        np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-6)


def test_parallel_light_stays_within_the_margin():
    """Rays across the scene, at any angle of the sun's disk, against the cone line that they have at its middle."""
    angle = 0.0046
    view = light_views(light(LightShape.SUN, cosine_cone=math.cos(angle)), CENTER, RADIUS)[0]
    tip, margin = float(view["tip_distance"]), float(view["margin"])
    place = np.linspace(-RADIUS, RADIUS, 21)[:, None]
    depth = np.linspace(-RADIUS, RADIUS, 21)[None, :]
    for slope in (-math.tan(angle), 0.0, math.tan(angle)):
        assert np.abs(place + slope * depth - place / tip * (tip + depth)).max() <= margin
    assert view["tangent"] * (tip - RADIUS) > RADIUS * (1.0 + math.tan(angle))


def test_many_views_share_the_texels():
    assert [views_side(count) for count in (1, 2, 6, 7, 32, 96)] == [512, 512, 256, 256, 128, 128]
