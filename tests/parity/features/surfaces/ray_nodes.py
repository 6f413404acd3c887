# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that trace rays of their own: Ambient Occlusion and Bevel."""

import bmesh
import bpy

from ...scenes import place
from .. import stage
from ..rows import lit

GROUPS = ("Ambient Occlusion", "Bevel")
COLOR = {"Color": (0.8, 0.45, 0.3)}
LOW = {"Color": (0.7, 0.5, 0.3), "Roughness": 0.35}


def _beside(name: str) -> None:
    """A slab that leans over the ball, of another material or of the same."""
    mesh = bmesh.new()
    bmesh.ops.create_cube(mesh, size=2.0)
    where = place(at=(0.1, 0.7, 1.6), turn=(-60.0, 0.0, 10.0), scale=(1.2, 0.9, 0.1))
    stage.mesh_object(mesh, "Slab", bpy.data.materials[name], {"at": (0.0, 0.0, 0.0)}).matrix_world = where


def _slab() -> None:
    _beside("Feature")


def _cube() -> None:
    """A cube in place of the ball."""
    bpy.data.objects.remove(bpy.data.objects["Ball"])
    mesh = bmesh.new()
    bmesh.ops.create_cube(mesh, size=1.5)
    where = {"at": (0.1, 0.0, 0.85), "turn": (20.0, -15.0, 35.0), "scale": (1.0, 0.9, 1.1)}
    stage.mesh_object(mesh, "Cube", bpy.data.materials["Feature"], where)


def _alone(prepare=None):
    """Nothing that what glows could light: there Cycles' rays to lights take an occlusion for 1."""

    def build() -> None:
        if prepare is not None:
            prepare()
        bpy.data.objects.remove(bpy.data.objects["Ground"])

    return build


def _shown(output="AO", inputs=None, scale=1.0, **properties):
    """The value as it glows."""
    return lambda net: net.emission(net.out("AmbientOcclusion", output, inputs, **properties), scale)


def _ramp(net):
    """Nodes that are no straight lines show how the values of single places are spread."""
    found = net.out("AmbientOcclusion", "AO", {"Distance": 0.8}, samples=4)
    return net.emission(net.out("Math", 0, {0: found, 1: 4.0}, operation="POWER"))


def _worn(net):
    """Return an emission that shows edges, where the bevel's normal turns away from the surface's own."""
    turned = net.out(
        "VectorMath", "Value", {0: net.out("Bevel", inputs={"Radius": 0.2}), 1: net.out("NewGeometry", "Normal")},
        operation="DOT_PRODUCT",
    )  # fmt: skip
    return net.emission(turned)


AO = "Ambient Occlusion"
lit(AO, "as a color", lambda net: net.out("BsdfDiffuse", 0, {"Color": net.out("AmbientOcclusion")}))
lit(AO, "value", _shown(), on_ground=True, prepare=_slab)
lit(AO, "tinted, near", _shown("Color", {"Color": (0.9, 0.5, 0.2), "Distance": 0.4}), on_ground=True, prepare=_slab)
lit(AO, "inside", _shown(inputs={"Distance": 1.2}, inside=True, samples=8), prepare=_alone(_slab))
lit(AO, "only local", _shown(only_local=True), on_ground=True, prepare=_cube)
lit(AO, "far as the world says", _shown(inputs={"Distance": 0.0}), on_ground=True)
lit(
    AO,
    "distance by a texture",
    lambda net: _shown(inputs={"Distance": net.out("TexNoise", inputs={"Scale": 2.0})})(net),
    on_ground=True,
)
lit(AO, "4 samples to the power of 4", _ramp, on_ground=True)
lit(
    AO,
    "about a bump",
    lambda net: _shown(
        inputs={"Normal": net.out("Bump", inputs={"Height": net.out("TexNoise", inputs={"Scale": 4.0})})}
    )(net),
    prepare=_alone(),
)
lit(AO, "about a bevel", lambda net: _shown(inputs={"Normal": net.out("Bevel", inputs={"Radius": 0.3})})(net),
    prepare=_alone(_cube))  # fmt: skip
lit("Bevel", "on a smooth ball", lambda net: net.out("BsdfDiffuse", 0, COLOR | {"Normal": net.out("Bevel")}))
lit("Bevel", "edges of a cube", _worn, prepare=_alone(_cube))
lit(
    "Bevel",
    "diffuse",
    lambda net: net.out("BsdfDiffuse", 0, COLOR | {"Normal": net.out("Bevel", inputs={"Radius": 0.25})}),
    prepare=_cube,
)
lit(
    "Bevel",
    "glossy",
    lambda net: net.out("BsdfAnisotropic", 0, LOW | {"Normal": net.out("Bevel", 0, {"Radius": 0.25}, samples=8)}),
    prepare=_cube,
    effort=4,
)
lit(
    "Bevel",
    "of a bump",
    lambda net: net.out(
        "BsdfDiffuse",
        0,
        COLOR | {"Normal": net.out("Bevel", inputs={"Radius": 0.2, "Normal": net.out("Bump", inputs={
            "Distance": 0.3, "Height": net.out("TexNoise", inputs={"Scale": 4.0})})})},
    ),
    prepare=_cube,
)  # fmt: skip
