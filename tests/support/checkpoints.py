# SPDX-License-Identifier: GPL-3.0-or-later
"""Checkpoints of stills that nobody rendered."""

import hashlib

import numpy as np

from rppm_addon.integrator.common.photon_counts import NoiseVariances, PhotonCounts
from rppm_addon.integrator.state import RenderState
from rppm_addon.pictures import Placement
from rppm_addon.session.checkpoints.checkpoint_file import StillRender, write_checkpoint
from rppm_addon.session.checkpoints.continuation import Pause

HEIGHT, WIDTH, CELLS = 6, 9, 500
MARK = b"RPPM-SHA-256"
"""Stands in a checkpoint before its digest."""


def still_render(**values: object) -> StillRender:
    """Pixels 3 to 12 and 2 to 8 of a frame of 16x10."""
    scene = {"camera": "aa", "meshes": "bb", "lights": "cc"}
    settings = {"photons": 100, "alpha": 0.7, "seed": 0, "direct_light": "RAYS", "passes": ["Depth", "Normal"]}
    return StillRender(
        **{"scene": scene, "settings": settings, "exposure": 2.0, "placement": Placement(16, 10, 3, 2)} | values
    )


def pause(sample_offset: int = 0, iteration: int = 5, learned: bool = True) -> Pause:
    """Numbers of no meaning, other ones for other iterations; some pixels have found no surface."""
    random = np.random.default_rng([sample_offset, iteration])
    radiance, normal, depth, factors = (
        random.random((HEIGHT, WIDTH, *more), np.float32) for more in ((4,), (3,), (), ())
    )
    depth[random.random(depth.shape) < 0.4] = 1e10
    counts = random.integers(0, iteration - sample_offset + 1, depth.shape, np.uint32)
    normal[counts == 0], depth[counts == 0] = 0.0, 1e10
    counts = np.stack([counts, np.where(depth < 1e10, counts, 0)], axis=-1)
    passes = {"Depth": depth, "Normal": normal}
    tallies, learned_tallies = random.poisson(0.3, (2, CELLS, 2)).astype(np.uint32)
    state = RenderState(
        sample_offset, iteration, PhotonCounts((100, 100, 60)), NoiseVariances(160.0, 9.5, 0.25, 1, 0.125),
        0.1 + random.random(), 3.0 + random.random(), radiance, passes, counts, factors, tallies,
        learned_tallies if learned else None, random.random((3, 5), np.float32) if iteration < 16 else None,
    )  # fmt: skip
    return Pause(state, "a device", 0.25)


def write_part(path, sample_offset: int, iteration: int, **values: object):
    """A part of the still; returns its path."""
    write_checkpoint(path, still_render(**values), pause(sample_offset, iteration), 10.0)
    return path


def unsigned(data: bytes) -> bytes:
    """A checkpoint's bytes without the digest at their end."""
    return data[: data.rindex(MARK)]


def signed(data: bytes) -> bytes:
    """Bytes with the digest that makes them a whole checkpoint."""
    return data + MARK + hashlib.sha256(data).digest()
