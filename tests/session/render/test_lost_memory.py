# SPDX-License-Identifier: GPL-3.0-or-later
"""A device whose memory runs out while a render goes on."""

import moderngl
import numpy as np
import pytest
from session.conftest import scene_of

from rppm_addon.scene.errors import DeviceError
from rppm_addon.session.checkpoints.continuation import Continuation
from rppm_addon.session.render.renderer import Renderer


def test_a_render_ends_with_a_line_and_goes_on_from_what_is_kept():
    """As drivers do that allocate memory when they draw: nothing but OpenGL's error says so."""
    scene, kept = scene_of(4), []
    with Renderer() as renderer:
        expected = renderer.render(scene).frame.combined

        def run_out(progress, _):
            if progress.iteration == 2:
                moderngl.get_context().buffer(reserve=1 << 40)

        with pytest.raises(DeviceError, match="has run out of memory; lower the resolution or the photons"):
            renderer.render(scene, run_out, continuation=Continuation(keep=kept.append, interval=0.0))
        assert [pause.state.iteration for pause in kept] == [1, 2]
        picture = renderer.render(scene, continuation=Continuation(begin=kept[-1])).frame.combined
        np.testing.assert_array_equal(picture, expected)
