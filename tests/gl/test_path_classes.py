# SPDX-License-Identifier: GPL-3.0-or-later
"""Every light path class L(S|G|D)*E against quadrature (path_classes.py): nothing missing, nothing twice.

A spot lights the first surface of a class only, and the path lengths are as short as the class allows, so that no
other class reaches the measured pixels. They look through pixel centres at the inside of smoothly lit surfaces, at
least a splat's radius away from the edges, where density estimation loses light. What a splat's kernel does there is
a second derivative, which is taken from the reference itself.
"""

import dataclasses
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import path_classes as reference
import pytest
import scenes
from path_classes import Layer, Plane, Spot
from PIL import Image

from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import (
    Camera,
    DirectLight,
    Instance,
    Light,
    LightKind,
    Lobe,
    LobeKind,
    Material,
    Mesh,
    RenderSettings,
    Scene,
)

SIZE, BLOCKS, SEEDS = 24, 3, 4
"""Pixels along a side, blocks along a side, independent seeds."""
OUTPUT = Path(__file__).parents[2] / "out" / "path_classes"
ROUNDING = 5e-4
"""Relative error of float positions, of unit vectors in 2 x 16 bits, and of block means of the reference (measured
with twice the nodes: at most 3e-4)."""

FIRST, SECOND, THIRD = np.array([0.9, 0.7, 0.5]), np.array([0.6, 0.8, 0.7]), np.array([0.8, 0.75, 0.9])
"""Colours of the surfaces in the order in which light meets them: a wrong number of bounces shows in the hue."""
CUT = 0.5
SHARP, TRACED, STORED = 0.2, 0.48, 0.52
"""Roughness that draws caustics, just below the cut-off, just above it."""
SHARPNESS = 0.05
"""Share of the mean that every test must be able to tell; most tell much less."""
RAYS, PHOTONS = DirectLight.RAYS, DirectLight.PHOTONS
UP, DOWN = np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, -1.0])
ORIGIN = np.zeros(3)


@dataclass
class Case:
    scene: Scene
    expected: Callable[[np.ndarray], np.ndarray]
    """(H, W, 3) radiance if each importon met the photons that lie at an offset (3,), metres."""
    gathers: int | None = None
    """Which of ProgressivePhotonMapper.splat_radii the photons are gathered with; None: by rays alone."""
    across: np.ndarray | None = None
    """(2, 3) the axes of the surface on which they are gathered."""


FLOOR_AXES, WALL_AXES = np.eye(3)[:2], np.eye(3)[1:]


def lobe(kind: str | float, color: np.ndarray) -> Lobe:
    """D, S or the roughness of G."""
    if kind == "D":
        return Lobe(LobeKind.DIFFUSE, color=tuple(color))
    roughness = 0.0 if kind == "S" else kind
    return Lobe(LobeKind.GLOSSY, color=tuple(color), roughness=roughness, multiscatter=False)


def scattering(kind: str | float) -> reference.Scatter:
    return reference.diffuse if kind == "D" else reference.glossy(kind)


def level(name: str, z: float, low: float = -1.5, high: float = 1.5, width: float = 1.5) -> Mesh:
    """A rectangle that faces up."""
    return scenes.rectangle(name, (low, -width, z), (high, -width, z), (high, width, z), (low, width, z))


def facing_down(name: str, z: float, low: float, high: float) -> Mesh:
    return scenes.rectangle(name, (low, -1.5, z), (low, 1.5, z), (high, 1.5, z), (high, -1.5, z))


def spot(position: tuple, target: tuple, half_angle: float, radius: float = 0.0) -> Light:
    matrix = scenes.looking(position, target)
    return Light(
        "spot", LightKind.SPOT, matrix, np.full(3, 5.0), radius=radius, spot_angle=2 * half_angle, spot_blend=1.0
    )


def view(position: tuple, target: tuple, tangent: float) -> Camera:
    return Camera(scenes.looking(position, target), (-tangent, tangent, -tangent, tangent), SIZE, SIZE, clip_start=0.01)


