# SPDX-License-Identifier: GPL-3.0-or-later
"""Media inside closed surfaces: every segment of a path absorbs and shines, wherever the path begins."""

import dataclasses

import numpy as np
import pytest
import scenes
from support.lobes import Lobe, LobeKind, material

from rppm_addon.integrator.surfaces.volume_insets import inset_matrix
from rppm_addon.scene import Camera, DirectLight, Instance, Light, LightKind, RenderSettings, Scene, Texels, World

ABSORPTION, OTHER = np.array([0.0, 0.5, 0.8]), np.array([0.3, 0.1, 0.2])
"""Absorption of bodies and of others within them, 1/m."""
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


def scene_of(*placements: tuple[int, np.ndarray, int], body=None, camera=None, lights=(), **settings) -> Scene:
    """Placements of the meshes (0: the box, 1: the card, 2: a ball) with a material; seen from the origin, downward."""
    materials = [
        body or body_of(TRANSPARENT),
        material("glow", Lobe(LobeKind.EMISSION)),
        material("white", Lobe(LobeKind.DIFFUSE, color=(0.8, 0.8, 0.8))),
    ]
    instances = [Instance(mesh, matrix, [surface]) for mesh, matrix, surface in placements]
    meshes = [scenes.box("box"), scenes.square("card", 3.0), scenes.sphere("ball", 64, 32)]
    settings = {"iterations": 1, "photons": 64, "filter_width": 0.0} | settings
    camera = camera or Camera(np.eye(4), (-HALF, HALF, -HALF, HALF), SIZE, SIZE, clip_start=1e-6)
    return Scene(camera, meshes, instances, materials, list(lights), settings=RenderSettings(**settings))


def at(z: float, scale: float = 1.0) -> np.ndarray:
    return scenes.placed(0.0, 0.0, z, scale)


def drawn_together(matrix: np.ndarray, number: int = 0) -> float:
    """Fraction to which the box of an instance shrinks whose surface bounds a volume alone."""
    box = np.array([[-1.0] * 3, [1.0] * 3])
    return float(inset_matrix(matrix, box, number)[2, 2] / matrix[2, 2])


def rays(distance: float = 1.0) -> np.ndarray:
    """(SIZE, SIZE, 1) lengths to what the pixels see at distance 1 m below, from so many meters above it."""
    x = HALF * (2 * (np.arange(SIZE) + 0.5) / SIZE - 1)
    return np.sqrt(distance**2 + x**2 + x[:, None] ** 2)[..., None]


def picture(renderer, scene: Scene) -> np.ndarray:
    frame = renderer.render(scene).frame
    assert scene.warnings == []
    return frame.combined[..., :3]


def passed(length: np.ndarray | float, absorption: np.ndarray = ABSORPTION) -> np.ndarray:
    return np.exp(-absorption * length)


LAMP = Light("lamp", LightKind.POINT, at(1.0), np.full(3, 10.0))
LIT = {"photons": 40000, "iterations": 4, "use_final_gather": False}


def with_and_without(renderer, *placements, surface: Lobe = TRANSPARENT, lamp: Light = LAMP, **settings):
    """Pictures of the scene and of the same without absorption, with the same random numbers."""
    return (
        picture(renderer, scene_of(*placements, body=body_of(surface, absorption), lights=[lamp], **LIT | settings))
        for absorption in (ABSORPTION, NEXT_TO_NOTHING)
    )


@pytest.mark.parametrize("surface", [TRANSPARENT, GLASS], ids=["volume alone", "glass"])
def test_a_card_seen_within_a_body(renderer, surface):
    scene = scene_of((0, at(0.0, 4.0), CLEAR), (1, at(-1.0), GLOW), body=body_of(surface))
    np.testing.assert_allclose(picture(renderer, scene), passed(rays()), rtol=1e-5)


def test_the_world_seen_from_a_body(renderer):
    scene = dataclasses.replace(scene_of((0, at(0.0, 4.0), CLEAR)), world=World(np.ones(3)))
    np.testing.assert_allclose(picture(renderer, scene), passed(4.0 * drawn_together(at(0.0, 4.0)) * rays()), rtol=1e-5)


