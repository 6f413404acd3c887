# SPDX-License-Identifier: GPL-3.0-or-later
"""How coarse the first pictures of a changed view are."""

import math
from dataclasses import replace

from ...scene.camera import Camera
from ...scene.scene import Scene

COARSEST = 0.25
"""Smallest share of the full side length. Coarser pictures show too little to steer by."""
_STEADY = 0.2
"""A first resolution that would change by less stays as it is, so that pictures do not flicker."""
_STEP = 2.0


class ResolutionScaler:
    """Chooses resolutions by what pixels have cost so far."""

    def __init__(self, seconds_per_pixel: float = math.inf) -> None:
        """seconds_per_pixel: a guess, until it is measured."""
        self._seconds_per_pixel = seconds_per_pixel
        self._first = COARSEST

    def measure(self, pixels: int, seconds: float) -> None:
        """Take note of how long a first picture has taken."""
        self._seconds_per_pixel = seconds / max(pixels, 1)

    def first(self, pixels: int, seconds: float) -> float:
        """The share of the full side length at which a picture comes in about ``seconds``, if not the coarsest."""
        affordable = seconds / (self._seconds_per_pixel * max(pixels, 1))
        wanted = min(1.0, max(COARSEST, math.sqrt(affordable)))
        if abs(wanted - self._first) > _STEADY * self._first or wanted in {1.0, COARSEST}:
            self._first = wanted
        return self._first

    def levels(self, pixels: int, seconds: float) -> list[float]:
        """Ascending shares of the full side length, the last 1: a first picture in about ``seconds``, then sharper
        ones, each four times as many pixels."""
        levels = [self.first(pixels, seconds)]
        while levels[-1] < 1.0:
            sharper = levels[-1] * _STEP
            levels.append(sharper if sharper < 1.0 / math.sqrt(_STEP) else 1.0)
        return levels


def at_level(scene: Scene, level: float) -> Scene:
    """The scene as it is rendered at a share of its side length: fewer pixels, and fewer photons in keeping.

    The radius of Eq. 3 goes with the frame and not with its pixels, so photons thin out less than pixels do. Pixels are
    looked at in their middle, where the picture that they are enlarged to has the surfaces that guide it.
    """
    if level >= 1.0:
        return scene
    photons = max(1, round(scene.photon_count * level))
    return replace(
        scene, camera=scaled(scene.camera, level), settings=replace(scene.settings, photons=photons, filter_width=0.0)
    )


def scaled(camera: Camera, level: float) -> Camera:
    """A camera with fewer pixels that sees the same, its crop to within one of them."""
    width, height = (max(1, round(size * level)) for size in (camera.width, camera.height))
    crop = None
    if camera.crop is not None:
        x_scale, y_scale = width / camera.width, height / camera.height
        x_min, y_min, x_max, y_max = camera.crop
        left, bottom = min(round(x_min * x_scale), width - 1), min(round(y_min * y_scale), height - 1)
        crop = left, bottom, max(left + 1, round(x_max * x_scale)), max(bottom + 1, round(y_max * y_scale))
    return replace(camera, width=width, height=height, crop=crop)
