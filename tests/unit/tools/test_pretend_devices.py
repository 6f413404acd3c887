# SPDX-License-Identifier: GPL-3.0-or-later
"""Devices as Mesa's drivers show them where drm-shim answers in the kernel's place (benchmarks.drivers fetches it)."""

import json
import os
import subprocess
import sys

import pytest

from benchmarks.drivers.lab import lab_folder
from rppm_addon.gl.context import project_mesa

SHIM = next(lab_folder().glob("project/usr/lib/*/libamdgpu_noop_drm_shim.so"), None)
_LIST = """
import dataclasses, json, sys
from rppm_addon.gl.context.context import Context, open_others
context = Context.create()
information, available = context.information, context.available_memory
devices = open_others(information.devices, information.number)
print(json.dumps([available, *map(dataclasses.asdict, devices)]))
"""


@pytest.mark.skipif(SHIM is None or project_mesa.has_gpu(), reason="a GPU, or no drm-shim of make drivers")
@pytest.mark.parametrize(
    ("device", "kind", "name", "least_memory"),
    [
        ("NAVI21", "discrete", "AMD Radeon RX 6800", 16 << 30),
        # Of a processor: its driver tells of 256 MiB that the firmware keeps aside, and takes what it needs.
        ("RAVEN", "integrated", "AMD Radeon Vega 10 Graphics", 1 << 29),
    ],
)
def test_a_device_that_is_not_there(device, kind, name, least_memory):
    environment = os.environ | {
        "LD_LIBRARY_PATH": str(project_mesa.libraries(project_mesa.FOLDER)[0].parent),
        "LD_PRELOAD": str(SHIM),
        "AMDGPU_GPU_ID": device,
        "RPPM_DEVICE": "",
    }
    run = subprocess.run([sys.executable, "-c", _LIST], env=environment, capture_output=True, text=True, timeout=60)
    assert run.returncode == 0, run.stderr
    available, card, software = json.loads(run.stdout)
    assert (card["kind"], card["name"], card["problem"]) == (kind, name, "")
    assert card["memory"] >= least_memory <= available and card["driver"].startswith("Mesa")
    assert card["identity"].startswith("1002:") and software["identity"] == software["kind"] == "software"
