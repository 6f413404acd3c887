# SPDX-License-Identifier: GPL-3.0-or-later
"""Estimators of light in volumes on a GL context: programs, buffers, and iterations with shrinking radii."""

from dataclasses import dataclass
from pathlib import Path

import moderngl
import numpy as np

from rppm_addon.gl.context.context import Context

from .scenes import HEIGHT, WIDTH, VolumeScene, cloud_densities

FOLDER = Path(__file__).parent
ALPHA = 2.0 / 3.0
"""Parameter of how radii shrink (Knaus and Zwicker 2011)."""
CAPACITY = 6 << 20
"""Photons of an iteration, at most."""
CELLS, SLICES = 64, 96
GROUPS = (WIDTH + 7) // 8, (HEIGHT + 7) // 8
"""Work groups of programs that run for each pixel."""
_DIMENSIONS = {"ball": 3, "disk": 2, "short beam": 1, "long beam": 1}
_SPLATS = {"light tracing": 0, "disk": 1, "short beam": 2, "long beam": 2}
_BEAMS = {"short beam": 1, "long beam": 2}


@dataclass(frozen=True)
class Method:
    """An estimator and its parameters.

    ``kind`` is "path", "light tracing", or a kernel: "ball", "disk", "short beam" (up to the
    collision), "long beam" (as far as the medium goes). ``paths`` are the photon
    paths of an iteration and ``radius`` is the first radius in m. ``shadow_rays`` give single scattering where no glass
    bends the light; else photons give all.
    """

    kind: str
    paths: int = 0
    radius: float = 0.0
    shadow_rays: bool = True

    def defines(self) -> dict[str, object]:
        return {"DIRECT": int(not self.shadow_rays), "BEAMS": _BEAMS.get(self.kind, 0)}

    @property
    def name(self) -> str:
        """Kind, photon paths (k: 1024), and radius."""
        paths = f"{self.paths >> 10}k" if self.paths >= 1024 else str(self.paths)
        parameters = [paths] if self.paths else []
        return ", ".join([self.kind, *parameters, *([f"r {self.radius:g}"] if self.radius else [])])


class DeviceObjects:
    """Objects of a GL context for one scene, released together; sources begin with the scene's defines."""

    def __init__(self, context: Context, scene: VolumeScene) -> None:
        self.context, self.gl, self.scene = context, context.moderngl, scene
        self._held: list = []

    def keep(self, thing):
        self._held.append(thing)
        return thing

    def buffer(self, size: int):
        return self.keep(self.gl.buffer(reserve=size))

    def texture(self, components: int):
        """A texture of floats, of the picture's size."""
        return self.keep(self.gl.texture((WIDTH, HEIGHT), components, dtype="f4"))

    def source(self, name: str, **defines: object) -> str:
        known = {"CELLS": CELLS, "SLICES": SLICES, **self.scene.defines(), **defines}
        lines = [f"#define {key} {value}" for key, value in known.items()]
        parts = ((FOLDER / part).read_text(encoding="utf-8") for part in ("common.glsl", name))
        return "\n".join(["#version 430", *lines, *parts])

    def compute(self, name: str, **defines: object):
        return self.keep(self.gl.compute_shader(self.source(name, **defines)))

    def run(self, program, groups: tuple[int, ...], values: dict[str, object]) -> None:
        """Run a program with those of the values that it has, and wait with what reads its results."""
        assign(program, values)
        program.run(*groups)
        self.context.barrier()

    def release(self) -> None:
        for thing in reversed(self._held):
            thing.release()


def assign(program, values: dict[str, object]) -> None:
    """Set the uniforms that a program has."""
    for name, value in values.items():
        if name in program:
            program[name].value = value


def bind_cloud(device: DeviceObjects) -> None:
    """Bind the cloud's densities, and the transmittances of camera rays."""
    densities = cloud_densities()
    volume = device.keep(device.gl.texture3d(densities.shape[::-1], 1, densities.tobytes(), dtype="f4"))
    slices = device.keep(device.gl.texture3d((WIDTH, HEIGHT, SLICES), 1, dtype="f4"))
    for texture in (volume, slices):
        texture.filter = moderngl.LINEAR, moderngl.LINEAR
        texture.repeat_x = texture.repeat_y = texture.repeat_z = False
    volume.use(0)
    slices.bind_to_image(2, read=False, write=True)
    device.run(device.compute("slices.comp"), GROUPS, {})
    slices.use(2)


