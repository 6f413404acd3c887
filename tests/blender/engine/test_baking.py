# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's bake operator with RPPM: textures, colors of vertices, several objects, stopping and errors."""

import bpy
import numpy as np
import pytest
from blender_scenes import add_light, add_mesh
from engine_calls import Proxy
from node_trees import new_material, surface
from support.baking import add_uv_map, aim_at, bake, select

from rppm_addon.blender.engine import baking
from rppm_addon.blender.engine import render_engine as engine_module
from rppm_addon.blender.export.updates.baking import nearest_texels
from rppm_addon.blender.render_client import renderer_thread
from rppm_addon.scene.errors import DeviceError

SLOPE = ([(-1, -1, 0), (1, -1, 0), (1, 1, 2), (-1, 1, 2)], [(0, 1, 2, 3)])


@pytest.fixture
def quad(lit):
    """A white quad with a UV map, whose radiance is 1 under the sun."""
    quad = lit.objects["Quad"]
    add_uv_map(quad)
    lit.render.bake.margin = 0
    return quad


def covered(size=32):
    """Whether add_uv_map puts a single quad on a texel's middle."""
    middles = (np.arange(size) + 0.5) / size
    inside = (middles > 0.05) & (middles < 0.95)
    return inside[:, None] & inside


def test_combined_is_the_light_of_the_surface(quad, lit):
    baked = bake(quad, type="COMBINED")
    np.testing.assert_allclose(baked[covered()], 1.0, rtol=1e-3)
    np.testing.assert_array_equal(baked[~covered()], 0.0)
    lit.camera.location.z = -5.0  # whence nothing of it is seen
    bpy.data.objects.remove(lit.camera)
    np.testing.assert_array_equal(bake(quad, type="COMBINED"), baked)


def test_it_is_baked_whatever_the_camera_sees_of_it(quad):
    quad.visible_camera, quad.is_holdout = False, True
    np.testing.assert_allclose(bake(quad, type="COMBINED")[covered()], 1.0, rtol=1e-3)


def test_the_margin_is_blenders(quad, lit):
    lit.render.bake.margin = 2
    assert (bake(quad, type="COMBINED")[..., 0] > 0.5).sum() > 1.1 * covered().sum()


@pytest.mark.parametrize("domain", ["POINT", "CORNER"])
def test_colors_of_vertices(quad, lit, domain):
    """They are no picture that could be denoised."""
    lit.rppm.use_denoising = True
    lit.render.bake.target = "VERTEX_COLORS"
    colors = quad.data.color_attributes.new("Baked", "FLOAT_COLOR", domain)
    quad.data.color_attributes.active_color = colors
    select(quad)
    bpy.ops.object.bake(type="COMBINED")
    found = np.array([item.color[:] for item in quad.data.color_attributes["Baked"].data])
    np.testing.assert_allclose(found, np.ones((4, 4)), rtol=1e-3)


def test_two_objects_share_a_texture(quad, lit):
    other = add_mesh(lit, "Slope", *SLOPE, location=(8.0, 0.0, 0.0), material=quad.data.materials[0])
    add_uv_map(other)
    for owner, start in ((quad, 0.0), (other, 0.5)):
        for place in owner.data.uv_layers[0].uv:
            place.vector = (start + 0.5 * place.vector[0], place.vector[1])
    baked = bake(quad, others=(other,), type="COMBINED")
    np.testing.assert_allclose(baked[6:26, 3:13, 0], 1.0, rtol=1e-3)
    np.testing.assert_allclose(baked[6:26, 19:29, 0], np.cos(np.pi / 4), rtol=1e-3)


def test_normals_of_a_detailed_object_for_a_plain_one(quad, lit):
    """The quad beneath a slope takes its normals, which Blender turns to the space that was asked for."""
    slope = [(x, y, 0.1 * z) for x, y, z in SLOPE[0]]
    slope = add_mesh(lit, "Slope", slope, SLOPE[1], material=quad.data.materials[0])
    tangent = bake(
        quad, others=(slope,), type="NORMAL", use_selected_to_active=True, cage_extrusion=0.5, normal_space="TANGENT"
    )
    expected = np.array([0.0, -0.1, 1.0]) / np.hypot(0.1, 1.0)
    np.testing.assert_allclose(tangent[12:20, 12:20, :3], np.broadcast_to(0.5 + 0.5 * expected, (8, 8, 3)), atol=1e-3)


