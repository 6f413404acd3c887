# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of compute shaders that tests write."""

from pathlib import Path

import numpy as np

from rppm_addon.gl.programs.programs import ProgramLibrary


def run_shader(
    library: ProgramLibrary,
    file: Path,
    count: int,
    arrays: dict[str, np.ndarray],
    width: int,
    values: dict | None = None,
    defines: dict | None = None,
) -> np.ndarray:
    """(width * count,) float32 that a shader writes to its block Results.

    arrays: what its other blocks hold. values: of its parameters.
    """
    gl = library.context.moderngl
    buffers = {name: gl.buffer(np.ascontiguousarray(array).tobytes()) for name, array in arrays.items()}
    buffers["Results"] = gl.buffer(reserve=4 * width * count)
    library.compute(str(file), defines).run(count, buffers, values)
    results = np.frombuffer(buffers["Results"].read(), np.float32)
    for buffer in buffers.values():
        buffer.release()
    return results
