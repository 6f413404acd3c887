# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of the scenes of light path classes."""

import dataclasses

import numpy as np
import path_quadrature as quadrature
import scenes
from path_constants import CUT, SIZE
from support.lobes import Lobe, LobeKind, material

from rppm_addon.scene import Camera, DirectLight, Light, LightKind, Mesh, Scene


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
    return scenes.scene_of(
        camera, *((mesh, material(mesh.name, lobe)) for mesh, lobe in surfaces), lights=[light] if light else [],
        iterations=iterations, photons=photons, direct_light=mode, photon_path_length=photon_path_length,
        camera_path_length=camera_path_length, radius_minimum=0.03, radius_maximum=0.03, filter_width=0.0,
        specular_roughness=CUT, use_final_gather=False,
        radius_scale=100.0,  # bounds the wide radius in pixels, which are few here
    )  # fmt: skip


def traced_only(scene: Scene, iterations: int, photons: int = 64) -> None:
    """Where the camera's random numbers make the noise, pixels are cheaper than photons."""
    scene.camera = dataclasses.replace(scene.camera, width=2 * SIZE, height=2 * SIZE)
    scene.settings = scene.settings.with_values(iterations=iterations, photons=photons)


def colored(values: np.ndarray, *colors: np.ndarray) -> np.ndarray:
    """(H, W) of white surfaces to (H, W, 3) of colored ones."""
    return values[..., None] * np.prod(colors, axis=0)
