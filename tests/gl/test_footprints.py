# SPDX-License-Identifier: GPL-3.0-or-later
"""Radii of importons against Eq. 3 and 4, and image textures against bilinear interpolation."""

import math

import numpy as np
import pytest
import scenes

from rppm_addon.integrator.records import IMPORTON
from rppm_addon.scene import Camera, Image, Instance, Light, LightKind, Lobe, LobeKind, Material, RenderSettings, Scene

SIZE = 24
TANGENT = 0.4  # of half the vertical aperture


def tilted_view(orthographic: bool, segments: int) -> Scene:
    """A camera that sees a mirror on the left and a floor, and the floor in the mirror."""
    floor = scenes.rectangle("floor", (-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0))
    mirror = scenes.rectangle("mirror", (-1, -9, 0), (-1, 9, 0), (-1, 9, 9), (-1, -9, 9))
    half = TANGENT if not orthographic else 2.0
    camera = Camera(scenes.looking((1, 0.3, 3), (0, 0, 0)), (-half, half, -half, half), SIZE, SIZE, orthographic)
    materials = [scenes.diffuse(0.5, 0.5, 0.5), Material("mirror", [Lobe(LobeKind.GLOSSY)])]
    sun = Light("sun", LightKind.SUN, np.eye(4), np.ones(3))
    settings = RenderSettings(
        photons=64, filter_width=0.0, radius_minimum=1e-9, radius_maximum=1e9, camera_path_length=segments
    )
    instances = [Instance(0, np.eye(4), [0]), Instance(1, np.eye(4), [1])]
    return Scene(camera, [floor, mirror], instances, materials, [sun], settings=settings)


@pytest.mark.parametrize("orthographic", [False, True])
def test_radii_are_those_of_equations_3_and_4(mapper, orthographic):
    scene = tilted_view(orthographic, 1)
    mapper.build(scene)
    mapper.iterate()
    direct = mapper._importons.importons.read(IMPORTON.dtype, SIZE * SIZE)
    scene.settings.camera_path_length = 2
    mapper.build(scene)
    mapper.iterate()
    mirrored = mapper._importons.importons.read(IMPORTON.dtype, SIZE * SIZE)

    camera = scene.camera
    scale = 10.0 * SIZE / 1024
    fraction = (np.arange(SIZE) + 0.5) / SIZE
    half = camera.window[1]
    x, y = np.meshgrid(half * (2 * fraction - 1), half * (2 * fraction - 1))
    right, up, forward = camera.matrix[:3, 0], camera.matrix[:3, 1], -camera.matrix[:3, 2]
    aside = x[..., None] * right + y[..., None] * up
    if orthographic:
        origin, ray = camera.matrix[:3, 3] + aside, np.broadcast_to(forward, aside.shape)
    else:
        ray = forward + aside
        origin, ray = camera.matrix[:3, 3], ray / np.linalg.norm(ray, axis=-1, keepdims=True)
    to_floor = (-origin[..., 2] / ray[..., 2]).reshape(-1)
    to_mirror = ((-1 - origin[..., 0]) / ray[..., 0]).reshape(-1)
    ray = ray.reshape(-1, 3)
    front = ray @ forward
    on_floor, on_mirror = direct["radius"] > 0, mirrored["radius"] > 0
    assert on_floor.sum() > 50 and on_mirror.sum() > 50 and not (on_floor & on_mirror).any()

    def equation_3(distance, facing):
        if orthographic:
            return scale * np.sqrt((2 * half / SIZE) ** 2 / (math.pi * facing))
        return scale * np.sqrt(4 * half**2 * distance**2 * front**3 / (math.pi * SIZE**2 * facing))

    np.testing.assert_allclose(direct["radius"][on_floor], equation_3(to_floor, abs(ray[:, 2]))[on_floor], rtol=2e-3)
    # In the mirror: Eq. 3 at the mirror, grown with the whole path's length. The mirrored path to the
    # floor is as long as the straight one to the floor's plane.
    grown = equation_3(to_mirror, abs(ray[:, 0])) * to_floor / to_mirror
    np.testing.assert_allclose(mirrored["radius"][on_mirror], grown[on_mirror], rtol=2e-3)


def texture(kind: str) -> tuple[Image, np.ndarray]:
    """An image and its (height, width, 3) linear pixels."""
    rng = np.random.default_rng(5)
    if kind == "half":
        pixels = rng.uniform(0, 8, (5, 7, 4)).astype(np.float32)
        return Image("half", pixels), pixels[..., :3].astype(np.float16).astype(float)
    pixels = rng.integers(0, 256, (5, 7, 4), np.uint8)
    linear = pixels[..., :3] / 255
    if kind == "sRGB":
        linear = np.where(linear <= 0.04045, linear / 12.92, ((linear + 0.055) / 1.055) ** 2.4)
    return Image(kind, pixels, "SRGB" if kind == "sRGB" else "LINEAR"), linear


@pytest.mark.parametrize("kind", ["sRGB", "bytes", "half"])
def test_image_textures_are_bilinear_and_repeat(renderer, kind):
    image, linear = texture(kind)
    sheet = scenes.rectangle("sheet", (-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0))
    sheet.corner_uv = np.array([(-0.5, -0.25), (1.5, -0.25), (1.5, 1.75), (-0.5, 1.75)], np.float32)
    camera = Camera(scenes.looking((0, 0, 1), (0, 0, 0)), (-1, 1, -1, 1), 40, 40, True)
    camera.matrix[:3, :3] = np.eye(3)
    glow = Material("glow", [Lobe(LobeKind.EMISSION, color=(1, 2, 3), color_image=0)])
    settings = RenderSettings(iterations=1, photons=64, filter_width=0.0)
    scene = Scene(camera, [sheet], [Instance(0, np.eye(4), [0])], [glow], images=[image], settings=settings)
    got = renderer.render(scene).frame.combined[..., :3]
    at = (np.arange(40) + 0.5) / 40 * 2
    u, v = (at - 0.5) * 7 - 0.5, (at - 0.25) * 5 - 0.5
    column, row = np.floor(u).astype(int), np.floor(v).astype(int)
    fu, fv = (u - column)[None, :, None], (v - row)[:, None, None]

    def texel(dy, dx):
        return linear[(row + dy) % 5][:, (column + dx) % 7]

    expected = (1 - fv) * ((1 - fu) * texel(0, 0) + fu * texel(0, 1)) + fv * ((1 - fu) * texel(1, 0) + fu * texel(1, 1))
    np.testing.assert_allclose(got, expected * [1, 2, 3], rtol=2e-3, atol=2e-3)
