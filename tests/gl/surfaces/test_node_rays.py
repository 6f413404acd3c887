# SPDX-License-Identifier: GPL-3.0-or-later
"""Ambient Occlusion, Bevel and Raycast nodes against closed forms."""

import math
from pathlib import Path

import numpy as np
import pytest
import scenes
from support.render_states import assert_goes_on

from rppm_addon.gl.buffers.records import Record
from rppm_addon.integrator.surfaces.node_rays import NODE_RAY
from rppm_addon.scene import AovOutput, Light, LightKind, Link, Material, NodeGraph, Scene

SAMPLES, ITERATIONS, SIDE = 64, 4, 8
Record("RaycastAnswerParameters", world_origin="vec3", ray_stride="uint", ray_level="uint", ray_levels="uint")
SHADER = str(Path(__file__).parent / "raycast_answer.comp")


def glowing(kind: str, output: str, shown=None, **members) -> Material:
    """Shines as the node says; ``shown``: what of it, by a graph and a link."""
    graph = NodeGraph()
    link = graph.add(kind, output, samples=float(SAMPLES), **members)
    graph.surface = graph.add("emission", "emission", color=link if shown is None else shown(graph, link))
    return Material("glowing", graph)


def seen_from_above(surface: Material, around: list, height: float = 0.5, at: float = 0.0) -> Scene:
    """A small piece of a floor at (at, 0, 0), with what is around it."""
    sun, gray = Light("sun", LightKind.SUN, np.eye(4), np.ones(3)), scenes.diffuse(0.5, 0.5, 0.5)
    return scenes.scene_of(
        scenes.camera((at, 0, height), (at, 0, 0), 1e-3, SIDE), (scenes.square("floor", 50.0), surface),
        *((mesh, gray) for mesh in around), lights=[sun], iterations=ITERATIONS, photons=64, passes=(),
        camera_path_length=1, photon_path_length=1, use_final_gather=False, filter_width=0.0,
    )  # fmt: skip


def wall(x: float, height: float = 50.0):
    return scenes.rectangle("wall", (x, -50, 0), (x, 50, 0), (x, 50, height), (x, -50, height))


def ceiling(z: float):
    return scenes.square("ceiling", 50.0, z)


def beyond(t: float) -> float:
    """Return the share of a disk of radius 1 that lies beyond a line at a distance t from its center: rays by the
    cosine are spread evenly over the disk below them."""
    return (math.acos(t) - t * math.sqrt(1.0 - t * t)) / math.pi


OCCLUSION = [
    ("alone", [], 0.0, 1.0, 1.0),
    ("below a plane, too far", [ceiling(1.001)], 0.0, 1.0, 1.0),
    ("below a plane", [ceiling(0.8)], 0.0, 1.0, 0.64),
    ("below a plane, near", [ceiling(0.8)], 0.0, 50.0, (0.8 / 50.0) ** 2),
    ("in a corner", [wall(-1e-3)], 0.0, 1.0, 0.5),
    ("before a wall", [wall(-0.5)], 0.0, 1.0, 1.0 - beyond(0.5)),
    ("between two", [wall(-0.5), wall(0.25)], 0.0, 1.0, 1.0 - beyond(0.5) - beyond(0.25)),
    ("without a reach", [wall(-1e-3)], 0.0, 0.0, 1.0),
]


@pytest.mark.parametrize(("around", "at", "reach", "expected"), [case[1:] for case in OCCLUSION],
                         ids=[case[0] for case in OCCLUSION])  # fmt: skip
def test_occlusion(renderer, around, at, reach, expected):
    scene = seen_from_above(glowing("ambient_occlusion", "ao", distance=reach), around, at=at)
    values = renderer.render(scene).frame.combined[..., 0]
    rays = SAMPLES * ITERATIONS * SIDE * SIDE
    assert values.mean() == pytest.approx(expected, abs=5.0 * math.sqrt(expected * (1.0 - expected) / rays) + 2e-3)


def test_the_object_alone_and_its_inside(renderer):
    """Locally nothing is in the way; inside of a floor nothing is but what lies below it."""
    local = glowing("ambient_occlusion", "ao", options={"only_local": True}, distance=1.0)
    assert (renderer.render(seen_from_above(local, [ceiling(0.8)])).frame.combined[..., 0] == 1.0).all()
    below = glowing("ambient_occlusion", "ao", options={"inside": True}, distance=1.0)
    values = renderer.render(seen_from_above(below, [ceiling(0.8), ceiling(-0.5)])).frame.combined[..., 0]
    assert values.mean() == pytest.approx(0.25, abs=5.0 * 0.44 / math.sqrt(SAMPLES * ITERATIONS * SIDE * SIDE) + 2e-3)


def fold(surface: Material) -> Scene:
    """A mesh of a floor and a wall that meet at x = 0, of which a piece of the floor at x = 0.1 is seen."""
    corners = [(0, -50, 0), (50, -50, 0), (50, 50, 0), (0, 50, 0), (0, -50, 50), (0, 50, 50)]
    mesh = scenes.polygons("fold", np.array(corners, float), [(0, 1, 2, 3), (0, 3, 5, 4)])
    scene = seen_from_above(surface, [], at=0.1)
    scene.meshes[:] = [mesh]
    return scene


