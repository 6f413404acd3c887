# SPDX-License-Identifier: GPL-3.0-or-later
"""Published speeds of the self-test's scene on devices that it was run on, to compare with."""

from dataclasses import dataclass

SPEED_SCENE = "a room of 2,000 triangles, 256 x 192 pixels, 16,384 photons a sample"


@dataclass(frozen=True)
class PublishedSpeed:
    """Seconds, as Speed has them."""

    device: str
    first_seconds: float
    sample_seconds: float
    build_seconds: float


PUBLISHED = (PublishedSpeed("llvmpipe, 2 cores of an AMD EPYC", 1.05, 0.373, 0.0243),)
"""With programs in the cache, idle; python -m rppm_addon doctor measures them."""
