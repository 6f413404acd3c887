# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of sockets and weights of shaders in a node tree, as far as they are constant."""

from collections.abc import Iterator
from dataclasses import dataclass

import bpy
import numpy as np

from . import constants
from .images import ImageTable
from .links import Path, Source, find_source, named_input
from .report import Report

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
"""Rec.709: how a colour becomes a number when it is plugged into a grey socket."""


@dataclass
class Value:
    """A constant colour that multiplies an image, if there is one."""

    color: np.ndarray
    """(3,) float64 linear Rec.709."""
    image: int = -1
    """Index into the exported images, or -1."""


@dataclass
class Shader:
    """A shader node and what is made of it."""

    weight: float
    node: bpy.types.Node
    path: Path
    type: str
    """The node's type, or that of the node that does what it and its neighbours do together;
    COLOR where a colour feeds a shader input, which glows with it, as in Cycles."""
    color: Value | None = None
    """COLOR: that colour."""


class Evaluator:
    """Reads one material, light or world.

    What is not constant gets a neutral value and a warning that names the node.
    """

    def __init__(self, owner: str, report: Report, images: ImageTable):
        """owner: what warnings name, such as 'Material "Glass"'."""
        self.owner = owner
        self.report = report
        self.images = images

    def warn(self, node: bpy.types.Node, text: str) -> None:
        self.report.warn(f'{self.owner}: node "{node.name}" ({node.type}) {text}')

    def value(self, socket: bpy.types.NodeSocket, path: Path) -> Value:
        """The colour at an input; an image that feeds it as it is stays an image."""
        source = find_source(socket, path)
        if not isinstance(source, Source):
            return Value(_default(source.socket))
        value = constants.evaluate(self, source)
        # What the user had chosen before plugging something in is the best guess for the unknown.
        return Value(_default(socket)) if value is None else value

    def mean_color(self, socket: bpy.types.NodeSocket, path: Path) -> np.ndarray:
        """The colour at an input, (3,) float64; an image counts by its mean."""
        return self.mean(self.value(socket, path))

    def mean(self, value: Value) -> np.ndarray:
        return value.color if value.image < 0 else value.color * self.images.mean(value.image)

    def scalar(self, socket: bpy.types.NodeSocket | None, path: Path, absent: float = 0.0) -> float:
        """The number at an input; an image counts by its mean, with a warning.

        absent: the value where this Blender version has no such socket.
        """
        if socket is None:
            return absent
        source = find_source(socket, path)
        value = self.value(socket, path)
        if value.image >= 0:
            self.warn(source.node, f'varies "{socket.name}" over the surface; its mean is used')
        color = self.mean(value)
        if isinstance(source, Source) and source.output.type == "VECTOR":
            return float(color.mean())
        return float(color @ LUMINANCE) if color.min() != color.max() else float(color[0])

    def shaders(self, socket: bpy.types.NodeSocket) -> Iterator[Shader]:
        """The shader nodes that feed an output node, with the weights that Mix and Add give them."""
        pending: list[tuple[float, bpy.types.NodeSocket, Path]] = [(1.0, socket, ())]
        while pending:
            weight, socket, path = pending.pop()
            source = find_source(socket, path)
            if not isinstance(source, Source):
                continue
            node, path = source.node, source.path
            if source.output.type != "SHADER":
                value = constants.evaluate(self, source)
                yield Shader(weight, node, path, "COLOR", Value(np.zeros(3)) if value is None else value)
            elif node.type == "MIX_SHADER":
                refraction = self._refraction_of_glass(node, path)
                if refraction is not None:
                    yield Shader(weight, refraction.node, refraction.path, "BSDF_GLASS")
                    continue
                factor = min(max(self.scalar(node.inputs[0], path), 0.0), 1.0)
                # The last pushed is read first: keep the order of the node.
                if factor > 0.0:
                    pending.append((weight * factor, node.inputs[2], path))
                if factor < 1.0:
                    pending.append((weight * (1.0 - factor), node.inputs[1], path))
            elif node.type == "ADD_SHADER":
                pending += [(weight, node.inputs[1], path), (weight, node.inputs[0], path)]
            else:
                yield Shader(weight, node, path, node.type)

    def _refraction_of_glass(self, mix: bpy.types.Node, path: Path) -> Source | None:
        """The Refraction node, when a Fresnel factor joins it to a Glossy node of the same look.

        Together they are what the Glass node is.
        """
        factor, first, second = (find_source(socket, path) for socket in mix.inputs[:3])
        if not all(isinstance(source, Source) for source in (factor, first, second)):
            return None
        if (factor.node.type, first.node.type, second.node.type) != ("FRESNEL", "BSDF_REFRACTION", "BSDF_GLOSSY"):
            return None

        def same(name: str, other: Source) -> bool:
            values = [self.value(source.node.inputs[name], source.path) for source in (first, other)]
            return values[0].image == values[1].image and np.allclose(values[0].color, values[1].color, atol=1e-5)

        return first if same("IOR", factor) and same("Color", second) and same("Roughness", second) else None

    def ignore(self, node: bpy.types.Node, path: Path, *names: str) -> None:
        """Warn when one of the inputs of a node that nothing is made of has an effect."""
        for name in names:
            socket = named_input(node, name)
            if socket is None:
                continue
            linked = isinstance(find_source(socket, path), Source)
            if linked or (socket.type == "VALUE" and socket.default_value != 0.0):
                self.warn(node, f'has "{name}", which is not rendered yet and is ignored')


def _default(socket: bpy.types.NodeSocket) -> np.ndarray:
    """The value stored in a socket as a colour, (3,) float64."""
    stored = getattr(socket, "default_value", 0.0)
    if isinstance(stored, bpy.types.bpy_prop_array) or hasattr(stored, "__len__"):
        color = np.array(stored[:3], np.float64) if not isinstance(stored, str) else np.zeros(3)
    elif isinstance(stored, int | float):
        color = np.full(3, float(stored))
    else:
        color = np.zeros(3)
    return np.nan_to_num(color, nan=0.0, posinf=0.0, neginf=0.0)
