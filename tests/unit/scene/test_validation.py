# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that are not what their declaration says are refused, naming member and field."""

import dataclasses

import numpy as np
import pytest
from support.full_scene import full_scene, graph_of_everything

from rppm_addon.scene import AttributeDomain, Link, MeshAttribute, NodeGraph, ShaderNode, Texels, load_scene, save_scene
from rppm_addon.scene.errors import SceneError
from rppm_addon.scene.meshes import SMOOTH_NORMALS, Dicing, DicingView, RayVisibility
from rppm_addon.scene.storage.validation import check_scene

NAN, INF = float("nan"), float("inf")


def changed(array, place, value):
    array = array.copy()
    array[place] = value
    return array


def linking(node, output="bsdf"):
    graph = graph_of_everything()
    graph.surface = Link(node, output)
    return graph


def displacing(node):
    return dataclasses.replace(graph_of_everything(), displacement=Link(node, "vector"))


def texels(scene, triangle):
    width, height = scene.camera.resolution
    places = (np.zeros((height, width, count), np.float32) for count in (2, 4))
    return Texels(0, np.full((height, width), triangle, np.int32), *places)


def smooth(domain, numbers):
    return {SMOOTH_NORMALS: MeshAttribute(domain, np.zeros((4, numbers), np.float32))}


