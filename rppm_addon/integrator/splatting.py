# SPDX-License-Identifier: GPL-3.0-or-later
"""Photon splatting: onto the camera view (direct) and onto cubemap views (indirect), section 4.2."""

import math
from dataclasses import dataclass

import moderngl
import numpy as np

from ..gl.buffers import GrowingBuffer
from ..gl.context import Context
from ..gl.programs import ProgramLibrary
from ..gl.records import Record

_CUBE_RESOLUTION, _BLOCK_SIZE = 128, 8
_FEW_IMPORTONS = 40_000
"""Up to so many have a cubemap of half the side: the same picture, on llvmpipe in 7 to 23 % less time."""
_JOB_HEADER, _JOB = 16, 16
_FACES_OF_A_SPLAT = 3
"""A cone of 30 degrees touches at most so many faces of a cube."""

_CAUSTIC_PARAMETERS = {"photon_count": "uint", "world_photon_flux": "float", "most_scattered": "uint"}
"""Parameters of programs that include shaders/common/importon.glsl."""

Record("StoredParameters", count="uint", indirect_only="uint")
Record("SplatParameters", count="uint", radius="float", wide_radius="float", gathers="uint")
Record(
    "QuadParameters",
    width="uint",
    height="uint",
    wide_radius="float",
    quanta="float",
    roulette="uint",
    counting="uint",
    **_CAUSTIC_PARAMETERS,
)
Record(
    "CubeParameters",
    centre="vec3",
    count="uint",
    radius="float",
    wide_radius="float",
    resolution="uint",
    quanta="float",
    gathers="uint",
    counting="uint",
    **_CAUSTIC_PARAMETERS,
)

_STORED_HEADER = 8
_PHOTON_QUANTA = 1 << 24
_GATHERED = 48


def radiance_quantum(photon_flux: float, radius: float) -> float:
    """W/(m^2 sr), a power of two: what the sums of splats count in.

    A white diffuse surface reflects about 2^24 of them when a photon of mean flux (W) is spread over a disk of the
    largest splat radius (m). Sums end at 2^64.
    """
    radiance = photon_flux / (math.pi**2 * max(radius, 1e-12) ** 2) / _PHOTON_QUANTA
    return 2.0 ** math.floor(math.log2(min(max(radiance, 1e-30), 1e20)))


@dataclass(frozen=True)
class StoredPhotons:
    """The photons of an iteration and what else their splats depend on (integrator/photons.py)."""

    photons: moderngl.Buffer
    world_radiances: moderngl.Buffer
    photon_count: int
    world_photon_flux: float
    """Mean flux of the world's photons, W."""
    most_scattered: int
    """Caustics of the world by up to so many surfaces are found by gathering rays as well, if there are any."""

    @property
    def blocks(self) -> dict[str, moderngl.Buffer]:
        return {"Photons": self.photons, "WorldRadiances": self.world_radiances}

    @property
    def parameters(self) -> dict[str, object]:
        """Values of _CAUSTIC_PARAMETERS."""
        return {
            "photon_count": self.photon_count,
            "world_photon_flux": self.world_photon_flux,
            "most_scattered": self.most_scattered,
        }