def traced_only(scene: Scene, iterations: int, photons: int = 64) -> None:
    """Where the camera's random numbers make the noise, pixels are cheaper than photons."""
    scene.camera = dataclasses.replace(scene.camera, width=2 * SIZE, height=2 * SIZE)
    scene.settings = scene.settings.with_values(iterations=iterations, photons=photons)


def scene_of(
    surfaces: list[tuple[Mesh, Lobe]],
    light: Light | None,
    camera: Camera,
    mode: DirectLight,
    photon_path_length: int,
    camera_path_length: int,
    iterations: int = 8,
) -> Scene:
    settings = RenderSettings(
        iterations=iterations, photons=16384, direct_light=mode, photon_path_length=photon_path_length,
        camera_path_length=camera_path_length, radius_minimum=0.03, radius_maximum=0.03, filter_width=0.0,
        specular_roughness=CUT,
    )  # fmt: skip
    return Scene(
        camera,
        [mesh for mesh, _ in surfaces],
        [Instance(index, np.eye(4), [index]) for index in range(len(surfaces))],
        [Material(mesh.name, [lobe]) for mesh, lobe in surfaces],
        [light] if light else [],
        settings=settings,
    )


def flat(values: np.ndarray, *colors: np.ndarray) -> np.ndarray:
    """(H, W) of white surfaces to (H, W, 3) of coloured ones."""
    return values[..., None] * np.prod(colors, axis=0)


# --- a floor that the spot lights, and a wall that it does not -----------------------------------

FLOOR = Plane(ORIGIN, UP)
WALL = Plane(np.array([1.2, 0.0, 0.0]), np.array([-1.0, 0.0, 0.0]))
ON_WALL = view((0.0, -0.4, 1.9), (1.2, -0.2, 1.0), 0.3)
ON_FLOOR = view((1.0, -0.2, 0.9), (0.0, 0.0, 0.0), 0.15)
BY_WALL = view((0.0, -0.2, 2.0), (1.2, -0.1, 1.0), 0.08)


def corner(
    floor: str | float,
    wall: str | float,
    camera: Camera,
    mode: DirectLight,
    lengths: tuple[int, int],
    radius: float = 0.0,
    half_angle: float | None = None,
    iterations: int = 8,
) -> tuple[Scene, Spot]:
    """Floor and wall of kinds D, S or a roughness, path lengths of photons and camera.

    The cone of a light with an extent is narrower, so that all of its beams still end on the floor.
    """
    light = spot((-1.2, 0.2, 1.0), (0.0, 0.0, 0.0), half_angle or (0.15 if radius else 0.2), radius)
    upright = scenes.rectangle("wall", (1.2, -1.5, 0.02), (1.2, -1.5, 2), (1.2, 1.5, 2), (1.2, 1.5, 0.02))
    surfaces = [(level("floor", 0.0, -1.5, 1.2), lobe(floor, FIRST)), (upright, lobe(wall, SECOND))]
    return scene_of(surfaces, light, camera, mode, *lengths, iterations), Spot.of(light)


def straight(kind: str | float, mode: DirectLight, radius: float = 0.0) -> Case:
    """LDE, LGE: the floor seen straight."""
    scene, light = corner(kind, "D", ON_FLOOR, mode, (1, 2), radius)
    if mode is RAYS or kind == TRACED:
        traced_only(scene, 64)
    origin, directions = reference.camera_rays(scene.camera)
    points = FLOOR.hit(origin, directions)

    def expected(offset: np.ndarray) -> np.ndarray:
        return flat(reference.lit(light, scattering(kind), UP, points + offset, -directions), FIRST)

    gathers = 0 if mode is PHOTONS and kind != TRACED else None
    return Case(scene, expected, gathers, FLOOR_AXES)


