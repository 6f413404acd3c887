# SPDX-License-Identifier: GPL-3.0-or-later
"""Node graphs to GLSL.

A graph becomes the function ``evaluate_material`` and its constants. Numbers, images, tables and attributes are
constants in a buffer, so graphs that differ in those only have the same text and share a program.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from ...scene.errors import RppmError
from ...scene.meshes import SMOOTH_NORMALS, UNDISPLACED
from ...scene.node_graphs import AovOutput, Link, NodeGraph, ShaderNode
from ...scene.passes import PassKind, RenderPass
from ..dispersion import disperses
from ..nodes import KINDS
from ..nodes.node_kinds import COLOR, FLOAT, SHADER, NodeKind, SocketType
from ..traits.node_rays import RAYCAST
from ..traits.subsurface import has_subsurface
from ..traits.transparency import asks_for_shadow_rays
from .pieces import in_pieces

LUMINANCE = (0.2126391, 0.7151691, 0.0721928)
"""Rec.709: how a color becomes a number, measured in Cycles."""

MIX_SHADER, ADD_SHADER, BUMP = "mix_shader", "add_shader", "bump"
"""Kinds that the compiler itself knows: two share out weights, one evaluates its input three times."""

_IMPLICIT = {
    "normal": "surface.normal",
    "position": "world_position(surface)",
    "tangent": "default_tangent(surface)",
}
"""GLSL expressions for inputs whose default is a name, by that name."""


class GraphError(RppmError):
    """A graph is not what the kinds of its nodes say."""


@dataclass(frozen=True)
class Resource:
    """A constant that is known only when all materials of a scene are laid out."""

    what: str
    """table, image or attribute."""
    node: int
    name: str = ""
    """Name of an attribute that is not the node's own."""


@dataclass(frozen=True)
class NodeRayCounts:
    """Counts of the rays that the nodes of a text ask for."""

    places: int = 0
    """Number of places for what rays find, for each hit."""
    levels: int = 0
    """How many times rays are traced: those of a node may depend on what those of another found."""
    samples: int = 0
    """Rays of a place, at most."""
    casts: bool = False
    """Whether there are rays from any place, as of Raycast nodes."""

    def united(self, other: "NodeRayCounts") -> "NodeRayCounts":
        """Return the counts for graphs that have their text in common."""
        return replace(self, samples=max(self.samples, other.samples))


MOST_NODE_RAYS = 128
"""Samples of a node, as in Blender."""


@dataclass
class CompiledGraph:
    """GLSL for a structure of graphs, and the constants of one graph."""

    text: str
    constants: list[float | Resource] = field(default_factory=list)
    rays: NodeRayCounts = NodeRayCounts()


_DEEPEST_BUMP = 2
"""Each bump whose height depends on the normal of another asks for that three times: 3^2 are enough."""

MOST_CALLS = 8192
"""Nodes that a graph may compute, those of a bump's height as often as they are asked: drivers compile more for many
minutes."""

_LARGEST = float(np.finfo(np.float32).max)

