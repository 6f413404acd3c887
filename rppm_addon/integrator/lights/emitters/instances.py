# SPDX-License-Identifier: GPL-3.0-or-later
"""Emissive instances that rays place in the world: the emitters of a mesh, once, and a light tree over these.

A leaf of the light tree may be an instance. Below it goes on the tree of its mesh, whose nodes the walk places in the
world (shaders/lights/two_levels/tree.glsl).
"""

import numpy as np

from ....gl.buffer_sets import BufferSet, StorageBuffer
from ....gl.buffers.constants import Constants
from ....gl.buffers.records import Record
from ....gl.context.context import Context
from ....gl.programs.programs import ProgramLibrary
from ...acceleration.instances import HitPaths, InstancedMeshes
from ...surfaces.gather_inputs import part_starts
from ...surfaces.placements import FARTHEST
from ..light_records import LIGHT_NODE
from ..light_tree import widened
from .meshes import FoundEmitters, MeshEmitters

INSTANCE_MEMBER = 1 << 31
"""In the members of leaves of the light tree: the rest is the number of an instance."""
Constants("EmitterInstances", INSTANCE_MEMBER=INSTANCE_MEMBER)
EMITTER_LEVELS = Record(
    "EmitterLevels", instance_count="uint", first_hit_triangle="uint", first_light_hit="uint", first_photon_hit="uint"
)
"""Number of all instances; the first hit triangle; where the hit triangles of sampled lights and of photons begin,
counted from that."""
EMITTER_INSTANCE = Record(
    "EmitterInstance",
    row0="vec4",
    row1="vec4",
    row2="vec4",
    pivot="vec3",
    first_triangle="uint",
    tree="uint",
    leaves="uint",
    first_emitter="uint",
    emitter_count="uint",
    leaf="uint",
    mirrored="uint",
    set_code="float",
    stretch="float",
    probability="float",
    cumulated="float",
    traits="uint",
)
"""An instance of BottomLevelInstances, which has the same number: ``row``, ``pivot``, ``first_triangle``, ``mirrored``
and ``set_code`` are as there. ``tree``, ``leaves``: where the nodes of its mesh's light tree begin, and how many leaves
this has, 0 where the instance emits nothing. ``first_emitter``, ``emitter_count``: emissive triangles of its mesh, one
for each triangle. ``leaf``: its own leaf of the light tree; ``stretch``: the square of the condition number of its
matrix; ``probability``, ``cumulated``: EmissiveTriangle's; ``traits``: those of all of its triangles, and its
LightLink, as in EmissiveTriangle."""

INSTANCED_EMITTERS = {"EMITTERS": "lights/two_levels"}
"""Defines of programs for scenes with emissive instances that rays place in the world."""
_ROUNDING = 1e-5


