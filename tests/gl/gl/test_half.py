# SPDX-License-Identifier: GPL-3.0-or-later
"""Half floats of images."""

import numpy as np

from rppm_addon.gl.programs import sources
from rppm_addon.gl.programs.programs import ProgramLibrary

PROGRAM = """#version 430 core
layout(local_size_x = 64) in;
#include "half.glsl"
readonly buffer Words { uint words[]; };
writeonly buffer Unpacked { vec2 unpacked[]; };
void main() { unpacked[gl_GlobalInvocationID.x] = two_halves(words[gl_GlobalInvocationID.x]); }
"""


def test_every_half_is_the_float_that_numpy_has(context, tmp_path, monkeypatch):
    text = (sources.SHADER_FOLDER / "common" / "half.glsl").read_text()
    monkeypatch.setattr(sources, "SHADER_FOLDER", tmp_path)
    (tmp_path / "half.glsl").write_text(text)
    (tmp_path / "all.comp").write_text(PROGRAM)
    halves = np.arange(1 << 16, dtype=np.uint16)
    words = context.moderngl.buffer(halves.tobytes())
    unpacked = context.moderngl.buffer(reserve=4 << 16)
    library = ProgramLibrary(context)
    library.compute("all.comp").run(1 << 15, {"Words": words, "Unpacked": unpacked})
    found, expected = np.frombuffer(unpacked.read(), np.float32), halves.view(np.float16).astype(np.float32)
    numbers = ~np.isnan(expected)
    np.testing.assert_array_equal(found.view(np.uint32)[numbers], expected.view(np.uint32)[numbers])
    assert np.isnan(found[~numbers]).all()
    library.release()
