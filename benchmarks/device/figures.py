# SPDX-License-Identifier: GPL-3.0-or-later
"""The measurements: each takes a scene and returns plain values for its line in a figure's JSON.

Times are seconds, memory is bytes. ``differences`` counts hits that are not bit for bit those of the
hierarchy of boxes.
"""

import inspect
import logging
from collections.abc import Callable

import numpy as np

from rppm_addon.integrator.common.records.rays import NO_TRIANGLE
from rppm_addon.integrator.deep_cubemap.deep_cubemap import DeepCubemap
from rppm_addon.scene.errors import RppmError

from ..machine import Clock
from .bounding_volumes import build_nodes
from .scenes import SAMPLE, SHARED, Subject

log = logging.getLogger("benchmark")

_SWEPT = ("room_100k", "glass_caustics", "pool", "diamond_ring", "fireplace_room", "bathroom", "sponza_dabrovic_1M")
SCENES = {
    "construction": (
        "room_1k", "room_3k", "room_10k", "room_30k", "room_100k", "room_300k", "room_1M", SAMPLE, *SHARED,
    ),
    "resolution": _SWEPT,
    "bins": _SWEPT,
    "rays": ("room_1k", "room_10k", "room_100k", "room_1M", SAMPLE, *SHARED),
    "placement": (
        "room_100k", SAMPLE, "glass_caustics", "pool", "mirror_room", "sponza_dabrovic", "fireplace_room", "bathroom",
    ),
}  # fmt: skip
"""Scenes of a full run, by figure."""
QUICK_SCENES = {
    "construction": ("room_1k", "room_10k", "room_100k", SAMPLE, "glass_caustics", "pool"),
    "resolution": ("room_10k", "glass_caustics", "pool"),
    "bins": ("room_10k", "glass_caustics", "pool"),
    "rays": ("room_1k", "room_10k", "room_100k", SAMPLE, "glass_caustics", "pool"),
    "placement": ("room_10k", "glass_caustics"),
}

ROUTES = {"rasterization": True, "compute": False}
RESOLUTIONS = (64, 128, 256, 512, 1024)
QUICK_RESOLUTIONS = (64, 128, 256)
BINS = (1, 2, 4, 8, 16, 32, 64, 128)
QUICK_BINS = (1, 4, 16, 64)
# There are many places, and only their times' ratios matter: software drivers trace a part of the rays.
_PLACEMENT_STRIDE = 8


def can_choose_bins() -> bool:
    """Whether the cubemap lets us say how many depth bins a cell may have."""
    return "max_bins" in inspect.signature(DeepCubemap.__init__).parameters


def make_cubemap(subject: Subject, rasterize: bool | None = None, max_bins: int | None = None) -> DeepCubemap:
    """An empty cubemap; None is the default of DeepCubemap. ``max_bins``: depth bins that a cell may have."""
    options: dict[str, object] = {}
    if rasterize is not None:
        options["rasterize"] = rasterize
    if max_bins is not None:
        options["max_bins"] = max_bins
    return DeepCubemap(subject.context, subject.library, **options)


def construction(subject: Subject, clock: Clock, quick: bool) -> dict:
    """Both routes' first build and rebuild, and two hierarchies of boxes over the same triangles."""
    routes = {name: _or_failure(_construct, subject, clock, rasterize, quick) for name, rasterize in ROUTES.items()}
    triangles = subject.host_triangles
    seconds = [clock.host(lambda: subject.nodes, 1)]
    if len(triangles) < 50_000 and not quick:
        seconds += [clock.host(lambda: build_nodes(triangles), 1) for _ in range(4)]
    hierarchies = {"SAH": {"seconds": float(np.median(seconds)), "threads": 1, "nodes": len(subject.nodes[0])}}
    try:
        hierarchies["Embree"] = {"seconds": _build_embree(triangles, clock, quick), "threads": clock.cores}
    except ImportError:
        log.warning("embreex is not here: Embree's build is left out")
    rebuild = routes["rasterization"].get("rebuild_seconds")
    factors = {name: values["seconds"] / rebuild for name, values in hierarchies.items()} if rebuild else {}
    return {"routes": routes, "hierarchies": hierarchies, "times_the_rebuild": factors}


def resolution(subject: Subject, clock: Clock, quick: bool) -> dict:
    """Memory and trace times by the most cells along a face's side; 0 is automatic."""
    tried = (0, *(QUICK_RESOLUTIONS if quick else RESOLUTIONS))
    return {
        "rays": _ray_counts(subject),
        "points": [
            {"resolution": cells, **_or_failure(_build_and_trace, subject, clock, {}, cells)} for cells in tried
        ],
    }


def bins(subject: Subject, clock: Clock, quick: bool) -> dict:
    """Memory and trace times by the most depth bins that a cell may have; None is the cubemap's own choice."""
    tried = (None, *(QUICK_BINS if quick else BINS))
    return {
        "rays": _ray_counts(subject),
        "points": [
            {"max_bins": most, **_or_failure(_build_and_trace, subject, clock, {"max_bins": most}, 0)} for most in tried
        ],
    }


def rays(subject: Subject, clock: Clock, quick: bool) -> dict:
    """Rays a second of the cubemap and of the hierarchy of boxes, by kind of ray."""
    buffer = subject.geometry.triangles.buffer
    cubemap = _build_and_trace(subject, clock, {}, 0)
    boxes, _ = subject.trace_times(clock, lambda *arguments: subject.volumes.trace(buffer, *arguments))
    kinds = {}
    for kind, count in _ray_counts(subject).items():
        seconds = cubemap["trace_seconds"][kind]
        kinds[kind] = {
            "rays": count,
            "hit_share": float(np.mean(subject.expected_hits[kind]["triangle"] != NO_TRIANGLE)),
            "cubemap_rays_per_second": count / seconds,
            "boxes_rays_per_second": count / boxes[kind],
            "ratio": boxes[kind] / seconds,
            "differences": cubemap["differences"][kind],
        }
    return {"finest": cubemap["finest"], "center": subject.automatic_center, "kinds": kinds}


