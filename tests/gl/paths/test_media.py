# SPDX-License-Identifier: GPL-3.0-or-later
"""Media inside closed surfaces: every segment of a path absorbs and shines, wherever the path begins."""

import dataclasses

import numpy as np
import pytest
import scenes
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import Camera, DirectLight, Instance, Light, LightKind, RenderSettings, Scene, Texels, World

ABSORPTION = np.array([0.0, 0.5, 0.8])
"""1/m."""
SHINING = np.array([0.4, 0.7, 1.0])
"""Emission of media, W/(m^3 sr)."""
SIZE, HALF = 8, 0.3
"""Pixels of a side, and half of what they see at distance 1, m."""
CLEAR, GLOW, WHITE = 0, 1, 2
"""Materials of the scenes: the body's, of a card that shines, of a diffuse one."""


def body_of(surface: Lobe, absorption: np.ndarray | None = ABSORPTION, glow: np.ndarray | None = None):
    return material("body", surface, absorption=absorption, glow=glow)


TRANSPARENT = Lobe(LobeKind.TRANSPARENT)
NEXT_TO_NOTHING = np.full(3, 1e-12)
"""Absorption, 1/m, that leaves all light, of a medium that stops shadow rays as every other does."""
GLASS = Lobe(LobeKind.GLASS, ior=1.0)


def box(name: str = "box"):
    """A box from -1 to 1 whose faces look outward."""
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], np.float32)
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return scenes.polygons(name, corners, faces)


def card(half: float = 3.0):
    """A square in XY that looks up."""
    return scenes.rectangle("card", (-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0))


def scene_of(*placements: tuple[int, np.ndarray, int], body=None, camera=None, lights=(), **settings) -> Scene:
    """Placements of the meshes (0: the box, 1: the card, 2: a ball) with a material; seen from the origin, downward."""
    materials = [
        body or body_of(TRANSPARENT),
        material("glow", Lobe(LobeKind.EMISSION)),
        material("white", Lobe(LobeKind.DIFFUSE, color=(0.8, 0.8, 0.8))),
    ]
    instances = [Instance(mesh, matrix, [surface]) for mesh, matrix, surface in placements]
    meshes = [box(), card(), scenes.sphere("ball", 64, 32)]
    settings = {"iterations": 1, "photons": 64, "filter_width": 0.0} | settings
    camera = camera or Camera(np.eye(4), (-HALF, HALF, -HALF, HALF), SIZE, SIZE, clip_start=1e-6)
    return Scene(camera, meshes, instances, materials, list(lights), settings=RenderSettings(**settings))


def at(z: float, scale: float = 1.0) -> np.ndarray:
    return scenes.placed(0.0, 0.0, z, scale)


def rays() -> np.ndarray:
    """(SIZE, SIZE, 1) lengths of the pixels' rays, by meter downward."""
    x = HALF * (2 * (np.arange(SIZE) + 0.5) / SIZE - 1)
    return np.sqrt(1 + x**2 + x[:, None] ** 2)[..., None]


def picture(renderer, scene: Scene) -> np.ndarray:
    frame = renderer.render(scene).frame
    assert scene.warnings == []
    return frame.combined[..., :3]


def passed(length: np.ndarray | float, absorption: np.ndarray = ABSORPTION) -> np.ndarray:
    return np.exp(-absorption * length)


@pytest.mark.parametrize("surface", [TRANSPARENT, GLASS], ids=["volume alone", "glass"])
def test_a_card_seen_within_a_body(renderer, surface):
    scene = scene_of((0, at(0.0, 4.0), CLEAR), (1, at(-1.0), GLOW), body=body_of(surface))
    np.testing.assert_allclose(picture(renderer, scene), passed(rays()), rtol=1e-5)


def test_the_world_seen_from_a_body(renderer):
    scene = dataclasses.replace(scene_of((0, at(0.0, 4.0), CLEAR)), world=World(np.ones(3)))
    np.testing.assert_allclose(picture(renderer, scene), passed(4.0 * rays()), rtol=1e-5)