def two_bounces(first: str | float, second: str | float, mode: DirectLight, radius: float = 0.0) -> Case:
    """LDDE, LGDE, LDGE, LGGE: the wall, lit by the floor, seen straight."""
    scene, light = corner(first, second, ON_WALL, mode, (2, 3), radius, iterations=16 if first == "D" else 8)
    if second == TRACED:
        splats = mode is PHOTONS and first != TRACED
        scattering_alone = mode is PHOTONS and first == TRACED
        traced_only(scene, 192 if scattering_alone else 64, 1024 if splats else 64)
    origin, directions = reference.camera_rays(scene.camera)
    points = WALL.hit(origin, directions)
    scatters = scattering(first), scattering(second)
    on_floor = second == TRACED

    def expected(offset: np.ndarray) -> np.ndarray:
        # The floor's photons move with their light, the wall's are met beside the importon.
        moved, places = (light.moved(-offset), points) if on_floor else (light, points + offset)
        detail = 2 if radius else 10 if first == SHARP else 3
        picture = reference.relit(moved, FLOOR, *scatters, WALL.normal, places, -directions, detail)
        return flat(picture, FIRST, SECOND)

    if not on_floor:
        return Case(scene, expected, 0 if first == SHARP else 1, WALL_AXES)
    return Case(scene, expected, 0 if mode is PHOTONS and first != TRACED else None, FLOOR_AXES)


def mirror_then(kind: str | float, mode: DirectLight, radius: float = 0.0) -> Case:
    """LSDE, LSGE: the wall, lit by a mirror, seen straight."""
    scene, light = corner("S", kind, ON_WALL, mode, (2, 3), radius)
    if kind == TRACED:
        traced_only(scene, 128)
    image = light.mirrored(FLOOR)
    origin, directions = reference.camera_rays(scene.camera)
    points = WALL.hit(origin, directions)

    def expected(offset: np.ndarray) -> np.ndarray:
        picture = reference.lit(image, scattering(kind), WALL.normal, points + offset, -directions)
        return flat(picture, FIRST, SECOND)

    return Case(scene, expected, None if kind == TRACED else 0, WALL_AXES)


def then_mirror(mode: DirectLight) -> Case:
    """LDSE: the floor seen in the wall."""
    scene, light = corner("D", "S", BY_WALL, mode, (1, 2), iterations=4)
    origin, directions = reference.camera_rays(scene.camera)
    points = FLOOR.hit(WALL.mirrored(origin), WALL.mirrored_direction(directions))

    def expected(offset: np.ndarray) -> np.ndarray:
        viewers = -WALL.mirrored_direction(directions)
        return flat(reference.lit(light, reference.diffuse, UP, points + offset, viewers), FIRST, SECOND)

    return Case(scene, expected, 0 if mode is PHOTONS else None, FLOOR_AXES)


def two_mirrors(mode: DirectLight) -> Case:
    """LSSDE: a ceiling lit by way of the floor and the wall."""
    camera = view((-0.2, -0.2, 0.6), (0.0, -0.4, 2.0), 0.2)
    scene, light = corner("S", "S", camera, mode, (3, 1), half_angle=0.16)
    ceiling = Plane(np.array([0.0, 0.0, 2.0]), DOWN)
    scene.meshes.append(facing_down("ceiling", 2.0, -1.7, 1.19))
    scene.materials.append(Material("ceiling", [lobe("D", THIRD)]))
    scene.instances.append(Instance(2, np.eye(4), [2]))
    image = light.mirrored(FLOOR).mirrored(WALL)
    origin, directions = reference.camera_rays(scene.camera)
    points = ceiling.hit(origin, directions)

    def expected(offset: np.ndarray) -> np.ndarray:
        picture = reference.lit(image, reference.diffuse, DOWN, points + offset, -directions)
        return flat(picture, FIRST, SECOND, THIRD)

    return Case(scene, expected, 0, FLOOR_AXES)


PATCHES = 28
"""Along a side of the ceiling between two glossy surfaces."""


