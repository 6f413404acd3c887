# SPDX-License-Identifier: GPL-3.0-or-later
"""Scattering by a shader node from a point light to a camera, by Cycles and by the node's closure, pixel by pixel.

A point light without extent makes Cycles' picture of one sample exact: the sum of the BSDFs times cosine and
irradiance, for as many pairs of directions as there are pixels.
"""

import math
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np

from rppm_addon.gl.buffers.records import Record
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.integrator.common.records import closures  # noqa: F401  declares Closure
from rppm_addon.materials import albedo_tables
from rppm_addon.materials.nodes.node_kinds import FLOAT
from rppm_addon.materials.nodes.shaders import KINDS

from ..engines import cycles_pass, unfilter
from ..net import material
from ..scenes import camera, light, new_scene, place, plane
from .names import blender_node
from .shader_runs import run_shader

SIZE = 32
ANGLE = 70.0
TANGENT = (1.0, 0.0, 0.0)
Record("ClosureTestParameters", viewer="vec3", count="uint", light="vec3", choices="uint", normal="vec3", unused="uint")

_SHADER = """#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
layout(local_size_x = 64) in;
#include <ClosureTestParameters>
#include "common/invocation.glsl"
#include "materials/subsurface.glsl"
#include "materials/nodes/shaders.glsl"
uniform Parameters { ClosureTestParameters parameters; };
readonly buffer Points { vec4 points[]; };
writeonly buffer Results { vec4 results[]; };
readonly buffer Inputs { float inputs[]; };
void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    vec3 point = points[index].xyz, wo = normalize(parameters.viewer - point), wi = normalize(parameters.light - point);
    vec3 up = vec3(0.0, 0.0, wo.z > 0.0 ? 1.0 : -1.0), normal = parameters.normal * up.z;
    vec3 sum = vec3(0.0);
    // More than three lobes take turns.
    for (uint choice = 0u; choice < parameters.choices; ++choice) {
        float u = (float(choice) + 0.5) / float(parameters.choices);
        ClosureBuilder builder = closure_builder(wo, up, up, wo.z < 0.0, u);
        builder.closure.shading_normal = pack_unit_vector(up);
        CALL
        bool front = dot(wi, up) > 0.0;
        sum += diffuse_scattered(builder.closure, wo, wi, front);
        for (int k = 0; k < builder.lobes; ++k) {
            MicrofacetLobe lobe = unpacked_lobe(builder.closure.lobes[k]);
            float cosine = dot(lobe_normal(lobe), wi);
            if (lobe.kind == LOBE_NONE || (cosine > 0.0) != front) continue;
            sum += abs(cosine) * lobe_shadowing(lobe, builder.closure.shading_normal, wi)
                 * evaluate_lobe(lobe, lobe_normal(lobe), wo, wi);
        }
    }
    vec3 apart = parameters.light - point;
    results[index] = vec4(sum / float(parameters.choices) / dot(apart, apart), 0.0);
}
"""


@dataclass(frozen=True)
class View:
    """Where camera and light are, about a horizontal plane through the origin."""

    camera: tuple[float, float, float]
    light: tuple[float, float, float]


ABOVE = View((0.0, -1.6, 1.2), (0.5, 0.6, 0.9))
GRAZING = View((0.0, -2.0, 0.5), (-0.3, 1.0, 0.5))
THROUGH = View((0.0, -1.6, 1.2), (0.3, 0.4, -0.9))
INSIDE = View((0.0, -1.6, -1.2), (0.3, 0.4, -0.9))
INSIDE_OUT = View((0.0, -1.0, -1.6), (0.3, 0.4, 1.2))


def _camera_rays(view: View) -> np.ndarray:
    """(pixels, 3) points of the plane at the pixels' centers."""
    camera(view.camera, (0.0, 0.0, 0.0), ANGLE)
    bpy.context.view_layer.update()
    matrix = np.array(bpy.context.scene.camera.matrix_world)
    at = (np.arange(SIZE) + 0.5) / SIZE * 2.0 - 1.0
    x, y = np.meshgrid(at, at)
    local = np.stack([x, y, np.full_like(x, -1.0 / math.tan(math.radians(ANGLE) / 2.0))], -1).reshape(-1, 3)
    directions = local @ matrix[:3, :3].T
    with np.errstate(divide="ignore"):
        distance = -matrix[2, 3] / directions[:, 2]
    points = matrix[:3, 3] + distance[:, None] * directions
    points[(distance <= 0.0) | ~np.isfinite(distance)] = np.nan
    return points


