# SPDX-License-Identifier: GPL-3.0-or-later
"""All that modules declare for shaders, and all variants in which shaders are compiled."""

import importlib
import pkgutil
import re
from collections.abc import Collection
from dataclasses import dataclass, field

import rppm_addon
from rppm_addon.gl.programs.sources import SHADER_FOLDER, Source, expand

from .every_node import displacements, programs

STAGES = (".comp", ".vert", ".frag", ".geom")
GENERATED = "materials/generated.glsl"
"""Stands for what the compiler of node graphs writes."""
_LINT = re.compile(r"^\s*//\s*lint:(.*)$", re.MULTILINE)


def import_declarations() -> None:
    """Import every module without Blender that may declare records, constants or storage blocks."""
    for floor in ("self_test", "gl", "materials", "integrator"):
        package = importlib.import_module(f"{rppm_addon.__name__}.{floor}")
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            importlib.import_module(module.name)


@dataclass(frozen=True)
class Variant:
    """A stage file below the shader folder with values for the defines that it needs."""

    name: str
    defines: dict[str, object] = field(default_factory=dict)
    generated: str = ""
    """Text generated from a node graph."""
    kinds: str = ""
    """Which kinds of nodes the graph has: the name of their file."""

    def expand(
        self, reads_texels: bool = False, large: Collection[str] = (), whole: bool = False, beside: Source | None = None
    ) -> Source:
        """Its text, with functions that nothing calls if it is to be whole; beside: the other stage of its program.

        Raises ShaderError.
        """
        inserts = {GENERATED: self.generated} if self.generated else {}
        return expand(self.name, self.defines, inserts, reads_texels, large, whole, beside)


def _graphs_of(text: str) -> dict[str, str]:
    """Return what the node graph compiler writes for a stage file with this text, by the file of the nodes' kinds."""
    if GENERATED not in text:
        return {"": ""}
    # Worlds and lights trace no rays.
    return displacements() if "material_displacement" in text else programs(traces_rays="path_of_node_rays" in text)


def variants() -> list[Variant]:
    """List every stage file's variants by its lint lines; those that run node graphs have every kind of node."""
    import_declarations()
    found = []
    for path in sorted(SHADER_FOLDER.rglob("*")):
        if path.suffix in STAGES:
            text = path.read_text(encoding="utf-8")
            name = path.relative_to(SHADER_FOLDER).as_posix()
            for line in _LINT.findall(text) or [""]:
                defines: dict[str, object] = dict(item.partition("=")[::2] for item in line.split())
                found += [
                    Variant(name, defines, graph, kinds.removesuffix(".glsl"))
                    for kinds, graph in _graphs_of(text).items()
                ]
    return found
