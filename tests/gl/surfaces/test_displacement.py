# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices that are moved by what nodes give."""

import dataclasses
import weakref

import numpy as np
import pytest
from rendering import radiance_of

from rppm_addon.integrator.surfaces.displacement import Displacement
from rppm_addon.integrator.viewport.first_look import FirstLook
from rppm_addon.materials.tables import MaterialTables
from rppm_addon.scene import Deformation, Light, LightKind, Material, NodeGraph, RenderSettings, Scene, Shutter, World
from rppm_addon.scene.camera import Camera, Texels
from rppm_addon.scene.meshes import (
    SMOOTH_NORMALS,
    UNDISPLACED,
    AttributeDomain,
    Dicing,
    DicingView,
    Instance,
    Mesh,
    MeshAttribute,
)
from rppm_addon.self_test.meshes import placed, polygons, sphere

STEPS, WAVES, HEIGHT = 128, 6.0, 0.15


def grid(steps: int = STEPS) -> Mesh:
    """A smooth square from -1 to 1 that faces +Z, with a UV map whose seam is at x = 0."""
    x, y = np.meshgrid(np.linspace(-1.0, 1.0, steps + 1), np.linspace(-1.0, 1.0, steps + 1))
    a = (np.arange(steps)[:, None] * (steps + 1) + np.arange(steps)).ravel()
    faces = np.stack([a, a + 1, a + steps + 2, a + steps + 1], axis=-1)
    mesh = polygons("Grid", np.stack([x, y, 0.0 * x], axis=-1).reshape(-1, 3), [tuple(face) for face in faces])
    right = mesh.positions[faces].mean(axis=1)[:, :1] > 0.0
    u = mesh.positions[mesh.corner_vertices, 0] + np.repeat(right[:, 0], 4)
    return dataclasses.replace(mesh, corner_uv=np.stack([u, 0.0 * u], axis=-1).astype(np.float32))


def plain(name: str = "Plain") -> Material:
    graph = NodeGraph()
    graph.surface = graph.add("bsdf_diffuse", "bsdf", color=(0.5, 0.5, 0.5))
    return Material(name, graph)


def waves(name: str = "Waves", height: float = HEIGHT, bump: bool = False, space: str = "OBJECT") -> Material:
    """Diffuse; height * sin(WAVES * x) by the object's x."""
    material = plain(name)
    graph = material.graph
    x = graph.add("separate_xyz", "x", vector=graph.add("tex_coord", "object"))
    phase = graph.add("math", "value", options={"operation": "MULTIPLY"}, value=x, value_001=WAVES)
    sine = graph.add("math", "value", options={"operation": "SINE"}, value=phase)
    graph.displacement = graph.add(
        "displacement", "displacement", options={"space": space}, height=sine, midlevel=0.0, scale=height
    )
    if bump:
        height = graph.add("displacement_height", "height", displacement=graph.displacement)
        graph.normal = graph.add("bump", "normal", attribute=UNDISPLACED, height=height)
    return material


def by_height(material: Material, height: object) -> Material:
    """The material, displaced along the normal by a value of its graph."""
    material.graph.displacement = material.graph.add("displacement", "displacement", height=height, midlevel=0.0)
    return material


def red(height: float = HEIGHT) -> Material:
    made = waves(height=height)
    made.graph.nodes[made.graph.surface.node].inputs["color"] = (0.9, 0.1, 0.1)
    return made


def bent(mesh: Mesh, *offset: float) -> Deformation:
    """From the mesh's shape to that a way off."""
    shapes = np.stack([mesh.positions, mesh.positions + np.float32(offset or 0.0)])
    return Deformation(0, np.array([0.0, 1.0]), shapes, np.stack([mesh.corner_normals] * 2))


def raised(offset: object) -> Material:
    """Everything by the same way in world space."""
    material = plain()
    material.graph.displacement = material.graph.add(
        "vector_displacement", "displacement", options={"space": "WORLD"}, vector=offset
    )
    return material


