# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of nodes over lists of inputs: Cycles' from one render, ours from compute programs.

Every case is a node with its options and, for each of its inputs, a list of values. In Cycles each sample is
a face of its own: inputs are attributes of faces, which are not interpolated, and outputs are shader AOVs,
which Cycles neither filters nor clamps. All cases share a render.
"""

import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import bpy
import moderngl
import numpy as np
from mathutils import Euler, Matrix

from rppm_addon.blender.export.common.report import Report
from rppm_addon.blender.export.context import ExportContext
from rppm_addon.blender.export.shading.nodes.graphs import GraphExporter
from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.sources import expand
from rppm_addon.materials.nodes.node_kinds import FLOAT, NodeKind
from rppm_addon.scene.node_graphs import Link, ShaderNode

from ..engines import cycles_channels, unfilter
from ..net import material
from ..scenes import link_object, new_scene, orthographic_camera

SAMPLE_SIZE = 0.02
SCENE_MATRIX = Matrix.Translation((3.0, -2.0, 5.0)) @ Matrix.Rotation(np.pi / 2, 4, "Z")
"""From the picture's plane to world space."""
OBJECT_MATRIX = (
    Matrix.Translation((1.0, 2.0, -0.5))
    @ Euler((0.3, 0.2, 1.0)).to_matrix().to_4x4()
    @ Matrix.Diagonal((2.0, 4.0, 0.5, 1.0))
)
"""Matrix of the object that the samples belong to."""
VIEWER = (0.0, 0.0, 1.0)
"""World direction from every sample to Cycles' camera."""
RAY_LENGTH = 10.0
"""Length of the camera's rays, which begin at its near plane."""
CAMERA_MATRIX = SCENE_MATRIX @ Matrix.Translation((0.0, 0.0, RAY_LENGTH + 0.1))
_GROUP = 64


@dataclass
class Case:
    """A node with chosen options over samples of its inputs."""

    kind_name: str
    kind: NodeKind
    blender_node: str
    """The bl_idname."""
    inputs: dict[str, np.ndarray]
    """(n,) or (n, 3) float32 by input of the kind; those left out keep the kind's default in both engines."""
    options: dict[str, object] = field(default_factory=dict)
    properties: dict[str, object] = field(default_factory=dict)
    """Properties of the Blender node, besides the options that it has by the same name."""
    prepare: Callable[[bpy.types.Node], None] | None = None
    """Whatever else is to be done to the Blender node."""
    sockets: dict[str, str | None] = field(default_factory=dict)
    """Identifiers of Blender's sockets where they are not the names of the kind; None where it has no such socket."""
    outputs: tuple[str, ...] = ()
    """Outputs of the kind to be compared; all if empty."""
    backfacing: bool = False
    """The faces turn their back to the camera."""
    label: str = ""
    """Tells cases apart that have the same options."""
    relative: float = 1e-5
    """Allowed difference as a share of Cycles' value, of vectors the largest part; the default allows for rounding."""
    absolute: float = 1e-6
    """Allowed absolute difference, on top of the relative one."""
    exported: ShaderNode | None = None
    """The node as it is exported, once Cycles has rendered it."""
    idle: set[str] = field(default_factory=set)
    """Inputs that Blender has no use for, with these options."""

    @property
    def name(self) -> str:
        chosen = {**self.options, **{k: v for k, v in self.properties.items() if isinstance(v, str | bool)}}
        words = [f"{key}={value}" if isinstance(value, bool) else str(value) for key, value in chosen.items()]
        return " ".join(
            [self.kind_name, *words, *([self.label] if self.label else [])]
            + (["backfacing"] if self.backfacing else [])
        )

    @property
    def count(self) -> int:
        return max(len(values) for values in self.inputs.values())

    @property
    def compared(self) -> tuple[str, ...]:
        return self.outputs or tuple(self.kind.outputs)


def grid(*axes: Sequence[float]) -> list[np.ndarray]:
    """All combinations of the axes' values: an (n,) float32 array for each axis."""
    return [values.ravel().astype(np.float32) for values in np.meshgrid(*axes, indexing="ij")]


