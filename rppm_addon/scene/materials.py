# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials: a node graph for the surface, and the interior."""

from dataclasses import dataclass, field

from .common.declared import declared
from .node_graphs import NodeGraph


@dataclass
class Material:
    """A surface, and the participating medium that it encloses."""

    name: str
    graph: NodeGraph = field(default_factory=NodeGraph)
    interior: NodeGraph | None = None
    """Nodes of the medium that the surface encloses (rppm_addon/materials/nodes/volumes.py): what it absorbs and
    scatters, 1/m, and the radiance that it emits by length, W/(m^3 sr)."""
    transparent_shadow: bool = True
    """Whether light of light objects and meshes passes where the surface is transparent; the world's always does."""
    pass_index: int = 0
    """Value in the pass Material Index."""
    abbe_number: float | None = field(default=None, metadata=declared(minimum=1.0))
    """V_d of what refracts light: by it the index depends on the wavelength, and that of the nodes is n_d. None: all
    wavelengths have the same."""
    corrects_bump: bool = True
    """True where normals that mirror the viewer's direction to below the surface are bent, and slopes of bumps shadow
    diffuse light."""
    on_round_shapes: bool = False
    """Whether it is on strands or points (MeshShape), and not on surfaces alone."""
    reads_grids: bool = False
    """Whether it is on volumes (Mesh.volume), whose grids the nodes of the interior read."""
