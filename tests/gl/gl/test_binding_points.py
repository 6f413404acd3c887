# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs read what they are given last, though what is bound already is not bound again."""

import numpy as np
import pytest

from rppm_addon.gl.buffers.records import Record
from rppm_addon.gl.programs import sources
from rppm_addon.gl.programs.programs import ProgramLibrary

SHADER = """#version 430 core
layout(local_size_x = 64) in;
#include <BoundParameters>
uniform Parameters { BoundParameters parameters; };
readonly buffer Given { uint given[]; };
writeonly buffer Found { uint found[]; };
void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index < 64u) found[index] = parameters.factor * given[index];
}
"""


@pytest.fixture
def program(context, tmp_path, monkeypatch):
    """A program that multiplies a buffer by a factor."""
    monkeypatch.setattr(sources, "SHADER_FOLDER", tmp_path)
    Record("BoundParameters", factor="uint", bias="float")
    (tmp_path / "bound.comp").write_text(SHADER)
    library = ProgramLibrary(context)
    yield library.compute("bound.comp")
    library.release()


def test_other_buffers_and_parameters_are_seen(context, program):
    numbers = np.arange(64, dtype=np.uint32)
    given = [context.moderngl.buffer(numbers + step) for step in (0, 100)]
    found = [context.moderngl.buffer(reserve=256) for _ in range(2)]
    for factor in (1, 1, 3):
        for which in (0, 1, 1, 0):
            for target in found:
                program.run(64, {"Given": given[which], "Found": target}, {"factor": factor, "bias": 0.0})
                read = np.frombuffer(target.read(), np.uint32)
                np.testing.assert_array_equal(read, factor * (numbers + 100 * which))
    # A buffer in the place of a released one, whose name and memory it may get.
    given[0].release()
    other = context.moderngl.buffer(numbers + 7)
    program.run(64, {"Given": other, "Found": found[0]}, {"factor": 1, "bias": 0.0})
    np.testing.assert_array_equal(np.frombuffer(found[0].read(), np.uint32), numbers + 7)
    for buffer in (given[1], other, *found):
        buffer.release()


def test_a_missing_block_is_named(context, program):
    buffer = context.moderngl.buffer(reserve=256)
    with pytest.raises(ValueError, match="Given"):
        program.run(64, {"Found": buffer}, {"factor": 1, "bias": 0.0})
    buffer.release()