def _socket(sockets: bpy.types.bpy_prop_collection, case: Case, name: str) -> bpy.types.NodeSocket:
    wanted = case.sockets.get(name, name)
    for socket in sockets:
        if wanted in (socket.identifier, socket.identifier.lower().replace(" ", "_")):
            return socket
    raise KeyError(f"{case.name}: no socket {wanted}, only {[socket.identifier for socket in sockets]}")


def _material(case: Case) -> bpy.types.Material:
    """The case's node between attributes of the faces and shader AOVs."""
    made, net = material(case.name)
    node = net.tree.nodes.new(case.blender_node)
    own = {name: value for name, value in case.options.items() if hasattr(node, name)}
    for name, value in {**own, **case.properties}.items():
        setattr(node, name, value)
    if case.prepare:
        case.prepare(node)
    for index, (name, (socket_type, default)) in enumerate(case.kind.inputs.items()):
        if case.sockets.get(name, name) is None:
            continue
        socket = _socket(node.inputs, case, name)
        if name in case.inputs:
            label, output = ("float", "Fac") if socket_type is FLOAT else ("vector", "Vector")
            net.set(socket, net.out("Attribute", output, attribute_name=f"{label}_{index}"))
        elif default is not None:
            if socket_type is FLOAT:
                socket.default_value = default
            else:
                channels = default if isinstance(default, tuple) else (default,) * 3
                socket.default_value = (*channels, 1.0)[: len(socket.default_value)]
    for index, name in enumerate(case.compared):
        label, member = ("float", "Value") if case.kind.outputs[name] is FLOAT else ("vector", "Color")
        aov = net.node("OutputAOV", {member: _socket(node.outputs, case, name)}, aov_name=f"{label}_{index}")
    exporter = GraphExporter(case.name, ExportContext(Report()))
    link = exporter.value(aov.inputs[member], ())
    case.exported = exporter.graph.nodes[link.node]
    case.idle = {
        name for name in case.inputs if case.sockets.get(name, name) and not _socket(node.inputs, case, name).enabled
    }
    net.output(net.out("Emission"))
    return made


