# SPDX-License-Identifier: GPL-3.0-or-later
"""Fixtures and settings that tests of several floors share."""

import os

import pytest


def pytest_addoption(parser):
    parser.addoption(
        "--cycles",
        choices=("kept", "render", "compare", "write"),
        default="kept",
        help="parity tests: take Cycles' side from tests/parity/references, render it, render it and compare it with "
        "the references, or write these; the last two leave RPPM out",
    )


class PlainRoot:
    """The checkout is a package for Blender alone: tests run in one whose name is none of Python's, too."""

    @pytest.hookimpl(tryfirst=True)
    def pytest_collect_directory(self, path, parent):
        return pytest.Dir.from_parent(parent, path=path) if path == parent.config.rootpath else None


def pytest_configure(config):
    """Workers share the cores: none compiles ahead on one that another worker needs, and waits for it; nor does one
    wake threads of Mesa's for each small dispatch, which takes a tenth of its time."""
    config.pluginmanager.register(PlainRoot())
    workers = int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
    if workers > 1:
        from rppm_addon.gl.programs import background_compiler

        usable_cores = background_compiler.usable_cores
        background_compiler.usable_cores = lambda: max(1, usable_cores() // workers)
        own = usable_cores() // workers
        os.environ.setdefault("LP_NUM_THREADS", str(own if own > 1 else 0))


@pytest.fixture(scope="session")
def registered():
    """RPPM registered in Blender as a module, once, and taken out again before the process ends.

    A RenderEngine that is still registered when Python exits crashes or hangs some Blender versions.
    """
    import rppm_addon

    rppm_addon.register()
    yield
    rppm_addon.unregister()


@pytest.fixture(scope="module")
def device():
    """A context and its library of programs, which no renderer has."""
    from rppm_addon.gl.context.context import Context
    from rppm_addon.gl.programs.programs import ProgramLibrary

    context = Context.create()
    library = ProgramLibrary(context)
    yield context, library
    library.release()
    context.release()