def _material(kind: str, options: dict, inputs: dict, normal: tuple | None) -> bpy.types.Material:
    made, net = material("Material")
    node = net.node(blender_node(kind).removeprefix("ShaderNode"), **options)
    sockets = {socket.identifier.lower().replace(" ", "_"): socket for socket in node.inputs}
    sockets.pop("weight")
    assert set(KINDS[kind].inputs) == set(sockets), f"{kind}: {set(KINDS[kind].inputs) ^ set(sockets)}"
    for name, value in inputs.items():
        net.set(sockets[name], value)
    vectors = {"tangent": TANGENT} | ({"normal": normal} if normal else {})
    for name, vector in vectors.items():
        if name in sockets:
            net.set(sockets[name], net.out("CombineXYZ", 0, dict(enumerate(vector))))
    net.output(node.outputs[0])
    return made


def by_cycles(
    kind: str, view: View, options: dict, inputs: dict, normal: tuple | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Points (pixels, 3) of the plane, NaN where it is not seen, and their radiance (pixels, 3) for 1 W/sr."""
    scene = new_scene(SIZE)
    scene.cycles.max_bounces = 0
    unfilter()
    # No edge between triangles in sight.
    plane(100.0, _material(kind, options, inputs, normal), place(at=(40.0, 10.0, 0.0)))
    light("POINT", 4.0 * math.pi, place(at=view.light), shadow_soft_size=0.0)
    points = _camera_rays(view)
    return points, cycles_pass().astype(np.float64).reshape(-1, 3)


def node_call(kind: str, options: dict) -> str:
    """The call of a node's GLSL function with the numbers of node_inputs in the buffer ``inputs``.

    So nodes of the same options share a program.
    """
    node = KINDS[kind]
    function, literals = node.call(kind, options)
    arguments, start = ["builder", "1.0", *literals], 0
    for name, (socket, default) in node.inputs.items():
        if default == "normal":
            arguments.append("normal" if name == "normal" else "up")
        elif default == "tangent":
            arguments.append(f"vec3({', '.join(map(str, TANGENT))})")
        elif socket is FLOAT:
            arguments.append(f"inputs[{start}]")
            start += 1
        else:
            arguments.append(f"vec3(inputs[{start}], inputs[{start + 1}], inputs[{start + 2}])")
            start += 3
    return f"{function}({', '.join(arguments)});"


def node_inputs(kind: str, inputs: dict) -> np.ndarray:
    """(n,) float32 numbers of a node's inputs, those given by name and the defaults."""
    node = KINDS[kind]
    unknown = [name for name in inputs if name not in node.inputs or isinstance(node.inputs[name][1], str)]
    assert not unknown, f"{kind} has no numbers {unknown}"
    numbers = [0.0]
    for name, (socket, default) in reversed(node.inputs.items()):
        if not isinstance(default, str):
            value = inputs.get(name, default)
            numbers[:0] = [value] if socket is FLOAT else ((value,) * 3 if np.isscalar(value) else value)
    return np.array(numbers, np.float32)


def by_closure(
    library: ProgramLibrary, folder: Path, kind: str, view: View, points: np.ndarray, options: dict, inputs: dict,
    normal: tuple | None = None, choices: int = 64,
) -> np.ndarray:  # fmt: skip
    """Radiance (pixels, 3) that the node's closure scatters of 1 W/sr. ``folder`` is for the shaders of the library."""
    file = folder / f"{'_'.join([kind, *(f'{name}_{value}' for name, value in sorted(options.items()))])}.comp"
    file.write_text(_SHADER.replace("CALL", node_call(kind, options)), encoding="utf-8")
    padded = np.zeros((len(points), 4), np.float32)
    padded[:, :3] = np.nan_to_num(points)
    arrays = {"Inputs": node_inputs(kind, inputs), "Points": padded, "AlbedoTables": albedo_tables.load()}
    normal = np.array(normal if normal else (0.0, 0.0, 1.0), float)
    values = {
        "viewer": view.camera, "count": len(points), "light": view.light, "choices": choices,
        "normal": normal / np.linalg.norm(normal), "unused": 0,
    }  # fmt: skip
    defines = {"ASHIKHMIN_LOBES": 1} if options.get("distribution") == "ASHIKHMIN_SHIRLEY" else {}
    if inputs.get("thin_film_thickness"):
        defines["THIN_FILM_LOBES"] = 1
    results = run_shader(library, file, len(points), arrays, 4, values, defines)
    return results.reshape(-1, 4)[:, :3].astype(np.float64)