def _mesh(cases: Sequence[Case], columns: int) -> bpy.types.Mesh:
    """A unit square for each sample, in rows; the attributes hold the inputs."""
    counts = [case.count for case in cases]
    total = sum(counts)
    place = np.stack([np.arange(total) % columns, np.arange(total) // columns], axis=1)
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
    backward = np.repeat([case.backfacing for case in cases], counts)
    order = np.where(backward[:, None], [0, 3, 2, 1], [0, 1, 2, 3])
    vertices = np.zeros((total, 4, 3), np.float32)
    vertices[..., :2] = SAMPLE_SIZE * (place[:, None] + corners[order] - columns / 2)
    mesh = bpy.data.meshes.new("Samples")
    mesh.vertices.add(4 * total)
    mesh.vertices.foreach_set("co", vertices.ravel())
    mesh.loops.add(4 * total)
    mesh.loops.foreach_set("vertex_index", np.arange(4 * total, dtype=np.int32))
    mesh.polygons.add(total)
    mesh.polygons.foreach_set("loop_start", np.arange(0, 4 * total, 4, dtype=np.int32))
    for case in cases:
        mesh.materials.append(_material(case))
    mesh.polygons.foreach_set("material_index", np.repeat(np.arange(len(cases), dtype=np.int32), counts))
    for index in range(max(len(case.kind.inputs) for case in cases)):
        for label, data_type, property_name, width in (
            ("float", "FLOAT", "value", 1),
            ("vector", "FLOAT_VECTOR", "vector", 3),
        ):
            values = np.zeros((total, width), np.float32)
            start = 0
            for case in cases:
                names = list(case.kind.inputs)
                if index < len(names) and names[index] in case.inputs:
                    given = np.asarray(case.inputs[names[index]], np.float32)
                    if (width == 1) == (case.kind.inputs[names[index]][0] is FLOAT):
                        values[start : start + case.count] = given.reshape(-1, width)
                start += case.count
            if values.any():
                attribute = mesh.attributes.new(f"{label}_{index}", data_type, "FACE")
                attribute.data.foreach_set(property_name, values.ravel())
    mesh.update(calc_edges=True)
    mesh.transform(OBJECT_MATRIX.inverted() @ SCENE_MATRIX)
    return mesh


def cycles_values(cases: Sequence[Case]) -> list[dict[str, np.ndarray]]:
    """Cycles' outputs of each case: (n,) or (n, 3) float32 by name. Loses the current Blender scene."""
    total = sum(case.count for case in cases)
    columns = int(np.ceil(np.sqrt(total)))
    scene = new_scene(columns)
    link_object(_mesh(cases, columns), OBJECT_MATRIX)
    orthographic_camera(SAMPLE_SIZE * columns, CAMERA_MATRIX).data.clip_start = 0.1
    unfilter()
    aovs = set()
    for case in cases:
        for index, name in enumerate(case.compared):
            aovs.add((case.kind.outputs[name] is FLOAT, index))
    for is_float, index in sorted(aovs):
        aov = scene.view_layers[0].aovs.add()
        aov.name = f"{'float' if is_float else 'vector'}_{index}"
        aov.type = "VALUE" if is_float else "COLOR"
    pictures = cycles_channels()
    values, start = [], 0
    for case in cases:
        found = {}
        for index, name in enumerate(case.compared):
            if case.kind.outputs[name] is FLOAT:
                flat = next(pictures[key] for key in pictures if key.startswith(f"float_{index}."))
                found[name] = flat.ravel()[start : start + case.count]
            else:
                planes = [pictures[f"vector_{index}.{c}"].ravel() for c in "RGB"]
                found[name] = np.stack([plane[start : start + case.count] for plane in planes], axis=-1)
        values.append(found)
        start += case.count
    return values


def _literal(value: object) -> str:
    if isinstance(value, tuple | list):
        return f"vec3({', '.join(_literal(v) for v in value)})"
    return repr(float(value))


def program_text(case: Case, surface: str = "") -> str:
    """A compute shader that calls the case's node with literal options, as the compiler does."""
    kind = case.kind
    includes = [surface] if surface else []
    includes.append(f'#include "materials/nodes/{kind.source}"')
    arguments = ["surface"] if kind.surface else []
    function, literals = kind.call(case.kind_name, case.options)
    arguments += literals
    arguments += ["0u" for _ in kind.resources]
    stride = sum(1 if kind.inputs[name][0] is FLOAT else 3 for name in case.inputs)
    offset, lines = 0, []
    for name, (socket_type, default) in kind.inputs.items():
        if name not in case.inputs:
            wide = not isinstance(default, tuple) and socket_type is not FLOAT
            arguments.append(_literal((default,) * 3 if wide else default))
        elif socket_type is FLOAT:
            arguments.append(f"inputs[start + {offset}u]")
            offset += 1
        else:
            arguments.append("vec3(" + ", ".join(f"inputs[start + {offset + i}u]" for i in range(3)) + ")")
            offset += 3
    for index, socket_type in enumerate(kind.outputs.values()):
        lines.append(f"    {socket_type.glsl} output{index};")
        arguments.append(f"output{index}")
    if kind.surface:
        lines.append("    Surface surface;")
        lines.append(f"    surface.viewer = {_literal(VIEWER)};")
        lines.append(f"    surface.backfacing = {str(case.backfacing).lower()};")
    lines.append(f"    {function}({', '.join(arguments)});")
    offset, stores = 0, []
    for index, socket_type in enumerate(kind.outputs.values()):
        for part in [""] if socket_type is FLOAT else [".x", ".y", ".z"]:
            stores.append((offset, f"output{index}{part}"))
            offset += 1
    lines += [f"    results[i * {offset}u + {place}u] = {value};" for place, value in stores]
    newline = "\n"
    return f"""#version 430 core
layout(local_size_x = {_GROUP}) in;
readonly buffer Inputs {{ float inputs[]; }};
writeonly buffer Results {{ float results[]; }};
{newline.join(includes)}
void main() {{
    uint i = gl_GlobalInvocationID.x;
    if (i >= {case.count}u) return;
    uint start = i * {stride}u;
{newline.join(lines)}
}}
"""


def our_values(context: Context, case: Case, surface: str = "") -> dict[str, np.ndarray]:
    """Our outputs of a case: (n,) or (n, 3) float32 by name.

    ``surface`` is GLSL that declares the struct Surface, for kinds that take one. Raises ShaderError.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "case.comp"
        path.write_text(program_text(case, surface))
        source = expand(str(path))
    gl = context.moderngl
    try:
        program = gl.compute_shader(source.text)
    except moderngl.Error as error:
        raise AssertionError(source.name_lines(str(error))) from error
    given = [
        np.asarray(v, np.float32).reshape(len(v), -1)
        for v in (case.inputs[name] for name in case.kind.inputs if name in case.inputs)
    ]
    inputs = np.concatenate([np.broadcast_to(v, (case.count, v.shape[1])) for v in given], axis=1)
    widths = [1 if socket_type is FLOAT else 3 for socket_type in case.kind.outputs.values()]
    table = np.zeros(1, np.float32) if case.exported is None else case.exported.table
    table = np.zeros(1, np.float32) if table is None else table
    buffers = {
        "Inputs": gl.buffer(np.ascontiguousarray(inputs, np.float32).tobytes()),
        "Results": gl.buffer(reserve=4 * case.count * sum(widths)),
        "MaterialData": gl.buffer(np.ascontiguousarray(table, np.float32).tobytes()),
    }
    for block, binding in source.blocks.items():
        buffers[block].bind_to_storage_buffer(binding)
    program.run(-(-case.count // _GROUP))
    context.barrier()
    results = np.frombuffer(buffers["Results"].read(), np.float32).reshape(case.count, -1)
    for buffer in buffers.values():
        buffer.release()
    program.release()
    values, start = {}, 0
    for name, width in zip(case.kind.outputs, widths):
        values[name] = results[:, start] if width == 1 else results[:, start : start + width]
        start += width
    return values


def assert_exported(case: Case) -> None:
    """The exporter makes the case's kind and options of Blender's node, and links the inputs that have lists."""
    node = case.exported
    assert node.kind == case.kind_name
    assert node.options == {name: values[0] for name, values in case.kind.options.items()} | case.options
    assert (node.table is not None) == ("table" in case.kind.resources)
    for name in case.inputs:
        if case.sockets.get(name, name) is not None and name not in case.idle:
            assert isinstance(node.inputs[name], Link), name


def assert_values_agree(case: Case, ours: dict[str, np.ndarray], cycles: dict[str, np.ndarray]) -> None:
    """Every value within the case's tolerances; prints the largest differences.

    Where Cycles' value is not finite ours may be anything: neither engine shows it.
    """
    for name in case.compared:
        a, b = ours[name].astype(np.float64), cycles[name].astype(np.float64)
        finite = np.isfinite(b)
        assert finite.mean() > 0.5, f"{case.name}: {name} of Cycles is mostly not finite"
        error = np.where(finite, np.abs(a - b), 0.0)
        error = np.where(finite & ~np.isfinite(a), np.inf, error)
        size = np.abs(np.where(finite, b, 0.0))
        size = size if b.ndim == 1 else size.max(axis=1, keepdims=True)
        excess = error - (case.absolute + case.relative * size)
        worst = np.unravel_index(np.argmax(excess), excess.shape)
        wrong = (excess > 0.0).reshape(case.count, -1).any(axis=1)
        shares = error / np.maximum(size, 1e-3)
        print(
            f"\n{case.name}: {name} differs by {error.max():.3g}, by {shares.max():.3g} of its size; "
            f"{(~finite).sum()} of {b.size} not finite"
        )
        given = {key: np.asarray(v)[worst[0] if len(v) > 1 else 0].tolist() for key, v in case.inputs.items()}
        assert not wrong.any(), (
            f"{case.name}: {name} differs at {wrong.sum()} of {case.count}, most at {given}: "
            f"ours {a[worst[0]]}, Cycles {b[worst[0]]}"
        )
