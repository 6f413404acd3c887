# SPDX-License-Identifier: GPL-3.0-or-later
"""Each modifier with its defaults, on a cube and a monkey, and nodes that make each primitive."""

import functools
from collections.abc import Callable

import bpy

from .files import cube, file, monkey, paint, plain, start

MODIFIERS = [
    "DATA_TRANSFER",
    "MESH_CACHE",
    "MESH_SEQUENCE_CACHE",
    "NORMAL_EDIT",
    "WEIGHTED_NORMAL",
    "UV_PROJECT",
    "UV_WARP",
    "VERTEX_WEIGHT_EDIT",
    "ARRAY",
    "BEVEL",
    "BOOLEAN",
    "BUILD",
    "DECIMATE",
    "EDGE_SPLIT",
    "NODES",
    "MASK",
    "MIRROR",
    "MULTIRES",
    "REMESH",
    "SCREW",
    "SKIN",
    "SOLIDIFY",
    "SUBSURF",
    "TRIANGULATE",
    "VOLUME_TO_MESH",
    "WELD",
    "WIREFRAME",
    "ARMATURE",
    "CAST",
    "CURVE",
    "DISPLACE",
    "HOOK",
    "LAPLACIANDEFORM",
    "LATTICE",
    "MESH_DEFORM",
    "SHRINKWRAP",
    "SIMPLE_DEFORM",
    "SMOOTH",
    "CORRECTIVE_SMOOTH",
    "LAPLACIANSMOOTH",
    "SURFACE_DEFORM",
    "WARP",
    "WAVE",
    "CLOTH",
    "COLLISION",
    "EXPLODE",
    "FLUID",
    "OCEAN",
    "PARTICLE_INSTANCE",
    "PARTICLE_SYSTEM",
    "SOFT_BODY",
    "MESH_TO_VOLUME",
]


def _modifier(kind: str, make: object) -> None:
    start()
    thing = make()
    thing.modifiers.new(kind.title(), kind)


for kind in MODIFIERS:
    file(f"modifier_{kind.lower()}", functools.partial(_modifier, kind, cube))
for kind in ("SUBSURF", "DECIMATE", "EDGE_SPLIT", "REMESH", "WIREFRAME", "SOLIDIFY", "BEVEL", "MIRROR", "ARRAY"):
    file(f"modifier_{kind.lower()}_monkey", functools.partial(_modifier, kind, monkey))


def _set(kind: str, values: dict, smooth: bool = False) -> None:
    start()
    thing = monkey()
    if smooth:
        bpy.ops.object.shade_smooth()
    modifier = thing.modifiers.new(kind, kind)
    for name, value in values.items():
        setattr(modifier, name, value)


for name, kind, values, smooth in (
    ("subsurf_viewport_off", "SUBSURF", {"show_viewport": False}, True),
    ("subsurf_render_off", "SUBSURF", {"show_render": False}, True),
    ("subsurf_render_3", "SUBSURF", {"levels": 0, "render_levels": 3}, True),
    ("subsurf_simple", "SUBSURF", {"subdivision_type": "SIMPLE"}, False),
    ("screw_smooth", "SCREW", {"use_smooth_shade": True}, False),
    ("solidify_complex", "SOLIDIFY", {"solidify_mode": "NON_MANIFOLD", "thickness": 0.1}, False),
    ("solidify_materials", "SOLIDIFY", {"thickness": -0.2, "material_offset": 1}, False),
    ("mirror_xyz", "MIRROR", {"use_axis": (True, True, True), "use_clip": True}, False),
    ("weighted_normal_smooth", "WEIGHTED_NORMAL", {}, True),
    ("normal_edit_smooth", "NORMAL_EDIT", {}, True),
    ("smooth_by_bevel", "BEVEL", {"harden_normals": True}, True),
    ("decimate_planar", "DECIMATE", {"decimate_type": "DISSOLVE", "angle_limit": 0.5}, False),
    ("cast_strong", "CAST", {"factor": 1.0}, True),
    ("twist", "SIMPLE_DEFORM", {"angle": 2.0}, True),
    ("build_half", "BUILD", {"frame_duration": 2.0}, False),
):
    file(f"modifier_{name}", functools.partial(_set, kind, values, smooth))


def _boolean(operation: str, solver: str) -> None:
    start()
    bpy.ops.mesh.primitive_uv_sphere_add(radius=1.0, location=(0.6, -0.6, 0.6))
    cutter = paint(bpy.context.object, plain((0.1, 0.1, 0.8)))
    cutter.hide_render = True
    cutter.display_type = "WIRE"
    modifier = cube().modifiers.new("Boolean", "BOOLEAN")
    modifier.operation, modifier.object, modifier.solver = operation, cutter, solver


for operation in ("DIFFERENCE", "INTERSECT", "UNION"):
    file(f"modifier_boolean_{operation.lower()}", functools.partial(_boolean, operation, "EXACT"))


def _displaced(kind: str) -> None:
    start()
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=32, y_subdivisions=32, size=3.0)
    paint(bpy.context.object)
    bpy.ops.object.shade_smooth()
    modifier = bpy.context.object.modifiers.new("Displace", "DISPLACE")
    modifier.texture, modifier.strength = bpy.data.textures.new("Texture", kind), 0.6


