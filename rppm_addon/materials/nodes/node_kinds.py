# SPDX-License-Identifier: GPL-3.0-or-later
"""Kinds of nodes: their sockets, their options, and the GLSL functions that compute them."""

import enum
from dataclasses import dataclass, field
from typing import Any


class SocketType(enum.Enum):
    """Types of sockets; the values are those of GLSL, a SHADER has none."""

    FLOAT = "float"
    COLOR = "color"
    VECTOR = "vector"
    SHADER = "shader"

    @property
    def glsl(self) -> str:
        """The name of the type."""
        return "float" if self is SocketType.FLOAT else "vec3"


FLOAT, COLOR, VECTOR, SHADER = SocketType
BOOLEAN = (False, True)


@dataclass(frozen=True)
class NodeKind:
    """A kind of node, computed by the GLSL function ``node_<name>`` of shaders/materials/nodes/<source>.

    The function takes, in this order: ``Surface surface`` if ``surface`` says so; of shader nodes ``inout
    ClosureBuilder builder, float weight``; an int for each option, the place of its value in the option's tuple
    (always a literal, so that the compiler folds it); a uint for each resource; of nodes that trace rays a uint for the
    index of their first NODE_RAY and one for its level; the inputs; ``out`` the outputs.

    Inputs and outputs are named as the identifiers of Blender's sockets, in lower case with underscores for blanks;
    options as the properties of its nodes, with Blender's own values.
    """

    source: str
    inputs: dict[str, tuple[SocketType, Any]] = field(default_factory=dict)
    """Type and default value by name: a float, three, or "normal", "tangent" or "position" of the surface."""
    outputs: dict[str, SocketType] = field(default_factory=dict)
    options: dict[str, tuple] = field(default_factory=dict)
    """Values that each option can take: they select code."""
    resources: tuple[str, ...] = ()
    """Resources that the node needs besides: "table", where its table starts in material_data; "image", the number of
    its image; "attribute", the number of its mesh attribute."""
    surface: bool = False
    ray_places: int = 0
    """Number of NODE_RAY records for the node's queries and their results. The rays are traced before the node's value
    is computed (shaders/materials/node_rays.glsl). An input "samples" says how many rays; without it, it is
    one."""
    fallbacks: dict[str, str] = field(default_factory=dict)
    """Replacement that is rendered in place of the node, by the value that an option has, or "" for any: users are
    warned."""
    function_option: str = ""
    """An option with a GLSL function for each of its values, ``node_<name>_<value in lower case>``. The option is no
    argument then: drivers take long to fold a choice among many at every call."""

    @property
    def traces_rays(self) -> bool:
        """Whether the node requests rays."""
        return self.ray_places > 0

    def call(self, name: str, options: dict[str, Any]) -> tuple[str, list[str]]:
        """The GLSL function of a node of this kind, which has a name, and its literals for options.

        Options that are left out have their first value. Raises ValueError, with the option's name, for unknown values.
        """
        function, literals = f"node_{name}", []
        for option, values in self.options.items():
            value = options.get(option, values[0])
            if value not in values:
                raise ValueError(f"has the unknown {option} {value}")
            if option == self.function_option:
                function += f"_{value.lower()}"
            else:
                literals.append(str(values.index(value)))
        return function, literals

    def fallback(self, options: dict[str, Any]) -> str:
        """Return what is rendered in place of a node with these options; "" where it is rendered as what it is."""
        values = ("", *(options.get(name, values[0]) for name, values in self.options.items()))
        return next((self.fallbacks[value] for value in values if value in self.fallbacks), "")

    @property
    def is_shader(self) -> bool:
        """Whether the node adds to the closure."""
        return SHADER in self.outputs.values()
