# SPDX-License-Identifier: GPL-3.0-or-later
"""Files with fluid domains, which have Blender's module abort as it ends."""

import subprocess
import sys

import pytest

from rppm_addon.pictures import read_exr

pytest.importorskip("bpy", reason="needs the bpy wheel")

WRITE = """
import os, sys, bpy
kind, path = sys.argv[1:]
bpy.ops.wm.read_factory_settings()
modifier = bpy.data.objects["Cube"].modifiers.new("Fluid", "FLUID")
modifier.fluid_type = "DOMAIN"
modifier.domain_settings.domain_type = kind
modifier.domain_settings.resolution_max = 8
bpy.ops.wm.save_as_mainfile(filepath=path)
os._exit(0)
"""


@pytest.mark.parametrize("kind", ["GAS", pytest.param("LIQUID", marks=pytest.mark.long)])
def test_a_fluid_domain_is_rendered_with_status_0(tmp_path, rppm, kind):
    """The mesh of a gas domain is not shown, as in Cycles: the gray world is all there is. As the domain is not
    evaluated, frames after its first one are rendered as well."""
    blend, exr = tmp_path / "fluid.blend", tmp_path / "fluid.exr"
    subprocess.run([sys.executable, "-c", WRITE, kind, blend], check=True, capture_output=True, timeout=60)
    frame = {"GAS": "4", "LIQUID": "1"}[kind]
    options = ("--samples", "1", "--resolution", "32x24", "--frame", frame)
    status, output, errors = rppm("render", blend, "-o", exr, *options)
    assert status == 0 and "fluid.exr" in output, errors
    combined = read_exr(exr).combined[..., :3]
    assert (combined.std() < 1e-6) == (kind == "GAS")
    assert ('"Cube": smoke and fire' in errors) == (kind == "GAS")
    assert "may abort" not in errors


@pytest.mark.long
def test_a_domain_that_may_abort_is_named_before(tmp_path, rppm):
    blend = tmp_path / "fluid.blend"
    subprocess.run([sys.executable, "-c", WRITE, "LIQUID", blend], check=True, capture_output=True, timeout=60)
    _, _, errors = rppm("render", blend, "-o", tmp_path / "fluid.exr", "--samples", "1", "--frame", "4")
    assert 'rppm: Object "Cube": Blender as a module may abort' in errors


ANIMATE = """
import sys
from types import SimpleNamespace as Data
from rppm_addon.commands.blend_files.fluid_domains import end_before_blender_aborts, note_fluid_domains
objects = []
for kind in ("GAS", "LIQUID"):
    domain = Data(domain_type=kind, cache_frame_start=1)
    objects.append(Data(name=kind, modifiers=[Data(type="FLUID", fluid_type="DOMAIN", domain_settings=domain)]))
bpy = Data(data=Data(objects=objects, filepath="fluid.blend"), app=Data(tempdir=sys.argv[1]))
for frame in (1, 2, 3):
    print("frame", frame, file=sys.stderr)
    note_fluid_domains(bpy, frame)
end_before_blender_aborts(7)
"""


def test_a_domain_of_liquid_is_named_once_and_its_files_are_removed(tmp_path):
    """In an animation, from the first frame on at which it may abort; the process ends without Blender's end."""
    folder = tmp_path / "blender_1"
    folder.mkdir()
    run = subprocess.run([sys.executable, "-c", ANIMATE, folder], capture_output=True, text=True, timeout=60)
    assert (run.returncode, folder.exists()) == (7, False)
    first, gas, second, warning, third = run.stderr.splitlines()
    assert (first, second, third) == ("frame 1", "frame 2", "frame 3") and '"LIQUID"' in warning and '"GAS"' in gas
