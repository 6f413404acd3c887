# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders Raycast nodes with Cycles and writes raycast.json; with bpy 5.2 and what RPPM imports beside it:

python -m tests.parity.materials.measure_raycast
"""

import json
from pathlib import Path

import bpy
import numpy as np

from ..engines import render_cycles
from ..net import Net
from .raycast_cases import CASES, COLORS, INCOMING, INSIDE, build


def shown(net: Net, case: dict) -> bpy.types.NodeSocket:
    """Return the output of a case's Raycast node that is shown."""
    node = net.node("Raycast", {"Length": case.get("length", 1.0)}, only_local=case.get("only_local", False))
    if case.get("direction") == INCOMING:
        incoming = net.out("NewGeometry", "Incoming")
        net.set(node.inputs["Direction"], net.scaled(incoming, -1.7, 0.0))
    elif "direction" in case:
        net.set(node.inputs["Direction"], net.out("CombineXYZ", 0, dict(zip("XYZ", case["direction"], strict=True))))
    if case.get("position") == INSIDE:
        inputs = {0: net.out("NewGeometry", "Normal"), 1: (-0.05,) * 3, 2: net.out("NewGeometry", "Position")}
        net.set(node.inputs["Position"], net.out("VectorMath", 0, inputs, operation="MULTIPLY_ADD"))
    if case["output"].startswith(COLORS):
        node.sample_attribute_items.new("RGBA", COLORS)
        node.inputs[COLORS].default_value = COLORS
    return node.outputs[case["output"]]


def main() -> None:
    measured = {}
    for name, case in CASES.items():
        _, net = build()
        scale, offset = case.get("scale", 1.0), case.get("offset", 0.0)
        net.output(net.emission(net.scaled(shown(net, case), scale, offset)))
        picture = render_cycles(1, 1)[0]
        measured[name] = np.round(picture.astype(float), 4).reshape(-1, 3).tolist()
    text = json.dumps({"blender": bpy.app.version_string, "radiance": measured}, separators=(",", ":"))
    Path(__file__).with_name("raycast.json").write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