def scene_of(*materials: Material, meshes: list[Mesh] | None = None, instances: list[Instance] | None = None) -> Scene:
    instances = instances or [Instance(0, np.eye(4), list(range(len(materials))))]
    camera = Camera(placed(0.0, 0.0, 3.0), (-0.3, 0.3, -0.3, 0.3), 32, 32)
    settings = RenderSettings(iterations=1, photons=64, filter_width=0.0, passes=("Depth", "Normal"))
    return Scene(camera, meshes or [grid(8)], instances, list(materials), world=World(np.ones(3)), settings=settings)


@pytest.fixture
def displaced(context, library):
    """Displaces a scene; the same materials' tables and known shapes from call to call."""
    tables, displacement = MaterialTables(context, library), Displacement(context, library)

    def give(scene: Scene, renewed: bool = True) -> Scene:
        tables.build(scene)
        return displacement.displaced(scene, tables, renewed)

    yield give
    tables.release()


def seen_waves(frame) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return x, depth and normal of the points that a camera 3 m above sees in the middles of pixels."""
    depth = frame.passes["Depth"].astype(np.float64)
    ray = 0.6 * ((np.arange(32) + 0.5) / 32 - 0.5)
    return ray * depth, depth, frame.passes["Normal"]


# As Cycles, bump asks for the height along the displaced surface, whose x changes less than that of the flat one.
@pytest.mark.parametrize(("bump", "error"), [(False, 0.01), (True, 0.06)], ids=["only", "and bump"])
def test_depth_and_normals_of_waves_are_those_of_the_formula(renderer, bump, error):
    frame = renderer.render(scene_of(waves(bump=bump), meshes=[grid()])).frame
    x, depth, normal = seen_waves(frame)
    # Between vertices triangles leave the sine by at most a * k^2 * step^2 / 8.
    bound = HEIGHT * WAVES**2 * (2.0 / STEPS) ** 2 / 8.0
    np.testing.assert_allclose(depth, 3.0 - HEIGHT * np.sin(WAVES * x), atol=1.1 * bound)
    slope = HEIGHT * WAVES * np.cos(WAVES * x)
    expected = np.stack([-slope, 0.0 * slope, np.ones_like(slope)], axis=-1) / np.sqrt(1.0 + slope**2)[..., None]
    np.testing.assert_allclose(normal, expected, atol=error)


def test_scenes_without_stay_what_they_are(displaced):
    scene = scene_of(plain())
    assert displaced(scene) is scene


def test_what_is_turned_and_mirrored_is_displaced_in_its_own_space(displaced):
    matrix = np.array([[0.0, -0.5, 0.0, 3.0], [-2.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.25, 1.0], [0.0, 0.0, 0.0, 1.0]])
    instance = Instance(0, matrix, [0])
    (mesh,) = displaced(scene_of(waves(), instances=[instance])).meshes
    x = grid(8).positions[:, 0]
    np.testing.assert_allclose(mesh.positions[:, 2], HEIGHT * np.sin(WAVES * x), atol=1e-5)
    (mesh,) = displaced(scene_of(waves(space="WORLD"), instances=[instance])).meshes
    np.testing.assert_allclose(mesh.positions[:, 2], 4.0 * HEIGHT * np.sin(WAVES * x), atol=1e-5)


def test_attributes_of_what_is_mirrored_are_those_of_its_corners(displaced):
    material, mesh = plain(), grid(8)
    mesh.attributes["x"] = MeshAttribute(AttributeDomain.POINT, mesh.positions[:, :1].copy())
    x = material.graph.add("attribute", "fac", attribute="x")
    instance = Instance(0, np.diag([-1.0, 1.0, 1.0, 1.0]), [0])
    (moved,) = displaced(scene_of(by_height(material, x), meshes=[mesh], instances=[instance])).meshes
    np.testing.assert_allclose(moved.positions[:, 2], mesh.positions[:, 0], atol=1e-6)


def test_the_first_triangle_of_a_vertex_moves_it(displaced):
    """Two materials and a third that does not displace: vertices where they meet are moved once."""
    mesh = grid(8)
    middles = mesh.positions[mesh.corner_vertices[mesh.triangle_corners]].mean(axis=1)
    mesh.triangle_slots = np.select([middles[:, 1] < -0.5, middles[:, 1] < 0.5], [0, 1], 2).astype(np.int32)
    scene = scene_of(raised((0.0, 0.0, 1.0)), raised((0.0, 0.0, 2.0)), plain(), meshes=[mesh])
    (moved,) = displaced(scene).meshes
    y = mesh.positions[:, 1]
    np.testing.assert_array_equal(moved.positions[:, 2], np.select([y <= -0.5, y <= 0.5], [1.0, 2.0], 0.0))


def test_seams_of_uv_maps_do_not_open(displaced):
    material = plain()
    u = material.graph.add("separate_xyz", "x", vector=material.graph.add("tex_coord", "uv"))
    mesh = grid(8)
    (moved,) = displaced(scene_of(by_height(material, u), meshes=[mesh])).meshes
    x = mesh.positions[:, 0]
    np.testing.assert_allclose(moved.positions[:, 2], np.where(x <= 0.0, x, x + 1.0), atol=1e-6)


def test_flat_faces_take_their_triangles_normals(displaced):
    mesh = grid(8)
    values = np.concatenate([mesh.corner_normals, np.zeros((len(mesh.corner_vertices), 1), np.float32)], axis=1)
    mesh.attributes[SMOOTH_NORMALS] = MeshAttribute(AttributeDomain.CORNER, values)
    for bump in (False, True):
        (moved,) = displaced(scene_of(waves(bump=bump), meshes=[mesh])).meshes
        assert not moved.corner_normals.any()
    # Bump begins from smooth normals even there.
    np.testing.assert_array_equal(moved.attributes[SMOOTH_NORMALS].values, values)
    np.testing.assert_array_equal(moved.attributes[UNDISPLACED].values, mesh.positions)


def test_sharp_edges_stay_sharp_and_shut(displaced):
    """Corners of a vertex keep the angle between their normals."""
    mesh = grid(8)
    tilt = np.where(mesh.corner_uv[:, 0] > mesh.positions[mesh.corner_vertices, 0], 0.6, -0.6)
    mesh.corner_normals = np.stack([tilt, 0.0 * tilt, np.full_like(tilt, 0.8)], axis=-1).astype(np.float32)
    values = np.concatenate([mesh.corner_normals, np.ones((len(tilt), 1), np.float32)], axis=1)
    mesh.attributes[SMOOTH_NORMALS] = MeshAttribute(AttributeDomain.CORNER, values)
    (moved,) = displaced(scene_of(raised((0.0, 0.0, 1.0)), meshes=[mesh])).meshes
    assert (moved.positions[:, 2] == 1.0).all()
    np.testing.assert_allclose(moved.corner_normals, mesh.corner_normals, atol=1e-6)


def test_what_bends_is_displaced_at_all_times(displaced):
    mesh = grid(8)
    scene = scene_of(waves(), meshes=[mesh])
    scene.shutter = scene.neighbors = Shutter(np.ones(4), meshes=[bent(mesh, 0.0, 0.0, 0.5)])
    result = displaced(scene)
    for shutter in (result.shutter, result.neighbors):
        (moved,) = shutter.meshes
        np.testing.assert_array_equal(moved.positions[0], result.meshes[0].positions)
        np.testing.assert_allclose(
            moved.positions[1] - moved.positions[0], [[0.0, 0.0, 0.5]] * len(mesh.positions), atol=1e-6
        )
        np.testing.assert_allclose(moved.corner_normals[1], result.meshes[0].corner_normals, atol=1e-5)


def test_objects_with_other_materials_keep_the_mesh_as_it_was(displaced):
    mesh = grid(8)
    materials = [waves(), waves("High", 2.0 * HEIGHT), plain()]
    instances = [Instance(0, placed(index, 0.0, 0.0), [index]) for index in (0, 1, 2)]
    scene = scene_of(*materials, meshes=[mesh], instances=[*instances, Instance(0, placed(5.0, 0.0, 0.0), [0])])
    scene.shutter = Shutter(np.ones(4), meshes=[bent(mesh)])
    result = displaced(scene)
    heights = [np.ptp(result.meshes[instance.mesh].positions[:, 2]) for instance in result.instances]
    np.testing.assert_allclose(heights, np.array([1.0, 2.0, 0.0, 1.0]) * heights[0], rtol=1e-5)
    assert result.meshes[0] is mesh and result.instances[2] is scene.instances[2]
    assert sorted(moved.mesh for moved in result.shutter.meshes) == [0, 1, 2]
    again = displaced(scene)
    assert all(a is b for a, b in zip(result.meshes, again.meshes, strict=True))
    assert all(a is b for a, b in zip(result.instances, again.instances, strict=True))


def test_what_did_not_change_is_the_same_object(displaced):
    scene = scene_of(waves())
    (first,) = displaced(scene).meshes
    assert displaced(scene, renewed=False).meshes[0] is first
    assert displaced(dataclasses.replace(scene, materials=[red()])).meshes[0] is first
    other = displaced(dataclasses.replace(scene, materials=[waves(height=0.2)])).meshes[0]
    assert np.ptp(other.positions[:, 2]) > 1.2 * np.ptp(first.positions[:, 2])


def test_caustics_of_displaced_water_are_those_of_a_mesh_with_its_waves(mapper, displaced):
    """Bit for bit: nothing but the mesh counts, for light and photons alike."""
    water, floor = waves("Water", 0.05), grid(4)
    water.graph.surface = water.graph.add("bsdf_glass", "bsdf", ior=1.33)
    scene = scene_of(water, plain(), meshes=[grid(32), floor])
    scene.instances = [Instance(0, placed(0.0, 0.0, 0.5), [0]), Instance(1, np.eye(4), [1])]
    scene.lights, scene.world = [Light("Sun", LightKind.SUN, np.eye(4), np.full(3, 2.0))], World(np.zeros(3))
    scene.settings = RenderSettings(iterations=2, photons=4096)

    still = dataclasses.replace(water, graph=dataclasses.replace(water.graph, displacement=None))
    calm = dataclasses.replace(scene, materials=[still, scene.materials[1]])
    moved = dataclasses.replace(calm, meshes=displaced(scene).meshes)
    caustic = radiance_of(mapper, scene, 2)
    np.testing.assert_array_equal(radiance_of(mapper, moved, 2), caustic)
    assert not np.array_equal(radiance_of(mapper, calm, 2), caustic)


def test_an_update_equals_a_build(mapper, other_mapper):
    scene = scene_of(waves(), plain(), meshes=[grid(16), grid(4)])
    scene.instances = [Instance(0, np.eye(4), [0]), Instance(1, placed(0.3, 0.0, 0.1), [1])]

    mapper.build(scene)
    for changed in (
        dataclasses.replace(scene, materials=[red(HEIGHT), scene.materials[1]]),
        dataclasses.replace(scene, materials=[red(2.0 * HEIGHT), scene.materials[1]]),
        dataclasses.replace(scene, camera=dataclasses.replace(scene.camera, matrix=placed(0.2, 0.0, 2.5))),
        dataclasses.replace(scene, materials=[plain(), scene.materials[1]]),
    ):
        mapper.update(changed)
        other_mapper.build(changed)
        for each in (mapper, other_mapper):
            each.iterate()
        np.testing.assert_array_equal(mapper.film.read_radiance(), other_mapper.film.read_radiance())
    placements = mapper.device_scene.geometry.placements
    mapper.update(dataclasses.replace(changed, camera=scene.camera))
    assert mapper.device_scene.geometry.placements is placements  # nothing was built for a camera


def test_first_looks_draw_what_is_displaced(context, library, mapper):
    """They share the device's triangles with what renders, and leave them as they are."""
    scene = scene_of(waves(), raised((0.0, 0.0, 0.25)), meshes=[grid(8), grid(4)])
    scene.instances = [Instance(0, np.eye(4), [0]), Instance(1, placed(0.5, 0.0, -1.0), [1])]
    mapper.build(scene)
    built = mapper.device_scene
    triangles = built.geometry.triangles.buffer.read()
    look = FirstLook(context, library, built.geometry, built.displacement.as_known)
    look.draw(scene)
    assert built.geometry.triangles.buffer.read() == triangles
    # What the mapper does not know yet is drawn as it is, until it has been built.
    other = dataclasses.replace(scene, meshes=[grid(8), scene.meshes[1]])
    look.draw(other)
    assert built.geometry.bounds_high[2] == 0.0
    mapper.update(other)
    assert built.geometry.triangles.buffer.read() == triangles
    look.release()


