# SPDX-License-Identifier: GPL-3.0-or-later
"""One renderer for all parity tests, and Blender with RPPM registered while they run."""

import pytest

pytest.importorskip("bpy", reason="the parity tests render with Cycles in the bpy wheel")

from rppm_addon.session.renderer import Renderer  # noqa: E402


@pytest.fixture(scope="session")
def renderer(registered):
    with Renderer() as renderer:
        yield renderer
