# SPDX-License-Identifier: GPL-3.0-or-later
"""One OpenGL context for all GL tests."""

import pytest

from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.session.render.renderer import Renderer


@pytest.fixture(scope="session")
def context():
    context = Context.create()
    yield context
    context.release()


@pytest.fixture(autouse=True)
def current(context):
    """Tests that open contexts of their own leave them current: each test starts with the shared one."""
    with context.moderngl:
        yield


@pytest.fixture(scope="session")
def library(context):
    library = ProgramLibrary(context)
    yield library
    library.release()


def new_mapper(context, library):
    mapper = ProgressivePhotonMapper(context, library)
    yield mapper
    mapper.release()


mapper = pytest.fixture(new_mapper)
other_mapper = pytest.fixture(new_mapper)
"""For comparison, in the same test."""


@pytest.fixture(scope="module")
def renderer():
    with Renderer() as renderer:
        yield renderer