def test_ways_that_are_no_numbers_count_as_none(displaced):
    material = raised((0.0, 0.0, 0.0))
    huge = material.graph.add("math", "value", options={"operation": "POWER"}, value=1e30, value_001=9.0)
    material.graph.displacement = material.graph.add("combine_xyz", "vector", z=huge)
    scene = scene_of(material)
    np.testing.assert_array_equal(displaced(scene).meshes[0].positions, scene.meshes[0].positions)


def test_a_displacement_that_is_malformed_is_left_out_with_a_warning(displaced):
    material = plain()
    material.graph.displacement = material.graph.surface
    scene = scene_of(material)
    assert displaced(scene) is scene
    assert any('"Plain"' in text and "displaces nothing" in text for text in scene.warnings)


def test_meshes_are_divided_before(displaced):
    """By pixels as the camera sees them, and their shapes and triangles with them."""
    mesh = dataclasses.replace(grid(4), dicing=Dicing(0.05, False, True))
    scene = scene_of(waves(bump=True), meshes=[mesh])
    scene.shutter = Shutter(np.ones(4), meshes=[bent(mesh)])
    result = displaced(scene)
    (moved,) = result.meshes
    assert moved.triangle_count == 16 * 16**2 and moved.dicing is None  # squares of 0.5 with two triangles, 1 : 2^7
    np.testing.assert_allclose(moved.positions[:, 2], HEIGHT * np.sin(WAVES * moved.positions[:, 0]), atol=1e-5)
    np.testing.assert_array_equal(result.shutter.meshes[0].positions[1], moved.positions)
    assert displaced(scene).meshes[0] is moved
    pixels = dataclasses.replace(mesh, dicing=Dicing(4.0, True, True))
    near, far = (
        displaced(dataclasses.replace(scene_of(waves(), meshes=[pixels]), dicing_view=DicingView(rate))).meshes[0]
        for rate in (1.0, 8.0)
    )
    assert near.triangle_count > far.triangle_count == mesh.triangle_count


