# SPDX-License-Identifier: GPL-3.0-or-later
"""Phase functions against Cycles', by light that is scattered once.

A sun lights a slab, and a camera looks along its axis: all light is scattered by one angle. What an isotropic medium
shows in its place tells the factor of 4 pi times the phase function.
"""

import functools
import math

import bpy
import numpy as np
import pytest
from support.media.phase_values import values_and_samples

from rppm_addon.materials.phase_functions import MODELS

from ..engines import cycles_pass, exported_scene, unfilter
from ..scenes import box, light, orthographic_camera, place
from .scenes import PHASES, begin, medium, scatter

ANGLES = (175.0, 150.0, 120.0, 90.0, 45.0, 5.0)
"""Turns of the sun, degrees: by 180 it shines straight at the camera, by 0 along its view."""
CASES = {
    **PHASES,
    "HENYEY_GREENSTEIN": {"Anisotropy": -0.5},
    "RAYLEIGH": {},
}
DROPLETS = (0.05, 0.5, 3.0, 20.0)


def lit_slab(angle: float, phase: str, **inputs: float) -> float:
    """Cycles' radiance of the slab."""
    begin(0)
    orthographic_camera(0.5, place(at=(0.0, 0.0, 5.0)))
    box((20.0, 20.0, 0.05), medium("Fog", scatter(0.5, phase=phase, **inputs)))
    light("SUN", 1.0, place(turn=(0.0, angle, 0.0))).data.angle = 0.0
    unfilter()
    bpy.context.scene.render.resolution_x = bpy.context.scene.render.resolution_y = 8
    bpy.context.scene.render.engine = "CYCLES"
    return float(cycles_pass(samples=64).mean())


@functools.cache
def isotropic(angle: float) -> float:
    return lit_slab(angle, "HENYEY_GREENSTEIN", Anisotropy=0.0)


@pytest.mark.parametrize(
    ("phase", "inputs"), [*CASES.items(), *(("MIE", {"Diameter": d}) for d in DROPLETS)], ids=lambda value: str(value)
)
def test_phase_functions_are_those_of_cycles(context, library, phase, inputs):
    cosines = np.array([-math.cos(math.radians(angle)) for angle in ANGLES])
    even = np.array([isotropic(angle) for angle in ANGLES])
    expected = np.array([lit_slab(angle, phase, **inputs) for angle in ANGLES]) / even / (4.0 * math.pi)
    (node,) = (node for node in exported_scene().materials[0].interior.nodes if node.kind == "volume_scatter")
    with context.moderngl:
        found = np.zeros(len(ANGLES))
        for model in MODELS[phase]:
            parameters = model.parameters(*(float(node.inputs[name]) for name in model.inputs))
            weight = 1.0
            if phase == "MIE":
                draine = draine_weight(float(node.inputs["diameter"]))
                weight = draine if model.mie_lobe == "DRAINE" else 1.0 - draine
            found += weight * values_and_samples(context, library, model.kind, parameters, cosines)[0]
    np.testing.assert_allclose(found, expected, rtol=1e-3)


def draine_weight(diameter: float) -> float:
    """Weight of Draine's lobe for droplets (Jendersie and d'Eon 2023, Eqs. 7, 14, 18 and 22)."""
    d, log_d = diameter, math.log(diameter)
    if d <= 0.1:
        return 0.252977 - 312.983 * d**4.3
    if d < 1.5:
        return 0.146209 * math.cos(3.38707 * log_d + 2.11193) + 0.316072 + 0.0778917 * log_d
    if d < 5.0:
        return 0.026914 * (log_d - math.cos(5.68947 * (math.log(log_d) - 0.0292149))) + 0.376475
    return math.exp(-0.599085 / (d - 0.641583) - 0.665888)