def test_lamps_seen_in_a_body(renderer):
    """From within as from outside, before a card behind them as well."""
    lamp = Light("lamp", LightKind.AREA, at(-1.0) @ np.diag([1.0, -1.0, -1.0, 1.0]), np.ones(3), size=(3.0, 3.0))
    within = scene_of((0, at(0.0, 3.0), CLEAR), (1, at(-2.0), 2), lights=[lamp], direct_light=DirectLight.PHOTONS)
    within.materials[WHITE] = material("black", Lobe(LobeKind.DIFFUSE, color=(0.0, 0.0, 0.0)))
    np.testing.assert_allclose(picture(renderer, within), passed(rays()), rtol=1e-5)
    outside = scene_of((0, at(-1.0, 0.5), CLEAR), lights=[lamp])
    np.testing.assert_allclose(picture(renderer, outside), passed(0.5 * rays()), rtol=5e-5)


@pytest.mark.parametrize("mode", [DirectLight.RAYS, DirectLight.PHOTONS])
def test_light_of_a_lamp_within_a_body(renderer, mode):
    """Beside the same without absorption, with the same random numbers."""
    lamp = Light("lamp", LightKind.POINT, scenes.placed(0.0, 0.0, 1.0), np.full(3, 10.0))
    settings = {"photons": 40000, "iterations": 4, "direct_light": mode, "use_final_gather": False}

    made = [
        scene_of((0, at(0.0, 4.0), CLEAR), (1, at(-1.0, 0.5), WHITE), body=body, lights=[lamp], **settings)
        for body in (body_of(TRANSPARENT), body_of(TRANSPARENT, NEXT_TO_NOTHING))
    ]
    ratio = picture(renderer, made[0]) / picture(renderer, made[1])
    x = HALF * (2 * (np.arange(SIZE) + 0.5) / SIZE - 1)
    to_lamp = np.sqrt(4 + x**2 + x[:, None] ** 2)[..., None]
    limit = 1e-4 if mode is DirectLight.RAYS else 3e-3
    np.testing.assert_allclose(ratio, passed(rays() + to_lamp), rtol=limit)


def test_light_of_a_lamp_outside_a_body(renderer):
    """The lamp is half a meter above the water, by photons; the camera above it, too."""
    lamp = Light("lamp", LightKind.POINT, scenes.placed(0.0, 0.0, 1.0), np.full(3, 10.0))
    settings = {"photons": 40000, "iterations": 4, "use_final_gather": False}
    made = [
        scene_of((0, at(-2.5, 2.0), CLEAR), (1, at(-1.0, 0.5), WHITE), body=body, lights=[lamp], **settings)
        for body in (body_of(TRANSPARENT), body_of(TRANSPARENT, NEXT_TO_NOTHING))
    ]
    within, plain = (picture(renderer, scene) for scene in made)
    x = HALF * (2 * (np.arange(SIZE) + 0.5) / SIZE - 1)
    to_lamp = np.sqrt(4 + x**2 + x[:, None] ** 2)[..., None]
    expected = plain * passed(0.5 * rays() + 0.25 * to_lamp)
    assert (plain > 0.0).mean() > 0.9
    np.testing.assert_allclose(within, expected, rtol=3e-3)


@pytest.mark.parametrize("surface", [TRANSPARENT, GLASS], ids=["volume alone", "glass"])
def test_light_through_a_body_in_a_body(renderer, surface):
    """Photons from a lamp within one pass through another of its own absorption; so does the camera's ray."""
    other = np.array([0.3, 0.1, 0.2])
    lamp = Light("lamp", LightKind.POINT, scenes.placed(0.0, 0.0, 1.0), np.full(3, 10.0))
    settings = {"photons": 40000, "iterations": 4, "use_final_gather": False}
    within, plain = (
        scene_of((0, at(0.0, 4.0), CLEAR), (0, at(-0.5, 0.25), 3), (1, at(-1.0, 0.5), WHITE),
                 body=body_of(surface, absorption), lights=[lamp], **settings)
        for absorption in (ABSORPTION, NEXT_TO_NOTHING)
    )  # fmt: skip
    within.materials.append(material("other", surface, absorption=other))
    plain.materials.append(material("other", surface, absorption=NEXT_TO_NOTHING))
    x = HALF * (2 * (np.arange(SIZE) + 0.5) / SIZE - 1)
    to_lamp = np.sqrt(4 + x**2 + x[:, None] ** 2)[..., None]
    seen = (np.abs(x) < 0.2) & (np.abs(x[:, None]) < 0.2)  # rays that go through top and bottom
    expected = picture(renderer, plain) * passed(rays() + to_lamp) * passed(0.5 * rays() + 0.25 * to_lamp, other)
    np.testing.assert_allclose(picture(renderer, within)[seen], expected[seen], rtol=3e-3)