def test_a_denoised_picture_keeps_its_edges(quad, lit):
    """The black around an island does not darken it."""
    lit.rppm.direct_light, lit.rppm.photons = "PHOTONS", 1 << 14
    noisy = bake(quad, type="COMBINED")
    lit.rppm.use_denoising = True
    denoised = bake(quad, type="COMBINED")
    inner = np.zeros_like(covered())
    inner[4:-4, 4:-4] = True
    edge = covered() & ~inner
    assert denoised[covered()][:, 0].std() < 0.5 * noisy[covered()][:, 0].std()
    assert denoised[edge][:, 0].mean() == pytest.approx(noisy[edge][:, 0].mean(), rel=0.01)
    np.testing.assert_array_equal(denoised[~covered()], 0.0)


def test_texels_beside_islands_take_after_them():
    known = np.zeros((7, 8), bool)
    known[3, 4] = True
    y, x = np.mgrid[:7, :8]
    expected = np.where(np.maximum(abs(y - 3), abs(x - 4)) <= 2, 3 * 8 + 4, -1)
    np.testing.assert_array_equal(nearest_texels(known, 2), expected)
    np.testing.assert_array_equal(nearest_texels(known, 0) >= 0, known)


def test_what_is_not_offered_is_an_error(quad):
    with pytest.raises(RuntimeError, match="RPPM does not bake the type SHADOW; choose one of Combined, Ambient"):
        bake(quad, type="SHADOW")


def test_errors_of_the_renderer_reach_the_operator(quad, monkeypatch):
    def fail(*_):
        raise DeviceError("the device is gone; start anew")

    monkeypatch.setattr(renderer_thread, "render", fail)
    with pytest.raises(RuntimeError, match="the device is gone; start anew"):
        bake(quad, type="COMBINED")


def test_an_object_without_extent_is_an_error(quad):
    quad.scale = 0.0, 0.0, 0.0
    with pytest.raises(RuntimeError, match='object "Quad" is not rendered, so it cannot be baked'):
        bake(quad, type="COMBINED")


def break_when(monkeypatch, is_due):
    monkeypatch.setattr(
        engine_module, "bake", lambda engine, *given: baking.bake(Proxy(engine, {"test_break": is_due}), *given)
    )


def test_baking_can_be_stopped(quad, lit, monkeypatch):
    """Blender keeps what there is of it."""
    lit.rppm.samples = 1000
    reports = []
    monkeypatch.setattr(baking, "status_text", lambda progress, _: reports.append(progress.iteration) or "")
    break_when(monkeypatch, lambda: bool(reports) and reports[-1] >= 2)
    np.testing.assert_allclose(bake(quad, type="COMBINED")[covered()], 1.0, rtol=1e-3)
    assert reports[-1] == 2


def test_stopping_during_the_export(quad, monkeypatch):
    monkeypatch.setattr(renderer_thread, "render", lambda *_: pytest.fail("the export was to be stopped"))
    break_when(monkeypatch, lambda: True)
    assert (bake(quad, type="COMBINED")[..., :3] == 0.0).all()


def test_surfaces_seen_from_the_camera(quad, lit):
    """A mirror shows the sky straight above itself, or what the camera sees in it: a glowing wall."""
    white = (1, 1, 1, 1)
    quad.data.materials[0], _ = surface("ShaderNodeBsdfAnisotropic", Roughness=0.0, Color=white)
    glow, _ = surface("ShaderNodeEmission", material=new_material("Glow"), Color=white, Strength=3.0)
    add_mesh(lit, "Wall", [(20, -40, 0), (20, 40, 0), (20, 40, 60), (20, -40, 60)], material=glow)
    add_light(lit, "POINT", energy=0.0)
    lit.camera.data.type = "PERSP"
    lit.camera.location = (-5.0, 0.0, 5.0)
    assert (bake(quad, type="COMBINED")[covered()][:, 0] < 1e-3).all()
    lit.render.bake.view_from = "ACTIVE_CAMERA"
    np.testing.assert_allclose(bake(quad, type="COMBINED")[covered()][:, 0], 3.0, rtol=1e-3)


def test_an_image_of_another_size_changes_nothing_else(quad, lit):
    """The scene is taken over between bakes, whatever their number of texels."""
    first = bake(quad, size=16, type="COMBINED")
    bake(quad, size=32, type="EMIT")
    image = bpy.data.images.new("Again", 16, 16, alpha=True, float_buffer=True)
    aim_at(quad, image)
    np.testing.assert_array_equal(bake(quad, size=16, type="COMBINED"), first)
