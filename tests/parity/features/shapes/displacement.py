# SPDX-License-Identifier: GPL-3.0-or-later
"""Displacement that moves vertices, with and without the bump of its height, on meshes of all kinds."""

import bmesh
import bpy

from ...net import Socket, material, socket
from ...scenes import link_object, place
from .. import stage
from ..rows import Kind, Row, add, ground_material

GROUP = "Displacement"
COLOR = {"Color": (0.8, 0.45, 0.3)}


def displaced(name, displacement, method="DISPLACEMENT", prepare=None, **members):
    """A row of a diffuse ball that is displaced, under an area light and a weak world; ``displacement`` takes the
    net, None displaces nothing."""

    def build() -> None:
        stage.empty()
        plain = ground_material()
        stage.set_up(surface("Feature", displacement, method), 0.25, plain)
        stage.area_light()
        if prepare is not None:
            prepare()

    add(Row(GROUP, name, build, Kind.LIGHT, **members))


def surface(name: str, displacement, method: str, color: dict = COLOR) -> bpy.types.Material:
    made, net = material(name)
    made.displacement_method = method
    shading = net.out("BsdfDiffuse", inputs=color)
    net.output(shading, **({} if displacement is None else {"Displacement": displacement(net)}))
    return made


def noise(scale: float = 0.25, coordinates: str = "Object", space: str = "OBJECT") -> Socket:
    height = socket("TexNoise", 0, {"Vector": socket("TexCoord", coordinates), "Scale": 2.5, "Detail": 1.0})
    return socket("Displacement", 0, {"Height": height, "Scale": scale}, space=space)


def vector(space: str) -> Socket:
    color = socket("TexNoise", "Color", {"Vector": socket("TexCoord", "Object"), "Scale": 2.0, "Detail": 0.0})
    return socket("VectorDisplacement", 0, {"Vector": color, "Midlevel": 0.5, "Scale": 0.6}, space=space)


U = socket("SeparateXYZ", "X", {0: socket("TexCoord", "UV")})
NOISE, ALONG_U = noise(), socket("Displacement", 0, {"Height": U, "Midlevel": 0.0, "Scale": 0.4})
"""ALONG_U is not the same on both sides of the map's seam."""


def flat() -> None:
    bpy.data.objects["Ball"].data.shade_flat()


def other_half() -> None:
    """Another material on half of the ball, which is displaced by something else and bumped."""
    ball = bpy.data.objects["Ball"].data
    ball.materials.append(surface("Other", noise(0.4), "BOTH"))
    for face in ball.polygons:
        face.material_index = int(face.center.x > 0.0)


def subdivided(kind: str, space: str):
    """Adaptive Subdivision of a coarse ball."""

    def make() -> None:
        old = bpy.data.objects["Ball"]
        ball = stage.ball(old.data.materials[0], segments=8)
        bpy.data.objects.remove(old)
        modifier = ball.modifiers.new("Subdivision", "SUBSURF")
        modifier.levels = modifier.render_levels = 2
        modifier.subdivision_type, modifier.adaptive_space = kind, space
        modifier.use_adaptive_subdivision, modifier.adaptive_object_edge_length = True, 0.05

    return make


def divide(thing: bpy.types.Object, kind: str = "CATMULL_CLARK") -> None:
    """Adaptive Subdivision of an object whose modifier says nothing."""
    modifier = thing.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = modifier.render_levels = 0
    modifier.subdivision_type, modifier.use_adaptive_subdivision = kind, True


def cage(size: float, crease: float = 0.0):
    """A cube in place of the ball, with a crease around one of its sides. Cycles shades it smoothly across creases, as
    far as its triangles reach."""

    def make() -> None:
        old = bpy.data.objects["Ball"]
        mesh = bmesh.new()
        bmesh.ops.create_cube(mesh, size=size)
        layer = mesh.edges.layers.float.new("crease_edge")
        for edge in mesh.edges:
            edge[layer] = crease * all(vertex.co.z > 0.0 for vertex in edge.verts)
        made = stage.mesh_object(mesh, "Cage", old.data.materials[0], stage.BALL)
        made.data.shade_smooth()
        divide(made)
        bpy.context.scene.cycles.dicing_rate = 0.25
        bpy.data.objects.remove(old)

    return make


def horizon(displacement: Socket):
    """A ground of one face that is displaced and seen to the horizon."""

    def make() -> None:
        bpy.data.objects.remove(bpy.data.objects["Ground"])
        mesh = bmesh.new()
        bmesh.ops.create_grid(mesh, x_segments=1, y_segments=1, size=60.0)
        hills = surface("Hills", displacement, "DISPLACEMENT", {"Color": (0.25, 0.25, 0.25)})
        divide(stage.mesh_object(mesh, "Ground", hills, stage.GROUND), "SIMPLE")

    return make


def dicing_camera(displacement: Socket):
    """The horizon, divided so coarsely that only a camera which looks through a long lens sees it finely."""

    def make() -> None:
        horizon(displacement)()
        scene = bpy.context.scene
        lens = bpy.data.cameras.new("Long")
        lens.lens = 20.0 * scene.camera.data.lens
        scene.cycles.dicing_camera = link_object(lens, scene.camera.matrix_world, "Long")
        scene.cycles.dicing_rate, scene.cycles.offscreen_dicing_scale = 25.0, 1.0

    return make


def twin() -> None:
    """A smaller object of the same mesh, turned round and mirrored."""
    where = place(at=(-0.9, -0.6, 0.6), turn=(0.0, 60.0, 0.0), scale=(-0.5, 0.5, 0.4))
    link_object(bpy.data.objects["Ball"].data, where, "Twin")


displaced("only, noise", NOISE)
displaced("and bump, noise", NOISE, "BOTH")
displaced("only, flat faces", NOISE, prepare=flat)
displaced("and bump, flat faces", NOISE, "BOTH", flat)
displaced("along the seam of a UV map", ALONG_U)
displaced("by Generated, world space", noise(0.3, "Generated", "WORLD"))
displaced("two materials", ALONG_U, prepare=other_half)
displaced("two objects of a mesh", NOISE, prepare=twin)
displaced("Adaptive Subdivision", NOISE, prepare=subdivided("CATMULL_CLARK", "PIXEL"))
displaced("Adaptive Subdivision, simple, meters", NOISE, prepare=subdivided("SIMPLE", "OBJECT"))
displaced("Adaptive Subdivision, cage", None, prepare=cage(2.2))
displaced("Adaptive Subdivision, creased cage", None, prepare=cage(1.8, 1.0))
displaced("Adaptive Subdivision, to the horizon", None, prepare=horizon(noise(0.5)))
displaced("Adaptive Subdivision, Dicing Camera", None, prepare=dicing_camera(noise(0.5)))
for _space in ("OBJECT", "WORLD", "TANGENT"):
    displaced(f"by a vector, {_space}", vector(_space))