def glossy_diffuse_glossy(roughness: float, mode: DirectLight) -> Case:
    """LGDGE: two halves of a floor, which do not see each other, and the ceiling between."""
    light = spot((-1.3, 0.1, 0.8), (-0.75, 0.0, 0.0), 0.25)
    surfaces = [
        (level("lit", 0.0, -1.5, -0.05, 1.0), lobe(roughness, FIRST)),
        (facing_down("ceiling", 1.0, -2.0, 2.0), lobe("D", SECOND)),
        (level("seen", 0.0, 0.05, 1.5, 1.0), lobe(roughness, THIRD)),
    ]
    camera = view((1.6, -0.2, 0.7), (0.75, 0.0, 0.0), 0.22)
    scene = scene_of(surfaces, light, camera, mode, 3, 2, iterations=20)
    if roughness == TRACED:
        scene.settings = scene.settings.with_values(iterations=48, photons=2048)
    origin, directions = reference.camera_rays(scene.camera)
    points = FLOOR.hit(origin, directions).reshape(-1, 3)
    side, weight = reference.gauss_legendre(-2.0, 2.0, PATCHES)
    x, y = np.meshgrid(side, 0.75 * side)
    patches = np.stack([x, y, np.ones_like(x)], -1).reshape(-1, 3)
    area = 0.75 * np.outer(weight, weight).ravel()
    glossy = scattering(roughness)
    seen = roughness != TRACED

    def expected(offset: np.ndarray) -> np.ndarray:
        places = patches if seen else patches + offset
        radiance = reference.relit(Spot.of(light), FLOOR, glossy, reference.diffuse, DOWN, places, DOWN + 0 * places)
        picture = reference.gathered(
            patches, DOWN, np.pi * radiance * area, glossy, UP,
            points + offset if seen else points, -directions.reshape(-1, 3),
        )  # fmt: skip
        return flat(picture.reshape(directions.shape[:2]), FIRST, SECOND, THIRD)

    return Case(scene, expected, 1, FLOOR_AXES)


# --- a floor below an interface of glass or a slab -----------------------------------------------

AIR, INDEX = 1.0, 1.5
INTERFACE = 0.6
SLAB = 0.6, 0.8


def glass(name: str, z: float, faces_up: bool = True) -> tuple[Mesh, Lobe]:
    mesh = level(name, z, -2.0, 2.0, 2.0) if faces_up else facing_down(name, z, -2.0, 2.0)
    return mesh, Lobe(LobeKind.GLASS, color=(1.0, 1.0, 1.0), ior=INDEX)


def layers(top: float, slab: bool) -> list[Layer]:
    """From a height down to the floor."""
    if not slab and top <= INTERFACE:
        return [Layer(top, INDEX)]
    if not slab:
        return [Layer(top - INTERFACE, AIR), Layer(INTERFACE, INDEX)]
    if top <= SLAB[0]:
        return [Layer(top, AIR)]
    return [Layer(top - SLAB[1], AIR), Layer(SLAB[1] - SLAB[0], INDEX), Layer(SLAB[0], AIR)]


def panes(slab: bool) -> list[tuple[Mesh, Lobe]]:
    return [glass("bottom", SLAB[0], False), glass("top", SLAB[1])] if slab else [glass("top", INTERFACE)]


def refraction(light_above: bool, camera_above: bool, slab: bool, mode: DirectLight) -> Case:
    """LSDE, LSSDE; LDSE, LDSSE; LSDSE, LSSDSSE: light and camera each above or below the glass."""
    light = spot((-0.5, 0.1, 1.6), (0.0, 0.0, 0.3), 0.4) if light_above else spot((-0.3, 0.1, 0.5), (0, 0, 0), 0.4)
    camera = view((0.6, -0.3, 1.9), (0.0, 0.0, 0.0), 0.1) if camera_above else view((0.5, -0.2, 0.5), (0, 0, 0), 0.2)
    crossings = 2 if slab else 1
    lengths = 1 + crossings * light_above, 1 + crossings * camera_above
    surfaces = [(level("floor", 0.0), lobe("D", FIRST)), *panes(slab)]
    scene = scene_of(surfaces, light, camera, mode, *lengths, iterations=4)
    origin, directions = reference.camera_rays(camera)
    points, _, share = reference.seen_through(layers(origin[2], slab), origin, directions)
    downwards = layers(light.matrix[2, 3], slab)

    def expected(offset: np.ndarray) -> np.ndarray:
        irradiance = reference.refracted_irradiance(Spot.of(light), downwards, points + offset)
        return flat(irradiance * share / np.pi, FIRST)

    gathers = 0 if light_above or mode is PHOTONS else None
    return Case(scene, expected, gathers, FLOOR_AXES)


