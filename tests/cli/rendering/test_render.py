# SPDX-License-Identifier: GPL-3.0-or-later
"""rppm render and export on saved scenes and .blend files."""

import json
import signal
import sys

import numpy as np
import PIL.Image
import pytest
from cli.conftest import interrupt, rppm_here, start_rppm, succeed

from rppm_addon.pictures import read_exr
from rppm_addon.scene import load_scene


def expected_radiance(x, y):
    """Direct light of floor_scene at a floor point: albedo/pi times intensity times cosine over distance squared."""
    squared = (x + 1.0) ** 2 + (y - 1.0) ** 2 + 4.0
    return 0.5 / np.pi * 10.0 * (2.0 / np.sqrt(squared)) / squared


def test_a_saved_scene_renders_to_exr_png_and_json(tmp_path, rppm, saved_scene):
    exr, png, report = tmp_path / "new" / "out.exr", tmp_path / "new" / "out.png", tmp_path / "log" / "out.json"
    centers = ("--set", "rppm.filter_width=0")
    status, output, errors = rppm("render", saved_scene, "-o", exr, "-o", png, "--json", report, *centers)
    assert (status, "Traceback" in errors) == (0, False), errors
    assert "3 samples" in output
    assert "3.07 k photons" in output

    picture = read_exr(exr)
    assert picture.combined.shape == (12, 16, 4)
    # Pixel centers on the floor, 4 m below: x and y grow with column and row, rows from the bottom.
    columns, rows = np.meshgrid(np.arange(16), np.arange(12))
    x, y = (columns + 0.5) / 16 * 4 - 2, ((rows + 0.5) / 12 - 0.5) * 3
    inside = columns < 7
    np.testing.assert_allclose(picture.combined[inside][:, 0], expected_radiance(x, y)[inside], rtol=0.05)
    np.testing.assert_allclose(picture.layer("Depth")[inside], 4.0, rtol=1e-5)
    np.testing.assert_allclose(picture.layer("Normal")[inside], [[0, 0, 1]] * inside.sum(), atol=1e-5)
    beyond = columns > 8
    assert picture.combined[beyond][:, :3].max() == 0.0
    assert picture.layer("Depth")[beyond].min() == pytest.approx(1e10)
    with PIL.Image.open(png) as image:
        assert image.size == (16, 12)
        assert np.asarray(image)[:, :7, 0].min() > np.asarray(image)[:, 9:, 0].max()

    found = json.loads(report.read_text())
    assert found["statistics"]["iterations"] == 3
    assert found["statistics"]["photons"] == 3072
    assert found["seconds"] >= found["statistics"]["seconds"] > 0
    assert "blender" not in found
    assert picture.metadata["iterations"] == "3"
    assert picture.metadata["device"] == found["statistics"]["device"]


def test_options_reach_the_renderer(tmp_path, saved_scene):
    exr, report = tmp_path / "out.exr", tmp_path / "out.json"
    succeed(
        rppm_here, "render", saved_scene, "-o", exr, "--json", report, "--samples", 2, "--photons", 500,
        "--resolution", "24x8", "--set", "rppm.alpha=0.6", "--set", "rppm.direct_light=photons",
    )  # fmt: skip
    found = json.loads(report.read_text())
    assert found["settings"]["alpha"] == 0.6
    assert found["settings"]["direct_light"] == "PHOTONS"
    assert found["statistics"]["photons"] == 1000
    picture = read_exr(exr)
    assert picture.combined.shape == (8, 24, 4)
    # The longer side keeps its view of 4 m: the floor still ends at the middle.
    assert picture.layer("Depth")[:, :11].max() < 5.0
    assert picture.layer("Depth")[:, 13:].min() > 1e9


