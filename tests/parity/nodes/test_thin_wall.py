# SPDX-License-Identifier: GPL-3.0-or-later
"""The Principled BSDF's Thin Wall against Cycles of Blender 5.2, which bpy here has not: thin_wall.json keeps what
measure_thin_wall.py found there."""

import json
from pathlib import Path

import numpy as np
import pytest

from rppm_addon.gl.buffers.records import Record
from rppm_addon.materials import albedo_tables

from . import closures
from .closures import View
from .shader_runs import run_shader

MEASURED = json.loads((Path(__file__).parent / "thin_wall.json").read_text(encoding="utf-8"))
(POINTS,), (CAMERAS,), (LIGHTS,) = MEASURED["points"], MEASURED["cameras"], MEASURED["lights"]
OPTIONS = {"distribution": "MULTI_GGX", "thin_wall": True}
EXACT, TABLES = 0.006, 0.016
"""As in test_shader_nodes.py."""
FILM = 0.08
"""As there: one angle stands for all microfacets, and Gaussians for the eye's sensitivities."""
NOISE = 0.002
"""Noise of shares, by 4096 samples of each pixel, which choose what is reflected."""
Record("SheetTestParameters", count="uint", seen_by_camera="uint", below="uint", unused="uint")

_SHADER = """#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
layout(local_size_x = 64) in;
#include <SheetTestParameters>
#include "common/invocation.glsl"
#include "materials/nodes/shaders.glsl"
uniform Parameters { SheetTestParameters parameters; };
readonly buffer Cosines { float cosines[]; };
writeonly buffer Results { vec4 results[]; };
readonly buffer Inputs { float inputs[]; };
void main() {
    uint index = invocation_index();
    if (index >= parameters.count) return;
    float cosine = cosines[index];
    vec3 up = vec3(0.0, 0.0, 1.0), normal = up, wo = vec3(sqrt(1.0 - cosine * cosine), 0.0, cosine);
    ClosureBuilder builder = closure_builder(wo, up, up, parameters.below != 0u, 0.5);
    builder.seen_by_camera = parameters.seen_by_camera != 0u;
    CALL
    vec3 reflected = vec3(0.0), passed = vec3(0.0);
    float bent = 0.0;
    for (int k = 0; k < CLOSURE_LOBES; ++k) {
        MicrofacetLobe lobe = unpacked_lobe(builder.closure.lobes[k]);
        LobeSample scattered = sample_lobe(lobe, up, wo, vec2(0.3, 0.6), 0.0, true);
        if (scattered.transmitted) {
            passed += scattered.weight;
            bent = max(bent, length(scattered.direction + wo));
        } else reflected += scattered.weight;
    }
    results[3u * index] = vec4(reflected, bent);
    results[3u * index + 1u] = vec4(passed, 0.0);
    results[3u * index + 2u] = vec4(builder.closure.transparent, 0.0);
}
"""


def named(cases: list[dict]) -> list:
    ids = ["-".join(case[key] for key in ("name", "camera", "light") if key in case) for case in cases]
    return [pytest.param(case, id=name) for case, name in zip(cases, ids, strict=True)]


def tolerance(case: dict) -> float:
    if "thin_film_thickness" in case["inputs"]:
        return FILM
    return EXACT if case["inputs"].get("transmission_weight") == 1.0 else TABLES


@pytest.mark.parametrize("case", named(MEASURED["lit"]))
def test_lit(library, folder, case):
    """Every point's radiance agrees within a share of it, or of a fiftieth of the brightest."""
    view = View(CAMERAS[case["camera"]], LIGHTS[case["light"]])
    points, cycles = np.array(POINTS[case["camera"]]), np.array(case["radiance"])
    with library.context.moderngl:
        ours = closures.by_closure(
            library, folder, "bsdf_principled", view, points, OPTIONS, case["inputs"], choices=256
        )
    if not cycles.any():
        assert not ours.any()
        return
    error = np.abs(ours - cycles) / np.maximum(cycles, 0.02 * cycles.max())
    print(f"{case['name']}: mean {ours.mean(axis=0) / cycles.mean(axis=0)} worst {error.max():.5f}")
    assert error.max() < tolerance(case)


def shares(library, folder, case: dict, seen_by_camera: bool) -> np.ndarray:
    """(n, 3, 4): what a smooth sheet reflects, what its lobes pass and what is transparent; in the first's last
    component, how far the lobes bend rays."""
    file = folder / "sheet.comp"
    call = closures.node_call("bsdf_principled", OPTIONS)
    file.write_text(_SHADER.replace("CALL", call), encoding="utf-8")
    cosines = np.array(case["cosines"], np.float32)
    inputs = closures.node_inputs("bsdf_principled", case["inputs"] | {"roughness": 0.0})
    arrays = {"Cosines": cosines, "Inputs": inputs, "AlbedoTables": albedo_tables.load()}
    values = {
        "count": len(cosines), "seen_by_camera": seen_by_camera, "below": case["camera"] == "below", "unused": 0,
    }  # fmt: skip
    with library.context.moderngl:
        results = run_shader(library, file, len(cosines), arrays, 12, values)
    return results.reshape(-1, 3, 4).astype(np.float64)


@pytest.mark.parametrize("case", named(MEASURED["shares"]))
def test_smooth_sheets(library, folder, case):
    """The camera's rays meet a lobe that bends none, all others what is transparent; both pass as much as in Cycles."""
    reflected, passed = np.array(case["reflected"]), np.array(case["passed"])
    for seen_by_camera in (True, False):
        found = shares(library, folder, case, seen_by_camera)
        through, none = (1, 2) if seen_by_camera else (2, 1)
        cycles = np.stack([reflected, passed], axis=1)
        error = np.abs(found[:, [0, through], :3] - cycles)
        print(f"{case['name']}: worst {error.max(axis=(0, 2))}")
        assert not found[:, none, :3].any() and found[:, 0, 3].max() < 1e-6
        if "thin_film_thickness" in case["inputs"]:
            assert (error / np.maximum(cycles, 0.1)).max() < FILM
        else:
            assert error.max() < NOISE
