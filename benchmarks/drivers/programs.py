# SPDX-License-Identifier: GPL-3.0-or-later
"""All programs of RPPM: every stage file with the defines that its lint lines name, and with every kind of node."""

import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import PurePosixPath

from rppm_addon.gl.programs.sources import Source
from tests.support.shader_declarations import Variant, variants


@dataclass(frozen=True)
class Program:
    """A program by its name and the stages that are linked together, each by the suffix of its file."""

    name: str
    stages: dict[str, Source]

    @property
    def texts(self) -> dict[str, str]:
        """Texts that the driver gets, by stage."""
        return {stage: source.text for stage, source in self.stages.items()}

    @property
    def digest(self) -> str:
        """The same for the same texts."""
        return hashlib.sha256(json.dumps(self.texts, sort_keys=True).encode()).hexdigest()

    def name_lines(self, message: str) -> str:
        """A driver's message with our files' names; of a draw, as if it spoke of the fragment shader."""
        return (self.stages.get("frag") or self.stages["comp"]).name_lines(message)


def all_programs() -> list[Program]:
    """Compute programs and draws: a fragment shader is drawn with each vertex shader in its folder."""
    checked = variants()
    vertices: dict[PurePosixPath, list[Variant]] = {}
    for variant in checked:
        if variant.name.endswith(".vert"):
            vertices.setdefault(PurePosixPath(variant.name).parent, []).append(variant)
    return list(_programs(checked, vertices))


def _words(defines: Mapping[str, object]) -> list[str]:
    """List what tells variants of a file apart: names of defines or, where these name a file to include, its folder and
    what its name adds to "traverse"."""
    words = []
    for name, value in sorted(defines.items()):
        path = PurePosixPath(str(value))
        words += [path.parent.name, *path.stem.split("_")[1:]] if "/" in str(value) else [name]
    return words


def _programs(checked: list[Variant], vertices: dict[PurePosixPath, list[Variant]]) -> Iterator[Program]:
    for variant in checked:
        path = PurePosixPath(variant.name)
        words = [variant.name, *_words(variant.defines), *([variant.kinds] if variant.kinds else [])]
        if path.suffix == ".comp":
            yield Program(" ".join(words), {"comp": variant.expand()})
        elif path.suffix == ".frag":
            beside = vertices[path.parent]
            for vertex_variant in beside:
                vertex = vertex_variant.expand()
                stem = [PurePosixPath(vertex_variant.name).stem] if len(beside) > 1 else []
                yield Program(" ".join(words + stem), {"vert": vertex, "frag": variant.expand(beside=vertex)})
