# SPDX-License-Identifier: GPL-3.0-or-later
"""Node trees to node graphs."""

import re
from collections.abc import Callable

import bpy
import numpy as np

from .....materials.nodes import KINDS
from .....materials.nodes.node_kinds import SHADER, VECTOR, NodeKind
from .....scene import Link, NodeGraph
from .....scene.sky import Sky
from ...context import ExportContext
from ...geometry.meshes.attributes import GENERATED
from .inlining import ReadableTree
from .links import LinkTable, Path, Source, Unlinked, find_source
from .texture_mapping import mapped

Handler = Callable[["GraphExporter", bpy.types.Node, bpy.types.NodeSocket, Path], object]
"""Gives the value of an output: a Link, a number or a color."""

HANDLERS: dict[str, Handler] = {}
"""By node type, the nodes that are more than their sockets and options."""


def handles(*types: str) -> Callable[[Handler], Handler]:
    """Register a handler for node types."""

    def keep(handler: Handler) -> Handler:
        HANDLERS.update(dict.fromkeys(types, handler))
        return handler

    return keep


def snake_case(identifier: str) -> str:
    """Blender's socket identifier as inputs and outputs of node kinds are named."""
    return identifier.lower().replace(" ", "_")


def kind_name(node: bpy.types.Node) -> str:
    """The kind of a Blender node: "ShaderNodeTexNoise" is tex_noise."""
    name = node.bl_idname.removeprefix("ShaderNode")
    if name in _IRREGULAR:
        return _IRREGULAR[name]
    return "".join(f"_{c.lower()}" if c.isupper() and i and not name[i - 1].isupper() else c.lower()
                   for i, c in enumerate(name))  # fmt: skip


_DEEPEST = 40
"""Nodes that are followed one from another before the rest is put off: Python's stack holds some hundred of them."""


class _TooDeep(Exception):
    """An output that has to be known before anything else is."""

    def __init__(self, source: Source) -> None:
        super().__init__(source.node.name)
        self.source = source


