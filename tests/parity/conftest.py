# SPDX-License-Identifier: GPL-3.0-or-later
"""One renderer for all parity tests, and Blender with RPPM registered while they run."""

import pytest

pytest.importorskip("bpy", reason="the parity tests render with Cycles in the bpy wheel")

import rppm_addon  # noqa: E402
from rppm_addon.session.renderer import Renderer  # noqa: E402


@pytest.fixture(scope="session", autouse=True)
def registered():
    # An engine still registered when Python exits crashes or hangs some Blender versions.
    rppm_addon.register()
    yield
    rppm_addon.unregister()


@pytest.fixture(scope="session")
def renderer(registered):
    with Renderer() as renderer:
        yield renderer