def test_what_bends_is_divided_where_nothing_displaces_it(displaced):
    """Flat meshes are not, as the picture is the same."""
    ball, square = (dataclasses.replace(mesh, dicing=Dicing(2.0, True, True)) for mesh in (sphere("Ball"), grid(4)))
    flat = dataclasses.replace(square, dicing=Dicing(2.0, True, False))
    instances = [Instance(0, np.eye(4), [0]), Instance(1, np.eye(4), [0]), Instance(2, np.eye(4), [0])]
    result = displaced(scene_of(plain(), meshes=[ball, square, flat], instances=instances))
    np.testing.assert_allclose(np.linalg.norm(result.meshes[0].positions, axis=1), 1.0, atol=5e-3)
    assert result.meshes[0].triangle_count > 2 * ball.triangle_count
    assert result.meshes[1].triangle_count > 4 * square.triangle_count and result.meshes[2] is flat


@pytest.mark.parametrize("materials", [[], [0]])
def test_what_bends_and_is_not_displaced_is_divided_at_all_times(displaced, materials):
    mesh = dataclasses.replace(grid(4), dicing=Dicing(2.0, True, True))
    scene = scene_of(plain(), meshes=[mesh], instances=[Instance(0, np.eye(4), materials)])
    scene.shutter = Shutter(np.ones(4), meshes=[bent(mesh, 0.0, 0.0, 0.5)])
    result = displaced(scene)
    (moved,), (shape,) = result.meshes, result.shutter.meshes
    assert moved.triangle_count > 4 * mesh.triangle_count
    np.testing.assert_array_equal(shape.positions[0], moved.positions)
    np.testing.assert_allclose(shape.positions[1], moved.positions + np.float32([0.0, 0.0, 0.5]), atol=1e-6)
    np.testing.assert_array_equal(shape.corner_normals[0], moved.corner_normals)
    assert displaced(scene, False).shutter.meshes[0] is shape


