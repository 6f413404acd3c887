# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of a device, and the results that they must have."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..gl.context.context import Context
from ..gl.programs.programs import ProgramLibrary
from ..integrator.bvh.bvh import Bvh
from ..scene.meshes import Mesh
from ..scene.scene import Scene
from ..scene.settings import DirectLight
from ..session.render.renderer import Renderer
from ..session.render.results import RenderResult
from .meshes import box_sides, placed, sphere
from .ray_queries import TracedTriangles, ray_records
from .scenes import furnace, glass_in_white, room

REFERENCE = Path(__file__).with_name("room.npz")
"""The room of ``reference_scene`` as 4,096 samples gave it (tools/self_test_reference.py)."""
ROOM = (32, 24)
"""Pixels of the picture that is compared."""
_BLOCK = 4
"""Pixels along a side of what is compared."""
MEAN_TOLERANCE = 0.03
BLOCK_TOLERANCE = 0.15
"""Relative tolerance of a block. Over eight seeds noise and radius put the mean off by .4 % (standard deviation .7 %),
the worst block by 7 %."""
_SAMPLES = 64
_SPEED_SIZE = (256, 192)
_SPEED_SAMPLES = 4
_RAYS = 1 << 16


@dataclass(frozen=True)
class Finding:
    """Result of one check."""

    name: str
    passed: bool
    text: str
    """Figures, one line."""


def exact_rays(device: str | None) -> Finding:
    """Whether rays hit through either acceleration structure what they hit when all triangles are tried, bit for bit
    (HIT records).

    Raises DeviceError.
    """
    triangles = np.concatenate(
        [mesh.positions[mesh.corner_vertices][mesh.triangle_corners] for mesh in (*box_sides(), _small_ball())]
    )
    rng = np.random.default_rng(7)
    origins = rng.uniform(-0.98, 0.98, (_RAYS, 3))
    directions = rng.normal(size=(_RAYS, 3))
    directions[::4] = np.round(directions[::4])  # along axes and diagonals, where cells of a cubemap meet
    directions[np.all(directions == 0.0, axis=1)] = 0.0, 0.0, 1.0
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    rays = ray_records(origins, directions)
    context = Context.create(device)
    library = ProgramLibrary(context)
    try:
        center = np.array([0.1, 0.05, -0.2])
        with (
            TracedTriangles(context, library, triangles, center) as traced,
            TracedTriangles(context, library, triangles, center, structure=Bvh(context, library)) as by_bvh,
        ):
            found, tried = (traced.trace(rays), by_bvh.trace(rays)), traced.brute_force(rays)
    finally:
        library.release()
        context.release()
    wrong = int(sum((hits != tried).sum() for hits in found))
    return Finding("Rays", wrong == 0, f"{wrong} of {2 * _RAYS:,} rays hit another thing than brute force finds")


def _small_ball() -> Mesh:
    ball = sphere("ball")
    matrix = placed(0.3, 0.2, -0.4, 0.4).astype(np.float32)
    ball.positions = ball.positions @ matrix[:3, :3].T + matrix[:3, 3]
    return ball


def energy(renderer: Renderer) -> list[Finding]:
    """Whether light is neither lost nor gained where its radiance is known. Raises the errors of scene/errors.py."""
    by_rays, by_photons = (furnace(24, 4, direct_light) for direct_light in (DirectLight.RAYS, DirectLight.PHOTONS))
    bounced = 2.0 * (1.0 - 0.5**12)
    return [
        _mean_of(renderer, "Energy of diffuse light, by rays", by_rays, bounced, 0.02),
        _mean_of(renderer, "Energy of diffuse light, by photons", by_photons, bounced, 0.02),
        _mean_of(renderer, "Energy through rough glass", glass_in_white(24, 16), 1.0, 0.01),
    ]


def _mean_of(renderer: Renderer, name: str, scene: Scene, expected: float, tolerance: float) -> Finding:
    mean = float(renderer.render(scene).frame.combined[..., :3].mean())
    text = f"mean radiance {mean:.4f}, by theory {expected:.4f}, tolerance {tolerance:.0%}"
    return Finding(name, abs(mean / expected - 1.0) < tolerance, text)


def reference_scene(samples: int, seed: int = 0) -> Scene:
    """The room, small: what the reference is of."""
    return room(*ROOM, samples, seed)


def reference() -> np.ndarray:
    """Load the radiance of the room's reference picture, (24, 32, 3) float32."""
    with np.load(REFERENCE, allow_pickle=False) as file:
        return file["radiance"]


def picture(renderer: Renderer) -> Finding:
    """Whether the room looks as it should, in blocks of 4 x 4 pixels. Raises the errors of scene/errors.py."""
    seen = renderer.render(reference_scene(_SAMPLES)).frame.combined[..., :3]
    mean, worst = differences(seen, reference())
    text = f"mean {mean:+.2%} from the reference (tolerance {MEAN_TOLERANCE:.0%}), "
    text += f"blocks at most {worst:.1%} (tolerance {BLOCK_TOLERANCE:.0%})"
    return Finding("Picture", abs(mean) < MEAN_TOLERANCE and worst < BLOCK_TOLERANCE, text)


def differences(seen: np.ndarray, reference: np.ndarray) -> tuple[float, float]:
    """Relative: of the pictures' means, and of blocks over the reference's block, or its mean where that is more."""
    blocks = [_blocks(np.asarray(picture, np.float64)) for picture in (seen, reference)]
    scale = np.maximum(blocks[1], reference.mean())
    return float(seen.mean() / reference.mean() - 1.0), float((np.abs(blocks[0] - blocks[1]) / scale).max())


def _blocks(picture: np.ndarray) -> np.ndarray:
    rows, columns = (side // _BLOCK for side in picture.shape[:2])
    return picture.reshape(rows, _BLOCK, columns, _BLOCK, -1).mean((1, 3, 4))


@dataclass(frozen=True)
class Speed:
    """Speed at which the room renders at the size of the speed check, _SPEED_SIZE pixels."""

    first_seconds: float
    """Until there is a first sample: programs compiled or loaded, the scene built."""
    sample_seconds: float
    """Seconds for each further sample."""
    build_seconds: float
    """Seconds to build the acceleration structure."""
    photons_a_second: float
    stage_seconds: dict[str, float]


def speed(renderer: Renderer, on_progress: Callable[[str], None]) -> Speed:
    """Render the room twice, the second time with all programs at hand. Raises the errors of scene/errors.py."""
    on_progress("programs and first sample")
    start = time.perf_counter()
    renderer.render(room(*_SPEED_SIZE, 1))
    first = time.perf_counter() - start
    on_progress("samples")
    marks: list[float] = []
    result: RenderResult = renderer.render(
        room(*_SPEED_SIZE, 1 + _SPEED_SAMPLES), lambda _progress, _read: marks.append(time.perf_counter())
    )
    sample = (marks[-1] - marks[1]) / _SPEED_SAMPLES
    statistics = result.statistics
    photons = statistics.photons / statistics.iterations / sample
    return Speed(first, sample, statistics.build_seconds, photons, statistics.stage_seconds)
