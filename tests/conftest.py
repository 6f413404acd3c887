# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests of several floors share."""

import pytest


def pytest_addoption(parser):
    parser.addoption(
        "--cycles",
        choices=("kept", "render", "compare", "write"),
        default="kept",
        help="parity tests: take Cycles' side from tests/parity/references, render it, render it and compare it with "
        "the references, or write these; the last two leave RPPM out",
    )


@pytest.fixture(scope="session")
def registered():
    """RPPM registered in Blender as a module, once, and taken out again before the process ends.

    A RenderEngine that is still registered when Python exits crashes or hangs some Blender versions.
    """
    import rppm_addon

    rppm_addon.register()
    yield
    rppm_addon.unregister()