class PhotonTracer:
    """Photons or beams of an iteration."""

    def __init__(self, device: DeviceObjects, method: Method) -> None:
        self._device, self._paths = device, method.paths
        self._program = device.compute("trace.comp", **method.defines())
        self._photons, self._counter = device.buffer(32 * CAPACITY), device.buffer(4)

    def trace(self, values: dict[str, object]) -> int:
        """Store photons and return how many. Raises RuntimeError where they have no place."""
        self._counter.write(bytes(4))
        self._photons.bind_to_storage_buffer(0)
        self._counter.bind_to_storage_buffer(1)
        self._device.run(self._program, ((self._paths + 63) // 64,), {**values, "paths": self._paths})
        count = int(np.frombuffer(self._counter.read(), np.uint32)[0])
        if count > CAPACITY:
            raise RuntimeError(f"{count} photons, but there is room for {CAPACITY}")
        return count


class PhotonGrid:
    """Lists of photons by cells."""

    def __init__(self, device: DeviceObjects) -> None:
        self._device, self._program = device, device.compute("grid.comp")
        self._empty = np.full(CELLS**3, -1, np.int32).tobytes()
        self._heads, self._nexts = device.buffer(4 * CELLS**3), device.buffer(4 * CAPACITY)

    def build(self, count: int, values: dict[str, object]) -> None:
        self._heads.write(self._empty)
        self._heads.bind_to_storage_buffer(2)
        self._nexts.bind_to_storage_buffer(3)
        self._device.run(self._program, (max(1, (count + 63) // 64),), {**values, "count": count})


class Splats:
    """Photons drawn as points of one pixel or as quads, whose fragments are counted."""

    def __init__(self, device: DeviceObjects, method: Method) -> None:
        self._device, self._draws_points = device, method.kind == "light tracing"
        names = ("splat.vert", "splat.frag")
        sources = (device.source(name, SPLAT=_SPLATS[method.kind], **method.defines()) for name in names)
        self._program = device.keep(device.gl.program(*sources))
        self._quads = device.keep(device.gl.vertex_array(self._program, []))
        self._query = device.gl.query(samples=True)
        self.fragments = 0

    def draw(self, target, intervals, count: int, values: dict[str, object]) -> None:
        gl = self._device.gl
        target.use()
        gl.enable_only(moderngl.BLEND | moderngl.PROGRAM_POINT_SIZE)
        gl.blend_func = moderngl.ONE, moderngl.ONE
        intervals.use(1)
        assign(self._program, values)
        mode, vertices = (moderngl.POINTS, count) if self._draws_points else (moderngl.TRIANGLES, 6 * count)
        with self._query:
            self._quads.render(mode, vertices=vertices)
        self.fragments += self._query.samples
        self._device.context.barrier()


class VolumeEstimator:
    """Iterations of one method in one scene. Even and odd iterations have sums of their own.

    Without ``single`` pictures lack light that has scattered once and that no glass has bent.
    """

    def __init__(
        self, context: Context, scene: VolumeScene, method: Method, seed: int = 0, single: bool = True
    ) -> None:
        self._device, self._method, self._seed = DeviceObjects(context, scene), method, seed
        device, kind = self._device, method.kind
        self._sums = [device.texture(4) for _ in range(2)]
        self._targets = [device.keep(device.gl.framebuffer([texture])) for texture in self._sums]
        self._intervals = device.texture(2)
        self._intervals.filter = moderngl.NEAREST, moderngl.NEAREST
        mode = 1 if kind == "path" else 3 if kind == "ball" else 2 if method.shadow_rays else 0
        self._paths = device.compute("paths.comp", MODE=mode, SINGLE=int(single))
        if scene.is_cloud:
            bind_cloud(device)
        self._tracer = None if kind == "path" else PhotonTracer(device, method)
        self._grid = PhotonGrid(device) if kind == "ball" else None
        self._splats = Splats(device, method) if kind in _SPLATS else None
        self.restart()

    def restart(self) -> None:
        """Forget all iterations."""
        self._jitters = np.random.default_rng(self._seed)
        self.iteration, self.radius = 0, self._method.radius
        if self._splats:
            self._splats.fragments = 0
        for target in self._targets:
            target.clear()

    @property
    def fragments(self) -> int:
        """Fragments of all iterations."""
        return self._splats.fragments if self._splats else 0

    def iterate(self) -> None:
        """Add one iteration to the sums of its parity. Raises RuntimeError where photons have no place."""
        values = {
            "iteration": self.iteration,
            "run_seed": self._seed,
            "jitter": tuple(self._jitters.random(2) - 0.5),
            "radius": self.radius,
            "cell_size": max(2.0 * self.radius, 3.0 / CELLS),
        }
        count = self._tracer.trace(values) if self._tracer else 0
        if self._grid:
            self._grid.build(count, values)
        parity = self.iteration % 2
        self._sums[parity].bind_to_image(0, read=True, write=True)
        self._intervals.bind_to_image(1, read=False, write=True)
        self._device.run(self._paths, GROUPS, values)
        if self._splats:
            self._splats.draw(self._targets[parity], self._intervals, count, values)
        self.iteration += 1
        if dimension := _DIMENSIONS.get(self._method.kind):
            self.radius *= ((self.iteration + ALPHA) / (self.iteration + 1.0)) ** (1.0 / dimension)

    def pictures(self) -> np.ndarray:
        """(2, HEIGHT, WIDTH) radiance of even and of odd iterations, the latter 0 before there are any."""
        halves = []
        for parity, texture in enumerate(self._sums):
            values = np.frombuffer(texture.read(), np.float32).reshape(HEIGHT, WIDTH, 4)[..., 0]
            halves.append(values / max(1, (self.iteration + 1 - parity) // 2))
        return np.stack(halves)

    def picture(self) -> np.ndarray:
        """(HEIGHT, WIDTH) radiance of all iterations."""
        even, odd = self.pictures()
        evens = (self.iteration + 1) // 2
        return (even * evens + odd * (self.iteration - evens)) / self.iteration

    def release(self) -> None:
        self._device.release()
