# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of shader nodes from Cycles and from our GLSL, at the same coordinates.

Cycles shades a tilted plane whose material writes the coordinates and each node's outputs to passes (AOVs), one
sample per pixel; the GLSL functions are then called with exactly those coordinates.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix

from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.materials.nodes.node_kinds import FLOAT, NodeKind

from ..engines import cycles_channels, unfilter
from ..net import Net, material
from ..scenes import mesh_object, new_scene, orthographic_camera
from .shader_runs import run_shader

RESOLUTION = 48
CORNERS = [(-2.1, -1.9, 0.3), (2.0, -2.05, 1.9), (2.2, 1.95, -0.4), (-1.9, 2.1, -2.0)]
"""Corners of the plane: a single quadrilateral, seen from above, whose heights differ from its other coordinates."""


@dataclass(frozen=True)
class NodeCase:
    """A node to evaluate: ``vector`` and ``w``, where it has them, are the coordinates; the rest is constant."""

    node: str
    """Blender's bl_idname."""
    options: dict = field(default_factory=dict)
    inputs: dict = field(default_factory=dict)
    """Values by our names for sockets; what is missing has its default."""


def our_name(identifier: str) -> str:
    """Our name for a socket identifier of Blender."""
    return identifier.lower().replace(" ", "_")


def _set(node: bpy.types.Node, case: NodeCase) -> None:
    for name, value in case.options.items():
        setattr(node, name, value)
    sockets = {our_name(socket.identifier): socket for socket in node.inputs}
    for name, value in case.inputs.items():
        if name not in sockets:
            setattr(node, name, type(getattr(node, name))(value))
        elif sockets[name].type == "RGBA":
            sockets[name].default_value = (*value, 1.0)
        else:
            sockets[name].default_value = value


class _Passes:
    """Sockets of a material that are written to passes of the picture."""

    def __init__(self, net: Net) -> None:
        self.net = net
        self.count = 0

    def add(self, socket: bpy.types.NodeSocket) -> str:
        name = f"pass_{self.count:04d}"
        self.count += 1
        made = bpy.context.view_layer.aovs.add()
        made.name, made.type = name, "VALUE" if socket.type == "VALUE" else "COLOR"
        self.net.node("OutputAOV", {made.type.capitalize(): socket}, aov_name=name)
        return name


def _pass(channels: dict[str, np.ndarray], name: str) -> np.ndarray:
    """(pixels,) or (pixels, 3) float32."""
    if f"{name}.R" in channels:
        return np.stack([channels[f"{name}.{c}"].reshape(-1) for c in "RGB"], axis=-1).astype(np.float32)
    found = next(pixels for channel, pixels in channels.items() if channel.split(".")[0] == name)
    return found.reshape(-1).astype(np.float32)


def cycles_values(
    cases: Sequence[NodeCase], shift: Sequence[float] = (0.0, 0.0, 0.0)
) -> tuple[np.ndarray, np.ndarray, list[dict[str, np.ndarray]]]:
    """Return Cycles' values for some twenty cases: vectors (pixels, 3), w (pixels,), each case's outputs by our names.

    More cases in one picture do not fit the stack of Cycles' virtual machine.
    """
    new_scene(RESOLUTION)
    made, net = material("Values")
    mesh_object(CORNERS, [(0, 1, 2, 3)], made)
    orthographic_camera(3.7, Matrix.Translation((0.0, 0.0, 5.0)))
    vector = net.out("VectorMath", 0, {0: net.out("NewGeometry", "Position"), 1: tuple(shift)})
    w = net.out("VectorMath", "Value", {0: vector, 1: (0.7, -0.9, 0.4)}, operation="DOT_PRODUCT")
    passes, tree = _Passes(net), net.tree
    vector_pass, w_pass = passes.add(vector), passes.add(w)
    names = []
    for case in cases:
        node = tree.nodes.new(case.node)
        _set(node, case)
        for socket in node.inputs:
            if socket.identifier in ("Vector", "W"):
                tree.links.new(vector if socket.identifier == "Vector" else w, socket)
        names.append({our_name(s.identifier): passes.add(s) for s in node.outputs if s.enabled})
    net.output(net.out("Emission"))
    unfilter()
    channels = cycles_channels()
    results = [{name: _pass(channels, given) for name, given in case.items()} for case in names]
    vectors = _pass(channels, vector_pass)
    assert np.ptp(vectors, axis=0).min() > 1.0, "Cycles shaded nothing"
    return vectors, _pass(channels, w_pass), results


