# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings and storage of scenes."""

import dataclasses

import numpy as np
import pytest
from lobes import Lobe, LobeKind, image_world, material

from rppm_addon.commands.saved_scene import camera_at_resolution
from rppm_addon.materials.compiler import compile_graph
from rppm_addon.scene import (
    Aperture,
    AttributeDomain,
    Camera,
    DirectLight,
    Image,
    Instance,
    Light,
    LightKind,
    Material,
    Mesh,
    MeshAttribute,
    NodeGraph,
    Panorama,
    PanoramaKind,
    Particle,
    RenderSettings,
    Scene,
    load_scene,
    save_scene,
)
from rppm_addon.scene.errors import SceneError, SettingsError
from rppm_addon.scene.meshes import RayVisibility


def graph_of_everything() -> NodeGraph:
    """Links, numbers, colours, options of both kinds, a table, an image and an attribute."""
    graph = NodeGraph()
    place = graph.add("uvmap", "uv", attribute="UVMap")
    image = graph.add("tex_image", "color", name="Picture", image=0, vector=place, options={"interpolation": "Cubic"})
    table = np.linspace(0, 1, 257 * 4, dtype=np.float32).reshape(257, 4)
    ramp = graph.add("val_to_rgb", "color", table=table, options={"constant": True}, fac=image)
    graph.surface = graph.add("bsdf_diffuse", "bsdf", color=ramp)
    graph.normal = graph.add("bump", "normal", height=0.5, normal=(0.0, 0.0, 1.0))
    return graph


def full_scene() -> Scene:
    rng = np.random.default_rng(0)
    mesh = Mesh(
        "m",
        rng.random((4, 3), np.float32),
        np.arange(4, dtype=np.int32),
        rng.random((4, 3), np.float32),
        np.array([[0, 1, 2], [0, 2, 3]], np.int32),
        np.array([0, 1], np.int32),
        rng.random((4, 2), np.float32),
        attributes={"heat": MeshAttribute(AttributeDomain.CORNER, rng.random((4, 3), np.float32))},
    )
    bare = dataclasses.replace(mesh, name="bare", corner_uv=None)
    return Scene(
        camera=Camera(np.eye(4), (-1, 1, -0.5, 0.5), 64, 32, True, 0.2, 50.0, (1, 2, 30, 31)),
        meshes=[mesh, bare],
        instances=[
            Instance(0, np.diag([1, 2, 3, 1.0]), [0, -1], "object", 3, visibility=RayVisibility(5)),
            Instance(
                1, np.eye(4), particle=Particle(index=2.0, velocity=(1.0, 2.0, 3.0)), attributes={"a": (1.0, 2.0)}
            ),
        ],
        materials=[
            material("a", Lobe(LobeKind.GLASS, 0.5, (1, 0, 0), roughness=0.1), absorption=np.array([1, 2, 3.0])),
            Material("b", graph_of_everything()),
        ],
        lights=[Light("sun", LightKind.SUN, np.eye(4), np.array([1, 2, 3.0]), sun_angle=0.1)],
        world=image_world(0),
        images=[Image("i", rng.integers(0, 255, (2, 3, 4), np.uint8), "SRGB")],
        settings=RenderSettings(iterations=7, direct_light=DirectLight.PHOTONS),
        exposure=2.0,
        warnings=["w"],
    )


def assert_same(first, second):
    assert type(first) is type(second)
    if dataclasses.is_dataclass(first):
        for field in dataclasses.fields(first):
            assert_same(getattr(first, field.name), getattr(second, field.name))
    elif isinstance(first, np.ndarray):
        assert first.dtype == second.dtype
        np.testing.assert_array_equal(first, second)
    elif isinstance(first, dict):
        assert first.keys() == second.keys()
        for name in first:
            assert_same(first[name], second[name])
    elif isinstance(first, list | tuple):
        assert len(first) == len(second)
        for a, b in zip(first, second, strict=True):
            assert_same(a, b)
    else:
        assert first == second


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


def test_other_files_are_refused_in_one_line(tmp_path):
    (tmp_path / "a.npz").write_bytes(b"not a scene")
    np.savez(tmp_path / "b.npz", x=np.zeros(3))
    for name in ("a.npz", "b.npz", "absent.npz"):
        with pytest.raises(SceneError, match="rppm export") as error:
            load_scene(tmp_path / name)
        assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("iterations", 0), ("photons", 0), ("photons", 1 << 23), ("alpha", 1.0), ("alpha", 0.0), ("radius_scale", 0.0),
        ("camera_path_length", 0), ("photon_path_length", 65), ("cubemap_resolution", 100), ("seed", -1),
        ("specular_roughness", 1.1), ("radius_scale", float("nan")), ("time_limit", -1.0), ("filter_width", -1.0),
    ],
)  # fmt: skip
def test_bad_settings_are_named(name, value):
    with pytest.raises(SettingsError, match=f"^{name} is .*; set it to"):
        dataclasses.replace(RenderSettings(), **{name: value}).validate()


def test_default_settings_are_valid():
    RenderSettings().validate()


def test_settings_from_text():
    settings = RenderSettings().with_values(
        iterations="3", alpha="0.5", direct_light="photons", film_transparent="true"
    )
    assert (settings.iterations, settings.alpha) == (3, 0.5)
    assert settings.direct_light is DirectLight.PHOTONS and settings.film_transparent is True
    with pytest.raises(SettingsError, match="there is no setting nonsense"):
        RenderSettings().with_values(nonsense=1)
    with pytest.raises(SettingsError, match="iterations cannot be 'many'"):
        RenderSettings().with_values(iterations="many")


def test_radius_limits_must_be_in_order():
    with pytest.raises(SettingsError, match="raise it"):
        RenderSettings(radius_minimum=2.0, radius_maximum=1.0).validate()
