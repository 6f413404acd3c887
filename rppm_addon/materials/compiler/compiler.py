# SPDX-License-Identifier: GPL-3.0-or-later
"""Node graphs to GLSL.

A graph becomes the function ``evaluate_material`` and its constants. Numbers, images, tables and attributes are
constants in a buffer, so graphs that differ in those only have the same text and share a program.
"""

from collections.abc import Sequence
from typing import Any

from ...scene.common.working_space import REC709, WorkingSpace
from ...scene.meshes import SMOOTH_NORMALS, UNDISPLACED
from ...scene.node_graphs import AovOutput, Link, NodeGraph, ShaderNode
from ...scene.passes import PassKind, RenderPass
from ..dispersion import disperses
from ..nodes import KINDS
from ..nodes.node_kinds import COLOR, FLOAT, SHADER, NodeKind, SocketType
from ..traits.ray_portals import has_ray_portals
from ..traits.subsurface import has_subsurface
from ..traits.transparency import asks_for_shadow_rays
from .bump import Bump
from .compiled_graph import CompiledGraph, GraphError, NodeRayCounts, Resource
from .graph_constants import LUMINANCE, GraphConstants, read_constant, socket_constants
from .pieces import in_pieces
from .ray_levels import RayLevels

MIX_SHADER, ADD_SHADER, BUMP = "mix_shader", "add_shader", "bump"
"""Kinds that the compiler itself knows: two distribute weights, one evaluates its input three times."""

_IMPLICIT = {
    "normal": "surface.normal",
    "position": "world_position(surface)",
    "tangent": "default_tangent(surface)",
}
"""GLSL expressions for inputs whose default is a name, by that name."""


_MAX_BUMP_DEPTH = 2
"""Each bump whose height depends on the normal of another asks for that three times: 3^2 are enough."""

MAX_CALLS = 8192
"""Largest number of nodes that a graph may compute, those of a bump's height as often as they are asked: drivers
compile more for many minutes."""


class _Scope:
    """Statements of one GLSL function, each output of a node computed once."""

    def __init__(self, depth: int = 0, ray_level: int = 0) -> None:
        self.depth = depth
        """How many heights of bumps lie around it."""
        self.ray_level = ray_level
        """Level of the first rays that its nodes ask for. Rays that its normal depends on are traced before."""
        self.lines: list[str] = []
        self.known: dict[int, dict[str, str]] = {}


