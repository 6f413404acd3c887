# SPDX-License-Identifier: GPL-3.0-or-later
"""Tangents, and bumps whose height depends on them, which Cycles does not move where a bump looks beside."""

import bpy
import numpy as np
import pytest

from ..engines import PIXEL_CENTERS, cycles_pass, render_frame, unfilter
from ..net import Net, material
from ..scenes import ball, camera, light, new_scene, place


def constant_vector(net: Net) -> bpy.types.NodeSocket:
    """Along the tangent, whose direction alone changes: no bump at all."""
    return net.out("VectorDisplacement", 0, {"Vector": (0.8, 0.4, -0.5, 1.0)})


def noise_along_all(net: Net) -> bpy.types.NodeSocket:
    color = net.out("TexNoise", "Color", {"Vector": net.out("TexCoord", "Object"), "Scale": 2.0})
    return net.out("VectorDisplacement", 0, {"Vector": color, "Scale": 0.5})


def tangent_node(net: Net) -> bpy.types.NodeSocket:
    height = net.out("SeparateXYZ", "X", {0: net.out("Tangent")})
    return net.out("Displacement", 0, {"Height": height, "Scale": 0.5})


@pytest.mark.parametrize("give", [constant_vector, noise_along_all, tangent_node], ids=lambda give: give.__name__)
def test_bumps_by_tangents(renderer, give):
    new_scene()
    made, net = material("Feature")
    net.output(net.out("BsdfDiffuse"), Displacement=give(net))
    seen = ball(1.0, made, place(turn=(20.0, 30.0, 40.0)), segments=32)
    layer = seen.data.uv_layers.new()
    positions = np.array([seen.data.vertices[loop.vertex_index].co for loop in seen.data.loops])
    layer.uv.foreach_set("vector", (positions[:, :2] + 0.3 * positions[:, 2:]).astype(np.float32).ravel())
    camera((0.0, -4.0, 2.0), (0.0, 0.0, 0.0))
    light("SUN", 3.0, place(turn=(30.0, 20.0, 0.0)))
    bpy.context.view_layer.use_pass_normal = True
    unfilter()
    theirs = cycles_pass("Normal", "XYZ")
    frame = render_frame(renderer, **PIXEL_CENTERS, passes=("Normal",))
    difference = np.abs(frame.passes["Normal"] - theirs).max(axis=-1)
    assert np.median(difference[np.abs(theirs).max(axis=-1) > 0.0]) < 1e-3
    assert np.percentile(difference, 95) < 0.02


@pytest.mark.parametrize("smooth", [True, False])
def test_tangents_of_meshes_without_a_uv_map(renderer, smooth):
    """Along longitudes, also where these begin anew, toward the camera."""
    new_scene()
    made, net = material("Feature")
    tangent = net.out("Tangent", 0, direction_type="UV_MAP")
    net.output(net.emission(net.scaled(tangent, 0.5, 0.5)))
    seen = ball(1.0, made, place(turn=(0.0, 10.0, 5.0)), segments=16)
    if not smooth:
        seen.data.shade_flat()
    camera((0.3, -4.0, 0.5), (0.0, 0.0, 0.0), 15.0)
    unfilter()
    theirs = cycles_pass()
    difference = np.abs(render_frame(renderer, **PIXEL_CENTERS).combined[..., :3] - theirs).max(axis=-1)
    assert np.percentile(difference, 97) < 1e-3