def test_a_tinted_bulb(renderer):
    """A lamp in a ball of absorption lights a floor."""
    lamp = Light("lamp", LightKind.POINT, at(0.5), np.full(3, 10.0))
    settings = {"photons": 20000, "iterations": 4, "use_final_gather": False}

    made = [
        scene_of((2, at(0.5, 0.4), CLEAR), (1, at(-1.0), WHITE), body=body, lights=[lamp], **settings)
        for body in (body_of(TRANSPARENT), body_of(TRANSPARENT, NEXT_TO_NOTHING))
    ]
    ratio = picture(renderer, made[0]) / picture(renderer, made[1])
    np.testing.assert_allclose(ratio, np.broadcast_to(passed(0.4), ratio.shape), rtol=2e-3)


def test_bodies_that_overlap_add_up(renderer):
    """The camera is in three of a material, and in a fourth of another; the ray leaves two before it comes to the
    card."""
    other = np.array([0.3, 0.1, 0.2])
    scene = scene_of(
        (0, at(0.0, 4.0), CLEAR), (0, at(0.2, 0.5), CLEAR), (0, at(0.1, 0.2), 3), (0, at(0.0, 3.5), CLEAR),
        (1, at(-2.0), GLOW),
    )  # fmt: skip
    scene.materials.append(material("other", TRANSPARENT, absorption=other))
    expected = passed(rays() * 2.0 * 2) * passed(0.3 * rays()) * passed(0.1 * rays(), other)
    np.testing.assert_allclose(picture(renderer, scene), expected, rtol=1e-4)


def test_a_bubble(renderer):
    """The camera is in a hollow of a body, whose surface looks inward."""
    hollow = np.diag([-0.5, 0.5, 0.5, 1.0])
    scene = scene_of((0, at(0.0, 4.0), CLEAR), (0, hollow, CLEAR), (1, at(-2.0), GLOW))
    scene.meshes[0] = dataclasses.replace(scene.meshes[0])
    scene.meshes.append(inside_out(box()))
    scene.instances[1] = Instance(3, at(0.0, 0.5), [CLEAR])
    np.testing.assert_allclose(picture(renderer, scene), passed(1.5 * rays()), rtol=1e-4)


def inside_out(mesh):
    return dataclasses.replace(
        mesh, triangle_corners=np.ascontiguousarray(mesh.triangle_corners[:, ::-1]), corner_normals=-mesh.corner_normals
    )


