# SPDX-License-Identifier: GPL-3.0-or-later
"""Constants of a node graph: unlinked inputs, and resources such as images, by their places in a buffer."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...scene.node_graphs import ShaderNode
from ..nodes.node_kinds import FLOAT, SocketType
from .compiled_graph import GraphError, Resource

LUMINANCE = (0.2126391, 0.7151691, 0.0721928)
"""Rec.709: how a color becomes a number, measured in Cycles."""

_LARGEST = float(np.finfo(np.float32).max)


class GraphConstants:
    """Constants in the order in which the GLSL first reads them."""

    def __init__(self) -> None:
        self.values: list[float | Resource] = []
        self._places: dict[tuple[int, str], int] = {}

    def place(self, key: tuple[int, str], values: Sequence[float | Resource]) -> int:
        """Return the place of the first of the constants of a key, (node, name), which are added where they are new."""
        if key not in self._places:
            self._places[key] = self.append(values)
        return self._places[key]

    def append(self, values: Sequence[float | Resource]) -> int:
        """Add constants, and return the place of the first."""
        place = len(self.values)
        self.values.extend(values)
        return place

    def index(self, key: tuple[int, str], resource: Resource) -> str:
        """Return GLSL, a uint, for where a resource is."""
        return f"constant_index(first + {self.place(key, [resource])}u)"


def read_constant(place: int, kind: SocketType) -> str:
    """Return GLSL for the value of a socket whose constants begin at a place."""
    return f"constant_float(first + {place}u)" if kind is FLOAT else f"constant_vec3(first + {place}u)"


def socket_constants(
    node: ShaderNode, name: str, value: Any, kind: SocketType, luminance: Sequence[float] = LUMINANCE
) -> list[float]:
    """Return the constants of an unlinked socket: one for a FLOAT, else three. luminance: weights of a color's.

    Raises GraphError for a value that is neither one number nor three.
    """
    try:
        numbers = [finite(v) for v in np.atleast_1d(value)[:3]]
    except (TypeError, ValueError) as error:
        raise GraphError(f'node "{node.name}" ({node.kind}): its {name} is no number but {value!r}') from error
    if len(numbers) not in (1, 3):
        raise GraphError(f'node "{node.name}" ({node.kind}): its {name} has {len(numbers)} numbers')
    if kind is FLOAT:
        return numbers if len(numbers) == 1 else [finite(np.dot(luminance, numbers))]
    return numbers * 3 if len(numbers) == 1 else numbers


def finite(value: float) -> float:
    """Return a number as a float of single precision; 0 where it is not finite."""
    value = float(value)
    return float(np.clip(value, -_LARGEST, _LARGEST)) if np.isfinite(value) else 0.0
