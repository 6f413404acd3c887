# SPDX-License-Identifier: GPL-3.0-or-later
"""What a kind of node is: its sockets, its options, and the GLSL function that computes it."""

import enum
from dataclasses import dataclass, field


class SocketType(enum.Enum):
    """Types of sockets; the values are those of GLSL, a SHADER has none."""

    FLOAT = "float"
    COLOR = "color"
    VECTOR = "vector"
    SHADER = "shader"

    @property
    def glsl(self) -> str:
        return "float" if self is SocketType.FLOAT else "vec3"


FLOAT, COLOR, VECTOR, SHADER = SocketType
BOOLEAN = (False, True)


@dataclass(frozen=True)
class NodeKind:
    """A kind of node, computed by the GLSL function ``node_<name>`` of shaders/materials/nodes/<source>.

    The function takes, in this order: ``Surface surface`` if ``surface`` says so; of shader nodes ``inout
    ClosureBuilder builder, float weight``; an int for each option, the place of its value in the option's tuple
    (always a literal, so that the compiler folds it); a uint for each resource; the inputs; ``out`` the outputs.

    Inputs are named as the identifiers of Blender's sockets, options as the properties of its nodes and their
    values as its enumerations, in lower case with underscores for blanks where Blender has capitals and blanks.
    """

    source: str
    inputs: dict[str, tuple[SocketType, object]] = field(default_factory=dict)
    """Type and default value by name; the value is a float or three."""
    outputs: dict[str, SocketType] = field(default_factory=dict)
    options: dict[str, tuple] = field(default_factory=dict)
    """Values that each option can take: they select code."""
    resources: tuple[str, ...] = ()
    """"table": where the node's table starts in material_data; "image": the number of its image."""
    surface: bool = False

    @property
    def is_shader(self) -> bool:
        return SHADER in self.outputs.values()