def test_snapshots_and_seconds_count_from_the_scene(tmp_path, rppm, saved_scene):
    exr, report = tmp_path / "out.exr", tmp_path / "out.json"
    _, errors = succeed(
        rppm, "render", saved_scene, "-o", exr, "--seconds", 3, "--snapshots", "1,2,50", "--json", report
    )
    assert "50 s" in errors
    found = json.loads(report.read_text())
    assert [entry["mark"] for entry in found["snapshots"]] == [1.0, 2.0]
    assert found["snapshots_missed"] == [50.0]
    for entry in found["snapshots"]:
        assert entry["mark"] <= entry["seconds"]
        assert read_exr(tmp_path / f"out_{entry['mark']:g}s.exr").combined[:, :7].min() > 0.0
    assert found["seconds"] >= 3.0
    iterations = [entry["iterations"] for entry in found["snapshots"]] + [found["statistics"]["iterations"]]
    assert iterations == sorted(set(iterations))
    assert not (tmp_path / "out_50s.exr").exists()


def test_snapshots_alone_say_how_long_to_render(tmp_path, saved_scene):
    picture, report = tmp_path / "out.exr", tmp_path / "out.json"
    succeed(rppm_here, "render", saved_scene, "-o", picture, "--snapshots", "0.5", "--json", report)
    found = json.loads(report.read_text())
    assert found["snapshots_missed"] == []
    assert found["seconds"] >= 0.5
    assert found["statistics"]["iterations"] < found["settings"]["iterations"]


def test_interrupting_keeps_what_is_there(tmp_path, saved_scene):
    exr, snapshot = tmp_path / "out.exr", tmp_path / "out_0.2s.exr"
    with start_rppm("render", saved_scene, "-o", exr, "--seconds", 90, "--snapshots", 0.2) as process:
        errors = interrupt(process, signal.SIGINT, snapshot.exists)
    assert process.returncode == 130 and "interrupted" in errors
    assert int(read_exr(exr).metadata["iterations"]) >= 1


def test_a_blend_file_renders_inside_blender(tmp_path, rppm, blend_files):
    exr, png, report = tmp_path / "out.exr", tmp_path / "out.png", tmp_path / "out.json"
    output, _ = succeed(
        rppm, "render", blend_files[0], "-o", exr, "-o", png, "--json", report, "--snapshots", 1, "--samples", 5
    )
    assert output.count("\n") == 1, output
    found = json.loads(report.read_text())
    assert found["statistics"]["iterations"] == 5
    assert found["blender"]["frame"] == 1
    assert min(found["blender"][f"{what}_seconds"] for what in ("start", "load", "export")) > 0.0
    picture = read_exr(exr)
    assert picture.combined.shape == (12, 16, 4)
    assert picture.combined[:, :7, :3].min() > 0.0
    assert picture.combined[:, 9:, :3].max() == 0.0
    with PIL.Image.open(png) as image:
        assert image.size == (16, 12)
        assert np.asarray(image)[:, :7].min() > np.asarray(image)[:, 9:].max()


@pytest.mark.long
def test_frame_and_data_paths_change_a_blend_render(tmp_path, rppm, blend_files):
    dark, double, single = (tmp_path / f"{name}.exr" for name in ("dark", "double", "single"))
    for path, options in (
        (single, []),
        (double, ["--set", 'objects["Light"].data.energy=600']),
        (dark, ["--frame", "2", "--set", "render.resolution_percentage=50"]),
    ):
        succeed(rppm, "render", blend_files[0], "-o", path, *options)
    lit = read_exr(single).combined[:, :7, 0]
    np.testing.assert_allclose(read_exr(double).combined[:, :7, 0], 2 * lit, rtol=1e-3)
    assert read_exr(dark).combined.shape == (6, 8, 4)
    assert read_exr(dark).combined[:, :3, 0].max() < 0.05 * lit.min()


def test_an_exported_scene_renders_like_its_blend_file(tmp_path, rppm, blend_files):
    scene, inside, outside = tmp_path / "new" / "s.npz", tmp_path / "inside.exr", tmp_path / "outside.exr"
    output, _ = succeed(rppm, "export", blend_files[0], "-o", scene, "--set", "rppm.seed=7")
    assert output.startswith("2 triangles, 1 lights")
    assert load_scene(scene).settings.seed == 7
    assert rppm_here("render", scene, "-o", outside)[0] == 0
    assert rppm("render", blend_files[0], "-o", inside, "--set", "rppm.seed=7")[0] == 0
    np.testing.assert_allclose(read_exr(outside).combined, read_exr(inside).combined, rtol=1e-5, atol=1e-7)