BROKEN = [
    ("exposure", lambda scene: NAN, "exposure is nan"),
    ("exposure", lambda scene: INF, "exposure is inf"),
    ("exposure", lambda scene: 1e300, "exposure is 1e.300"),
    ("exposure", lambda scene: -1.0, "exposure is -1.0; it must be 0 to 1e.12"),
    ("exposure", lambda scene: "1", "exposure is '1'; it must be a float"),
    ("exposure", lambda scene: True, "exposure is True; it must be a float"),
    ("lights.0.radius", lambda scene: NAN, 'lights.0. "sun": radius is nan'),
    ("lights.0.radius", lambda scene: -1.0, "radius is -1.0; it must be 0 or more"),
    ("lights.0.strength", lambda scene: np.array([1.0, INF, 1.0]), "strength is inf"),
    ("lights.0.strength", lambda scene: np.ones(4), r"strength has the shape \(4,\); it must be \(3\)"),
    ("lights.0.shape", lambda scene: "ROUND", "shape is 'ROUND'; it must be one of SQUARE"),
    ("lights.0.kind", lambda scene: "sun", "kind is 'sun'; it must be a LightKind"),
    ("lights.0.visibility", lambda scene: RayVisibility(1 << 40), "0 to 63"),
    ("world.radiance", lambda scene: np.array([NAN, 0.0, 0.0]), "world: radiance is nan"),
    ("camera.matrix", lambda scene: np.zeros((4, 4)), "camera: matrix has axes of no length"),
    ("camera.matrix", lambda scene: np.ones((4, 4)), "camera: matrix has axes of no length or in one plane"),
    ("camera.matrix", lambda scene: np.full((4, 4), NAN), "camera: matrix is nan"),
    ("camera.matrix", lambda scene: [1.0], "camera: matrix is .1.0.; it must be a ndarray"),
    ("camera.window", lambda scene: (1.0, -1.0, 0.0, 1.0), "window is .*left must be less"),
    ("camera.window", lambda scene: (1.0, 2.0), "4 values"),
    ("camera.width", lambda scene: 0, "camera: width is 0"),
    ("camera.height", lambda scene: 1 << 40, "camera: height is"),
    ("camera.width", lambda scene: 8.0, "it must be a int"),
    ("camera.crop", lambda scene: (0, 0, 65, 32), "crop is"),
    ("camera.texels", lambda scene: texels(scene, 2), "index 2; there are 2 triangles"),
    ("camera.texels", lambda scene: texels(scene, -2), "triangles is -2"),
    ("camera.texels", lambda scene: dataclasses.replace(texels(scene, 0), instance=4), "instance is 4"),
    ("camera.texels", lambda scene: dataclasses.replace(texels(scene, 0), triangles=np.zeros((1, 1))), "float64"),
    ("camera.clip_start", lambda scene: INF, "clip_start is inf"),
    ("meshes.0.corner_vertices", lambda scene: np.array([0, 1, 2, 4], np.int32), "index 4; there are 4 vertices"),
    ("meshes.0.corner_vertices", lambda scene: np.array([0, 1, 2, -1], np.int32), "index -1; there are 4 vertices"),
    ("meshes.0.corner_vertices", lambda scene: np.arange(4), "array of int64"),
    ("meshes.0.triangle_corners", lambda scene: np.array([[0, 1, 2], [0, 2, 9]], np.int32), "index 9; .*4 corners"),
    ("meshes.0.triangle_slots", lambda scene: np.array([0, -1], np.int32), "triangle_slots is -1"),
    ("meshes.0.triangle_slots", lambda scene: np.zeros(3, np.int32), r'meshes.0. "m": triangle_slots has the shape'),
    ("meshes.0.positions", lambda scene: np.zeros((4, 2), np.float32), r"it must be \(vertices, 3\)"),
    ("meshes.0.positions", lambda scene: np.zeros((3, 3), np.float32), "index 3; there are 3 vertices"),
    ("meshes.0.corner_normals", lambda scene: np.zeros((5, 3), np.float32), "of 4 vertices, 4 corners"),
    ("meshes.0.attributes.heat.values", lambda scene: np.zeros((3, 3), np.float32), "there are 4 corners"),
    ("meshes.0.attributes", lambda scene: smooth(AttributeDomain.CORNER, 3), "must have 4 numbers for each corner"),
    ("meshes.0.attributes", lambda scene: smooth(AttributeDomain.POINT, 4), "must have 4 numbers for each corner"),
    ("meshes.0.dicing", lambda scene: Dicing(NAN, True, False), "dicing: edge_length is nan"),
    ("meshes.0.dicing", lambda scene: Dicing(0.0, True, False), "dicing: edge_length is 0.0; it must be 1e-06 or more"),
    ("meshes.0.dicing", lambda scene: Dicing(1.0, 1, False), "dicing: in_pixels is 1; it must be a bool"),
    ("meshes.1.shape", lambda scene: "STRANDS", "shape is 'STRANDS'; it must be a MeshShape"),
    ("dicing_view", lambda scene: DicingView(-1.0), "dicing_view: rate is -1.0; it must be 1e-06 or more"),
    ("dicing_view", lambda scene: DicingView(offscreen_scale=0.5), "offscreen_scale is 0.5; it must be 1 or more"),
    ("instances.0.mesh", lambda scene: 2, 'instances.0. "object": mesh is 2; .* one of 2 meshes'),
    ("instances.0.mesh", lambda scene: -1, "mesh is -1"),
    ("instance_arrays.0.first.mesh", lambda scene: 2, "instance_arrays.0.: first: mesh is 2; .* one of 2 meshes"),
    ("instance_arrays.0.places", lambda scene: np.array([3, 1], np.int32), "places must ascend"),
    ("instance_arrays.0.places", lambda scene: np.array([3, 4], np.int32), "a place that is none of 4"),
    ("instance_arrays.0.places", lambda scene: np.array([1], np.int32), "matrices has the shape .2, 3, 4.; it must be"),
    ("instance_arrays.0.matrices", lambda scene: np.zeros((2, 4, 4), np.float32), "matrices has the shape"),
    ("instance_arrays.0.randoms", lambda scene: np.zeros(3), "randoms has the shape .3,."),
    (
        "instance_arrays.0.particles",
        lambda scene: scene.instance_arrays[0].particles.rows([0]),
        "there are 1 particles",
    ),
    ("instance_arrays.0.attributes", lambda scene: {"a": np.zeros(2)}, r'attributes."a". has the shape .2,.'),
    ("instance_arrays", lambda scene: scene.instance_arrays * 2, "the same place"),
    ("instances.0.materials", lambda scene: [0, 2], r"materials\[1\] is 2; it must be the index of one of 2 materials"),
    ("instances.0.matrix", lambda scene: np.eye(3), "matrix has the shape"),
    ("instances.1.attributes", lambda scene: {"a": (1.0, "b")}, r"attributes\[.a.\]\[1\] is 'b'"),
    ("images.0.pixels", lambda scene: np.zeros((2, 2, 3), np.uint8), "pixels has the shape"),
    ("images.0.pixels", lambda scene: np.zeros((2, 2, 4), np.int32), "array of int32"),
    ("images.0.encoding", lambda scene: "JPEG", "encoding is 'JPEG'"),
    ("materials.1.graph", lambda scene: linking(99), "links to node 99; there are"),
    ("materials.1.graph", lambda scene: linking(-1), "links to node -1"),
    ("materials.1.graph", lambda scene: NodeGraph([ShaderNode("a", inputs={"x": Link(0, "b")})]), "links to node 0"),
    ("materials.1.graph", lambda scene: NodeGraph([ShaderNode("a", inputs={"x": NAN})]), r"inputs\[.x.\] is nan"),
    ("materials.1.graph", lambda scene: NodeGraph([ShaderNode("a", image=1)]), "image is 1; .* one of 1 images"),
    ("materials.1.graph", lambda scene: NodeGraph([ShaderNode("a", inputs={"x": [[1]]})]), "must be a number"),
    ("materials.1.graph", lambda scene: NodeGraph([ShaderNode("a", inputs={"x": (1.0, ())})]), "must be a number"),
    ("materials.1.graph", lambda scene: NodeGraph([ShaderNode("a", inputs={"x": 1 << 400})]), "must be finite"),
    ("materials.1.graph", lambda scene: displacing(99), "links to node 99; there are"),
    ("materials.1.on_round_shapes", lambda scene: 1, "on_round_shapes is 1; it must be a bool"),
    ("materials.1.abbe_number", lambda scene: 0.0, "abbe_number is 0.0; it must be 1 or more"),
    ("materials.1.abbe_number", lambda scene: NAN, "abbe_number is nan"),
    ("shutter.instances.0.member", lambda scene: 4, "shutter: instances.0.: member is 4; there are 4 instances"),
    ("shutter.lights.0.matrices", lambda scene: np.full((2, 4, 4), INF), "matrices is inf"),
    ("shutter.lights.0.times", lambda scene: np.array([1.0, 0.0]), "times must ascend"),
    ("shutter.meshes.0.mesh", lambda scene: 5, "mesh is 5"),
    ("shutter.meshes.0.positions", lambda scene: np.zeros((2, 3, 3), np.float32), "3 vertices"),
    ("shutter.curve", lambda scene: np.zeros(0), "curve is empty"),
    ("settings.iterations", lambda scene: "7", "settings: iterations is '7'"),
    ("settings.passes", lambda scene: ("Depth", 5), r"passes\[1\] is 5"),
    ("meshes", lambda scene: None, "meshes is None"),
    ("lights", lambda scene: [5], r"lights\[0\] is 5; it must be a Light"),
    ("asset_names", lambda scene: {5: "a"}, "asset_names.* is 5"),
]