class GraphExporter:
    """Builds the graph of one material, world or light.

    What cannot be rendered gets a neutral value and a warning that names the node.
    """

    def __init__(
        self,
        owner: str,
        context: ExportContext,
        tree: ReadableTree | None = None,
        pass_index: int = 0,
        *,
        is_volume: bool = False,
    ) -> None:
        """owner: what warnings name, such as 'Material "Glass"'; tree: of the nodes, None if the user's nodes are read
        one by one; pass_index: the material's; is_volume: whether the graph is that of a volume."""
        self.graph = NodeGraph()
        self.owner = owner
        self._tree = tree
        self.context = context
        self.images = context.images
        self.pass_index = pass_index
        self.skies: dict[int, Sky] = {}
        """Sky textures by the index of their node."""
        self.is_volume = is_volume
        self.is_world = owner.startswith("World") and not is_volume
        self._links = LinkTable()
        self._known: dict[tuple, object] = {}
        self._open: set[tuple] = set()
        self._waiting: set[tuple] = set()

    def warn(self, node: bpy.types.Node, text: str) -> None:
        """Tell the user what is done about a node."""
        seen = self.user_node(node)
        # A node that has its type's name is not described twice.
        kind = "" if re.sub(r"\.\d+$", "", seen.name) == seen.bl_label else f" ({seen.bl_label})"
        self.context.report.warn(f'{self.owner}: node "{seen.name}"{kind} {text}')

    def user_node(self, node: bpy.types.Node) -> bpy.types.Node:
        """The node that the user sees, where Blender made the one that is read."""
        return node if self._tree is None else self._tree.user_node(node)

    def name_of(self, node: bpy.types.Node) -> str:
        """The name by which the user knows a node."""
        return self.user_node(node).name

    def surface(self) -> Link | None:
        """The shader of the tree's output; groups that are lost are named even where Blender cut their links."""
        for node in self._tree.lost_groups:
            self.warn(node, _LOST if self._tree.owner is None else _CUT_OFF)
        return self.shader(self._tree.output.inputs["Surface"])

    def _source(self, socket: bpy.types.NodeSocket, path: Path) -> Source | Unlinked:
        """The output that feeds an input, or the socket whose own value counts."""
        return find_source(socket, path, self._links)

    def shader(self, socket: bpy.types.NodeSocket, path: Path = ()) -> Link | None:
        """The shader that feeds an input; a color in place of it glows, as in Cycles."""
        source = self._source(socket, path)
        if not isinstance(source, Source):
            if source.broken is not None:
                self.warn(source.broken, _LOST)
                return self.graph.add("bsdf_diffuse", "bsdf", name=source.broken.name, color=0.8)
            return None
        value = self._output(source)
        if value is None and _is_undefined(source.node):
            return self.graph.add("bsdf_diffuse", "bsdf", name=self.name_of(source.node), color=0.8)
        if isinstance(value, Link) and KINDS[self.graph.nodes[value.node].kind].outputs[value.output] is SHADER:
            return value
        return (
            None
            if value is None
            else self.graph.add("emission", "emission", name=self.name_of(source.node), color=value)
        )

    def value(self, socket: bpy.types.NodeSocket, path: Path) -> object:
        """Return the value of an input of a node: a Link, a number, or a tuple of three."""
        source = self._source(socket, path)
        if not isinstance(source, Source):
            if source.broken is not None:
                self.warn(source.broken, _LOST)
            return self.stored(source.socket)
        value = self._output(source)
        # What the user had chosen before plugging something in is the best guess for the unknown.
        return self.stored(socket) if value is None else value

    def stored(self, socket: bpy.types.NodeSocket) -> object:
        """The value in a socket: a number or a tuple of three; what is not finite counts as 0."""
        stored = getattr(socket, "default_value", 0.0)
        if isinstance(stored, str) or stored is None:
            return 0.0
        several = hasattr(stored, "__len__")
        values = [float(v) for v in stored[:3]] if several else [float(stored)]
        if not np.isfinite(values).all():
            self.warn(socket.node, f'has a value in "{socket.name}" that is not finite; 0 is used')
            values = [v if np.isfinite(v) else 0.0 for v in values]
        return (*values, 0.0, 0.0)[:3] if several else values[0]

    def text(self, socket: bpy.types.NodeSocket, path: Path) -> str:
        """The text in an input; empty where a node gives it."""
        source = self._source(socket, path)
        return "" if isinstance(source, Source) else str(getattr(source.socket, "default_value", ""))

    def is_linked(self, socket: bpy.types.NodeSocket, path: Path) -> bool:
        """Whether a node's output feeds an input."""
        return isinstance(self._source(socket, path), Source)

    def is_given(self, socket: bpy.types.NodeSocket, path: Path, shown: bool = False) -> bool:
        """Whether an input gets another value than without links: from a node's output, or from a socket of a group
        (as in Cycles, normals only from one that shows its value)."""
        source = self._source(socket, path)
        return isinstance(source, Source) or (source.socket != socket and not (shown and source.socket.hide_value))

    def _output(self, source: Source) -> object:
        """The value of an output, None when nothing is known."""
        if self._open:
            return self._found(source)
        pending = [source]
        try:
            while True:
                try:
                    value = self._found(pending[-1])
                except _TooDeep as deeper:
                    self._waiting.add(_output_key(pending[-1]))
                    pending.append(deeper.source)
                    continue
                pending.pop()
                if not pending:
                    return value
                self._waiting.discard(_output_key(pending[-1]))
        finally:
            self._waiting.clear()

    def _found(self, source: Source) -> object:
        node = source.node
        output_key = _output_key(source)
        if output_key in self._known:
            return self._known[output_key]
        if output_key in self._open or output_key in self._waiting:
            self.warn(node, "is linked to itself through other nodes; the link is left out")
            return None
        if len(self._open) >= _DEEPEST:
            raise _TooDeep(source)
        self._open.add(output_key)
        try:
            value = self._make(node, source.output, source.path)
        except _UNREADABLE as error:
            self.warn(node, f"cannot be read ({error}); the value of the socket it feeds is used")
            value = None
        finally:
            self._open.discard(output_key)
        self._known[output_key] = value
        return value

    def _make(self, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> object:
        handler = HANDLERS.get(node.type)
        if handler is not None:
            return handler(self, node, output, path)
        kind = kind_name(node)
        if kind not in KINDS:
            return self._fallback(node, output, path)
        name = snake_case(output.identifier)
        if name not in KINDS[kind].outputs:
            name = _OLDER.get(name, name)
        if name not in KINDS[kind].outputs:
            self.warn(node, f'has an output "{output.name}" that is not rendered; 0 is used')
            return 0.0
        return self.add(kind, node, path, name)

    def add(self, kind: str, node: bpy.types.Node, path: Path, output: str = "", **members: object) -> Link:
        """A node of a kind with the inputs and options that the Blender node has by the kind's names; one serves all
        of the outputs."""
        key = (kind, *node_key(node, path))
        if key not in self._known:
            self._known[key] = self.append(kind, node, path, output, **members).node
        return Link(self._known[key], output)

    def append(self, kind: str, node: bpy.types.Node, path: Path, output: str = "", **members: object) -> Link:
        """As ``add``, but one more node at each call."""
        declared = KINDS[kind]
        inputs = self._inputs(declared, node, path) | members.pop("inputs", {})
        options = self._options(declared, node) | members.pop("options", {})
        if fallback := declared.fallback(options):
            self.warn(node, f"is not rendered as such; {fallback} stands in")
        return self.graph.add(kind, output, name=self.name_of(node), options=options, **members, **inputs)

    def _inputs(self, kind: NodeKind, node: bpy.types.Node, path: Path) -> dict[str, object]:
        sockets = {snake_case(socket.identifier): socket for socket in node.inputs}
        if kind.is_shader and kind in (KINDS["mix_shader"], KINDS["add_shader"]):
            shaders = {name: self.shader(sockets[name], path) for name in ("shader", "shader_001")}
            factor = {"fac": self.value(sockets["fac"], path)} if "fac" in sockets else {}
            return factor | {name: shader for name, shader in shaders.items() if shader is not None}
        inputs: dict[str, object] = {}
        for name, (socket_type, default) in kind.inputs.items():
            socket = sockets.get(name) or sockets.get(_OLDER.get(name, ""))
            if socket is None:
                if name in _own_properties(node):
                    inputs[name] = float(getattr(node, name))
                continue  # or another version of Blender
            given = self.is_given(socket, path, shown=isinstance(default, str))
            if not given and isinstance(default, str):
                continue  # the surface's own
            if not given and socket_type is VECTOR and socket.hide_value and _is_placed(node):
                inputs[name] = self._mapped(node, self.implicit_coordinates(node))
                continue
            inputs[name] = self.value(socket, path)
            if name == "vector":
                inputs[name] = self._mapped(node, inputs[name])
        return inputs

    def _options(self, kind: NodeKind, node: bpy.types.Node) -> dict[str, object]:
        options: dict[str, object] = {}
        for name, values in kind.options.items():
            value = getattr(node, name, values[0])
            if value == "":  # a choice of a newer version of Blender, which shows it as none
                value = values[0]
            if value not in values:
                declared = node.bl_rna.properties[name]
                names = {item.identifier: item.name for item in getattr(declared, "enum_items", ())}
                called, used = (names.get(item, item) for item in (value, values[0]))
                self.warn(node, f"has the {declared.name} {called}, which is not rendered; {used} is used")
                value = values[0]
            options[name] = value
        return options

    def coordinates_of(self, node: bpy.types.Node, path: Path) -> object:
        """Return where a texture node looks itself up: the value of its Vector input, through its texture mapping."""
        socket = self.given_coordinates(node, path)
        vector = self.implicit_coordinates(node) if socket is None else self.value(socket, path)
        return self._mapped(node, vector)

    def _mapped(self, node: bpy.types.Node, vector: object) -> object:
        return mapped(self.graph, self.name_of(node), node, vector)

    def given_coordinates(self, node: bpy.types.Node, path: Path) -> bpy.types.NodeSocket | None:
        """The Vector input of a texture node, where something else than the implicit coordinates is given to it."""
        socket = next((socket for socket in node.inputs if socket.identifier == "Vector"), None)
        return None if socket is None or not self.is_given(socket, path) else socket

    def implicit_coordinates(self, node: bpy.types.Node) -> Link:
        """Where a texture is placed without a link."""
        if node.type == "TEX_IMAGE":
            return self.shared("tex_coord", "uv")
        if node.type in {"TEX_ENVIRONMENT", "TEX_SKY"} and self.is_world:
            return self.shared("new_geometry", "position")
        return self.shared("generated_coord", "generated", GENERATED)

    def shared(self, kind: str, output: str, attribute: str = "", name: str = "") -> Link:
        """An output of a node without inputs, of which the graph has one; ``name``: of the Blender node, for
        messages."""
        key = (kind, attribute)
        if key not in self._known:
            self._known[key] = self.graph.add(kind, name=name, attribute=attribute).node
        return Link(self._known[key], output)

    def _fallback(self, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> object:
        """The stand-in for a node that is not rendered: a diffuse surface of its color, or nothing, as in Cycles."""
        if output.type != "SHADER":
            self.warn(node, "is not rendered yet; the value of the socket it feeds is used")
            return None
        if node.type == "EEVEE_SPECULAR":
            self.warn(node, "is for EEVEE alone and black, as in Cycles; use a Principled BSDF")
            return self.graph.add("bsdf_diffuse", "bsdf", name=self.name_of(node), color=0.0)
        self.warn(node, "is not rendered yet; a diffuse surface of its color stands in")
        socket = node.inputs.get("Color")
        color = 0.8 if socket is None else self.value(socket, path)
        return self.graph.add("bsdf_diffuse", "bsdf", name=self.name_of(node), color=color)


_LOST = "is a group whose node tree is missing; a neutral value or a gray surface stands in"
_CUT_OFF = "is a group whose node tree is missing; its links are left out"


def _is_undefined(node: bpy.types.Node) -> bool:
    """Whether this Blender does not know the type of a node, which another version or an add-on made."""
    return not node.bl_idname.startswith("ShaderNode")


def node_key(node: bpy.types.Node, path: Path) -> tuple[int, ...]:
    """Return a key that tells a node in its groups from all others."""
    return (node.as_pointer(), *(group.as_pointer() for group in path))


def _output_key(source: Source) -> tuple:
    return (*node_key(source.node, source.path), source.output.identifier)


_UNREADABLE = (AttributeError, IndexError, KeyError, RuntimeError, TypeError, ValueError)
"""Errors raised by reading a node that is broken or of another version of Blender."""

_IRREGULAR = {"CameraData": "camera", "RGBToBW": "rgb_to_bw", "RGBCurve": "rgb_curve", "BsdfAnisotropic": "bsdf_glossy"}


def _own_properties(node: bpy.types.Node) -> set[str]:
    """Numbers that a node has and nodes in general have not, such as a brick texture's offset."""
    own = set(node.bl_rna.properties.keys()) - set(bpy.types.ShaderNode.bl_rna.properties.keys())
    return {name for name in own if node.bl_rna.properties[name].type in {"INT", "FLOAT"}}


def _is_placed(node: bpy.types.Node) -> bool:
    """Whether coordinates stand in for a vector that is not linked: Cycles gives white noise zero."""
    return node.type.startswith("TEX_") and node.type != "TEX_WHITE_NOISE"


_OLDER = {"factor": "fac", "fac": "factor"}
"""Identifiers that differ between versions of Blender."""
