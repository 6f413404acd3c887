# SPDX-License-Identifier: GPL-3.0-or-later
"""The resolution of the first pictures of a changed view."""

import math
from dataclasses import replace

from ...scene.camera import Camera
from ...scene.scene import Scene

COARSEST = 0.25
"""Smallest fraction of the full side length. Coarser pictures show too little to navigate."""
_STEADY = 0.2
"""Least relative change of the first resolution; smaller ones would make pictures flicker."""
_STEP = 2.0


class ResolutionScaler:
    """Chooses resolutions by the time that pixels have taken so far."""

    def __init__(self, seconds_per_pixel: float = math.inf) -> None:
        """seconds_per_pixel: an estimate, until it is measured."""
        self._seconds_per_pixel = seconds_per_pixel
        self._first = COARSEST

    def measure(self, pixels: int, seconds: float) -> None:
        """Record the time that a first picture has taken."""
        self._seconds_per_pixel = seconds / max(pixels, 1)

    def first(self, pixels: int, seconds: float) -> float:
        """Return the fraction of the full side length at which a picture takes about ``seconds``, at least COARSEST."""
        affordable = seconds / (self._seconds_per_pixel * max(pixels, 1))
        wanted = min(1.0, max(COARSEST, math.sqrt(affordable)))
        if abs(wanted - self._first) > _STEADY * self._first or wanted in {1.0, COARSEST}:
            self._first = wanted
        return self._first

    def levels(self, pixels: int, seconds: float) -> list[float]:
        """Return ascending fractions of the full side length, the last 1.

        The first picture takes about ``seconds``; each of the others has about four times as many pixels.
        """
        levels = [self.first(pixels, seconds)]
        while levels[-1] < 1.0:
            sharper = levels[-1] * _STEP
            levels.append(sharper if sharper < 1.0 / math.sqrt(_STEP) else 1.0)
        return levels


def at_level(scene: Scene, level: float) -> Scene:
    """Return the scene as it is rendered at a fraction of its side length, with fewer pixels and photons.

    The radius of Eq. 3 is proportional to the frame and not to its pixels, so photons become fewer by less than pixels.
    Camera rays go through the middle of pixels: the enlarged picture is guided by the surfaces there.
    """
    if level >= 1.0:
        return scene
    photons = max(1, round(scene.photon_count * level))
    return replace(
        scene, camera=scaled(scene.camera, level), settings=replace(scene.settings, photons=photons, filter_width=0.0)
    )


def scaled(camera: Camera, level: float) -> Camera:
    """Return a camera with fewer pixels and the same view; its crop is rounded to pixels."""
    width, height = (max(1, round(size * level)) for size in (camera.width, camera.height))
    crop = None
    if camera.crop is not None:
        x_scale, y_scale = width / camera.width, height / camera.height
        x_min, y_min, x_max, y_max = camera.crop
        left, bottom = min(round(x_min * x_scale), width - 1), min(round(y_min * y_scale), height - 1)
        crop = left, bottom, max(left + 1, round(x_max * x_scale)), max(bottom + 1, round(y_max * y_scale))
    return replace(camera, width=width, height=height, crop=crop)