class _Compiler:
    def __init__(
        self,
        graph: NodeGraph,
        aovs: Sequence[RenderPass],
        abbe_number: float | None,
        *,
        corrects_bump: bool,
        on_round_shapes: bool,
        traces_rays: bool,
        space: WorkingSpace,
    ) -> None:
        self._graph = graph
        self._luminance = LUMINANCE if space is REC709 else tuple(space.luminance.tolist())
        self._corrects_bump, self._on_round_shapes = corrects_bump, on_round_shapes
        self._abbe_number = abbe_number
        self._traces_rays = traces_rays
        self._aovs = aovs
        self._constants = GraphConstants()
        self._rays = RayLevels(graph)
        self._sources: dict[str, None] = {}
        self._functions: list[str] = []
        self._heights: dict[tuple[int, int], str] = {}
        self._numbers: dict[int, int] = {}
        self._calls = 0

    def compile(self) -> CompiledGraph:
        scope = _Scope(ray_level=self._rays.of_normal)
        text = '#include "materials/round_shapes.glsl"\n' if self._on_round_shapes else ""
        if not self._corrects_bump:
            text += '#include "materials/uncorrected_bump.glsl"\n'
        if self._abbe_number is not None and disperses(self._graph):
            text += '#include "materials/dispersion.glsl"\n'
            place = self._constants.place((-1, "inverse_abbe_number"), [1.0 / max(self._abbe_number, 1.0)])
            scope.lines.append(f"inverse_abbe_number = constant_float(first + {place}u);")
        if asks_for_shadow_rays(self._graph):
            text += '#include "materials/shadow_rays.glsl"\n'
        if has_subsurface(self._graph):
            text += '#include "materials/subsurface.glsl"\n'
        if has_ray_portals(self._graph):
            text += '#include "materials/ray_portals.glsl"\n'
        if self._graph.normal is not None:
            self._sources[KINDS[BUMP].source] = None
            # Apart: what nodes ask of the surface may be another with the new normal.
            normal = _Scope()
            value = self._converted(normal, self._graph.normal, SocketType.VECTOR)
            self._functions.append(_function("vec3", "material_normal", normal.lines, value))
            scope.lines.append("surface.normal = material_normal(surface, first);")
            scope.lines.append("set_shading_normal(builder, surface.normal);")
        if self._graph.surface is not None:
            self._add_shaders(scope, self._graph.surface)
        aovs = self._aov_function()
        text += "".join([*self._includes(), *self._functions])
        text += (
            "void evaluate_material(Surface surface, uint first, inout ClosureBuilder builder) {\n"
            + "".join(f"    {line}\n" for line in in_pieces(scope.lines))
            + "}\n"
        )
        rays = self._rays.counts if self._traces_rays else NodeRayCounts()
        return CompiledGraph(text + aovs, self._constants.values, rays)

    def compile_displacement(self) -> CompiledGraph:
        assert self._graph.displacement is not None
        scope = _Scope()
        value = self._converted(scope, self._graph.displacement, SocketType.VECTOR)
        function = _function("vec3", "material_displacement", scope.lines, value)
        return CompiledGraph("".join([*self._includes(), *self._functions, function]), self._constants.values)

    def _includes(self) -> list[str]:
        rays = ['#include "materials/node_rays.glsl"\n'] if self._rays.counts.places and self._traces_rays else []
        return rays + [f'#include "materials/nodes/{source}"\n' for source in sorted(self._sources)]

    def _aov_function(self) -> str:
        """The function that writes the passes of AOV Output nodes, and what it needs; nothing of a graph that has
        none."""
        stride = sum(len(entry.channels) for entry in self._aovs)
        scope, written, place = _Scope(ray_level=self._rays.of_normal), list[str](), 0
        if self._graph.normal is not None:
            scope.lines.append("surface.normal = material_normal(surface, first);")
        for entry in self._aovs:
            for output in self._graph.aovs:
                if output.name == entry.name:
                    value = self._aov_value(scope, output, entry)
                    written.append(f"add_aov({stride}u * path + {place}u, {value});")
            place += len(entry.channels)
        if not written:
            return ""
        lines = "".join(f"    {line}\n" for line in in_pieces([*scope.lines, *written]))
        head = "void evaluate_aovs(Surface surface, uint first, uint path)"
        return f'#include "surfaces/resolve/aovs.glsl"\n{head} {{\n{lines}}}\n'

    def _aov_value(self, scope: _Scope, output: AovOutput, entry: RenderPass) -> str:
        """GLSL for what a node writes: a color, or a value."""
        kind = FLOAT if entry.kind is PassKind.VALUE else COLOR
        value = output.value if kind is FLOAT else output.color
        if isinstance(value, Link):
            return self._converted(scope, value, kind)
        node = ShaderNode("aov_output", output.name)
        name = "value" if kind is FLOAT else "color"
        return read_constant(self._constants.append(socket_constants(node, name, value, kind, self._luminance)), kind)

    def _number(self, index: int) -> int:
        """Names go by the order of use, so that nodes that nothing uses leave the text as it is."""
        return self._numbers.setdefault(index, len(self._numbers))

    def _kind(self, index: int) -> NodeKind:
        if not 0 <= index < len(self._graph.nodes):
            raise GraphError(f"a link goes to node {index} of {len(self._graph.nodes)}")
        node = self._graph.nodes[index]
        if node.kind not in KINDS:
            raise GraphError(f'node "{node.name}" is of the unknown kind {node.kind}')
        return KINDS[node.kind]

    # --- shaders ------------------------------------------------------------------------------------

    def _add_shaders(self, scope: _Scope, output: Link) -> None:
        """Weights flow from the output to the shaders; each shader is added once with the sum of its weights."""
        weights: dict[int, list[str]] = {output.node: ["1.0"]}
        self._check_shader(output)
        # Inputs link to earlier nodes only: going down, all weights of a node are known when it is reached.
        for index in range(output.node, -1, -1):
            if index not in weights:
                continue
            node = self._graph.nodes[index]
            weight = f"w{self._number(index)}"
            scope.lines.append(f"float {weight} = {' + '.join(weights[index])};")
            first, second = node.inputs.get("shader"), node.inputs.get("shader_001")
            if node.kind == MIX_SHADER:
                factor = f"f{self._number(index)}"
                scope.lines.append(f"float {factor} = clamp({self._input(scope, index, 'fac', FLOAT, 0.5)}, 0.0, 1.0);")
                parts = ((first, f"{weight} * (1.0 - {factor})"), (second, f"{weight} * {factor}"))
            elif node.kind == ADD_SHADER:
                parts = ((first, weight), (second, weight))
            else:
                self._call(scope, index, weight)
                continue
            for shader, part in parts:
                if isinstance(shader, Link):
                    self._check_order(index, shader)
                    self._check_shader(shader)
                    weights.setdefault(shader.node, []).append(part)

    def _check_shader(self, link: Link) -> None:
        if self._kind(link.node).outputs.get(link.output) is not SHADER:
            node = self._graph.nodes[link.node]
            raise GraphError(f'node "{node.name}" ({node.kind}) gives no shader "{link.output}"')

    def _check_order(self, index: int, link: Link) -> None:
        if link.node >= index:
            raise GraphError(f'node "{self._graph.nodes[index].name}" links to a node that does not come before it')

    # --- values -------------------------------------------------------------------------------------

    def _input(self, scope: _Scope, index: int, name: str, kind: SocketType, default: Any) -> str:
        """GLSL for an input of a node."""
        value = self._graph.nodes[index].inputs.get(name, default)
        if isinstance(value, Link):
            self._check_order(index, value)
            return self._converted(scope, value, kind)
        if isinstance(value, str) and value in _IMPLICIT:
            return _IMPLICIT[value]
        constants = socket_constants(self._graph.nodes[index], name, value, kind, self._luminance)
        return read_constant(self._constants.place((index, name), constants), kind)

    def _converted(self, scope: _Scope, link: Link, wanted: SocketType) -> str:
        given = self._kind(link.node).outputs.get(link.output)
        if given is None or given is SHADER or wanted is SHADER:
            node = self._graph.nodes[link.node]
            values = ", ".join(name for name, kind in self._kind(link.node).outputs.items() if kind is not SHADER)
            raise GraphError(
                f'node "{node.name}" ({node.kind}) has no value output "{link.output}", only {values or "shaders"}'
            )
        value = self._value(scope, link)
        if given is FLOAT:
            return value if wanted is FLOAT else f"vec3({value})"
        if wanted is FLOAT:
            return f"luminance({value})" if given is SocketType.COLOR else f"mean({value})"
        return value

    def _value(self, scope: _Scope, link: Link) -> str:
        # By hand, not by recursion: chains of nodes are longer than Python's stack.
        pending = [link.node]
        while pending:
            index = pending[-1]
            if index in scope.known:
                pending.pop()
                continue
            unknown = [node for node in self._needed(index) if node not in scope.known]
            if unknown:
                pending += reversed(unknown)
            else:
                pending.pop()
                self._call(scope, index, None)
        return scope.known[link.node][link.output]

    def _needed(self, index: int) -> list[int]:
        """The nodes that must be known before a node is computed. The height of a bump is computed apart."""
        node, kind = self._graph.nodes[index], self._kind(index)
        links = [link for name in kind.inputs if isinstance(link := node.inputs.get(name), Link)]
        if node.kind == BUMP:
            links = [link for link in links if link is not node.inputs.get("height")]
        for link in links:
            self._check_order(index, link)
        return [link.node for link in links]

    def _call(self, scope: _Scope, index: int, weight: str | None) -> None:
        """Compute all outputs of a node, or add a shader with a weight."""
        node, kind = self._graph.nodes[index], self._kind(index)
        self._calls += 1
        if self._calls > MAX_CALLS:
            raise GraphError(
                f"it has more than {MAX_CALLS} nodes, which drivers compile for many minutes; bake them to a texture, "
                "or take some out"
            )
        if node.kind == BUMP:
            self._bump(scope, index)
            return
        self._sources[kind.source] = None
        arguments = ["surface"] if kind.surface else []
        if kind.is_shader:
            if weight is None:
                raise GraphError(f'node "{node.name}" is a shader and gives no value')
            arguments += ["builder", weight]
        function, literals = _function_of(node, kind)
        arguments += literals
        for what in kind.resources:
            arguments.append(self._constants.index((index, f"<{what}>"), Resource(what, index)))
        if kind.traces_rays:
            arguments += self._rays.arguments(index, scope.ray_level)
        for name, (socket, default) in kind.inputs.items():
            arguments.append(self._input(scope, index, name, socket, default))
        values = {
            name: f"n{self._number(index)}_{name}" for name, socket in kind.outputs.items() if socket is not SHADER
        }
        for name, value in values.items():
            scope.lines.append(f"{kind.outputs[name].glsl} {value};")
        scope.lines.append(f"{function}({', '.join([*arguments, *values.values()])});")
        scope.known[index] = values

    def _bump(self, scope: _Scope, index: int) -> None:
        """The height is a function of the place, which is asked at three of them."""
        kind = self._kind(index)
        self._sources[kind.source] = None
        number = self._number(index)
        value = f"n{number}_normal"
        scope.known[index] = {"normal": value}
        displaced = self._graph.nodes[index].attribute == UNDISPLACED
        # As in Cycles: what has the same height everywhere hands its normal on, of whatever length.
        level = not displaced and not isinstance(self._graph.nodes[index].inputs.get("height"), Link)
        if level or scope.depth >= _MAX_BUMP_DEPTH:
            scope.lines.append(f"vec3 {value} = {self._input(scope, index, 'normal', *kind.inputs['normal'])};")
            return
        function = f"height_{number}_{scope.depth}"
        if (index, scope.depth) not in self._heights:
            inner = _Scope(scope.depth + 1, scope.ray_level)
            height = self._input(inner, index, "height", *kind.inputs["height"])
            self._functions.append(_function("float", function, inner.lines, height))
            self._heights[index, scope.depth] = function
        strength, distance, normal, filter_width = (
            self._input(scope, index, name, *kind.inputs[name])
            for name in ("strength", "distance", "normal", "filter_width")
        )
        _, (invert,) = _function_of(self._graph.nodes[index], kind)
        bump = Bump(function, strength, distance, normal, filter_width, invert)
        if not displaced:
            scope.lines += bump.statements(value)
            return
        layer, normals = (
            self._constants.index((index, f"<{name}>"), Resource("attribute", index, name))
            for name in (UNDISPLACED, SMOOTH_NORMALS)
        )
        self._sources["undisplaced.glsl"] = None
        scope.lines += bump.undisplaced_statements(value, layer, normals)


