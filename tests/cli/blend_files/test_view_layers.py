# SPDX-License-Identifier: GPL-3.0-or-later
"""View layers and stereo of .blend files in the program: one file with all, or one each."""

import json
from pathlib import Path

import numpy as np
import OpenEXR
import PIL.Image
import pytest
from cli.conftest import run_in_blender, succeed

from rppm_addon.commands.picture_set import path_of_picture
from rppm_addon.pictures import PictureName, read_exr

_MAKE_LAYERS = """
bpy.ops.wm.open_mainfile(filepath=sys.argv[1])
scene = bpy.context.scene
scene.rppm.samples, scene.rppm.photons = 3, 256
scene.view_layers[0].use_pass_z = True
override = bpy.data.materials.new("Gray")
override.use_nodes = True
override.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.1, 0.1, 0.1, 1.0)
for name, use in (("Gray one", True), ("Off", False)):
    layer = scene.view_layers.new(name)
    layer.use, layer.material_override, layer.use_pass_z = use, override, False
scene.view_layers["Gray one"].samples = 2
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[2])
"""
FIRST, GRAY = "ViewLayer", "Gray one"


@pytest.fixture(scope="module")
def layers_file(tmp_path_factory, blend_files):
    """The floor with two view layers in use, the second all gray with fewer samples, and one that is not."""
    path = tmp_path_factory.mktemp("layers") / "layers.blend"
    run_in_blender(_MAKE_LAYERS, blend_files[0], path)
    return path


def planes_of(path) -> dict[str, np.ndarray]:
    """By the names of the parts' channels, with the view's behind it where there is one."""
    with OpenEXR.File(str(path), separate_channels=True) as file:
        return {
            f"{name}-{part.header['view']}" if "view" in part.header else name: channel.pixels
            for part in file.parts
            for name, channel in part.channels.items()
        }


def pixels(path) -> np.ndarray:
    with PIL.Image.open(path) as image:
        return np.asarray(image).astype(int)


def test_all_layers_come_into_one_file(tmp_path, rppm, layers_file):
    exr, png, told = tmp_path / "out.exr", tmp_path / "out.png", tmp_path / "out.json"
    output, _ = succeed(rppm, "render", layers_file, "-o", exr, "-o", png, "--json", told)
    assert f"{FIRST}: 3 samples" in output and f"{GRAY}: 2 samples" in output and "out_Gray_one.png" in output
    planes = planes_of(exr)
    assert {name.rpartition(".")[0] for name in planes} == {
        f"{layer}.{name}" for layer in (FIRST, GRAY) for name in ("Combined", "Depth", "Normal")
    }
    report = json.loads(told.read_text())
    assert [picture["layer"] for picture in report["pictures"]] == [FIRST, GRAY]
    assert [picture["statistics"]["iterations"] for picture in report["pictures"]] == [3, 2]
    with OpenEXR.File(str(exr)) as file:
        assert file.header()["rppm.Gray one.iterations"] == "2"
        assert file.header()["BlenderMultiChannel"]
    # Each is what it is alone, under the names of a single picture.
    alone_exr, alone_png = tmp_path / "alone.exr", tmp_path / "alone.png"
    succeed(rppm, "render", layers_file, "--view-layer", GRAY, "-o", alone_exr, "-o", alone_png)
    alone = read_exr(alone_exr)
    for number, channel in enumerate("RGBA"):
        np.testing.assert_array_equal(planes[f"{GRAY}.Combined.{channel}"][::-1], alone.combined[..., number])
    np.testing.assert_array_equal(planes[f"{GRAY}.Depth.Z"][::-1], alone.channels["Depth.Z"])
    beside = pixels(tmp_path / "out_Gray_one.png")
    assert np.abs(beside - pixels(alone_png)).max() <= 1  # Blender dithers what it has rendered itself
    assert np.abs(beside - pixels(png)).max() > 5


def test_layers_that_are_named(tmp_path, rppm, layers_file):
    status, _, errors = rppm("render", layers_file, "--view-layer", "Nowhere", "-o", tmp_path / "out.exr")
    assert (status, errors.count("\n")) == (1, 1)
    assert f'there is no view layer "Nowhere"; there are {FIRST}, {GRAY}, Off' in errors


@pytest.mark.long
def test_parts_of_layers_are_gone_on_with_and_merged(tmp_path, rppm, layers_file):
    whole, merged, merged_png = (tmp_path / name for name in ("whole.exr", "merged.exr", "merged.png"))
    for arguments in (
        ("render", layers_file, "-o", whole, "--samples", 4),
        ("render", layers_file, "-o", tmp_path / "a.exr", "--samples-range", "0:2"),
        ("render", layers_file, "-o", tmp_path / "b.exr", "--samples-range", "2:4"),
        ("merge", tmp_path / "a.exr", tmp_path / "b.exr", "-o", merged, "-o", merged_png),
    ):
        output, _ = succeed(rppm, *arguments)
    assert "Gray one: 4 samples" in output
    expected, found = planes_of(whole), planes_of(merged)
    assert found.keys() == expected.keys()
    for name, values in expected.items():
        np.testing.assert_allclose(found[name], values, rtol=1e-5, atol=1e-6, err_msg=name)
    assert (tmp_path / "merged_Gray_one.png").is_file() and merged_png.is_file()
    (tmp_path / "b_Gray_one.exr").unlink()
    status, _, errors = rppm("merge", tmp_path / "a.exr", tmp_path / "b.exr", "-o", merged)
    assert status == 1 and "the part of Gray one, is not there" in errors
    kept, resumed = tmp_path / "kept.exr", tmp_path / "resumed.exr"
    for more in (("--samples", 2), ("--samples", 4, "--resume")):
        succeed(rppm, "render", layers_file, "-o", resumed, "--checkpoint", kept, *more)
    assert (tmp_path / "kept_Gray_one.exr").is_file()
    for name, values in planes_of(resumed).items():
        np.testing.assert_array_equal(values, expected[name], name)


def test_views_are_in_the_file(tmp_path, rppm, blend_files):
    exr, png = tmp_path / "out_####.exr", tmp_path / "out_####.png"
    stereo = ("--set", "render.use_multiview=true", "--set", 'objects["Camera"].data.stereo.interocular_distance=0.5')
    output, _ = succeed(rppm, "render", blend_files[0], "--frames", "1", "-o", exr, "-o", png, *stereo)
    assert "left: 3 samples" in output
    planes = planes_of(tmp_path / "out_0001.exr")
    left, right = (planes[f"ViewLayer.Depth.Z-{eye}"] < 1e9 for eye in ("left", "right"))
    assert left.any() and (left != right).any()
    assert (tmp_path / "out_0001.png").is_file() and (tmp_path / "out_0001_right.png").is_file()


def test_names_of_files():
    names = [PictureName("A b", "left"), PictureName("A b", "right"), PictureName("C", "left")]
    paths = [path_of_picture(Path("x.exr"), name, names).name for name in names]
    assert paths == ["x.exr", "x_A_b_right.exr", "x_C_left.exr"]