NEUTRAL_TEXT = """void evaluate_material(Surface surface, uint first, inout ClosureBuilder builder) {
    builder.closure.diffuse = vec3(0.8);
}
"""
"""GLSL that stands in for a graph that cannot be compiled: a gray surface."""


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
        on_round_shapes: bool,
        traces_rays: bool,
    ) -> None:
        self._graph = graph
        self._on_round_shapes = on_round_shapes
        self._abbe_number = abbe_number
        self._traces_rays = traces_rays
        self._rays = NodeRayCounts()
        self._aovs = aovs
        self._constants: list[float | Resource] = []
        self._places: dict[tuple[int, str], int] = {}
        self._sources: dict[str, None] = {}
        self._functions: list[str] = []
        self._heights: dict[tuple[int, int], str] = {}
        self._numbers: dict[int, int] = {}
        self._calls = 0

    def compile(self) -> CompiledGraph:
        scope = _Scope(ray_level=self._level_of_normal)
        text = '#include "materials/round_shapes.glsl"\n' if self._on_round_shapes else ""
        if self._abbe_number is not None and disperses(self._graph):
            text += '#include "materials/dispersion.glsl"\n'
            place = self._place((-1, "inverse_abbe_number"), [1.0 / max(self._abbe_number, 1.0)])
            scope.lines.append(f"inverse_abbe_number = constant_float(first + {place}u);")
        if asks_for_shadow_rays(self._graph):
            text += '#include "materials/shadow_rays.glsl"\n'
        if has_subsurface(self._graph):
            text += '#include "materials/subsurface.glsl"\n'
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
        return CompiledGraph(text + aovs, self._constants, self._rays if self._traces_rays else NodeRayCounts())

    def compile_displacement(self) -> CompiledGraph:
        assert self._graph.displacement is not None
        scope = _Scope()
        value = self._converted(scope, self._graph.displacement, SocketType.VECTOR)
        function = _function("vec3", "material_displacement", scope.lines, value)
        return CompiledGraph("".join([*self._includes(), *self._functions, function]), self._constants)

    def _includes(self) -> list[str]:
        rays = ['#include "materials/node_rays.glsl"\n'] if self._rays.places and self._traces_rays else []
        return rays + [f'#include "materials/nodes/{source}"\n' for source in sorted(self._sources)]

    def _aov_function(self) -> str:
        """The function that writes the passes of AOV Output nodes, and what it needs; nothing of a graph that has
        none."""
        stride = sum(len(entry.channels) for entry in self._aovs)
        scope, written, place = _Scope(ray_level=self._level_of_normal), list[str](), 0
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
        return f'#include "surfaces/resolve/aovs.glsl"\nvoid evaluate_aovs(Surface surface, uint first, uint path) {{\n{lines}}}\n'

    def _aov_value(self, scope: _Scope, output: AovOutput, entry: RenderPass) -> str:
        """GLSL for what a node writes: a color, or a value."""
        kind = FLOAT if entry.kind is PassKind.VALUE else COLOR
        value = output.value if kind is FLOAT else output.color
        if isinstance(value, Link):
            return self._converted(scope, value, kind)
        node = ShaderNode("aov_output", output.name)
        place = len(self._constants)
        self._constants.extend(self._constants_of(node, "value" if kind is FLOAT else "color", value, kind))
        return f"constant_float(first + {place}u)" if kind is FLOAT else f"constant_vec3(first + {place}u)"

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
                shares = ((first, f"{weight} * (1.0 - {factor})"), (second, f"{weight} * {factor}"))
            elif node.kind == ADD_SHADER:
                shares = ((first, weight), (second, weight))
            else:
                self._call(scope, index, weight)
                continue
            for shader, share in shares:
                if isinstance(shader, Link):
                    self._check_order(index, shader)
                    self._check_shader(shader)
                    weights.setdefault(shader.node, []).append(share)

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
        place = self._place((index, name), [*self._constants_of(self._graph.nodes[index], name, value, kind)])
        return f"constant_float(first + {place}u)" if kind is FLOAT else f"constant_vec3(first + {place}u)"

    def _constants_of(self, node: ShaderNode, name: str, value: Any, kind: SocketType) -> list[float]:
        try:
            numbers = [_finite(v) for v in np.atleast_1d(value)[:3]]
        except (TypeError, ValueError) as error:
            raise GraphError(f'node "{node.name}" ({node.kind}): its {name} is no number but {value!r}') from error
        if len(numbers) not in (1, 3):
            raise GraphError(f'node "{node.name}" ({node.kind}): its {name} has {len(numbers)} numbers')
        if kind is FLOAT:
            return numbers if len(numbers) == 1 else [_finite(np.dot(LUMINANCE, numbers))]
        return numbers * 3 if len(numbers) == 1 else numbers

    def _place(self, key: tuple[int, str], values: list[float | Resource]) -> int:
        if key not in self._places:
            self._places[key] = len(self._constants)
            self._constants.extend(values)
        return self._places[key]

    def _converted(self, scope: _Scope, link: Link, wanted: SocketType) -> str:
        given = self._kind(link.node).outputs.get(link.output)
        if given is None or given is SHADER or wanted is SHADER:
            node = self._graph.nodes[link.node]
            raise GraphError(f'node "{node.name}" ({node.kind}) gives no value "{link.output}"')
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
        if self._calls > MOST_CALLS:
            raise GraphError(
                f"it has more than {MOST_CALLS} nodes, which drivers compile for many minutes; bake them to a texture, "
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
            place = self._place((index, f"<{what}>"), [Resource(what, index)])
            arguments.append(f"constant_index(first + {place}u)")
        if kind.traces_rays:
            arguments += self._ray_arguments(scope, index)
        for name, (socket, default) in kind.inputs.items():
            arguments.append(self._input(scope, index, name, socket, default))
        values = {
            name: f"n{self._number(index)}_{name}" for name, socket in kind.outputs.items() if socket is not SHADER
        }
        for name, value in values.items():
            scope.lines.append(f"{kind.outputs[name].glsl} {value};")
        scope.lines.append(f"{function}({', '.join([*arguments, *values.values()])});")
        scope.known[index] = values

    @cached_property
    def _ray_depths(self) -> list[int]:
        """By node, how many nodes that trace rays follow one from another up to it."""
        depths: list[int] = []
        for index, node in enumerate(self._graph.nodes):
            links = [link.node for link in node.inputs.values() if isinstance(link, Link)]
            below = max((depths[link] for link in links if 0 <= link < index), default=0)
            depths.append(below + (node.kind in KINDS and KINDS[node.kind].traces_rays))
        return depths

    @property
    def _level_of_normal(self) -> int:
        normal = self._graph.normal
        return 0 if normal is None or not 0 <= normal.node < len(self._ray_depths) else self._ray_depths[normal.node]

    def _ray_arguments(self, scope: _Scope, index: int) -> list[str]:
        """The first place of what a node's rays find, and its level."""
        place, level = self._rays.places, scope.ray_level + self._ray_depths[index] - 1
        node, kind = self._graph.nodes[index], self._kind(index)
        count = 1
        if "samples" in kind.inputs:
            samples = node.inputs.get("samples", kind.inputs["samples"][1])
            count = MOST_NODE_RAYS  # of what other nodes give, no more than the most
            if isinstance(samples, int | float):
                count = int(np.clip(_finite(samples), 1, MOST_NODE_RAYS))
        self._rays = NodeRayCounts(
            place + kind.ray_places,
            max(self._rays.levels, level + 1),
            max(self._rays.samples, count),
            self._rays.casts or node.kind == RAYCAST,
        )
        return [f"{place}u", f"{level}u"]

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
        if level or scope.depth >= _DEEPEST_BUMP:
            scope.lines.append(f"vec3 {value} = {self._input(scope, index, 'normal', *kind.inputs['normal'])};")
            return
        function = f"height_{number}_{scope.depth}"
        if (index, scope.depth) not in self._heights:
            inner = _Scope(scope.depth + 1, scope.ray_level)
            height = self._input(inner, index, "height", *kind.inputs["height"])
            self._functions.append(_function("float", function, inner.lines, height))
            self._heights[index, scope.depth] = function
        strength, distance, normal = (
            self._input(scope, index, name, *kind.inputs[name]) for name in ("strength", "distance", "normal")
        )
        width = self._input(scope, index, "filter_width", *kind.inputs["filter_width"])
        _, (invert,) = _function_of(self._graph.nodes[index], kind)
        there, before, ways, after, along = "surface_beside(surface, way)", [], [], [], "along"
        if displaced:  # as Cycles: where the surface was, in object space
            layer, normals = (
                f"constant_index(first + {self._place((index, f'<{name}>'), [Resource('attribute', index, name)])}u)"
                for name in (UNDISPLACED, SMOOTH_NORMALS)
            )
            self._sources["undisplaced.glsl"] = None
            before = [f"surface.normal = undisplaced_normal(surface, {normals});"]
            ways = [f"  vec3 way_{axis} = undisplaced_way(surface, along_{axis}, {layer});" for axis in "xy"]
            ways += ["  float stretch = undisplaced_stretch(surface, along_x, way_x, way_y);"]
            there, along = f"undisplaced_beside(surface, way, stretch, {layer})", "way"
            normal = f"unit_to_object(surface, {normal})"
            after = [f"{value} = unit_to_world(surface, {value});"]
        scope.lines += [
            *before,
            f"vec3 {value};",
            f"{{ vec3 along_x, along_y, heights = vec3(0.0); bump_offsets(surface, {width}, along_x, along_y);",
            *ways,
            # A loop, so that drivers need not compile the height three times.
            "  for (int k = 0; k < 3; ++k) {",
            "    vec3 way = k == 0 ? vec3(0.0) : k == 1 ? along_x : along_y;",
            f"    float height = {function}({there}, first);",
            "    if (k == 0) heights.x = height; else if (k == 1) heights.y = height; else heights.z = height;",
            "  }",
            f"  node_bump(surface, {invert}, {strength}, {distance}, {normal}, {along}_x, {along}_y,",
            f"            heights.y - heights.x, heights.z - heights.x, {value}); }}",
            *after,
        ]


def _function(result: str, name: str, lines: list[str], value: str) -> str:
    body = "".join(f"    {line}\n" for line in in_pieces(lines))
    return f"{result} {name}(Surface surface, uint first) {{\n{body}    return {value};\n}}\n"


def _finite(value: float) -> float:
    """A number as a float of single precision; 0 where it is not finite."""
    value = float(value)
    return float(np.clip(value, -_LARGEST, _LARGEST)) if np.isfinite(value) else 0.0


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
    traces_rays: bool = True,
) -> CompiledGraph:
    """The GLSL of a graph's structure, and its constants; ``aovs``: the passes of AOV Output nodes that are rendered;
    ``abbe_number``: by which its glass disperses light, None where it does not; ``on_round_shapes``: whether it is on
    strands or points; ``traces_rays``: whether nodes may, which those of worlds and lights do not.

    Raises GraphError when nodes, options or links are unknown.
    """
    return _Compiler(graph, aovs, abbe_number, on_round_shapes=on_round_shapes, traces_rays=traces_rays).compile()


def compile_displacement(graph: NodeGraph) -> CompiledGraph:
    """The GLSL of what moves vertices, ``material_displacement``, and its constants. Raises as compile_graph does."""
    return _Compiler(graph, (), None, on_round_shapes=False, traces_rays=False).compile_displacement()