def test_lamps_seen_in_a_body(renderer):
    """From within as from outside, before a card behind them as well."""
    lamp = Light("lamp", LightKind.AREA, at(-1.0) @ np.diag([1.0, -1.0, -1.0, 1.0]), np.ones(3), size=(3.0, 3.0))
    within = scene_of((0, at(0.0, 3.0), CLEAR), (1, at(-2.0), 2), lights=[lamp], direct_light=DirectLight.PHOTONS)
    within.materials[WHITE] = material("black", Lobe(LobeKind.DIFFUSE, color=(0.0, 0.0, 0.0)))
    np.testing.assert_allclose(picture(renderer, within), passed(rays()), rtol=1e-5)
    outside = scene_of((0, at(-1.0, 0.5), CLEAR), lights=[lamp])
    np.testing.assert_allclose(picture(renderer, outside), passed(0.5 * rays()), rtol=5e-5)


@pytest.mark.parametrize(("mode", "limit"), [(DirectLight.RAYS, 1e-4), (DirectLight.PHOTONS, 3e-3)])
def test_light_of_a_lamp_within_a_body(renderer, mode, limit):
    placements = (0, at(0.0, 4.0), CLEAR), (1, at(-1.0, 0.5), WHITE)
    within, plain = with_and_without(renderer, *placements, direct_light=mode)
    np.testing.assert_allclose(within / plain, passed(rays() + rays(2.0)), rtol=limit)


def test_light_of_a_lamp_outside_a_body(renderer):
    """The lamp is half a meter above the water, by photons; the camera above it, too."""
    within, plain = with_and_without(renderer, (0, at(-2.5, 2.0), CLEAR), (1, at(-1.0, 0.5), WHITE))
    assert (plain > 0.0).mean() > 0.9
    np.testing.assert_allclose(within, plain * passed(0.5 * rays() + 0.25 * rays(2.0)), rtol=3e-3)


@pytest.mark.parametrize("surface", [TRANSPARENT, GLASS], ids=["volume alone", "glass"])
def test_light_through_a_body_in_a_body(renderer, surface):
    """Photons from a lamp within one pass through another of its own absorption; so does the camera's ray."""
    pictures = []
    for inner, outer in ((OTHER, ABSORPTION), (NEXT_TO_NOTHING, NEXT_TO_NOTHING)):
        placements = (0, at(0.0, 4.0), CLEAR), (0, at(-0.5, 0.25), 3), (1, at(-1.0, 0.5), WHITE)
        scene = scene_of(*placements, body=body_of(surface, outer), lights=[LAMP], **LIT)
        scene.materials.append(material("other", surface, absorption=inner))
        pictures.append(picture(renderer, scene))
    within, plain = pictures
    x = HALF * (2 * (np.arange(SIZE) + 0.5) / SIZE - 1)
    seen = (np.abs(x) < 0.2) & (np.abs(x[:, None]) < 0.2)  # rays that go through top and bottom
    expected = plain * passed(rays() + rays(2.0)) * passed(0.5 * rays() + 0.25 * rays(2.0), OTHER)
    np.testing.assert_allclose(within[seen], expected[seen], rtol=3e-3)


def test_a_tinted_bulb(renderer):
    """A lamp in a ball of absorption lights a floor."""
    lamp = dataclasses.replace(LAMP, matrix=at(0.5))
    placements = (2, at(0.5, 0.4), CLEAR), (1, at(-1.0), WHITE)
    within, plain = with_and_without(renderer, *placements, lamp=lamp, photons=20000)
    np.testing.assert_allclose(within / plain, np.broadcast_to(passed(0.4), plain.shape), rtol=2e-3)


def test_bodies_that_overlap_add_up(renderer):
    """The camera is in three of a material, and in a fourth of another; the ray leaves two before it comes to the
    card."""
    scene = scene_of(
        (0, at(0.0, 4.0), CLEAR), (0, at(0.2, 0.5), CLEAR), (0, at(0.1, 0.2), 3), (0, at(0.0, 3.5), CLEAR),
        (1, at(-2.0), GLOW),
    )  # fmt: skip
    scene.materials.append(material("other", TRANSPARENT, absorption=OTHER))
    expected = passed(rays() * 2.0 * 2) * passed(0.3 * rays()) * passed(0.1 * rays(), OTHER)
    np.testing.assert_allclose(picture(renderer, scene), expected, rtol=1e-4)


