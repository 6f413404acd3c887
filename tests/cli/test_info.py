# SPDX-License-Identifier: GPL-3.0-or-later
"""rppm info: the device, and the memory that a scene takes."""

import json

import pytest

from rppm_addon.gl.context.context import device_information

from .conftest import rppm_here, succeed


def test_the_memory_of_a_saved_scene(tmp_path, saved_scene):
    report = tmp_path / "new" / "info.json"
    output, _ = succeed(
        rppm_here, "info", "--scene", saved_scene, "--resolution", "40x30", "--json", report,
        "--set", "rppm.photons=2000", "--set", "rppm.max_photon_bounces=2",
    )  # fmt: skip
    told = json.loads(report.read_text())
    assert told["device"]["name"] in output
    (used,) = (device for device in told["device"]["devices"] if device["number"] == told["device"]["number"])
    assert used["name"] in told["device"]["name"]
    assert f"* --device {used['number']} or {used['identity']}: {used['name']}" in output
    assert used["memory"] > 1 << 28 and not used["problem"]
    memory = told["memory"]
    assert (memory["pixels"], memory["photons"], memory["segments"]) == (1200, 2000, 3)
    assert memory["ppm"]["film"] == 16 * 1200
    assert memory["ppm"]["photons"] == 64 * 2000 * 3
    assert memory["paper_bytes"] == 32 * 1200 + 64 * 2000 * 3
    assert memory["total_bytes"] == memory["ppm_bytes"] + sum(memory["working_bytes"].values())
    assert "R = 1,200 pixels (40 x 30), M = 2,000 photons an iteration, L = 3 segments" in output
    for size in (memory["ppm_bytes"], memory["paper_bytes"], memory["total_bytes"], *memory["working_bytes"].values()):
        assert f"{size:,}" in output


def test_the_memory_of_a_blend_file(tmp_path, rppm, blend_files):
    output, _ = succeed(rppm, "info", "--scene", blend_files[0], "--json", tmp_path / "info.json")
    memory = json.loads((tmp_path / "info.json").read_text())["memory"]
    assert (memory["pixels"], memory["photons"]) == (16 * 12, 1024)
    assert "32 R + 64 M L" in output


def test_options_of_a_scene_need_one():
    for options in (("--resolution", "8x8"), ("--set", "rppm.photons=10"), ("--frame", "1")):
        status, output, errors = rppm_here("info", *options)
        assert (status, output) == (1, "") and "--scene" in errors


def test_the_device_alone_as_json(tmp_path):
    output, _ = succeed(rppm_here, "info", "--json", tmp_path / "info.json")
    told = json.loads((tmp_path / "info.json").read_text())
    assert set(told) == {"blender", "device", "denoiser"} and told["device"]["limits"]
    assert f"Denoise  {told['denoiser']}\n" in output
    for name in ("Device ", "GL_MAX_SHADER_STORAGE_BLOCK_SIZE", "Missing "):
        assert name in output


@pytest.mark.parametrize("lacking", ["MESA_GL_VERSION_OVERRIDE=4.2", "MESA_EXTENSION_OVERRIDE=-GL_ARB_compute_shader"])
def test_a_driver_without_a_feature(rppm, monkeypatch, lacking):
    if "Mesa" not in device_information().driver:
        pytest.skip("only Mesa lets features be taken away")
    monkeypatch.setenv(*lacking.split("=", 1))
    status, _, errors = rppm("info")
    assert status == 1 and errors.startswith("rppm: no OpenGL 4.3 context") and "install a driver" in errors
    assert errors.count("\n") == 1
