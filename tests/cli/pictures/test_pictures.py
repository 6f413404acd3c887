# SPDX-License-Identifier: GPL-3.0-or-later
"""EXR and PNG files: channels, values, which way is up, and errors."""

import numpy as np
import OpenEXR
import PIL.Image
import pytest

from rppm_addon.commands.picture_files import write_png
from rppm_addon.pictures import PictureError, Placement, read_exr, standard_view, write_exr
from rppm_addon.scene.common.working_space import ACESCG


@pytest.fixture
def frame():
    """Every value different, so that any swap of rows, columns or channels shows."""
    random = np.random.default_rng(1)
    return {
        "combined": random.uniform(0.0, 9.0, (5, 7, 4)).astype(np.float32),
        "Depth": random.uniform(0.0, 1e10, (5, 7)).astype(np.float32),
        "Normal": random.uniform(-1.0, 1.0, (5, 7, 3)).astype(np.float32),
    }


def test_exr_holds_plain_channels_with_the_top_row_first(tmp_path, frame):
    path = tmp_path / "made" / "for_it" / "picture.exr"
    write_exr(path, frame["combined"], {name: frame[name] for name in ("Depth", "Normal")})
    with OpenEXR.File(str(path), separate_channels=True) as file:
        channels = file.channels()
        assert set(channels) == {"R", "G", "B", "A", "Depth.Z", "Normal.X", "Normal.Y", "Normal.Z"}
        assert {channel.pixels.dtype for channel in channels.values()} == {np.dtype(np.float32)}
        np.testing.assert_array_equal(channels["G"].pixels[0], frame["combined"][4, :, 1])
        np.testing.assert_array_equal(channels["Normal.Y"].pixels, frame["Normal"][::-1, :, 1])
        np.testing.assert_array_equal(channels["Depth.Z"].pixels, frame["Depth"][::-1])
    assert [entry.name for entry in path.parent.iterdir()] == ["picture.exr"]


def test_exr_reads_back_bit_for_bit(tmp_path, frame):
    path = tmp_path / "picture.exr"
    placement = Placement(20, 10, x=3, y=2)
    metadata = {"iterations": 12, "photons": 5_000_000_000, "device": "a device"}
    write_exr(path, frame["combined"], {"Depth": frame["Depth"], "Normal": frame["Normal"]}, metadata, placement)
    picture = read_exr(path)
    np.testing.assert_array_equal(picture.combined, frame["combined"])
    np.testing.assert_array_equal(picture.layer("Depth"), frame["Depth"])
    np.testing.assert_array_equal(picture.layer("Normal"), frame["Normal"])
    assert picture.metadata == {"iterations": "12", "photons": "5000000000", "device": "a device"}
    assert picture.placement == placement


def test_exr_of_one_pixel_and_of_special_values(tmp_path):
    path = tmp_path / "picture.exr"
    combined = np.array([[[np.inf, -1.0, 1e-30, 0.0]]], np.float32)
    write_exr(path, combined)
    np.testing.assert_array_equal(read_exr(path).combined, combined)


def test_what_cannot_be_written_or_read_is_named(tmp_path):
    (tmp_path / "file").write_text("not a folder")
    with pytest.raises(PictureError, match=r"file/picture\.exr cannot be written"):
        write_exr(tmp_path / "file" / "picture.exr", np.zeros((1, 1, 4)))
    with pytest.raises(PictureError, match="cannot be read as EXR"):
        read_exr(tmp_path / "file")
    with pytest.raises(PictureError, match="cannot be read as EXR"):
        read_exr(tmp_path / "absent.exr")


def test_a_failed_write_keeps_the_old_file_and_leaves_no_other(tmp_path, monkeypatch):
    path = tmp_path / "picture.exr"
    write_exr(path, np.ones((2, 2, 4)))

    def fail(*_):
        raise RuntimeError("disk full")

    monkeypatch.setattr(OpenEXR.File, "write", fail)
    with pytest.raises(PictureError, match="disk full"):
        write_exr(path, np.zeros((2, 2, 4)))
    monkeypatch.undo()
    assert read_exr(path).combined.min() == 1.0
    assert [entry.name for entry in tmp_path.iterdir()] == ["picture.exr"]


def test_png_reads_back_the_right_way_up(tmp_path):
    random = np.random.default_rng(2)
    for count in (3, 4):
        pixels = random.integers(0, 256, (3, 4, count), dtype=np.uint8)
        write_png(tmp_path / "picture.png", pixels)
        with PIL.Image.open(tmp_path / "picture.png") as image:
            np.testing.assert_array_equal(np.asarray(image), pixels[::-1])


def test_standard_view_shows_working_spaces_as_rec709():
    white_and_red = np.array([[[0.5, 0.5, 0.5], ACESCG.from_rec709(np.array([0.2158605, 0.0, 0.0]))]])
    assert standard_view(white_and_red, ACESCG).tolist() == [[[188, 188, 188], [128, 0, 0]]]


def test_standard_view_is_the_srgb_curve_on_straight_color():
    combined = np.array([[[0.0, 0.0031308, 0.2158605, 1.0], [0.1, 0.2, 0.25, 0.5], [7.0, np.nan, -3.0, 1.0]]])
    shown = standard_view(combined)
    # 0.2158605 is the linear value of 128; 0.2/0.5 = 0.4 and 0.25/0.5 = 0.5 encode to 0.66519 and 0.73536
    assert shown[0, 0].tolist() == [0, 10, 128, 255]
    assert shown[0, 1, 1:].tolist() == [170, 188, 128]
    assert shown[0, 2].tolist() == [255, 0, 0, 255]