def upward(graph: NodeGraph, normal: Link) -> Link:
    return graph.add("separate_xyz", "z", vector=normal)


@pytest.mark.parametrize(("radius", "flat"), [(0.09, True), (0.3, False)])
def test_a_bevel_turns_the_normal_where_the_fold_is_near(renderer, radius, flat):
    """By the share of the fold's two sides in the disk, weighted by 10 (1 - r / R)^3 / (pi R^2)."""
    values = renderer.render(fold(glowing("bevel", "normal", upward, radius=radius))).frame.combined[..., 0]
    if flat:
        np.testing.assert_allclose(values, 1.0, rtol=1e-5)
        return
    spread = np.linspace(-radius, radius, 801)
    x, y = np.meshgrid(spread, spread)
    r = np.sqrt(0.1**2 + x * x + y * y)  # of points of the wall
    on_wall = np.maximum(1.0 - r / radius, 0.0)[x >= 0.0] ** 3
    on_floor = np.maximum(1.0 - np.hypot(x, y) / radius, 0.0)[x >= -0.1] ** 3
    normal = np.array([on_wall.sum(), on_floor.sum()])
    expected = normal[1] / np.linalg.norm(normal)
    assert 0.8 < expected < 0.99
    assert values.mean() == pytest.approx(expected, abs=0.01)


def test_a_cast_begins_where_another_ended(renderer):
    """Up to a ceiling, and from there by three times its normal through the floor to what lies below it; distances are
    in lengths of the direction. The first begins on the floor, which it does not meet."""
    graph = NodeGraph()
    up = graph.add("raycast", "hit_position", length=2.0)
    normal = graph.add("vector_math", "vector", options={"operation": "SCALE"}, scale=3.0,
                       vector=Link(up.node, "hit_normal"))  # fmt: skip
    below = graph.add("mapping", "vector", vector=up, location=(0.0, 0.0, -0.81))
    down = graph.add("raycast", "hit_distance", length=1.0, position=below, direction=normal)
    found = [Link(up.node, "hit_distance"), down, Link(down.node, "self_hit")]
    graph.surface = graph.add("emission", "emission", color=graph.add(
        "combine_xyz", "vector", **dict(zip("xyz", found, strict=True))))  # fmt: skip
    scene = seen_from_above(Material("casting", graph), [ceiling(0.8), ceiling(-0.31)])
    seen = renderer.render(scene).frame.combined[..., :3]
    np.testing.assert_allclose(seen, np.broadcast_to((0.8, 0.1, 0.0), seen.shape), atol=1e-5)
    local = glowing("raycast", "is_hit", options={"only_local": True}, length=2.0)
    assert (renderer.render(seen_from_above(local, [ceiling(0.8)])).frame.combined[..., 0] == 0.0).all()


def test_a_render_goes_on_bit_for_bit(mapper):
    graph = NodeGraph()
    beveled = graph.add("bevel", "normal", radius=0.3)
    occluded = graph.add("ambient_occlusion", "color", color=(0.5, 0.25, 1.0), normal=beveled)
    graph.surface = graph.add("emission", "emission", color=occluded)
    scene = fold(Material("both", graph))
    state = assert_goes_on(mapper, scene, "radiance")
    assert state.radiance[..., 0].std() > 0.0
    np.testing.assert_allclose(state.radiance[..., 2], 2.0 * state.radiance[..., 0], rtol=1e-5)


def test_a_pass_holds_what_rays_find(renderer):
    """Once: not once more for each time that the surface is evaluated to ask."""
    surface = glowing("ambient_occlusion", "ao", distance=1.0)
    surface.graph.aovs = [AovOutput("Shade", value=surface.graph.nodes[surface.graph.surface.node].inputs["color"])]
    scene = seen_from_above(surface, [ceiling(0.8)])
    scene.settings = scene.settings.with_values(aovs=("Shade.X",))
    frame = renderer.render(scene).frame
    np.testing.assert_allclose(frame.passes["Shade"].mean(), 0.64, atol=0.02)


@pytest.mark.parametrize("level", [0, 1])
def test_a_raycast_meets_nothing_until_it_was_traced(context, library, level):
    """The result that another hit left would name a triangle that is no more."""
    left = NODE_RAY.zeros(2)
    left["found"], left["direction"], left["reach"] = (1.0, 1.0, 0.0), (0.25, 0.25, 7.0), 3.0
    rays, results = context.moderngl.buffer(left.tobytes()), context.moderngl.buffer(reserve=16)
    blocks = {"NodeRays": rays, "Results": results}
    parameters = {"world_origin": (0.0, 0.0, 0.0), "ray_stride": 2, "ray_level": level, "ray_levels": 1}
    library.compute(SHADER).run(1, blocks, parameters)
    assert np.frombuffer(results.read(), np.float32).tolist() == ([7.0, 3.0, 1.0, 1.0] if level else [0.0] * 4)
    rays.release()
    results.release()