def test_meshes_are_divided_anew_for_another_view_only(displaced):
    mesh = dataclasses.replace(grid(4), dicing=Dicing(2.0, True, True))
    scene = scene_of(plain(), meshes=[mesh])
    view = DicingView(camera=scene.camera)
    scene = dataclasses.replace(scene, dicing_view=view)
    first = displaced(scene).meshes[0]
    near = dataclasses.replace(scene.camera, matrix=placed(0.0, 0.0, 1.0))
    assert displaced(dataclasses.replace(scene, camera=near), False).meshes[0] is first
    finer = displaced(dataclasses.replace(scene, camera=near, dicing_view=DicingView()), False).meshes[0]
    assert finer.triangle_count > first.triangle_count
    lower = displaced(dataclasses.replace(scene, dicing_view=dataclasses.replace(view, max_subdivisions=1)), False)
    assert lower.meshes[0].triangle_count == 4 * mesh.triangle_count


def test_nothing_is_divided_where_texels_know_triangles_by_number(displaced):
    mesh = dataclasses.replace(grid(4), dicing=Dicing(0.05, False, True))
    scene = scene_of(plain(), meshes=[mesh])
    scene.camera.texels = Texels(0, np.zeros((32, 32), np.int32), *(np.zeros((32, 32, n), np.float32) for n in (2, 4)))
    assert displaced(scene) is scene