def _function(result: str, name: str, lines: list[str], value: str) -> str:
    body = "".join(f"    {line}\n" for line in in_pieces(lines))
    return f"{result} {name}(Surface surface, uint first) {{\n{body}    return {value};\n}}\n"


def _function_of(node: ShaderNode, kind: NodeKind) -> tuple[str, list[str]]:
    try:
        return kind.call(node.kind, node.options)
    except ValueError as error:
        raise GraphError(f'node "{node.name}" ({node.kind}) {error}') from error


def compile_graph(
    graph: NodeGraph,
    aovs: Sequence[RenderPass] = (),
    abbe_number: float | None = None,
    on_round_shapes: bool = False,
    corrects_bump: bool = True,
    traces_rays: bool = True,
    space: WorkingSpace = REC709,
) -> CompiledGraph:
    """The GLSL of a graph's structure, and its constants; ``aovs``: the passes of AOV Output nodes that are rendered;
    ``abbe_number``: by which its glass disperses light, None where it does not; ``on_round_shapes``: whether it is on
    strands or points; ``corrects_bump``: as Material has it; ``traces_rays``: whether nodes may, which those of worlds
    and lights do not; ``space``: of its colors.

    Raises GraphError when nodes, options or links are unknown.
    """
    compiler = _Compiler(
        graph,
        aovs,
        abbe_number,
        corrects_bump=corrects_bump,
        on_round_shapes=on_round_shapes,
        traces_rays=traces_rays,
        space=space,
    )
    return compiler.compile()


def compile_displacement(graph: NodeGraph, space: WorkingSpace = REC709) -> CompiledGraph:
    """The GLSL of what moves vertices, ``material_displacement``, and its constants. Raises as compile_graph does."""
    compiler = _Compiler(graph, (), None, corrects_bump=True, on_round_shapes=False, traces_rays=False, space=space)
    return compiler.compile_displacement()