for kind in ("CLOUDS", "VORONOI"):
    file(f"modifier_displace_{kind.lower()}", functools.partial(_displaced, kind))

PRIMITIVES = ["Cone", "Cube", "Cylinder", "Grid", "IcoSphere", "Line", "Circle", "UVSphere"]
NODES = (
    *(f"GeometryNodeMesh{name}" for name in PRIMITIVES),
    "GeometryNodeCurvePrimitiveCircle",
    "GeometryNodeCurvePrimitiveBezierSegment",
    "GeometryNodeCurvePrimitiveLine",
    "GeometryNodeCurvePrimitiveQuadrilateral",
    "GeometryNodeCurveStar",
    "GeometryNodeCurveSpiral",
    "GeometryNodeCurveArc",
    "GeometryNodeCurveQuadraticBezier",
    "GeometryNodePoints",
    "GeometryNodeStringToCurves",
    "GeometryNodeVolumeCube",
)


def node_tree(thing: bpy.types.Object) -> tuple[bpy.types.NodeTree, bpy.types.Node, bpy.types.Node]:
    """A geometry nodes modifier of an object: its tree, input and output."""
    tree = bpy.data.node_groups.new("Geometry Nodes", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    thing.modifiers.new("Geometry Nodes", "NODES").node_group = tree
    return tree, tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")


def _geometry_node(kind: str, material: bool) -> None:
    start()
    thing = cube()
    tree, _, output = node_tree(thing)
    node = tree.nodes.new(kind)
    if kind == "GeometryNodeStringToCurves":
        node.inputs["String"].default_value = "Text"
    if kind == "GeometryNodePoints":
        node.inputs["Count"].default_value, node.inputs["Radius"].default_value = 1, 0.6
    made = node.outputs[0]
    if material:
        setter = tree.nodes.new("GeometryNodeSetMaterial")
        setter.inputs["Material"].default_value = plain((0.1, 0.3, 0.8))
        tree.links.new(made, setter.inputs["Geometry"])
        made = setter.outputs[0]
    tree.links.new(made, output.inputs[0])


for kind in NODES:
    name = kind.removeprefix("GeometryNode")
    file(f"nodes_{name.lower()}", functools.partial(_geometry_node, kind, False))
    file(f"nodes_{name.lower()}_material", functools.partial(_geometry_node, kind, True))


class _Tree:
    """A geometry nodes modifier of a monkey, and shorter words for adding to it."""

    def __init__(self) -> None:
        start()
        self._tree, self.given, self.output = node_tree(monkey())

    def node(self, kind: str, **inputs: object) -> bpy.types.Node:
        made = self._tree.nodes.new(f"GeometryNode{kind}")
        for socket, value in inputs.items():
            made.inputs[socket.replace("_", " ")].default_value = value
        return made

    def link(self, a: bpy.types.Node, b: bpy.types.Node, socket: str | int = 0) -> bpy.types.Node:
        self._tree.links.new(a.outputs[0], b.inputs[socket])
        return b

    def chain(self, *kinds: str) -> bpy.types.Node:
        """The geometry that is given, through nodes one after the other."""
        made = self.given
        for kind in kinds:
            made = self.link(made, self.node(kind))
        return made


def _scattered(tree: _Tree) -> bpy.types.Node:
    points = tree.link(tree.given, tree.node("DistributePointsOnFaces", Density=6.0))
    instances = tree.link(points, tree.node("InstanceOnPoints"))
    tree.link(tree.node("MeshIcoSphere", Radius=0.12), instances, "Instance")
    return instances


def _tubes(tree: _Tree) -> bpy.types.Node:
    made = tree.link(tree.node("CurveSpiral"), tree.node("CurveToMesh"))
    tree.link(tree.node("CurvePrimitiveCircle", Radius=0.1), made, "Profile Curve")
    return made


def _joined(tree: _Tree) -> bpy.types.Node:
    made = tree.link(tree.given, tree.node("JoinGeometry"))
    return tree.link(tree.link(tree.node("MeshCone"), tree.node("Transform", Translation=(1.5, 0.0, 0.0))), made)


CHAINS: dict[str, Callable[[_Tree], bpy.types.Node]] = {
    "scatter": _scattered,
    "scatter_realized": lambda tree: tree.link(_scattered(tree), tree.node("RealizeInstances")),
    "scatter_points": lambda tree: tree.link(tree.given, tree.node("DistributePointsOnFaces", Density=6.0)),
    "tubes": _tubes,
    "edges_to_curves": lambda tree: tree.chain("MeshToCurve"),
    "mesh_to_points": lambda tree: tree.chain("MeshToPoints"),
    "smooth": lambda tree: tree.chain("SubdivisionSurface", "SetShadeSmooth"),
    "joined": _joined,
    "dual_mesh": lambda tree: tree.chain("DualMesh"),
    "hull": lambda tree: tree.chain("ConvexHull"),
    "mesh_to_volume": lambda tree: tree.chain("MeshToVolume"),
}


def _chain(give: Callable[[_Tree], bpy.types.Node]) -> None:
    """Trees of tutorials: scatter, curves to tubes, smooth, instances."""
    tree = _Tree()
    tree.link(give(tree), tree.output)


for name, give in CHAINS.items():
    file(f"nodes_{name}", functools.partial(_chain, give))
file("nodes_nothing", _Tree)