def call_shader(function: str, kind: NodeKind, chosen: int) -> str:
    """A compute shader that calls a node's function for each invocation; see our_values.

    Its ``chosen`` options are numbers of a buffer, not literals as in materials: so all of them share a program.
    """
    constants = [given for given in kind.inputs if given not in ("vector", "w")]
    fetched = {"vector": "coordinates[3u * i], coordinates[3u * i + 1u], coordinates[3u * i + 2u]"}
    fetched["w"] = "coordinates[3u * count + i]"
    place = 0
    for given in constants:
        width = 1 if kind.inputs[given][0] is FLOAT else 3
        fetched[given] = ", ".join(f"constants[{place + k}u]" for k in range(width))
        place += width
    arguments = [f"options[{k}u]" for k in range(chosen)]
    arguments += [f"{kind.inputs[given][0].glsl}({fetched[given]})" for given in kind.inputs]
    declared, stored, place = [], [], 0
    for output, socket in kind.outputs.items():
        declared.append(f"{socket.glsl} out_{output};")
        arguments.append(f"out_{output}")
        for k in range(1 if socket is FLOAT else 3):
            stored.append(f"results[{place}u * count + i] = out_{output}{'' if socket is FLOAT else f'[{k}]'};")
            place += 1
    return "\n".join(
        [
            "#version 430 core",
            # REUSE-IgnoreStart
            "// SPDX-License-Identifier: GPL-3.0-or-later",
            # REUSE-IgnoreEnd
            "layout(local_size_x = 64) in;",
            "readonly buffer Coordinates { float coordinates[]; };",
            "readonly buffer Constants { float constants[]; };",
            "writeonly buffer Results { float results[]; };",
            "readonly buffer Options { int options[]; };",
            f'#include "materials/nodes/{kind.source}"',
            "void main() {",
            "uint i = gl_GlobalInvocationID.x;",
            "uint count = uint(coordinates.length()) / 4u;",
            "if (i >= count) return;",
            *declared,
            f"{function}({', '.join(arguments)});",
            *stored,
            "}",
            "",
        ]
    )


def our_values(
    library: ProgramLibrary, folder: Path, name: str, kind: NodeKind, case: NodeCase, vector: np.ndarray, w: np.ndarray
) -> dict[str, np.ndarray]:
    """Return the outputs of our GLSL for a case, as cycles_values returns those of Cycles."""
    function, literals = kind.call(name, case.options)
    path = folder / f"{function}.comp"
    path.write_text(call_shader(function, kind, len(literals)), encoding="utf-8")
    unknown = case.inputs.keys() - kind.inputs.keys()
    assert not unknown, f"{name} has no input {unknown}"
    constants = [np.ravel(case.inputs.get(g, d)) for g, (_, d) in kind.inputs.items() if g not in ("vector", "w")]
    count, width = len(w), sum(1 if socket is FLOAT else 3 for socket in kind.outputs.values())
    arrays = {
        "Coordinates": np.concatenate([vector.reshape(-1), w]).astype(np.float32),
        "Constants": np.concatenate([*constants, [0.0]]).astype(np.float32),
        "Options": np.array([*map(int, literals), 0], np.int32),
    }
    table = run_shader(library, path, count, arrays, width).reshape(width, count)
    values, place = {}, 0
    for output, socket in kind.outputs.items():
        size = 1 if socket is FLOAT else 3
        values[output] = table[place] if size == 1 else table[place : place + 3].T
        place += size
    return values
