# SPDX-License-Identifier: GPL-3.0-or-later
"""Things that modifiers carve, liquids in glasses, smoke and clouds, seen by cameras of all kinds."""

import math
from typing import Any

from . import materials
from .draws import Draws
from .graphs import finish, geometry_nodes, material
from .products import studio
from .rooms import sky
from .scenes import Place, add, camera, curve, cylinder, kind, modifier, shape, text


def _carved(draws: Draws, at: Place) -> None:
    """A block with a hole by a Boolean, whose edges are rounded and whose normals are weighted."""
    paint = [materials.anything(draws), materials.plain(draws)]
    block = add("Block", shape("cube", paint), at, (0, 0, draws.random()), (0.4, 0.3, draws.between(0.3, 0.5)))
    hole = add("Hole", cylinder(None, 0.1, 2.0), at, draws.vector(-0.5, 0.5))
    hole.hide_render, hole.display_type = True, "WIRE"
    modifier(block, "BOOLEAN", object=hole, operation="DIFFERENCE", solver="EXACT")
    modifier(block, "BEVEL", width=0.01, segments=2, material=1, harden_normals=draws.maybe())
    if draws.maybe():
        modifier(block, "WEIGHTED_NORMAL", keep_sharp=True)


def _mirrored(draws: Draws, at: Place) -> None:
    """Half of a thing and its mirror image, with custom normals where it is smooth."""
    half = add("Half", shape("monkey", materials.anything(draws), True), at, (0, 0, draws.between(-1, 1)), (0.15,) * 3)
    modifier(half, "MIRROR", use_axis=(False, False, True), use_mirror_u=draws.maybe())
    choice = draws.pick(("REMESH", "DECIMATE", "SMOOTH", "CAST", "WIREFRAME"))
    settings: dict[str, Any] = {
        "REMESH": {"voxel_size": 0.15, "use_smooth_shade": True},
        "DECIMATE": {"ratio": 0.4},
        "CAST": {"factor": 0.5},
        "WIREFRAME": {"thickness": 0.08},
    }.get(choice, {})
    modifier(half, choice, **settings)


def _drink(draws: Draws, at: Place) -> None:
    """A glass with a liquid that overlaps its wall a little, as tutorials say, or leaves a gap."""
    x, y, _ = at
    glass = shape("cone", materials.glass(draws, 0.0), True, radius1=0.13, radius2=0.16, depth=0.4, cap_ends=False)
    cup = add("Glass", glass, (x, y, 0.215))
    modifier(cup, "SOLIDIFY", thickness=0.02, offset=-1.0)
    made, graph = material("Liquid")
    color = draws.color(0.9, (0.5, 0.9))
    volume = draws.pick(("VolumeAbsorption", "VolumeScatter", "none"))
    shader = graph.node("BsdfGlass", Color=color if volume == "none" else (1, 1, 1, 1), Roughness=0.0, IOR=1.33)
    density = draws.between(2, 15)
    finish(graph, shader, volume=None if volume == "none" else graph.node(volume, Color=color, Density=density))
    radius = draws.pick((0.13, 0.115))
    add("Liquid", cylinder(made, radius, 0.25, 24), (x, y, 0.16)).data.shade_smooth()


def _smoke(draws: Draws, at: Place) -> None:
    """A cloud in a box, or of a mesh that geometry nodes make a volume of."""
    made, graph = material("Smoke")
    inputs: dict[str, Any] = {"Color": draws.color(0.3, (0.5, 1.0)), "Anisotropy": draws.pick((0.0, 0.3))}
    if draws.maybe(0.6):
        noise = graph.node("TexNoise", Scale=4.0, Vector=graph.node("TexCoord").outputs["Object"])
        inputs["Density"] = graph.node(
            "MapRange", Value=noise, From_Min=0.45, From_Max=0.7, To_Max=draws.between(5, 20)
        )
        if draws.maybe(0.3):
            inputs.update(Emission_Strength=0.3, Emission_Color=draws.color(0.8))
        finish(graph, volume=graph.node("VolumePrincipled", **inputs))
        add("Smoke", shape("cube", made), (at[0], at[1], 0.4), (0, 0, 0.3), (0.5, 0.5, 0.7))
        return
    finish(graph, volume=graph.node("VolumePrincipled", **inputs, Density=draws.between(3, 15)))
    thing = add("Smoke", shape("icosphere", made, radius=0.25), (at[0], at[1], 0.35))
    tree, given, output = geometry_nodes(thing)
    grid = tree.node("MeshToVolume", None, {0: given}, Voxel_Amount=24.0)
    painted = tree.node("SetMaterial", None, {0: grid}, Material=made)
    tree.tree.links.new(painted.outputs[0], output.inputs[0])


def _bent(draws: Draws, at: Place) -> None:
    """A profile along a curve, with a taper, or words along it."""
    points = [(at[0] + 0.15 * n, at[1] + 0.1 * math.sin(n), 0.25 + 0.1 * math.cos(2 * n)) for n in range(4)]
    path = curve(points, materials.anything(draws), 0.0 if draws.maybe() else 0.03)
    if not path.data.bevel_depth:
        profile = curve([(0.03, 0, 0), (0, 0.06, 0), (-0.03, 0, 0), (0, -0.02, 0)], materials.plain(draws), 0.0)
        profile.data.splines[0].use_cyclic_u, profile.data.dimensions = True, "2D"
        profile.location = (0, 0, -3)
        path.data.bevel_mode, path.data.bevel_object = "OBJECT", profile
    else:
        words = text("along the curve", materials.metal(draws), (0, 0, 0), (0, 0, 0), size=0.12, extrude=0.01)
        words.data.follow_curve = path


def _lens(draws: Draws) -> None:
    data = camera((draws.between(-0.8, 0.8), -2.6, 1.1), (0, 0.2, 0.3), draws.between(35, 55))
    choice = draws.pick(("PERSP", "PERSP", "PERSP", "ORTHO", "PANO"))
    data.type = choice
    if choice == "ORTHO":
        data.ortho_scale = 2.2
    elif choice == "PANO":
        data.panorama_type = draws.pick(("FISHEYE_EQUISOLID", "EQUIRECTANGULAR", "FISHEYE_EQUIDISTANT"))
    data.shift_x, data.shift_y = draws.pick((0.0, 0.1)), draws.pick((0.0, -0.05))
    if draws.maybe(0.4):
        data.dof.use_dof, data.dof.focus_distance, data.dof.aperture_fstop = True, 2.6, 1.0
        data.dof.aperture_ratio, data.dof.aperture_blades = draws.pick((1.0, 2.0)), draws.pick((0, 5))


@kind
def still_life(draws: Draws) -> None:
    """Sixteen things on a table, each made in another way."""
    table = draws.pick((materials.textured, materials.procedural, materials.plain))(draws)
    add("Table", shape("grid", table), scale=(9, 9, 1))
    makers = (_carved, _carved, _mirrored, _mirrored, _drink, _smoke, _bent)
    for at in range(16):
        place = (0.62 * (at % 4 - 1.5) + draws.between(-0.05, 0.05), 0.55 * (at // 4 - 1), 0.27)
        draws.pick(makers)(draws, place)
    sky(draws)
    studio(draws)
    _lens(draws)
