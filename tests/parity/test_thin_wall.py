# SPDX-License-Identifier: GPL-3.0-or-later
"""The Principled BSDF's Thin Wall against Cycles of Blender 5.2, which bpy here has not: thin_wall.json keeps what
measure_thin_wall.py found there."""

import json
from pathlib import Path

import numpy as np
import pytest

from rppm_addon.gl.context import Context

from . import closures
from .closures import View

MEASURED = json.loads((Path(__file__).parent / "thin_wall.json").read_text(encoding="utf-8"))
OPTIONS = {"distribution": "MULTI_GGX", "thin_wall": True}


@pytest.fixture(scope="module")
def context():
    context = Context.create()
    yield context
    context.release()


def named(cases: list[dict]) -> list:
    return [pytest.param(case, id="-".join(case[key] for key in ("name", "camera", "lamp") if key in case)) for case in cases]


@pytest.mark.parametrize("case", named(MEASURED["lit"]))
def test_lit(context, tmp_path, case):
    view = View(MEASURED["cameras"][0][case["camera"]], MEASURED["lamps"][0][case["lamp"]])
    points = np.array(next(row[case["camera"]] for row in MEASURED["points"] if case["camera"] in row))
    cycles = np.array(case["radiance"])
    with context.moderngl:
        ours = closures.by_closure(context, tmp_path, "bsdf_principled", view, points, OPTIONS, case["inputs"], choices=256)
    error = np.abs(ours - cycles) / np.maximum(cycles, 0.02 * cycles.max())
    print(case["name"], "mean", ours.mean(axis=0) / cycles.mean(axis=0), "worst", error.max())
    assert error.max() < 0.01
