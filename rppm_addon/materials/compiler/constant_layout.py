# SPDX-License-Identifier: GPL-3.0-or-later
"""ConstantLayout: the constants of all graphs of a scene in one buffer."""

import numpy as np

from ...scene.images import Image
from ...scene.node_graphs import NodeGraph
from ..images import MISSING
from .compiled_graph import CompiledGraph, Resource


class ConstantLayout:
    """Constants of all materials one after the other, and then their tables."""

    def __init__(self, images: list[Image]) -> None:
        self._images = images
        self._numbers: list[float] = []
        self._tables: list[np.ndarray] = []
        self._pending: list[tuple[int, int]] = []
        """Places of the starts of tables."""
        self._used: dict[int, int] = {}
        self.attributes: dict[str, int] = {}

    def add(self, graph: NodeGraph, compiled: CompiledGraph) -> int:
        """Take the constants of a graph; returns where they start."""
        first = len(self._numbers)
        for constant in compiled.constants:
            self._numbers.append(self._number(graph, constant) if isinstance(constant, Resource) else constant)
        return first

    def _number(self, graph: NodeGraph, resource: Resource) -> float:
        node = graph.nodes[resource.node]
        if resource.what == "image":
            return float(self._image(node.image))
        if resource.what == "attribute":
            return float(self.attributes.setdefault(resource.name or node.attribute, len(self.attributes)))
        table = np.zeros(4, np.float32) if node.table is None else np.asarray(node.table, np.float32)
        if node.kind == "tex_image_tiles":
            table = np.array([-1.0 if image < 0 else self._image(int(image)) for image in table.ravel()], np.float32)
        self._pending.append((len(self._numbers), len(self._tables)))
        self._tables.append(table.ravel())
        return 0.0

    def _image(self, image: int) -> int:
        return self._used.setdefault(image if 0 <= image < len(self._images) else -1, len(self._used))

    def data(self) -> np.ndarray:
        """(n,) float32 of constants and tables."""
        starts = len(self._numbers) + np.concatenate([[0], np.cumsum([len(table) for table in self._tables])])
        for place, table in self._pending:
            self._numbers[place] = float(starts[table])
        return np.concatenate([np.array(self._numbers or [0.0], np.float32), *self._tables]).astype(np.float32)

    def images(self) -> list[Image]:
        """The images in use, at least one; one that is missing is magenta."""
        return [MISSING if index < 0 else self._images[index] for index in self._used] or [MISSING]
