# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene with something of everything that a scene can hold."""

import dataclasses

import numpy as np

from rppm_addon.scene import Camera, DirectLight, Image, Light, LightKind, LightLinking, Material, RenderSettings, Scene
from rppm_addon.scene.meshes import (
    AttributeDomain,
    Dicing,
    DicingView,
    Instance,
    InstanceArray,
    Mesh,
    MeshAttribute,
    MeshShape,
    Particle,
    ParticleArray,
    RayVisibility,
)
from rppm_addon.scene.motion import CameraMovement, Deformation, Movement, Shutter
from rppm_addon.scene.node_graphs import AovOutput, NodeGraph
from support.graphs import surface_graph
from support.lobes import Lobe, LobeKind, image_world, material


def graph_of_everything() -> NodeGraph:
    """Links, numbers, colors, options of both kinds, a table, an image and an attribute."""
    graph = NodeGraph()
    place = graph.add("uvmap", "uv", attribute="UVMap")
    image = graph.add("tex_image", "color", name="Picture", image=0, vector=place, options={"interpolation": "Cubic"})
    table = np.linspace(0, 1, 257 * 4, dtype=np.float32).reshape(257, 4)
    ramp = graph.add("val_to_rgb", "color", table=table, options={"constant": True}, fac=image)
    graph.surface = graph.add("bsdf_diffuse", "bsdf", color=ramp)
    graph.normal = graph.add("bump", "normal", height=0.5, normal=(0.0, 0.0, 1.0))
    graph.displacement = ramp
    graph.aovs = [AovOutput("Mask", color=ramp, value=0.25), AovOutput("Tint", (0.1, 0.2, 0.3))]
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
        dicing=Dicing(2.0, True, False, 1),
    )
    bare = dataclasses.replace(mesh, name="bare", corner_uv=None, dicing=None, shape=MeshShape.STRANDS)
    return Scene(
        camera=Camera(np.eye(4), (-1, 1, -0.5, 0.5), 64, 32, True, 0.2, 50.0, (1, 2, 30, 31)),
        meshes=[mesh, bare],
        instances=[
            Instance(0, np.diag([1, 2, 3, 1.0]), [0, -1], "object", 3, visibility=RayVisibility(5)),
            Instance(
                1,
                np.eye(4),
                particle=Particle(index=2.0, velocity=(1.0, 2.0, 3.0)),
                attributes={"a": (1.0, 2.0)},
                linking=LightLinking(receiver_light_set=2, light_set_membership=-3),
            ),
        ],
        instance_arrays=[
            InstanceArray(
                Instance(1, np.eye(4), [1], "many", 4, particle=Particle(index=1.0)),
                np.array([1, 3], np.int32),
                np.stack([np.eye(4), np.diag([2.0, 1.0, 1.0, 1.0])])[:, :3].astype(np.float32),
                np.array([0.25, 0.75]),
                ParticleArray(*rng.random((5, 2)), *rng.random((3, 2, 3), np.float32)),
                {"a": rng.random((2, 3))},
            )
        ],
        materials=[
            material("a", Lobe(LobeKind.GLASS, 0.5, (1, 0, 0), roughness=0.1), absorption=np.array([1, 2, 3.0])),
            Material("b", graph_of_everything(), abbe_number=30.0, on_round_shapes=True),
        ],
        lights=[
            Light(
                "sun",
                LightKind.SUN,
                np.eye(4),
                np.array([1, 2, 3.0]),
                sun_angle=0.1,
                max_bounces=3,
                linking=LightLinking(1, 63, -(1 << 63), (1 << 63) - 1),
            )
        ],
        world=dataclasses.replace(image_world(0), volume=surface_graph("volume_scatter", density=0.5)),
        images=[Image("i", rng.integers(0, 255, (2, 3, 4), np.uint8), "SRGB")],
        settings=RenderSettings(iterations=7, direct_light=DirectLight.PHOTONS),
        exposure=2.0,
        dicing_view=DicingView(0.5, 2.0, 7, Camera(np.eye(4), (-1, 1, -0.5, 0.5), 32, 16)),
        shutter=Shutter(
            np.linspace(0, 1, 5),
            [Movement(0, np.array([0, 0.5, 1]), rng.random((3, 4, 4)))],
            [Movement(0, np.array([0, 1.0]), rng.random((2, 4, 4)))],
            [Deformation(1, np.array([0, 1.0]), rng.random((2, 4, 3), np.float32), rng.random((2, 4, 3), np.float32))],
            CameraMovement(np.array([0, 1.0]), rng.random((2, 4, 4)), rng.random((2, 4))),
        ),
        neighbors=Shutter(np.ones(1), [Movement(1, np.array([0, 0.5, 1]), rng.random((3, 4, 4)))]),
        asset_names={"object": "house"},
        stamps={"Camera": "c"},
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