class Splatting:
    """Adds the stored photons to the importons of a band."""

    def __init__(self, context: Context, library: ProgramLibrary, width: int, rows: int) -> None:
        gl = context.moderngl
        self._stored_program = library.compute("splatting/stored.comp")
        self._direct_jobs = library.compute("splatting/direct_jobs.comp")
        self._direct = library.draw("splatting/quads.vert", "splatting/direct.frag")
        self._insert = library.compute("splatting/insert.comp")
        self._indirect_jobs = library.compute("splatting/indirect_jobs.comp")
        self._indirect = library.draw("splatting/quads.vert", "splatting/indirect.frag")
        self._core_program = library.compute("splatting/core.comp")
        remedy = "lower the photons per iteration or the photon path length"
        self._stored = GrowingBuffer(context, "stored photons", remedy)
        self._jobs = GrowingBuffer(context, "splat jobs", remedy)
        self._heads = GrowingBuffer(context, "splat cubemap")
        self._core = GrowingBuffer(context, "splat core list")
        self.gathered = GrowingBuffer(context, "gathered radiance")
        few = width * rows <= _FEW_IMPORTONS
        self._resolution = max(_BLOCK_SIZE, _CUBE_RESOLUTION // 2) if few else _CUBE_RESOLUTION
        self._heads.require(4 * 6 * (self._resolution**2 + (self._resolution // _BLOCK_SIZE) ** 2 + 4))
        self._core.require(4 * (width * rows + 1))
        self._diffused_photons = GrowingBuffer(context, "diffused photons")
        self.gathered.require(_GATHERED * width * rows)
        self._diffused_photons.require(4 * width * rows)
        self._direct_view = gl.empty_framebuffer((width, rows))
        self._cube_size = (3 * self._resolution, 2 * self._resolution)
        self._cube_view = gl.empty_framebuffer(self._cube_size)
        self.stored_count = self.diffused_count = 0
        self.count_in(1.0, 0, False)

    @property
    def memory_bytes(self) -> dict[str, int]:
        buffers = (self._stored, self._jobs, self._heads, self._core, self.gathered, self._diffused_photons)
        return {buffer.name: buffer.size for buffer in buffers}

    def collect(self, photons: moderngl.Buffer, slots: int, indirect_only: bool) -> None:
        """List the photons to splat, of so many slots: those stored, or those of them that are no direct light."""
        self._stored.require(_STORED_HEADER + 4 * slots)
        self._stored.buffer.write(bytes(_STORED_HEADER))
        self._stored_program.run(
            slots,
            {"Photons": photons, "StoredPhotons": self._stored.buffer},
            {"count": slots, "indirect_only": indirect_only},
        )
        self.stored_count, self.diffused_count = map(int, self._stored.read(np.uint32, 2))
        self._jobs.require(_JOB_HEADER + _JOB * _FACES_OF_A_SPLAT * max(1, self.stored_count))

    def count_in(self, quantum: float, roulette: int, counting: bool) -> None:
        """Set what the sums count in, W/(m^2 sr), the seed of the fragments' roulette (0 keeps them all), and
        whether to count the diffused photons that pixels find."""
        self.quantum = quantum
        self.counting = counting
        self._counting = {"quanta": (2.0 if roulette else 1.0) / quantum, "roulette": roulette, "counting": counting}

    def begin(self) -> None:
        """Forget what the band before gathered."""
        self.gathered.clear()
        if self.counting:
            self._diffused_photons.clear()

    def _reset_jobs(self) -> None:
        """The arguments of the indirect draw: no vertices yet, one instance."""
        self._jobs.buffer.write(np.array([0, 1, 0, 0], np.uint32).tobytes())

    def direct(
        self,
        photons: StoredPhotons,
        importons: moderngl.Buffer,
        camera: moderngl.Buffer,
        width: int,
        rows: int,
        radii: tuple[float, float],
        gathers: bool,
    ) -> None:
        """DirectSplatting: photons (narrow and wide radius) onto the importons of the camera's first hits.

        When paths go on to gather (``gathers``), these take no indirect photons.
        """
        if not self.stored_count:
            return
        self._reset_jobs()
        self._direct_jobs.run(
            self.stored_count,
            {
                "Photons": photons.photons,
                "StoredPhotons": self._stored.buffer,
                "Camera": camera,
                "Jobs": self._jobs.buffer,
            },
            {"count": self.stored_count, "radius": radii[0], "wide_radius": radii[1], "gathers": gathers},
        )
        self._direct.draw(
            self._direct_view,
            self._jobs.buffer,
            {
                "Jobs": self._jobs.buffer,
                **photons.blocks,
                "Importons": importons,
                "Gathered": self.gathered.buffer,
                "DiffusedPhotons": self._diffused_photons.buffer,
            },
            {"width": width, "height": rows, "wide_radius": radii[1], **self._counting, **photons.parameters},
            viewport=(0, 0, width, rows),
        )

    def diffused_photons(self, count: int) -> np.ndarray:
        """(count,) how many diffused photons the importons of each of the band's pixels took, where they are counted.

        Those that roulette leaves stand for two.
        """
        return self._diffused_photons.read(np.uint32, count) * (2 if self._counting["roulette"] else 1)

    def indirect(
        self,
        photons: StoredPhotons,
        importons: moderngl.Buffer,
        count: int,
        centre: np.ndarray,
        radii: tuple[float, float],
        gathers: bool,
    ) -> None:
        """IndirectSplatting: photons (narrow and wide radius) onto importons anywhere, by the cubemap's lists.

        When the paths go on from there to gather (``gathers``), the importons take no indirect photons.
        """
        if not self.stored_count:
            return
        self._heads.clear()
        self._core.buffer.write(bytes(4))
        self._reset_jobs()
        cube = {
            "centre": centre,
            "radius": radii[0],
            "wide_radius": radii[1],
            "resolution": self._resolution,
            "quanta": 1.0 / self.quantum,
            "gathers": gathers,
            # Nothing plays roulette here, which what is counted is doubled for.
            "counting": self.counting and not self._counting["roulette"],
            **photons.parameters,
        }
        stored = {"Photons": photons.photons, "StoredPhotons": self._stored.buffer}
        self._insert.run(
            count,
            {"Importons": importons, "Heads": self._heads.buffer, "Core": self._core.buffer},
            {**cube, "count": count},
        )
        self._indirect_jobs.run(
            self.stored_count,
            {**stored, "Heads": self._heads.buffer, "Jobs": self._jobs.buffer},
            {**cube, "count": self.stored_count},
        )
        gathered = {"Importons": importons, "Gathered": self.gathered.buffer}
        self._indirect.draw(
            self._cube_view,
            self._jobs.buffer,
            {
                "Jobs": self._jobs.buffer,
                **photons.blocks,
                "Heads": self._heads.buffer,
                "DiffusedPhotons": self._diffused_photons.buffer,
                **gathered,
            },
            {
                "width": self._cube_size[0],
                "height": self._cube_size[1],
                "wide_radius": radii[1],
                **self._counting,
                **photons.parameters,
            },
            viewport=(0, 0, *self._cube_size),
        )
        self._core_program.run(
            self.stored_count,
            {
                **stored,
                **photons.blocks,
                "Core": self._core.buffer,
                "DiffusedPhotons": self._diffused_photons.buffer,
                **gathered,
            },
            {**cube, "count": self.stored_count},
        )

    def release(self) -> None:
        for resource in (
            self._stored,
            self._jobs,
            self._heads,
            self._core,
            self.gathered,
            self._diffused_photons,
            self._direct_view,
            self._cube_view,
        ):
            resource.release()