def test_divided_meshes_are_no_larger_than_they_may_be(mapper, monkeypatch):
    """Which is told as long as it is so, and no longer."""
    monkeypatch.setattr("rppm_addon.integrator.surfaces.dicing.diced_mesh.MOST_TRIANGLES", 512)

    def told(edge_length: float) -> list[str]:
        mesh = dataclasses.replace(grid(4), dicing=Dicing(edge_length, False, True))
        changed = dataclasses.replace(scene, meshes=[mesh], warnings=[])
        mapper.update(changed)
        assert mapper.scene.warnings is changed.warnings
        return [text for text in changed.warnings if "Adaptive Subdivision leaves edges" in text]

    scene = scene_of(waves())
    (first,), (second,) = told(0.05), told(0.02)
    assert mapper.triangle_count == 32 * 16 and first != second
    assert told(0.5) == []


def test_what_is_divided_may_have_no_triangles(displaced):
    mesh, none = grid(4), np.zeros((0, 3), np.int32)
    mesh = dataclasses.replace(mesh, triangle_corners=none, triangle_slots=none[:, 0], dicing=Dicing(0.05, False, True))
    (moved,) = displaced(scene_of(waves(), meshes=[mesh])).meshes
    np.testing.assert_array_equal(moved.positions, mesh.positions)


def test_what_moves_leaves_nothing_behind(displaced):
    """Objects and shapes that are others in each scene are forgotten with the scenes before."""
    mesh = grid(8)
    scene = scene_of(waves(), plain(), meshes=[mesh])
    left = []
    for place in range(3):
        moving, matrix = bent(mesh, place, place, place), placed(place, 0.0, 0.0)
        left += [weakref.ref(moving), weakref.ref(moving.positions), weakref.ref(matrix)]
        instances = [Instance(0, matrix, [0]), Instance(0, np.eye(4), [1])]
        displaced(dataclasses.replace(scene, instances=instances, shutter=Shutter(np.ones(4), meshes=[moving])), False)
    del moving, matrix, instances
    assert [found() is None for found in left] == [True] * 6 + [False] * 3