@pytest.mark.parametrize(("path", "make", "message"), BROKEN, ids=[f"{entry[0]}-{entry[2]}" for entry in BROKEN])
def test_what_is_wrong_is_named(path, make, message):
    scene = full_scene()
    check_scene(scene)
    *owners, name = path.split(".")
    owner = scene
    for step in owners:
        if isinstance(owner, dict | list):
            owner = owner[int(step) if step.isdecimal() else step]
        else:
            owner = getattr(owner, step)
    setattr(owner, name, make(scene))
    with pytest.raises(SceneError, match=message):
        check_scene(scene)


def test_a_saved_scene_is_held_to_its_declaration(tmp_path):
    path = tmp_path / "scene.npz"
    save_scene(dataclasses.replace(full_scene(), exposure=NAN), path)
    with pytest.raises(SceneError, match=r"scene.npz: exposure is nan.*export it again"):
        load_scene(path)


def test_names_do_not_reach_the_terminal_as_they_are():
    scene = full_scene()
    scene.lights[0].name = "\x1b[2J\nrppm: all is well"
    scene.lights[0].radius = NAN
    with pytest.raises(SceneError) as error:
        check_scene(scene)
    assert "\x1b" not in str(error.value) and "\n" not in str(error.value)


def test_texels_of_a_mesh_are_let_in():
    scene = full_scene()
    for triangle in (-1, 1):
        scene.camera.texels = texels(scene, triangle)
        check_scene(scene)


def test_tables_of_ramps_and_of_curves_pass():
    scene = full_scene()
    for shape in ((259,), (257, 4)):
        scene.materials[0].graph.add("float_curve", "value", table=np.zeros(shape, np.float32))
    check_scene(scene)
