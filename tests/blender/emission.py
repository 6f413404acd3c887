# SPDX-License-Identifier: GPL-3.0-or-later
"""Emission of exported graphs, by the programs that render them."""

import math
from contextlib import contextmanager

import numpy as np

from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.integrator.surfaces import surface_attributes  # noqa: F401  declares records that the programs name
from rppm_addon.materials.tables import MaterialTables
from rppm_addon.scene import Scene

HEIGHT = 256


@contextmanager
def tables_of(exported: Scene):
    """The materials of an exported scene on the device."""
    context = Context.create()
    library = ProgramLibrary(context)
    tables = MaterialTables(context, library)
    try:
        with context.moderngl:
            tables.build(exported)
            yield tables
    finally:
        tables.release()
        library.release()
        context.release()


def world_map(exported: Scene) -> np.ndarray:
    """(HEIGHT, 2 HEIGHT, 3) radiance of the world by direction, row 0 at the bottom."""
    with tables_of(exported) as tables:
        factor = tables.evaluate(exported.world.graph, 2 * HEIGHT, HEIGHT) if exported.world.graph else 1.0
    return np.broadcast_to(exported.world.radiance * factor, (HEIGHT, 2 * HEIGHT, 3))


def look_up(radiance: np.ndarray, direction) -> np.ndarray:
    """(3,) of a map in a world direction, without interpolation."""
    x, y, z = direction
    u = 0.5 - math.atan2(y, x) / (2.0 * math.pi)
    v = 0.5 + math.atan2(z, math.hypot(x, y)) / math.pi
    height, width = radiance.shape[:2]
    return radiance[min(int(v * height), height - 1), int(u * width) % width]


def light_strength(exported: Scene, number: int = 0) -> np.ndarray:
    """(3,) strength of a light, its nodes included."""
    light = exported.lights[number]
    with tables_of(exported) as tables:
        factor = tables.evaluate(light.graph)[0, 0] if light.graph else 1.0
    return light.strength * factor