@pytest.mark.parametrize("camera", ["orthographic", "clip start"])
def test_a_camera_half_in_a_body(renderer, camera):
    """Each ray begins in what is around its own origin."""
    matrix = np.eye(4)
    matrix[:3, :3] = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]  # along +Y
    seen = Camera(matrix, (-0.5, 0.5, -0.5, 0.5), SIZE, SIZE, orthographic=True)
    if camera == "clip start":
        seen = Camera(matrix, (-0.5, 0.5, -0.5, 0.5), SIZE, SIZE, clip_start=0.5)
    wall = np.eye(4)
    wall[:3, :3] = matrix[:3, :3]
    wall[:3, 3] = (0.0, 2.0, 0.0)
    water = scenes.placed(0.0, 0.0, -4.0, 4.0)
    scene = scene_of((0, water, CLEAR), (1, wall, GLOW), camera=seen)
    seen_picture = picture(renderer, scene)
    if camera == "orthographic":
        below = passed(np.full((SIZE // 2, SIZE, 1), 1.9))
    else:
        x = (np.arange(SIZE) + 0.5) / SIZE - 0.5
        below = passed(1.5 * np.sqrt(1 + x**2 + x[: SIZE // 2, None] ** 2)[..., None])
    np.testing.assert_allclose(seen_picture[: SIZE // 2], below, rtol=1e-4)
    np.testing.assert_array_equal(seen_picture[SIZE // 2 :], 1.0)


def shone(length: np.ndarray | float, absorption: np.ndarray) -> np.ndarray:
    """Radiance along a length of a medium."""
    with np.errstate(invalid="ignore", divide="ignore"):
        seen = np.where(absorption > 0, (1 - np.exp(-absorption * length)) / absorption, length)
    return SHINING * seen


@pytest.mark.parametrize("share", [0.0, 1.0, 1e-4], ids=["clear", "strong", "weak"])
@pytest.mark.parametrize("within", [False, True], ids=["from outside", "from within"])
def test_a_body_that_shines(renderer, share, within):
    """Before a card that shines as well."""
    absorption = share * ABSORPTION
    body = body_of(TRANSPARENT, absorption, SHINING)
    scene = scene_of((0, at(0.0 if within else -1.5), CLEAR), (1, at(-3.0), GLOW), body=body)
    length = rays() * (1.0 if within else 2.0)
    np.testing.assert_allclose(
        picture(renderer, scene), shone(length, absorption) + passed(length, absorption), rtol=2e-5
    )


def test_a_body_that_shines_lights_surfaces(renderer):
    """A card in a body whose light comes from near it alone gets the same from all sides."""
    absorption, far = np.full(3, 2.0), 0.01
    scene = scene_of(
        (0, at(-4.0, 20.0), CLEAR), (1, at(-far), WHITE), body=body_of(TRANSPARENT, absorption, SHINING), iterations=8
    )
    scene.materials[WHITE] = material("white", Lobe(LobeKind.DIFFUSE))
    expected = SHINING / 2.0 * passed(far * rays(), absorption) + shone(far * rays(), absorption)
    found = picture(renderer, scene).mean(axis=(0, 1))
    np.testing.assert_allclose(found, expected.mean(axis=(0, 1)), rtol=0.01)


@pytest.mark.parametrize("side", [0, 1], ids=["below", "above"])
def test_texels_lie_before_their_body(renderer, side):
    """Light that comes to the faces of a body from outside is as if there were nothing inside."""
    lamp = Light("lamp", LightKind.POINT, scenes.placed(0.0, 0.0, 3.0 if side else -3.0), np.full(3, 10.0))
    mesh = box()
    centers = mesh.positions[mesh.corner_vertices[mesh.triangle_corners]].mean(axis=1)
    triangle = int(np.argmax(centers[:, 2] if side else -centers[:, 2]))
    texels = Texels(
        instance=0,
        triangles=np.full((SIZE, SIZE), triangle, np.int32),
        barycentrics=np.random.default_rng(4).uniform(0.05, 0.45, (SIZE, SIZE, 2)).astype(np.float32),
        differentials=np.zeros((SIZE, SIZE, 4), np.float32),
    )
    camera = Camera(np.eye(4), (0.0, SIZE, 0.0, SIZE), SIZE, SIZE, orthographic=True, texels=texels)
    surface = Lobe(LobeKind.DIFFUSE, color=(0.8, 0.8, 0.8))
    filled, empty = (
        picture(renderer, scene_of((0, at(0.0), CLEAR), body=body_of(surface, inside), camera=camera, lights=[lamp]))
        for inside in (ABSORPTION, None)
    )
    assert (empty > 0.0).all()
    np.testing.assert_allclose(filled, empty, rtol=1e-5)


def test_texels_of_the_world_are_in_no_body(renderer):
    texels = Texels(
        instance=0,
        triangles=np.zeros((SIZE, SIZE), np.int32),
        barycentrics=np.full((SIZE, SIZE, 2), 0.3, np.float32),
        differentials=np.zeros((SIZE, SIZE, 4), np.float32),
        see_environment=True,
    )
    camera = Camera(np.eye(4), (0.0, SIZE, 0.0, SIZE), SIZE, SIZE, orthographic=True, texels=texels)
    scene = scene_of((0, at(0.0), CLEAR), camera=camera)
    scene.world = World(np.array([0.2, 0.4, 0.6]))
    np.testing.assert_allclose(picture(renderer, scene), np.broadcast_to([0.2, 0.4, 0.6], (SIZE, SIZE, 3)), rtol=1e-5)
