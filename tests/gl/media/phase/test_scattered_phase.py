# SPDX-License-Identifier: GPL-3.0-or-later
"""Scattering of the media that a path is in, by the buffers that a scene's volumes make."""

from pathlib import Path

import numpy as np
import pytest
from support.iteration_block import iteration_buffer

from rppm_addon.gl.buffers.records import Record
from rppm_addon.gl.programs.bindings import ITERATION
from rppm_addon.scene import Camera, Material, NodeGraph, Scene, World

Record("ScatteredPhaseParameters", weight="vec3", count="uint", flags="uint", cosine="float")
SHADER = str(Path(__file__).parent / "scattered_phase.comp")
COUNT = 4096
FIRST_MEDIUM = 12
WORLD, FIRST, SECOND = (0.1, 0.2), (0.3, 0.6), (0.5, -0.4)
"""Density and anisotropy of the world's fog and of two in a body."""


def fog(*parts: tuple[float, float]) -> NodeGraph:
    """The sum of gray volumes of a density and an anisotropy."""
    graph = NodeGraph()
    for density, anisotropy in parts:
        shader = graph.add("volume_scatter", "volume", color=1.0, density=density, anisotropy=anisotropy)
        graph.surface = (
            shader
            if graph.surface is None
            else graph.add("add_shader", "shader", shader=graph.surface, shader_001=shader)
        )
    return graph


def results(mapper, context, library, flags: int, cosine: float = 0.3) -> np.ndarray:
    """(COUNT, 4) the coefficient in the direction, twice, an anisotropy that is chosen, and the random number after."""
    materials = [Material("body", interior=fog(FIRST, SECOND)), Material("other", interior=fog((7.0, 0.0)))]
    mapper.build(Scene(Camera(np.eye(4), (-1, 1, -1, 1), 4, 4), materials=materials, world=World(volume=fog(WORLD))))
    tables = mapper.device_scene.materials
    buffer = context.moderngl.buffer(reserve=16 * COUNT)
    parameters = {"weight": (0.2, 0.3, 0.5), "count": COUNT, "flags": flags, "cosine": cosine}
    program = library.compute(SHADER, {"MEDIA": 1})
    bound = {**tables.blocks, **tables.media.blocks, ITERATION: iteration_buffer(context, number=1)}
    blocks = {name: bound[name] for name in program.blocks if name != "Results"}
    program.run(COUNT, blocks | {"Results": buffer}, parameters)
    read = np.frombuffer(buffer.read(), np.float32).reshape(COUNT, 4)
    buffer.release()
    return read


def phase(part: tuple[float, float], cosine: float) -> float:
    density, g = part
    return density * (1 - g * g) / (4 * np.pi * (1 + g * g - 2 * g * cosine) ** 1.5)


@pytest.mark.parametrize(("flags", "parts"), [(0, [WORLD]), (1 << FIRST_MEDIUM, [WORLD, FIRST, SECOND])])
def test_media_of_a_path_scatter_together(mapper, context, library, flags, parts):
    found = results(mapper, context, library, flags)
    np.testing.assert_allclose(found[:, :2], sum(phase(part, 0.3) for part in parts), rtol=1e-5)
    total = sum(density for density, _ in parts)
    for density, anisotropy in parts:
        chosen = np.isclose(found[:, 2], anisotropy)
        assert chosen.mean() == pytest.approx(density / total, abs=2.0 / COUNT)
        # The random number is as good as new.
        np.testing.assert_allclose(np.sort(found[chosen, 3]), (np.arange(chosen.sum()) + 0.5) / chosen.sum(), atol=2e-3)