def test_a_bubble(renderer):
    """The camera is in a hollow of a body, whose surface looks inward."""
    hollow = np.diag([-0.5, 0.5, 0.5, 1.0])
    scene = scene_of((0, at(0.0, 4.0), CLEAR), (0, hollow, CLEAR), (1, at(-2.0), GLOW))
    scene.meshes.append(scenes.inside_out(scenes.box("box")))
    scene.instances[1] = Instance(3, at(0.0, 0.5), [CLEAR])
    np.testing.assert_allclose(picture(renderer, scene), passed(1.5 * rays()), rtol=1e-4)


@pytest.mark.parametrize("camera", ["orthographic", "clip start"])
def test_a_camera_half_in_a_body(renderer, camera):
    """Each ray begins in what is around its own origin."""
    along_y, wall = np.eye(4), np.eye(4)
    along_y[:3, :3] = wall[:3, :3] = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]
    wall[1, 3] = 2.0
    seen = Camera(along_y, (-0.5, 0.5, -0.5, 0.5), SIZE, SIZE, orthographic=camera == "orthographic")
    below = passed(np.full((SIZE // 2, SIZE, 1), 1.9))
    if camera == "clip start":
        seen.clip_start = 0.5
        x = (np.arange(SIZE) + 0.5) / SIZE - 0.5
        below = passed(1.5 * np.sqrt(1 + x**2 + x[: SIZE // 2, None] ** 2)[..., None])
    found = picture(renderer, scene_of((0, at(-4.0, 4.0), CLEAR), (1, wall, GLOW), camera=seen))
    np.testing.assert_allclose(found[: SIZE // 2], below, rtol=1e-4)
    np.testing.assert_array_equal(found[SIZE // 2 :], 1.0)


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
    place = at(0.0 if within else -1.5)
    scene = scene_of((0, place, CLEAR), (1, at(-3.0), GLOW), body=body)
    length = rays() * (1.0 if within else 2.0) * drawn_together(place)
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


def texel_camera(triangle: int, **members: object) -> Camera:
    """A camera of texels of one triangle of the first instance."""
    texels = Texels(
        instance=0,
        triangles=np.full((SIZE, SIZE), triangle, np.int32),
        barycentrics=np.random.default_rng(4).uniform(0.05, 0.45, (SIZE, SIZE, 2)).astype(np.float32),
        differentials=np.zeros((SIZE, SIZE, 4), np.float32),
        **members,
    )
    return Camera(np.eye(4), (0.0, SIZE, 0.0, SIZE), SIZE, SIZE, orthographic=True, texels=texels)


@pytest.mark.parametrize("side", [0, 1], ids=["below", "above"])
def test_texels_lie_before_their_body(renderer, side):
    """Light that comes to the faces of a body from outside is as if there were nothing inside."""
    lamp = dataclasses.replace(LAMP, matrix=at(3.0 if side else -3.0))
    mesh = scenes.box("box")
    centers = mesh.positions[mesh.corner_vertices[mesh.triangle_corners]].mean(axis=1)
    camera = texel_camera(int(np.argmax(centers[:, 2] if side else -centers[:, 2])))
    surface = Lobe(LobeKind.DIFFUSE, color=(0.8, 0.8, 0.8))
    filled, empty = (
        picture(renderer, scene_of((0, at(0.0), CLEAR), body=body_of(surface, inside), camera=camera, lights=[lamp]))
        for inside in (ABSORPTION, None)
    )
    assert (empty > 0.0).all()
    np.testing.assert_allclose(filled, empty, rtol=1e-5)


def test_texels_of_the_world_are_in_no_body(renderer):
    scene = scene_of((0, at(0.0), CLEAR), camera=texel_camera(0, see_environment=True))
    scene.world = World(np.array([0.2, 0.4, 0.6]))
    np.testing.assert_allclose(picture(renderer, scene), np.broadcast_to([0.2, 0.4, 0.6], (SIZE, SIZE, 3)), rtol=1e-5)
