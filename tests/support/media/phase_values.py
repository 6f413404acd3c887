# SPDX-License-Identifier: GPL-3.0-or-later
"""Values and samples of a phase function, from the GPU."""

from pathlib import Path

import numpy as np

from rppm_addon.gl.buffers.records import Record
from rppm_addon.materials.phase_functions import Parameters
from rppm_addon.materials.records import PhaseFunctionKind

Record("PhaseFunctionsParameters", parameters="vec4", count="uint", kind="uint")
SHADER = str(Path(__file__).parent / "phase_functions.comp")


def values_and_samples(
    context, library, kind: PhaseFunctionKind, parameters: Parameters, cosines: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The function at (n,) cosines, 1/sr, and cosines for n evenly spread random numbers, (n,) float64."""
    count = len(cosines)
    given = context.moderngl.buffer(cosines.astype(np.float32).tobytes())
    values, samples = (context.moderngl.buffer(reserve=4 * count) for _ in range(2))
    blocks = {"Cosines": given, "Values": values, "Samples": samples}
    library.compute(SHADER).run(count, blocks, {"count": count, "kind": int(kind), "parameters": parameters})
    read = tuple(np.frombuffer(buffer.read(), np.float32).astype(np.float64) for buffer in (values, samples))
    for buffer in (given, values, samples):
        buffer.release()
    return read
