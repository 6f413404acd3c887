# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings and storage of scenes."""

import dataclasses

import numpy as np
import pytest
from support.full_scene import assert_same, full_scene

from rppm_addon.commands.saved_scene import camera_at_resolution
from rppm_addon.integrator.common.records.photons import PHOTON_SEGMENT_SHIFT
from rppm_addon.materials.compiler.compiler import compile_graph
from rppm_addon.scene import (
    Aperture,
    Camera,
    DirectLight,
    Panorama,
    PanoramaKind,
    RenderSettings,
    Scene,
    load_scene,
    save_scene,
)
from rppm_addon.scene.errors import SceneError, SettingsError
from rppm_addon.scene.settings import MOST_PHOTONS, MOST_SEGMENTS
from rppm_addon.scene.settings.setting_info import settings_of
from rppm_addon.scene.storage import storage
from tools import settings_table


def test_a_stored_scene_comes_back_whole(tmp_path):
    scene = full_scene()
    save_scene(scene, tmp_path / "scene.npz")
    assert_same(scene, load_scene(tmp_path / "scene.npz"))


def test_lens_and_panorama_come_back(tmp_path):
    scene = full_scene()
    scene.camera.aperture = Aperture(0.01, 3.0, 5, 0.2, 1.5)
    scene.camera.panorama = Panorama(PanoramaKind.MIRRORBALL, sensor=(36.0, 18.0))
    save_scene(scene, tmp_path / "scene.npz")
    assert_same(scene, load_scene(tmp_path / "scene.npz"))


def test_other_resolutions_of_a_panorama():
    camera = Camera(np.eye(4), (0, 1, 0, 1), 64, 64, panorama=Panorama(PanoramaKind.FISHEYE_EQUISOLID))
    wide = camera_at_resolution(camera, 200, 100)
    assert wide.window == (0, 1, 0, 1) and wide.panorama.sensor == (36.0, 18.0)
    assert camera_at_resolution(wide, 50, 100).panorama.sensor == (18.0, 36.0)


def test_a_stored_graph_compiles_to_the_same(tmp_path):
    scene = full_scene()
    save_scene(scene, tmp_path / "scene.npz")
    for before, after in zip(scene.materials, load_scene(tmp_path / "scene.npz").materials, strict=True):
        assert compile_graph(before.graph) == compile_graph(after.graph)


def test_what_another_version_saved_is_refused_in_one_line(tmp_path, monkeypatch):
    path = tmp_path / "scene.npz"
    save_scene(full_scene(), path)
    monkeypatch.setattr(storage, "decode", lambda *given: {}["an old setting"])
    with pytest.raises(SceneError, match="an old setting.*export it again"):
        load_scene(path)
    old = storage.FORMAT
    monkeypatch.setattr(storage, "FORMAT", old + 1)
    with pytest.raises(SceneError, match=f"scene format {old}, not {old + 1}; export it again"):
        load_scene(path)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("iterations", 0), ("photons", -1), ("photons", 1 << 23), ("alpha", 1.0), ("alpha", 0.0), ("radius_scale", 0.0),
        ("camera_path_length", 0), ("photon_path_length", 1026), ("cubemap_resolution", 100), ("seed", -1),
        ("specular_roughness", 1.1), ("radius_scale", float("nan")), ("time_limit", -1.0), ("filter_width", -1.0),
        ("max_bounces", -1), ("transparent_max_bounces", 1025),
    ],
)  # fmt: skip
def test_bad_settings_are_named(name, value):
    shown = settings_of(RenderSettings)[name].property_of(name)
    with pytest.raises(SettingsError, match=f"^{shown} is .*; set it to"):
        dataclasses.replace(RenderSettings(), **{name: value}).validate()


@pytest.mark.parametrize(
    ("asked", "size", "photons"),
    [
        (0, (256, 256), 65536), (0, (16, 12), 8192), (0, (480, 360), 172800), (0, (1920, 1080), 262144),
        (7, (256, 256), 7),
    ],
)  # fmt: skip
def test_automatic_photons_follow_the_pixels(asked, size, photons):
    settings = RenderSettings(photons=asked)
    assert settings.photons_for(*size) == photons
    assert Scene(Camera(np.eye(4), (-1.0, 1.0, -1.0, 1.0), *size), settings=settings).photon_count == photons


def test_paths_are_limited_as_a_whole_and_by_parts():
    """The record of a photon tells so many apart."""
    assert MOST_PHOTONS <= 1 << PHOTON_SEGMENT_SHIFT and MOST_SEGMENTS <= 1 << 32 - PHOTON_SEGMENT_SHIFT
    settings = RenderSettings(max_bounces=5, photon_path_length=3)
    assert (settings.camera_bounces, settings.photon_bounces) == (5, 2)
    settings = RenderSettings(max_bounces=1024, transparent_max_bounces=1024, camera_path_length=8)
    assert (settings.camera_bounces, settings.photon_bounces) == (7, 1024)
    assert settings.photon_segments == MOST_SEGMENTS


def test_settings_from_text():
    settings = RenderSettings().with_values(
        iterations="3", alpha="0.5", direct_light="photons", film_transparent="true"
    )
    assert (settings.iterations, settings.alpha) == (3, 0.5)
    assert settings.direct_light is DirectLight.PHOTONS and settings.film_transparent is True
    with pytest.raises(SettingsError, match="there is no setting nonsense"):
        RenderSettings().with_values(nonsense=1)


def test_settings_by_the_names_of_users():
    settings = RenderSettings().with_properties(
        {"samples": "3", "max_camera_bounces": "4", "max_photon_bounces": 0, "passes": "Depth, UV"}
    )
    assert (settings.iterations, settings.camera_path_length, settings.photon_path_length) == (3, 5, 1)
    assert settings.passes == ("Depth", "UV")
    with pytest.raises(SettingsError, match="there is no setting iterations; the settings are samples, "):
        RenderSettings().with_properties({"iterations": 1})
    with pytest.raises(SettingsError, match="samples cannot be 'many'"):
        RenderSettings().with_properties({"samples": "many"})
    with pytest.raises(SettingsError, match="^max_camera_bounces is 1025; set it to 0 to 1024$"):
        RenderSettings().with_properties({"max_camera_bounces": 1025}).validate()


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("iterations", "1 or more"), ("photons", "0 (automatic) or 1 to 4194304"), ("alpha", "0.01 to 0.999999"),
        ("time_limit", "0 (no limit) or seconds"), ("radius_maximum", "0 (automatic) or meters"),
        ("filter_width", "0 to 20 pixels"),
    ],
)  # fmt: skip
def test_what_is_said_of_ranges(name, words):
    assert settings_of(RenderSettings)[name].range_text == words


def test_single_precision_is_in_the_range():
    settings = RenderSettings(alpha=float(np.float32(0.01)), radius_scale=float(np.float32(0.01)))
    settings.validate()
    assert not settings_of(RenderSettings)["alpha"].accepts(0.00999)


def test_radius_limits_must_be_in_order():
    with pytest.raises(SettingsError, match="raise it"):
        RenderSettings(radius_minimum=2.0, radius_maximum=1.0).validate()


def test_the_page_of_settings_is_that_of_the_code():
    text = settings_table.PAGE.read_text(encoding="utf-8")
    assert text == settings_table.page(text), "run python tools/settings_table.py"
    assert "| Samples | `samples` | 128 | 1 or more |" in text
