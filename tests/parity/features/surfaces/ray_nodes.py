# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes that trace rays of their own: Ambient Occlusion and Bevel."""

import bmesh
import bpy

from ...net import socket
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


def _glow(given):
    return lambda net: net.emission(given(net))


def _shown(output="AO", inputs=None, **properties):
    """The value as it glows."""
    return _glow(socket("AmbientOcclusion", output, inputs, **properties))


def _bevel(**inputs):
    return socket("Bevel", inputs=inputs)


_NOISE = socket("TexNoise", inputs={"Scale": 4.0})
AO = "Ambient Occlusion"
GROUND = {"on_ground": True}
# Nodes that are no straight lines show how the values of single places are spread.
_few = socket("AmbientOcclusion", "AO", {"Distance": 0.8}, samples=4)
_ramp = _glow(socket("Math", 0, {0: _few, 1: 4.0}, operation="POWER"))
_bump = socket("Bump", inputs={"Height": _NOISE})
lit(AO, "as a color", socket("BsdfDiffuse", 0, {"Color": socket("AmbientOcclusion")}))
lit(AO, "value", _shown(), _slab, **GROUND)
lit(AO, "tinted, near", _shown("Color", {"Color": (0.9, 0.5, 0.2), "Distance": 0.4}), _slab, **GROUND)
lit(AO, "inside", _shown(inputs={"Distance": 1.2}, inside=True, samples=8), _alone(_slab))
lit(AO, "only local", _shown(only_local=True), _cube, **GROUND)
lit(AO, "far as the world says", _shown(inputs={"Distance": 0.0}), **GROUND)
lit(AO, "distance by a texture", _shown(inputs={"Distance": socket("TexNoise", inputs={"Scale": 2.0})}), **GROUND)
lit(AO, "4 samples to the power of 4", _ramp, **GROUND)
lit(AO, "about a bump", _shown(inputs={"Normal": _bump}), _alone())
lit(AO, "about a bevel", _shown(inputs={"Normal": _bevel(Radius=0.3)}), _alone(_cube))
# Edges, where the bevel's normal turns away from the surface's own.
_turned = {0: _bevel(Radius=0.2), 1: socket("NewGeometry", "Normal")}
_worn = _glow(socket("VectorMath", "Value", _turned, operation="DOT_PRODUCT"))
_glossy = LOW | {"Normal": socket("Bevel", 0, {"Radius": 0.25}, samples=8)}
_bumped = _bevel(Radius=0.2, Normal=socket("Bump", inputs={"Distance": 0.3, "Height": _NOISE}))
lit("Bevel", "on a smooth ball", socket("BsdfDiffuse", 0, COLOR | {"Normal": _bevel()}))
lit("Bevel", "edges of a cube", _worn, _alone(_cube))
lit("Bevel", "diffuse", socket("BsdfDiffuse", 0, COLOR | {"Normal": _bevel(Radius=0.25)}), _cube)
lit("Bevel", "glossy", socket("BsdfAnisotropic", 0, _glossy), _cube, effort=4)
lit("Bevel", "of a bump", socket("BsdfDiffuse", 0, COLOR | {"Normal": _bumped}), _cube)
