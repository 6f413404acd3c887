# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes that are measured: rooms made here, and Blender scenes exported to .npz."""

import dataclasses
import importlib.util
import itertools
import logging
import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import cached_property
from pathlib import Path

import numpy as np
from deep_cubemap_scenes import room_with_meshes
from support.lobes import Lobe, LobeKind, material

from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.integrator.common.active_paths import ActivePaths
from rppm_addon.integrator.common.records.rays import HIT
from rppm_addon.integrator.deep_cubemap.deep_cubemap import DeepCubemap
from rppm_addon.integrator.deep_cubemap.placement import radius_about
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import Camera, Scene, load_scene
from rppm_addon.scene.errors import RppmError
from rppm_addon.scene.lights import Light, LightKind
from rppm_addon.scene.meshes import Instance, Mesh

from .. import ROOT
from ..machine import Clock
from .bounding_volumes import BoundingVolumes, build_nodes
from .ray_sets import different, photon_origins, record_rays, triangles

log = logging.getLogger("benchmark")

ROOMS = {
    "room_1k": 1_000,
    "room_3k": 3_000,
    "room_10k": 10_000,
    "room_30k": 30_000,
    "room_100k": 100_000,
    "room_300k": 300_000,
    "room_1M": 1_000_000,
}
"""Made scenes and about how many triangles they have."""
SAMPLE = "first_light"
SHARED = (
    "diamond_ring",
    "glass_caustics",
    "causticcube",
    "mirror_room",
    "pool",
    "sponza_dabrovic",
    "cornell_box_tm",
    "water_caustic_cornell",
    "fireplace_room",
    "bathroom",
    "bmw27",
    "sponza_dabrovic_1M",
)
"""Blender scenes that are not part of this repository, by their file names."""
NAMES = (*ROOMS, SAMPLE, *SHARED)
_EXPORT_SECONDS = 300