class EmitterInstances(BufferSet):
    """The emissive instances of a scene that rays place in the world.

    ``leaves`` are their LIGHT_NODE records in the world; ``weights`` (n,) is what each emits, in proportion, and
    ``power`` (3,) what all do, W; ``links`` (n,) are the numbers of their LightLinks.
    """

    remedy = "let fewer instances emit light"
    _instances = StorageBuffer(
        "emitter instances", EMITTER_INSTANCE, header=EMITTER_LEVELS, texel_bytes=16, block="EmitterInstances"
    )

    def __init__(self, context: Context, library: ProgramLibrary, sizes: object = None) -> None:
        super().__init__(context, library, sizes)
        self.meshes: list[MeshEmitters] = []
        """The emitters of meshes that are in use."""
        self.leaves = LIGHT_NODE.zeros(0)
        self.weights, self.power = np.zeros(0), np.zeros(3)
        self.links = np.zeros(0, np.int64)
        self._numbers = np.zeros(0, np.int64)
        """(n,) the instances that emit, by their numbers among those that rays place."""
        self._which = np.zeros(0, np.int64)
        """(n,) their emitters, by the place in ``meshes``."""
        self._records = EMITTER_INSTANCE.zeros(0)

    @property
    def are_there(self) -> bool:
        """True where the scene has emissive instances that rays place in the world: programs have other defines."""
        return len(self._numbers) > 0

    def place(self, instanced: InstancedMeshes | None, found: FoundEmitters) -> None:
        """Take the instances that rays place in the world."""
        which = found.which
        if instanced is not None and len(which):
            with np.errstate(invalid="ignore"):  # triangles that lie nowhere, or too far off, are gathered as points
                which = np.where((np.abs(instanced.boxes) < FARTHEST).all(axis=(1, 2)), which, -1)
        self._numbers = np.flatnonzero(which >= 0)
        self._which = which[self._numbers]
        self.meshes, self.power = found.meshes, np.zeros(3)
        self.links = found.links[self._numbers]
        self.leaves, self.weights = LIGHT_NODE.zeros(len(self._numbers)), np.zeros(len(self._numbers))
        self._records = EMITTER_INSTANCE.zeros(0)
        if instanced is None or not self.are_there:
            self._instances.release()
            return
        self._records = records = EMITTER_INSTANCE.zeros(len(which))
        for name in ("row0", "row1", "row2", "pivot", "set_code"):
            records[name] = instanced.entries[name]
        records["first_triangle"] = instanced.mesh_first_triangles[instanced.which]
        records["mirrored"], records["traits"] = instanced.are_mirrored, found.traits
        for number, mesh in enumerate(found.meshes):
            is_of_mesh = self._which == number
            of_mesh = self._numbers[is_of_mesh]
            records["leaves"][of_mesh], records["emitter_count"][of_mesh] = len(mesh.nodes) // 2, len(mesh.records)
            placed, scales, records["stretch"][of_mesh] = placed_roots(mesh, instanced.matrices[of_mesh])
            placed["member"] = INSTANCE_MEMBER | of_mesh
            scales *= found.strengths[of_mesh]
            weights = mesh.nodes["intensity"][1] * scales
            placed["intensity"] = weights
            self.leaves[is_of_mesh], self.weights[is_of_mesh] = placed, weights
            self.power = self.power + mesh.power * scales.sum()

    def choose(self, leaves: np.ndarray, probabilities: np.ndarray, cumulated: float, first_emitter: int) -> None:
        """Take the leaf of each emissive instance, (n,) node numbers, and the probability of choosing it; cumulated:
        that of choosing anything else; first_emitter: where the emitters of meshes begin."""
        self._records["leaf"][self._numbers] = leaves
        self._records["probability"][self._numbers] = probabilities
        self._records["cumulated"] = cumulated + np.cumsum(self._records["probability"].astype(np.float64))
        counts = [len(mesh.records) for mesh in self.meshes]
        self._records["first_emitter"][self._numbers] = first_emitter + part_starts(counts)[self._which]

    def upload(self, instanced: InstancedMeshes | None, first_node: int) -> None:
        """Write the instances; first_node: where the light trees of the meshes begin, one behind the other."""
        if instanced is None or not self.are_there:
            return
        counts = [len(mesh.nodes) for mesh in self.meshes]
        self._records["tree"][self._numbers] = first_node + part_starts(counts)[self._which]
        levels = EMITTER_LEVELS.zeros(1)
        levels["instance_count"], levels["first_hit_triangle"] = len(self._records), instanced.hits.first_triangle
        levels["first_light_hit"] = instanced.hits.of_paths[HitPaths.LIGHT]
        levels["first_photon_hit"] = instanced.hits.of_paths[HitPaths.PHOTON]
        self._instances.require_items(len(self._records))
        self._instances.write(levels)
        self._instances.write(self._records, EMITTER_LEVELS.size)
        self._records = EMITTER_INSTANCE.zeros(0)  # the device has them


def placed_roots(mesh: MeshEmitters, matrices: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return (n,) LIGHT_NODE records that hold a mesh's emitters placed by matrices (n, 4, 4), by how much their areas
    grow, (n,), and the squares of the condition numbers, (n,).

    Areas grow by direction where a matrix is no similarity: the scale is the root mean square over the power.
    """
    root = mesh.nodes[1]
    linear = matrices[:, :3, :3]
    # (n, 3, 3), by which normals are multiplied.
    cofactors = np.stack([np.cross(linear[:, :, (k + 1) % 3], linear[:, :, (k + 2) % 3]) for k in range(3)], axis=2)
    scales = np.sqrt(np.maximum(np.einsum("nij,jk,nik->n", cofactors, mesh.normals, cofactors), 1e-300))
    placed = LIGHT_NODE.zeros(len(matrices))
    low, high = root["low"].astype(np.float64), root["high"].astype(np.float64)
    centers = np.einsum("nij,j->ni", linear, 0.5 * (low + high)) + matrices[:, :3, 3]
    reach = np.einsum("nij,j->ni", np.abs(linear), 0.5 * (high - low))
    placed["low"], placed["high"] = widened(centers - reach, centers + reach)
    axes = np.einsum("nij,j->ni", cofactors, root["axis"].astype(np.float64))
    placed["axis"] = axes / np.maximum(np.linalg.norm(axes, axis=1, keepdims=True), 1e-300)
    stretches = _squared_condition_numbers(linear)
    cosine = float(root["cosine_normals"])
    wider = stretches * (1.0 - cosine)
    placed["cosine_normals"] = (1.0 + cosine - wider) / np.maximum(1.0 + cosine + wider, 1e-300)
    placed["intensity"] = root["intensity"] * scales
    placed["cosine_emission"], placed["two_sided"] = root["cosine_emission"], root["two_sided"]
    placed["light_sets"] = root["light_sets"]
    return placed, scales, stretches


def _squared_condition_numbers(linear: np.ndarray) -> np.ndarray:
    """(n,) squares of the condition numbers of matrices (n, 3, 3), a little more; 1 for similarities."""
    products = np.einsum("nji,njk->nik", linear, linear)
    size = np.einsum("nii->n", products) / 3.0
    is_similar = np.abs(products - size[:, None, None] * np.eye(3)).max(axis=(1, 2)) <= _ROUNDING * size
    result = np.ones(len(linear))
    values = np.linalg.svd(linear[~is_similar], compute_uv=False)
    result[~is_similar] = (values[:, 0] / np.maximum(values[:, 2], 1e-30)) ** 2
    return np.minimum(result * (1.0 + 4.0 * _ROUNDING), 1e30)
