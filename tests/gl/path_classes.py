# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes in which one light path class L(S|G|D)*E alone reaches the camera, and what it shows there.

A spot lights the first surface of a class only, and the path lengths are as short as the class allows. The camera
looks through pixel centers at the inside of smoothly lit surfaces, farther from the edges than a splat reaches.
"""

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import path_quadrature as quadrature
import scenes
from path_quadrature import Plane, Spot
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import Camera, DirectLight, Instance, Light, LightKind, Mesh, RenderSettings, Scene

SIZE = 24
"""Pixels along a side."""
MODES = RAYS, PHOTONS = DirectLight.RAYS, DirectLight.PHOTONS
FIRST, SECOND, THIRD = np.array([0.9, 0.7, 0.5]), np.array([0.6, 0.8, 0.7]), np.array([0.8, 0.75, 0.9])
"""Colors of the surfaces in the order in which light meets them: a wrong number of bounces shows in the hue."""
CUT = 0.5
SHARP, TRACED, STORED = 0.2, 0.48, 0.52
"""Roughness that draws caustics, just below the cut-off, just above it."""
EXTENT = 0.35
"""Radius of the spot, meters, for paths that find it by scattering alone."""
UP, DOWN = np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, -1.0])
FLOOR = Plane(np.zeros(3), UP)
WALL = Plane(np.array([1.2, 0.0, 0.0]), np.array([-1.0, 0.0, 0.0]))
FLOOR_AXES, WALL_AXES = np.eye(3)[:2], np.eye(3)[1:]
NARROW, WIDE = 0, 1
"""Indices into ProgressivePhotonMapper.splat_radii."""


@dataclass
class Case:
    scene: Scene
    expected: Callable[[np.ndarray], np.ndarray]
    """(H, W, 3) radiance if each importon met the photons that lie at an offset (3,), meters."""
    gathers: int | None = None
    """The radius that its photons are gathered with, NARROW or WIDE; None: by rays alone."""
    across: np.ndarray | None = None
    """(2, 3) axes of the surface on which they are gathered."""


Build = Callable[[DirectLight], Case]


# --- parts of scenes -----------------------------------------------------------------------------


def lobe(kind: str | float, color: np.ndarray) -> Lobe:
    """D, S or the roughness of G."""
    if kind == "D":
        return Lobe(LobeKind.DIFFUSE, color=tuple(color))
    roughness = 0.0 if kind == "S" else kind
    return Lobe(LobeKind.GLOSSY, color=tuple(color), roughness=roughness, multiscatter=False)


def scattering(kind: str | float) -> quadrature.Scatter:
    return quadrature.diffuse if kind == "D" else quadrature.glossy(kind)


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


def scene_of(
    surfaces: list[tuple[Mesh, Lobe]],
    light: Light | None,
    camera: Camera,
    mode: DirectLight,
    photon_path_length: int,
    camera_path_length: int,
    iterations: int = 6,
    photons: int = 8192,
) -> Scene:
    settings = RenderSettings(
        iterations=iterations, photons=photons, direct_light=mode, photon_path_length=photon_path_length,
        camera_path_length=camera_path_length, radius_minimum=0.03, radius_maximum=0.03, filter_width=0.0,
        specular_roughness=CUT, use_final_gather=False,
        radius_scale=100.0,  # bounds the wide radius in pixels, which are few here
    )  # fmt: skip
    return Scene(
        camera,
        [mesh for mesh, _ in surfaces],
        [Instance(index, np.eye(4), [index]) for index in range(len(surfaces))],
        [material(mesh.name, lobe) for mesh, lobe in surfaces],
        [light] if light else [],
        settings=settings,
    )


def traced_only(scene: Scene, iterations: int, photons: int = 64) -> None:
    """Where the camera's random numbers make the noise, pixels are cheaper than photons."""
    scene.camera = dataclasses.replace(scene.camera, width=2 * SIZE, height=2 * SIZE)
    scene.settings = scene.settings.with_values(iterations=iterations, photons=photons)


def colored(values: np.ndarray, *colors: np.ndarray) -> np.ndarray:
    """(H, W) of white surfaces to (H, W, 3) of colored ones."""
    return values[..., None] * np.prod(colors, axis=0)


# --- a floor that the spot lights, and a wall that it does not -----------------------------------

ON_WALL = view((0.0, -0.4, 1.9), (1.2, -0.2, 1.0), 0.3)
ON_FLOOR = view((1.0, -0.2, 0.9), (0.0, 0.0, 0.0), 0.15)


def corner(
    floor: str | float,
    wall: str | float,
    camera: Camera,
    mode: DirectLight,
    lengths: tuple[int, int],
    radius: float = 0.0,
    half_angle: float | None = None,
    iterations: int = 6,
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
        traced_only(scene, 12 if mode is RAYS else 44)
    origin, directions = quadrature.camera_rays(scene.camera)
    points = FLOOR.hit(origin, directions)

    def expected(offset: np.ndarray) -> np.ndarray:
        return colored(quadrature.lit(light, scattering(kind), UP, points + offset, -directions), FIRST)

    return Case(scene, expected, NARROW if mode is PHOTONS and kind != TRACED else None, FLOOR_AXES)


def two_bounces(first: str | float, second: str | float, mode: DirectLight, radius: float = 0.0) -> Case:
    """LDDE, LGDE, LDGE, LGGE: the wall, lit by the floor, seen straight."""
    scene, light = corner(first, second, ON_WALL, mode, (2, 3), radius, iterations=12 if first == "D" else 6)
    gathered_on_floor = second == TRACED
    splats = not gathered_on_floor or (mode is PHOTONS and first != TRACED)
    if gathered_on_floor:
        scattering_alone = mode is PHOTONS and first == TRACED
        traced_only(scene, 192 if scattering_alone else 32 if splats else 44, 1024 if splats else 64)
    origin, directions = quadrature.camera_rays(scene.camera)
    points = WALL.hit(origin, directions)
    scatters = scattering(first), scattering(second)
    detail = 2 if radius else 14 if first == SHARP else 3

    def expected(offset: np.ndarray) -> np.ndarray:
        # The floor's photons move with their light, the wall's are met beside the importon.
        moved, places = (light.moved(-offset), points) if gathered_on_floor else (light, points + offset)
        picture = quadrature.relit(moved, FLOOR, *scatters, WALL.normal, places, -directions, detail)
        return colored(picture, FIRST, SECOND)

    if gathered_on_floor:
        return Case(scene, expected, NARROW if splats else None, FLOOR_AXES)
    return Case(scene, expected, NARROW if first == SHARP else WIDE, WALL_AXES)


def mirror_then(kind: str | float, mode: DirectLight, radius: float = 0.0) -> Case:
    """LSDE, LSGE: the wall, lit by a mirror, seen straight."""
    scene, light = corner("S", kind, ON_WALL, mode, (2, 3), radius, iterations=4)
    if kind == TRACED:
        traced_only(scene, 64)
    image = light.mirrored(FLOOR)
    origin, directions = quadrature.camera_rays(scene.camera)
    points = WALL.hit(origin, directions)

    def expected(offset: np.ndarray) -> np.ndarray:
        picture = quadrature.lit(image, scattering(kind), WALL.normal, points + offset, -directions)
        return colored(picture, FIRST, SECOND)

    return Case(scene, expected, None if kind == TRACED else NARROW, WALL_AXES)