class Subject:
    """A scene on the device, with its rays and what its hits must be. ``source``: made, sample or shared."""

    def __init__(
        self, name: str, scene: Scene, mapper: ProgressivePhotonMapper, library: ProgramLibrary, ray_count: int
    ) -> None:
        self.name, self.scene = name, scene
        self.source = "made" if name in ROOMS else "sample" if name == SAMPLE else "shared"
        self.mapper, self.library, self.context = mapper, library, mapper.context
        self._ray_count = ray_count
        settings = dataclasses.replace(
            scene.settings, photons=max(ray_count // 4, 256), cubemap_resolution=0, photon_path_length=8
        )
        # Few pixels: what the picture needs is not measured, and rays are spread over the window anyhow.
        camera = dataclasses.replace(scene.camera, width=64, height=48, crop=None)
        mapper.build(dataclasses.replace(scene, settings=settings, camera=camera))
        self.triangle_count = mapper.triangle_count
        self.automatic_center = tuple(float(c) for c in mapper.device_scene.acceleration.center)
        self._buffers: dict[int, dict] = {}
        self._listed = ActivePaths(self.context, library, "rays to measure with", "take fewer")

    @property
    def geometry(self):
        return self.mapper.device_scene.geometry

    @cached_property
    def host_triangles(self) -> np.ndarray:
        """(n, 3, 3) float32, world space, meters."""
        return triangles(self.mapper)

    @cached_property
    def nodes(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Arrays that build_nodes gives for the triangles."""
        return build_nodes(self.host_triangles)

    @cached_property
    def volumes(self) -> BoundingVolumes:
        """The hierarchy of boxes that speed and hits are compared with."""
        return BoundingVolumes(self.context, self.library, self.nodes)

    @cached_property
    def rays(self) -> dict[str, np.ndarray]:
        """RAY records by kind."""
        return {kind: rays for kind, rays in record_rays(self.mapper, self._ray_count).items() if len(rays)}

    @cached_property
    def emitters(self) -> np.ndarray:
        """(n, 3) points on lights within the bounds that photons leave from, meters."""
        points = photon_origins(self.mapper)
        low, high = self.geometry.bounds_low, self.geometry.bounds_high
        return points[np.all((points >= low) & (points <= high), axis=1)]

    @cached_property
    def expected_hits(self) -> dict[str, np.ndarray]:
        """HIT records of the hierarchy of boxes, by kind."""
        found = {}
        for kind, (rays, hits) in self._ray_buffers(1).items():
            self.volumes.trace(self.geometry.triangles.buffer, rays, hits, len(self.rays[kind]))
            found[kind] = np.frombuffer(hits.read(), HIT.dtype).copy()
        return found

    def build(self, cubemap: DeepCubemap, center=None, resolution: int = 0) -> None:
        """Build a cubemap of the scene; at the mapper's center where none is given. Resolution 0 is automatic."""
        center = np.asarray(self.automatic_center if center is None else center, float)
        cubemap.build(
            self.geometry.triangles.buffer,
            self.triangle_count,
            tuple(center),
            radius_about(center, self.geometry),
            resolution,
        )

    def trace_times(self, clock: Clock, trace: Callable, stride: int = 1) -> tuple[dict[str, float], dict[str, int]]:
        """Seconds and differences from the expected hits, by kind, of ``trace(rays, hits, count)``.

        Every ``stride``-th ray is traced.
        """
        seconds, differences = {}, {}
        for kind, (rays, hits) in self._ray_buffers(stride).items():
            expected = self.expected_hits[kind][::stride]
            count = len(expected)
            trace(rays, hits, min(count, 256) if clock.is_software else count)  # programs are made at first use
            hits.clear()
            seconds[kind] = clock.median(lambda: trace(rays, hits, count))  # noqa: B023 (called at once)
            differences[kind] = different(np.frombuffer(hits.read(), HIT.dtype), expected)
        return seconds, differences

    def traced_by(self, cubemap: DeepCubemap) -> Callable:
        """Return the function that trace_times takes, for a cubemap."""

        def trace(rays, hits, count):
            if self._listed.capacity != count:
                self._listed.fill(count)
            cubemap.trace(rays, hits, self._listed)

        return trace

    def _ray_buffers(self, stride: int) -> dict:
        """Buffers of every ``stride``-th ray, and one for hits, by kind."""
        if stride not in self._buffers:
            gl = self.context.moderngl
            chosen = {kind: rays[::stride] for kind, rays in self.rays.items()}
            self._buffers[stride] = {
                kind: (gl.buffer(rays.tobytes()), gl.buffer(reserve=HIT.size * len(rays)))
                for kind, rays in chosen.items()
            }
        return self._buffers[stride]

    def release(self) -> None:
        for buffers in self._buffers.values():
            for buffer in itertools.chain.from_iterable(buffers.values()):
                buffer.release()
        self._listed.release()
        if "volumes" in self.__dict__:
            self.volumes.release()


class SceneStore:
    """Finds scenes by name; keeps exported ones in ``saved``, a folder."""

    def __init__(self, blend_folder: Path, saved: Path) -> None:
        self._blend_folder, self._saved = blend_folder, saved

    def load(self, name: str) -> Scene | None:
        """A scene, or None where neither its .npz nor both its .blend and Blender are here."""
        if name in ROOMS:
            return room_scene(ROOMS[name])
        blend = ROOT / "docs/samples/first_light.blend" if name == SAMPLE else self._blend_folder / f"{name}.blend"
        saved = self._saved / f"{name}.npz"
        try:
            if saved.exists() and not (blend.exists() and blend.stat().st_mtime > saved.stat().st_mtime):
                return load_scene(saved).expanded()
        except RppmError as error:
            log.warning("%s", error)
        problem = _export(blend, saved)
        if problem:
            log.warning("%s is left out: %s", name, problem)
            return None
        return load_scene(saved).expanded()


def room_scene(triangle_count: int) -> Scene:
    """room_with_meshes of the deep cubemap's tests in one gray material, lit by a square under the ceiling."""
    corners = room_with_meshes(triangle_count)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    places = np.arange(3 * len(corners), dtype=np.int32)
    mesh = Mesh(
        name="room",
        positions=corners.reshape(-1, 3),
        corner_vertices=places,
        corner_normals=np.repeat(normals, 3, axis=0).astype(np.float32),
        triangle_corners=places.reshape(-1, 3),
        triangle_slots=np.zeros(len(corners), np.int32),
    )
    camera_matrix = np.eye(4)
    camera_matrix[:3, 3] = 0.11, 0.24, 0.93
    light_matrix = np.array([[1, 0, 0, 0.1], [0, 0, 1, 0.97], [0, -1, 0, 0.05], [0, 0, 0, 1]], float)
    return Scene(
        camera=Camera(camera_matrix, (-0.8, 0.8, -0.6, 0.6), 640, 480, clip_start=0.01),
        meshes=[mesh],
        instances=[Instance(0, np.eye(4), [0], "room")],
        materials=[material("gray", Lobe(LobeKind.DIFFUSE, color=(0.7, 0.7, 0.7)))],
        lights=[Light("square", LightKind.AREA, light_matrix, np.full(3, 10.0), size=(0.4, 0.4))],
    )


def subjects(
    names: list[str], store: SceneStore, context: Context, library: ProgramLibrary, ray_count: int
) -> Iterator[Subject]:
    """The scenes one after the other, each released before the next is made."""
    mapper = ProgressivePhotonMapper(context, library)
    try:
        for name in names:
            scene = store.load(name)
            if scene is None:
                continue
            try:
                subject = Subject(name, scene, mapper, library, ray_count)
            except RppmError as error:
                log.warning("%s is left out: %s", name, error)
                continue
            try:
                yield subject
            finally:
                subject.release()
    finally:
        mapper.release()


def _export(blend: Path, saved: Path) -> str:
    """Export a .blend in a process of its own, as Blender keeps much memory; returns what went wrong."""
    if not blend.exists():
        return f"neither {saved.name} nor {blend.name} is here"
    if importlib.util.find_spec("bpy") is None:
        return f"{saved.name} is not here, and without the bpy module it cannot be exported"
    saved.parent.mkdir(parents=True, exist_ok=True)
    log.info("exporting %s", blend.name)
    command = [sys.executable, "-m", "rppm_addon", "export", str(blend), "-o", str(saved)]
    try:
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=_EXPORT_SECONDS)
    except subprocess.TimeoutExpired:
        return f"no export after {_EXPORT_SECONDS} s"
    return (done.stderr.strip().splitlines() or ["the export failed"])[-1] if done.returncode else ""
