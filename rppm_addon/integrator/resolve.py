# SPDX-License-Identifier: GPL-3.0-or-later
"""Hits become closures in one batched pass (DIRT's deferred fetch)."""

import moderngl

from ..gl.programs import ProgramLibrary
from ..gl.records import Record
from ..materials import records as material_records  # noqa: F401  declares what the shader includes
from ..materials.tables import MaterialTables
from .geometry import Geometry

Record("ResolveParameters", count="uint", seed="uint", iteration="uint", segment="uint")


class Resolve:
    """Rays and their hits to closures."""

    def __init__(self, library: ProgramLibrary) -> None:
        self._program = library.compute("resolve/resolve.comp")

    def run(
        self,
        geometry: Geometry,
        materials: MaterialTables,
        rays: moderngl.Buffer,
        hits: moderngl.Buffer,
        closures: moderngl.Buffer,
        count: int,
        seed: int,
        iteration: int,
        segment: int,
    ) -> None:
        """Fill ``count`` closures; inactive rays and misses give closures without a triangle."""
        self._program.run(
            count,
            {
                "Rays": rays,
                "Hits": hits,
                "Closures": closures,
                "Triangles": geometry.triangles.buffer,
                "Attributes": geometry.attributes.buffer,
                **materials.buffers,
            },
            {"count": count, "seed": seed, "iteration": iteration, "segment": segment},
        )
