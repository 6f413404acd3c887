# SPDX-License-Identifier: GPL-3.0-or-later
"""One renderer for all parity tests, and Blender with RPPM registered while they run."""

from pathlib import Path

import pytest

pytest.importorskip("bpy", reason="the parity tests render with Cycles in the bpy wheel")

from rppm_addon.gl.context.context import Context  # noqa: E402
from rppm_addon.gl.programs.programs import ProgramLibrary  # noqa: E402
from rppm_addon.session.render.renderer import Renderer  # noqa: E402

from . import references  # noqa: E402from


class NoRenderer:
    """Where only Cycles' side is asked for, a test ends as it comes to RPPM's."""

    def render(self, *_, **__):
        pytest.skip("only Cycles' side")


def pytest_configure(config):
    references.use(references.Mode(config.getoption("--cycles")))


@pytest.fixture(autouse=True, scope="module")
def reference_file(request):
    """Use the module's reference file. Written, it loses what no test asked for, unless only some ran or one failed."""
    failed = request.session.testsfailed
    references.begin(request.path.relative_to(Path(__file__).parents[2]))
    yield
    arguments = [str(argument) for argument in request.config.invocation_params.args]
    some = any("::" in argument or argument.startswith(("-k", "-m", "--lf")) for argument in arguments)
    references.write(keep_others=some or request.session.testsfailed > failed)


@pytest.fixture(scope="session")
def renderer(registered):
    if references.only_cycles():
        yield NoRenderer()
        return
    with Renderer() as renderer:
        yield renderer


@pytest.fixture(scope="session")
def context():
    context = Context.create()
    yield context
    context.release()


@pytest.fixture(scope="session")
def library(context):
    """Programs of shaders that tests write to ``folder``."""
    library = ProgramLibrary(context)
    yield library
    with context.moderngl:
        library.release()


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("shaders")