@pytest.mark.parametrize(
    ("arguments", "status", "message"),
    [
        (["render", "{npz}"], 2, "-o"),
        (["render", "{npz}", "-o", "a.tif"], 2, "not the name of an .exr or .png"),
        (["render", "{npz}", "-o", "a.exr", "--seconds", "0"], 2, "above 0"),
        (["render", "{npz}", "-o", "a.exr", "--seconds", "3", "--samples", "2"], 2, "not allowed with"),
        (["render", "{npz}", "-o", "a.exr", "--snapshots", "3,2"], 2, "ascending"),
        (["render", "{npz}", "-o", "a.exr", "--resolution", "0x9"], 2, "640x480"),
        (["render", "{npz}", "-o", "/dev/null/a.exr"], 1, "cannot be written"),
        (["render", "{npz}", "-o", "{tmp}/a.exr", "--frame", "3"], 1, "one frame"),
        (["render", "{npz}", "-o", "{tmp}/a.exr", "--set", "render.fps=3"], 1, "needs a .blend"),
        (["render", "{npz}", "-o", "{tmp}/a.exr", "--set", "rppm.alfa=3"], 1, "no setting alfa"),
        (["render", "{npz}", "-o", "{tmp}/a.exr", "--set", "rppm.alpha=3"], 1, "set it to 0.01 to 0.999999"),
        (["render", "{npz}", "-o", "{tmp}/a.exr", "--photons", "99999999"], 2, "photons"),
        (["render", "{npz}", "-o", "{tmp}/a.exr", "--device", "77"], 1, "device"),
        (["render", "{tmp}/absent.npz", "-o", "{tmp}/a.exr"], 1, "absent.npz"),
        (["render", "{tmp}/absent.blend", "-o", "{tmp}/a.exr"], 1, "does not exist"),
        (["render", "{tmp}/scene.obj", "-o", "{tmp}/a.exr"], 1, "neither"),
        (["render", "{broken}", "-o", "{tmp}/a.exr"], 1, "cannot be opened"),
        (["render", "{blend}", "-o", "{tmp}/a.exr", "--set", "no.such=1"], 1, "nothing of that name"),
        (["render", "{no_camera}", "-o", "{tmp}/a.exr"], 1, "has no camera"),
        (["export", "{no_camera}", "-o", "{tmp}/a.npz"], 1, "has no camera"),
        (["export", "{npz}", "-o", "{tmp}/a.npz"], 1, "no .blend file"),
    ],
)
def test_errors_are_one_line(tmp_path, rppm, saved_scene, blend_files, arguments, status, message):
    broken = tmp_path / "broken.blend"
    broken.write_bytes(b"BLENDER but not really")
    names = {"npz": saved_scene, "tmp": tmp_path, "broken": broken}
    names["blend"], names["no_camera"] = blend_files
    opens_blender = any(word in " ".join(arguments) for word in (".blend", "{blend}", "{no_camera}", "{broken}"))
    run = rppm if opens_blender else rppm_here
    got, output, errors = run(*(argument.format(**names) for argument in arguments))
    assert (got, output) == (status, "")
    lines = [line for line in errors.splitlines() if not line.endswith("preparing the device")]
    assert len(lines) == 1, errors
    assert message in lines[0]
    assert lines[0].startswith("rppm")
    assert not (tmp_path / "a.exr").exists()


def test_a_saved_scene_needs_no_bpy(tmp_path, monkeypatch, saved_scene):
    """The program must not even look for bpy when it renders a saved scene."""
    monkeypatch.setitem(sys.modules, "bpy", None)  # importing it now raises ImportError
    succeed(rppm_here, "render", saved_scene, "-o", tmp_path / "out.exr")
