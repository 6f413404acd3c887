# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes with media that scatter light, and the judgment of their pictures by the noise between seeds."""

import dataclasses
from collections.abc import Sequence

import numpy as np
import scenes

from rppm_addon.scene import (
    Camera,
    Instance,
    Light,
    LightKind,
    Material,
    NodeGraph,
    RenderSettings,
    Scene,
    World,
)

Color = float | Sequence[float]
SIZE = 8
"""Pixels of a side."""


def _color(value: Color) -> tuple[float, ...]:
    return tuple(map(float, np.broadcast_to(value, 3)))


def camera(eye: tuple, target: tuple, half: float, size: int = SIZE) -> Camera:
    """scenes.camera, whose rays begin at the eye."""
    return dataclasses.replace(scenes.camera(eye, target, half, size), clip_start=1e-6)


def volume(scattering: Color, absorption: Color = 0.0, g: float = 0.0, emission: Color = 0.0) -> NodeGraph:
    """The graph of an even medium: coefficients, 1/m, anisotropy and emission, W/(m^3 sr)."""
    graph = NodeGraph()
    graph.surface = graph.add(
        "volume_coefficients",
        "volume",
        scatter_coefficients=_color(scattering),
        absorption_coefficients=_color(absorption),
        emission_coefficients=_color(emission),
        anisotropy=g,
    )
    return graph


def fog(scattering: Color, absorption: Color = 0.0, g: float = 0.0, emission: Color = 0.0) -> Material:
    """A material that has a volume alone."""
    surface = NodeGraph()
    surface.surface = surface.add("volume_boundary", "bsdf")
    return Material("fog", surface, volume(scattering, absorption, g, emission))


def lamp(*at: float, strength: Color = 1.0) -> Light:
    """A lamp without size, of so many W/sr."""
    return Light("lamp", LightKind.POINT, scenes.placed(*at, 1.0), np.array(_color(strength)))


def scene_of(
    camera: Camera,
    *parts: tuple[object, Material, np.ndarray],
    lights: Sequence[Light] = (),
    world: World | None = None,
    **settings: object,
) -> Scene:
    """Parts: a mesh, its material, and where it is."""
    settings = {"iterations": 16, "photons": 4096, "filter_width": 0.0, "max_bounces": 1024} | settings
    return Scene(
        camera,
        [mesh for mesh, _, _ in parts],
        [Instance(number, matrix, [number]) for number, (_, _, matrix) in enumerate(parts)],
        [surface for _, surface, _ in parts],
        list(lights),
        world or World(),
        settings=RenderSettings(**settings),
    )


def pictures_of(renderer, scene: Scene, seeds: int = 8) -> np.ndarray:
    """(seeds, H, W, 3) float64."""
    found = []
    for seed in range(seeds):
        scene.settings = dataclasses.replace(scene.settings, seed=seed)
        found.append(renderer.render(scene).frame.combined[..., :3].astype(np.float64))
    assert scene.warnings == []
    return np.array(found)


def rays(camera: Camera) -> tuple[np.ndarray, np.ndarray]:
    """Origin, (3,), and directions, (H, W, 3), through the middles of a perspective camera's pixels."""
    left, right, bottom, top = camera.window
    x = left + (right - left) * (np.arange(camera.width) + 0.5) / camera.width
    y = bottom + (top - bottom) * (np.arange(camera.height) + 0.5) / camera.height
    way = np.stack(np.broadcast_arrays(x, y[:, None], -1.0), -1) @ camera.matrix[:3, :3].T
    return camera.matrix[:3, 3], way / np.linalg.norm(way, axis=-1, keepdims=True)


def assert_expected(
    pictures: np.ndarray, expected: np.ndarray | float, most_error: float, bias: float = 0.0, block: int = 4
) -> None:
    """Assert that the mean of independent pictures, (seeds, H, W, 3), is what is expected, (H, W, 3).

    Means of blocks and channels may differ by ``bias``, a fraction, and by seven standard errors, which a t of 7
    degrees of freedom exceeds once in 5000; that of the picture as well. Its error must be below ``most_error``.
    """
    expected = np.broadcast_to(expected, pictures.shape[1:])
    seeds, height, width, _ = pictures.shape
    for side in (block, max(height, width)):
        rows, columns = max(height // side, 1), max(width // side, 1)
        shape = (rows, height // rows, columns, width // columns, 3)
        found = pictures.reshape(seeds, *shape).mean(axis=(2, 4)) / expected.reshape(shape).mean(axis=(1, 3))
        error = found.std(axis=0, ddof=1) / np.sqrt(seeds)
        off = np.abs(found.mean(axis=0) - 1.0)
        print(f"\nblocks of {side}: ratio {found.mean(axis=0).round(4).tolist()} +- {error.max():.2g}")
        assert (off <= bias + 7.0 * error + 1e-5).all(), f"off by {off.max():.3%} +- {error.flat[off.argmax()]:.3%}"
    assert error.max() <= most_error, f"too noisy to tell: {error.max():.3%}"
