# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials: a node graph for the surface, and the interior."""

from dataclasses import dataclass, field

import numpy as np

from .node_graphs import NodeGraph


@dataclass
class Material:
    """A surface, and the homogeneous absorption of what it encloses."""

    name: str
    graph: NodeGraph = field(default_factory=NodeGraph)
    absorption: np.ndarray = field(default_factory=lambda: np.zeros(3))
    """(3,) float64, absorption coefficient of the interior in 1/m (Volume Absorption:
    density times one minus colour)."""
