# SPDX-License-Identifier: GPL-3.0-or-later
"""Groups of a dispatch that are dealt to the threads of a software driver in turn."""

import numpy as np
import pytest

from rppm_addon.gl.programs import sources
from rppm_addon.gl.programs.program import GROUPS_PER_ROW
from rppm_addon.gl.programs.programs import ProgramLibrary

INVOCATION = (sources.SHADER_FOLDER / "common" / "invocation.glsl").read_text()
GROUPS = """#version 430 core
layout(local_size_x = 4) in;
#include "common/invocation.glsl"
writeonly buffer Found { uint found[]; };
void main() {
    found[(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 4u + gl_LocalInvocationID.x]
        = invocation_index();
}
"""


@pytest.fixture
def indices(context, tmp_path, monkeypatch):
    """Function that returns the invocation indices (groups, 4), in the driver's order, for a number of threads."""
    monkeypatch.setattr(sources, "SHADER_FOLDER", tmp_path)
    (tmp_path / "common").mkdir()
    (tmp_path / "common" / "invocation.glsl").write_text(INVOCATION)
    (tmp_path / "groups.comp").write_text(GROUPS)

    def run(groups, threads):
        monkeypatch.setattr(context, "driver_threads", threads)
        found = context.moderngl.buffer(bytes(16 * groups))
        library = ProgramLibrary(context)
        monkeypatch.setattr(library.pacing, "run", lambda _pace, _items, whole, _part: whole())  # in one piece
        library.compute("groups.comp").run(4 * groups, {"Found": found})
        library.release()
        order = np.frombuffer(found.read(), np.uint32).reshape(-1, 4)
        found.release()
        return order

    return run


@pytest.mark.parametrize("threads", [0, 1, 2, 3, 16, 32])
@pytest.mark.parametrize("groups", [1, 2, 7, 64, 900, 2 * GROUPS_PER_ROW])
def test_every_group_is_dealt_once(indices, groups, threads):
    found = indices(groups, threads)
    np.testing.assert_array_equal(np.sort(found, axis=None), np.arange(4 * groups))
    np.testing.assert_array_equal(found - found[:, :1], np.broadcast_to(np.arange(4), found.shape))


@pytest.mark.parametrize("threads", [2, 16])
def test_each_thread_has_groups_from_everywhere(indices, threads):
    groups = 901
    dealt = indices(groups, threads)[:, 0] // 4
    share = groups // threads
    for thread in range(threads):
        expected = np.arange(share) * threads + thread
        np.testing.assert_array_equal(dealt[thread * share : (thread + 1) * share], expected)
    np.testing.assert_array_equal(dealt[share * threads :], np.arange(share * threads, groups))