def placement(subject: Subject, clock: Clock, quick: bool) -> dict:
    """Trace times by where the center lies, relative to the automatic place."""
    cubemap = make_cubemap(subject)
    stride = _PLACEMENT_STRIDE if clock.is_software and not quick else 1
    places = []
    try:
        for name, center in _centers(subject, quick):
            build_seconds = clock.once(lambda: subject.build(cubemap, center))  # noqa: B023 (called at once)
            seconds, differences = subject.trace_times(clock, subject.traced_by(cubemap), stride)
            places.append(
                {
                    "place": name,
                    "center": [float(c) for c in center],
                    "finest": cubemap.resolution,
                    "build_seconds": build_seconds,
                    "trace_seconds": seconds,
                    "relative": {kind: value / places[0]["trace_seconds"][kind] for kind, value in seconds.items()}
                    if places
                    else dict.fromkeys(seconds, 1.0),
                    "differences": differences,
                }
            )
    finally:
        cubemap.release()
    return {"rays": _ray_counts(subject, stride), "places": places}


MEASUREMENTS: dict[str, Callable[[Subject, Clock, bool], dict]] = {
    "construction": construction,
    "resolution": resolution,
    "bins": bins,
    "rays": rays,
    "placement": placement,
}


def _ray_counts(subject: Subject, stride: int = 1) -> dict[str, int]:
    return {kind: len(records[::stride]) for kind, records in subject.rays.items()}


def _or_failure(measure: Callable[..., dict], *arguments) -> dict:
    """Return the result of a measurement, or why the device could not do it."""
    try:
        return measure(*arguments)
    except RppmError as error:
        log.warning("%s", error)
        return {"failure": str(error)}


def _construct(subject: Subject, clock: Clock, rasterize: bool, quick: bool) -> dict:
    first = []
    for _ in range(1 if quick or subject.triangle_count > 500_000 else 3):
        cubemap = make_cubemap(subject, rasterize)
        try:
            first.append(clock.once(lambda: subject.build(cubemap)))  # noqa: B023 (called at once)
            rebuild = clock.median(lambda: subject.build(cubemap))  # noqa: B023
            made = {"finest": cubemap.resolution, "counts": dict(cubemap.counts), "memory_bytes": cubemap.memory_bytes}
        finally:
            cubemap.release()
    # Fragments: triangles in cells; entries: triangles in depth bins of cells.
    for name, key in (("fragment", "fragments_per_triangle"), ("entry", "entries_per_triangle")):
        if name in made["counts"]:
            made[key] = made["counts"][name] / max(subject.triangle_count, 1)
    return {"first_seconds": float(np.median(first)), "rebuild_seconds": rebuild, **made}


def _build_and_trace(subject: Subject, clock: Clock, options: dict, cells: int) -> dict:
    cubemap = make_cubemap(subject, **options)
    try:
        subject.build(cubemap, resolution=cells)
        build_seconds = clock.once(lambda: subject.build(cubemap, resolution=cells))
        seconds, differences = subject.trace_times(clock, subject.traced_by(cubemap))
        return {
            "finest": cubemap.resolution,
            "rebuild_seconds": build_seconds,
            "memory_bytes": cubemap.memory_bytes,
            "counts": dict(cubemap.counts),
            "trace_seconds": seconds,
            "differences": differences,
        }
    finally:
        cubemap.release()


def _build_embree(triangles: np.ndarray, clock: Clock, quick: bool) -> float:
    """Median seconds that Embree takes to commit the triangles at its default quality, on all cores."""
    from embreex.mesh_construction import TriangleMesh
    from embreex.rtcore_scene import EmbreeScene

    origin, direction = np.zeros((1, 3), np.float32), np.array([[0.0, 0.0, 1.0]], np.float32)
    seconds = []
    for _ in range(2 if quick else 5):
        scene = EmbreeScene()
        TriangleMesh(scene, triangles)
        seconds.append(clock.host(lambda: scene.run(origin, direction), clock.cores))  # noqa: B023 (builds, 1 ray)
    return float(np.median(seconds[1:]))  # the first one starts Embree's threads


def _centers(subject: Subject, quick: bool) -> list[tuple[str, np.ndarray]]:
    """Names and (3,) points, meters: the automatic place first."""
    rng = np.random.default_rng(3)
    low, high = np.asarray(subject.geometry.bounds_low), np.asarray(subject.geometry.bounds_high)
    middle, radius = 0.5 * (low + high), subject.geometry.radius
    emitters = subject.emitters
    emitters = emitters[rng.choice(len(emitters), min(len(emitters), 1 if quick else 4), replace=False)]
    inside = rng.uniform(low, high, (4 if quick else 16, 3))
    directions = rng.normal(size=(1 if quick else 4, 3))
    outside = middle + 1.5 * radius * directions / np.linalg.norm(directions, axis=1, keepdims=True)
    return [
        ("automatic", np.asarray(subject.automatic_center)),
        ("camera", np.asarray(subject.mapper.scene.camera.matrix[:3, 3])),
        ("middle", middle),
        *(("emitter", point) for point in emitters),
        *(("inside", point) for point in inside),
        *(("outside", point) for point in outside),
    ]
