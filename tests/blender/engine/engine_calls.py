# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders in which methods of the engine are replaced."""

from rppm_addon.blender.engine import final
from rppm_addon.blender.engine import render_engine as engine_module


class Proxy:
    """The engine with some methods replaced; Blender does not let a class replace its own."""

    def __init__(self, engine, replaced):
        self._engine = engine
        self.__dict__.update(replaced)

    def __getattr__(self, name):
        return getattr(self._engine, name)


def replace_methods(monkeypatch, **replaced):
    """Let renders see an engine whose methods of these names are replaced."""
    monkeypatch.setattr(
        engine_module, "render_final", lambda engine, depsgraph: final.render_final(Proxy(engine, replaced), depsgraph)
    )