# --- light sources that are seen -----------------------------------------------------------------

RADIANCE = np.array([3.0, 2.0, 1.0])


def source(kind: str, matrix: np.ndarray) -> tuple[Light | None, list[tuple[Mesh, Lobe]], Callable]:
    """A rectangle of 0.7 x 0.4 or a ball that shines along -Z of a matrix: as a light, as surfaces, and the function
    of rays that tells what they see of it."""
    x, y, centre = 0.35 * matrix[:3, 0], 0.2 * matrix[:3, 1], matrix[:3, 3]
    normal = -matrix[:3, 2]

    def rectangle(origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
        place = Plane(centre, normal).hit(origins, directions) - centre
        inside = (abs(place @ x) < x @ x) & (abs(place @ y) < y @ y) & (directions @ normal < 0)
        return inside[..., None] * RADIANCE

    def ball(origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
        offset = centre - origins
        along = reference.dot(offset, directions)
        inside = reference.dot(offset, offset) - along**2 < 0.2**2
        return inside[..., None] * RADIANCE

    if kind == "area":
        light = Light("lamp", LightKind.AREA, matrix, RADIANCE, shape="RECTANGLE", size=(0.7, 0.4))
        return light, [], rectangle
    if kind == "sphere":
        return Light("lamp", LightKind.POINT, matrix, RADIANCE * np.pi * 0.2**2, radius=0.2), [], ball
    corners = (centre - x - y, centre - x + y, centre + x + y, centre + x - y)
    emission = Lobe(LobeKind.EMISSION, color=tuple(RADIANCE))
    return None, [(scenes.rectangle("lamp", *map(tuple, corners)), emission)], rectangle


def seen_straight(kind: str, mode: DirectLight) -> Case:
    """LE."""
    light, surfaces, shown = source(kind, scenes.looking((0.9, 0.2, 1.1), (0.0, 0.0, 0.0)))
    surfaces.append((level("floor", 0.0), lobe("D", np.zeros(3))))
    camera = view((-0.6, -0.3, 0.5), (0.9, 0.2, 1.1), 0.3)
    scene = scene_of(surfaces, light, camera, mode, 1, 1, iterations=2)
    origin, directions = reference.camera_rays(camera)
    return Case(scene, lambda _: shown(origin, directions))


def seen_in_mirror(kind: str, mode: DirectLight) -> Case:
    """LSE by reflection."""
    light, surfaces, shown = source(kind, scenes.looking((0.9, 0.2, 1.1), (0.0, 0.0, 0.0)))
    surfaces.append((level("floor", 0.0), lobe("S", FIRST)))
    camera = view((-0.8, -0.3, 1.2), (0.0, 0.0, 0.0), 0.2)
    scene = scene_of(surfaces, light, camera, mode, 1, 2, iterations=2)
    origin, directions = reference.camera_rays(camera)
    points = FLOOR.hit(origin, directions)
    return Case(scene, lambda _: FIRST * shown(points, FLOOR.mirrored_direction(directions)))


def seen_through_glass(kind: str, slab: bool, mode: DirectLight) -> Case:
    """LSE by refraction, LSSE through a slab."""
    light, surfaces, shown = source(kind, scenes.looking((0.1, 0.0, 0.21), (0.1, 0.1, 3.0)))
    camera = view((0.6, -0.3, 1.9), (0.0, 0.0, 0.2), 0.25)
    surfaces += panes(slab)
    scene = scene_of(surfaces, light, camera, mode, 1, 3 if slab else 2)
    traced_only(scene, 32)
    origin, directions = reference.camera_rays(scene.camera)
    cut = layers(origin[2], slab)[:-1] + [Layer(0.0, AIR if slab else INDEX)]
    points, leaving, share = reference.seen_through(cut, origin, directions)
    return Case(scene, lambda _: share[..., None] * shown(points, leaving))


# --- the classes ---------------------------------------------------------------------------------

BOTH = (RAYS, PHOTONS)
EXTENT = 0.35
"""Radius of the spot, metres, for paths that find it by scattering alone."""

CASES: dict[str, Callable[[DirectLight], Case]] = {
    "LDE": lambda mode: straight("D", mode),
    "LDDE": lambda mode: two_bounces("D", "D", mode),
    "LSDE mirror": lambda mode: mirror_then("D", mode),
    "LSDE interface": lambda mode: refraction(True, False, False, mode),
    "LSSDE mirrors": two_mirrors,
    "LSSDE slab": lambda mode: refraction(True, False, True, mode),
    "LDSE mirror": then_mirror,
    "LDSE interface": lambda mode: refraction(False, True, False, mode),
    "LDSSE slab": lambda mode: refraction(False, True, True, mode),
    "LSDSE interface": lambda mode: refraction(True, True, False, mode),
    "LSSDSSE slab": lambda mode: refraction(True, True, True, mode),
    "LGE traced": lambda mode: straight(TRACED, mode, EXTENT),
    "LGE stored": lambda mode: straight(STORED, mode, EXTENT),
    "LGDE sharp": lambda mode: two_bounces(SHARP, "D", mode),
    "LGDE traced": lambda mode: two_bounces(TRACED, "D", mode),
    "LGDE stored": lambda mode: two_bounces(STORED, "D", mode),
    "LDGE traced": lambda mode: two_bounces("D", TRACED, mode),
    "LDGE stored": lambda mode: two_bounces("D", STORED, mode),
    "LGDGE traced": lambda mode: glossy_diffuse_glossy(TRACED, mode),
    "LGDGE stored": lambda mode: glossy_diffuse_glossy(STORED, mode),
    "LSGE traced": lambda mode: mirror_then(TRACED, mode, EXTENT),
    "LSGE stored": lambda mode: mirror_then(STORED, mode, EXTENT),
    "LGGE traced traced": lambda mode: two_bounces(TRACED, TRACED, mode, EXTENT),
    "LGGE traced stored": lambda mode: two_bounces(TRACED, STORED, mode, EXTENT),
    "LGGE stored traced": lambda mode: two_bounces(STORED, TRACED, mode, EXTENT),
    "LGGE stored stored": lambda mode: two_bounces(STORED, STORED, mode, EXTENT),
}
for _kind in ("area", "mesh", "sphere"):
    CASES[f"LE {_kind}"] = lambda mode, kind=_kind: seen_straight(kind, mode)
    CASES[f"LSE mirror {_kind}"] = lambda mode, kind=_kind: seen_in_mirror(kind, mode)
    CASES[f"LSE interface {_kind}"] = lambda mode, kind=_kind: seen_through_glass(kind, False, mode)
    CASES[f"LSSE slab {_kind}"] = lambda mode, kind=_kind: seen_through_glass(kind, True, mode)
BY_RAYS_ALONE: dict[str, Callable[[DirectLight], Case]] = {
    "LGE point": lambda mode: straight(TRACED, mode),
    "LGGE point": lambda mode: two_bounces(TRACED, TRACED, mode),
}
"""No scattered path meets a light without extent."""


# --- judging -------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def mapper(context, library):
    mapper = ProgressivePhotonMapper(context, library)
    yield mapper
    mapper.release()


def render(mapper: ProgressivePhotonMapper, scene: Scene, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """(H, W, 3) radiance, and the mean over the iterations of the squares of both splat radii, m^2."""
    scene.settings.seed = seed
    mapper.build(scene)
    squares = []
    for _ in range(scene.settings.iterations):
        mapper.iterate()
        squares.append(np.square(mapper.splat_radii))
    return mapper.film.read_radiance()[..., :3].astype(np.float64), np.mean(squares, axis=0)


def kernel_bias(case: Case, exact: np.ndarray, square: np.ndarray) -> np.ndarray:
    """(H, W, 3) what density estimation adds, to the second order.

    The kernel 2 (1 - x^2) / pi over a disk of radius r adds r^2 / 12 times the Laplacian; so does the mean of four
    points at r / sqrt(3) around the middle. ``square`` is that of both splat radii, m^2.
    """
    if case.gathers is None:
        return np.zeros_like(exact)
    steps = np.sqrt(square[case.gathers] / 3) * np.concatenate([case.across, -case.across])
    return np.mean([case.expected(step) for step in steps], axis=0) - exact


def blocks(pictures: np.ndarray) -> np.ndarray:
    """(..., H, W, 3) to (..., BLOCKS, BLOCKS), means of pixels and channels."""
    *outer, height, width, _ = pictures.shape
    shape = *outer, BLOCKS, height // BLOCKS, BLOCKS, width // BLOCKS, 3
    return pictures.reshape(shape).mean(axis=(-4, -2, -1))


def block_errors(by_seed: np.ndarray, level: np.ndarray) -> np.ndarray:
    """(BLOCKS, BLOCKS) standard errors of the mean over seeds of block means (seeds, BLOCKS, BLOCKS).

    The variance goes with the level, as that of counted photons does; what goes beyond is common to all blocks, for
    four seeds tell little of a single one.
    """
    variance = by_seed.var(axis=0, ddof=1)
    level = np.maximum(level, 0.1 * level.mean())
    return np.sqrt(level * np.mean(variance / level) / len(by_seed))


def judge(name: str, pictures: np.ndarray, exact: np.ndarray, bias: np.ndarray) -> None:
    """Assert that pictures (seeds, H, W, 3) have the mean and the block means of the exact one (H, W, 3).

    They may differ by four standard errors, by the kernel's bias and by rounding.
    """
    draw(name, pictures.mean(axis=0), exact)
    level, by_seed = blocks(exact), blocks(pictures)
    errors = block_errors(by_seed, level)
    ratios = pictures.mean(axis=(1, 2)) / exact.mean(axis=(0, 1))
    mean = ratios.mean(axis=0)
    # Splats reach over blocks: the seeds' own spread counts as well.
    error = max(ratios.mean(axis=1).std(ddof=1) / np.sqrt(SEEDS), np.sqrt((errors**2).mean()) / BLOCKS / level.mean())
    mean_bias = abs(bias.mean() / exact.mean())
    difference = by_seed.mean(axis=0) - level
    allowed = 4 * errors + np.abs(blocks(bias)) + ROUNDING * np.maximum(level, level.mean())
    worst = np.unravel_index(np.argmax(np.abs(difference) / allowed), difference.shape)
    scale = max(level[worst], 0.1 * level.mean())
    print(
        f"\n{name}: ratio {np.round(mean, 4)} +- {error:.4f} bias {bias.mean() / exact.mean():+.4f}; worst block "
        f"{difference[worst] / scale:+.4f} +- {errors[worst] / scale:.4f} bias {blocks(bias)[worst] / scale:+.4f}"
    )
    assert 4 * error + mean_bias < SHARPNESS, f"{name}: too noisy or too blurred to tell"
    assert np.abs(mean - 1).max() <= 4 * error + mean_bias + ROUNDING
    assert (np.abs(difference) <= allowed).all()


def draw(name: str, result: np.ndarray, exact: np.ndarray) -> None:
    """Reference, result and their difference (blue less, red more, full colour at a tenth of the reference's highest
    radiance) side by side to out/path_classes/."""
    white = np.percentile(exact, 99)

    def heat(values: np.ndarray) -> np.ndarray:
        stops = np.array([[0, 0, 0], [70, 10, 110], [190, 40, 80], [250, 140, 20], [255, 255, 180]])
        return np.stack([np.interp(values / white, np.linspace(0, 1, 5), channel) for channel in stops.T], -1)

    part = np.clip((result - exact).mean(axis=-1) / (0.1 * white), -1, 1)[..., None]
    difference = 255 - np.abs(part) * np.where(part > 0, [0, 255, 255], [255, 255, 0])
    gap = np.full((len(exact), 1, 3), 128)
    picture = np.concatenate([heat(exact.mean(-1)), gap, heat(result.mean(-1)), gap, difference], axis=1)[::-1]
    image = Image.fromarray(np.round(picture).astype(np.uint8))
    factor = 192 // len(exact)
    OUTPUT.mkdir(parents=True, exist_ok=True)
    path = OUTPUT / f"{name.replace(' ', '_')}.png"
    image.resize((factor * image.width, factor * image.height), Image.Resampling.NEAREST).save(path)


def compare(mapper: ProgressivePhotonMapper, name: str, case: Case) -> None:
    first = zlib.crc32(name.encode()) & 0xFFFFFFF  # seeds of each case's own: no two share their noise
    renders = [render(mapper, case.scene, first + k) for k in range(SEEDS)]
    exact = case.expected(np.zeros(3))
    bias = kernel_bias(case, exact, np.mean([square for _, square in renders], axis=0))
    judge(name, np.array([picture for picture, _ in renders]), exact, bias)


@pytest.mark.parametrize("mode", BOTH, ids=lambda mode: mode.value)
@pytest.mark.parametrize("name", CASES)
def test_a_class_is_rendered_once(mapper, name, mode):
    compare(mapper, f"{name} {mode.value}", CASES[name](mode))


@pytest.mark.parametrize("name", BY_RAYS_ALONE)
def test_a_light_without_extent_is_found_by_rays(mapper, name):
    compare(mapper, name, BY_RAYS_ALONE[name](RAYS))


# --- all kinds of surfaces together --------------------------------------------------------------

NEAREST_BLOCK = 0.8 * 2.6 / BLOCKS
"""Metres across a block of the room's front, the window's width being 0.8 at 1 m."""
EDGES = 3
"""Edges between walls that cross a block."""


def all_kinds(mode: DirectLight) -> Scene:
    """A room with diffuse walls, a glass ball and a mirror ball, a back wall and a ceiling that are glossy too."""
    scene = scenes.room(
        2 * SIZE, iterations=12, photons=16384, direct_light=mode, photon_path_length=5, camera_path_length=5,
        radius_minimum=0.025, radius_maximum=0.025, filter_width=0.0, specular_roughness=CUT,
    )  # fmt: skip
    for index, roughness in ((1, TRACED), (2, STORED)):
        scene.materials.append(Material("glossy", [lobe("D", 0.4 * FIRST), lobe(roughness, 0.5 * SECOND)]))
        scene.instances[index].materials = [len(scene.materials) - 1]
    # Half as wide as the room: glossy walls find it by scattering, too.
    scene.lights[0] = dataclasses.replace(scene.lights[0], strength=np.full(3, 3.0), size=(1.0, 1.0))
    return scene


def test_direct_light_by_photons_or_by_rays_is_the_same_picture(mapper):
    """Block by block; light that photons alone bring is the same in both and cancels.

    What a kernel of radius r spreads beyond a surface's edge is lost: a strip's worth of 0.17 r, the mean of the
    kernel's positive half. Two walls that meet across a block of width w lose 2 x 0.17 r / w of its direct light.
    """
    renders = {mode: [render(mapper, all_kinds(mode), 100 + k) for k in range(SEEDS)] for mode in BOTH}
    by_rays, by_photons = (np.array([picture for picture, _ in renders[mode]]) for mode in BOTH)
    radius = np.sqrt(np.mean([square[0] for _, square in renders[PHOTONS]]))
    draw("all kinds", by_photons.mean(axis=0), by_rays.mean(axis=0))
    level, difference = blocks(by_rays.mean(axis=0)), blocks(by_photons - by_rays)
    errors = block_errors(difference, level)
    lost = EDGES * 2 * 0.17 * radius / NEAREST_BLOCK
    relative, noise = difference.mean(axis=0) / level, errors / level
    print(f"\nby photons over by rays, less 1:\n{np.round(relative, 4)}\n+-\n{np.round(noise, 4)}")
    print(f"lost at edges {lost:.4f}")
    assert (4 * noise).max() + lost < 2 * SHARPNESS
    assert (relative <= 4 * noise + ROUNDING).all() and (relative >= -4 * noise - lost - ROUNDING).all()
    overall, spread = relative.mean(), np.sqrt((noise**2).mean()) / BLOCKS
    assert 4 * spread + lost < SHARPNESS
    assert -4 * spread - lost - ROUNDING <= overall <= 4 * spread + ROUNDING
