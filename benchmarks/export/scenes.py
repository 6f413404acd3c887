# SPDX-License-Identifier: GPL-3.0-or-later
"""Animated Blender scenes that change wholly from frame to frame, for measuring what their export costs."""

import math
from collections.abc import Callable

import bpy

FRAMES = 250


def _stage() -> bpy.types.Scene:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "RPPM"
    scene.render.resolution_x = scene.render.resolution_y = 32
    scene.rppm.photons = 1024
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location = (0.0, 0.0, 20.0)
    light = bpy.data.objects.new("Light", bpy.data.lights.new("Light", "POINT"))
    light.location = (0.0, 0.0, 10.0)
    for added in (camera, light):
        scene.collection.objects.link(added)
    scene.camera = camera
    scene.world = bpy.data.worlds.new("World")
    return scene


def _link(name: str, data: bpy.types.ID | None, **values: object) -> bpy.types.Object:
    added = bpy.data.objects.new(name, data)
    for key, value in values.items():
        setattr(added, key, value)
    bpy.context.scene.collection.objects.link(added)
    return added


def _material(name: str, reads_uv: bool = False) -> bpy.types.Material:
    material = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0):
        material.use_nodes = True
    if reads_uv:
        tree = material.node_tree
        checker = tree.nodes.new("ShaderNodeTexChecker")
        coordinates = tree.nodes.new("ShaderNodeTexCoord")
        tree.links.new(coordinates.outputs["UV"], checker.inputs["Vector"])
        tree.links.new(checker.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    return material


def _grid(triangles: int) -> bpy.types.Object:
    """A smooth sheet of quads with a UV map and two material slots in turn."""
    side = max(2, round(math.sqrt(triangles / 2)))
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=side, y_subdivisions=side, size=10.0)
    sheet = bpy.context.object
    mesh = sheet.data
    mesh.materials.append(_material("Plain"))
    mesh.materials.append(_material("Checked", reads_uv=True))
    mesh.polygons.foreach_set("material_index", [number % 2 for number in range(len(mesh.polygons))])
    mesh.shade_smooth()
    return sheet


def _animate(owner: bpy.types.ID, path: str, start: object, end: object) -> None:
    """Straight from one value at the first frame to another at the last."""
    *parents, name = path.rsplit(".", 1)
    holder = owner.path_resolve(parents[0]) if parents else owner
    for frame, value in ((1, start), (FRAMES, end)):
        setattr(holder, name, value)
        owner.keyframe_insert(path, frame=frame)


def wave(triangles: int) -> None:
    """A sheet under a wave modifier."""
    _stage()
    modifier = _grid(triangles).modifiers.new("Wave", "WAVE")
    modifier.height, modifier.width, modifier.speed = 0.5, 2.0, 0.1


def shape_key(triangles: int) -> None:
    """A sheet between two shapes."""
    _stage()
    sheet = _grid(triangles)
    sheet.shape_key_add(name="Basis")
    key = sheet.shape_key_add(name="Bent")
    points = [0.0] * (3 * len(sheet.data.vertices))
    key.data.foreach_get("co", points)
    points[2::3] = [math.sin(x) for x in points[::3]]
    key.data.foreach_set("co", points)
    _animate(sheet.data.shape_keys, 'key_blocks["Bent"].value', 0.0, 1.0)


def _piece() -> bpy.types.Mesh:
    """Return the mesh that is placed many times: a cube with a UV map and a material."""
    bpy.ops.mesh.primitive_cube_add(size=0.1)
    cube = bpy.context.object
    mesh = cube.data
    bpy.data.objects.remove(cube)
    mesh.materials.append(_material("Piece", reads_uv=True))
    return mesh


def _turning_empty() -> bpy.types.Object:
    empty = _link("Turning", None)
    _animate(empty, "rotation_euler", (0.0, 0.0, 0.0), (0.0, 0.0, 6.0))
    return empty


def _place(number: int) -> tuple[float, float, float]:
    return number % 70 * 0.15 - 5.0, number // 70 * 0.15 - 5.0, 0.0


def objects(count: int) -> None:
    """Objects that share a mesh and hang on one that turns."""
    _stage()
    mesh, parent = _piece(), _turning_empty()
    for number in range(count):
        _link(f"Piece{number}", mesh, location=_place(number), parent=parent)


def collections(count: int) -> None:
    """Empties, each with the same collection, that hang on one that turns."""
    _stage()
    collection = bpy.data.collections.new("Pieces")
    collection.objects.link(bpy.data.objects.new("Piece", _piece()))
    parent = _turning_empty()
    for number in range(count):
        _link(f"Place{number}", None, location=_place(number), parent=parent, instance_type="COLLECTION",
              instance_collection=collection)  # fmt: skip


def geometry_nodes(count: int) -> None:
    """Instances on the points of a line, turned by the frame."""
    _stage()
    tree = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    piece = _link("Piece", _piece(), hide_render=True, hide_viewport=True)
    make = tree.nodes.new
    line, source, place, turn = (
        make(kind)
        for kind in (
            "GeometryNodeMeshLine", "GeometryNodeObjectInfo", "GeometryNodeInstanceOnPoints",
            "GeometryNodeRotateInstances",
        )
    )  # fmt: skip
    time, spin, output = make("GeometryNodeInputSceneTime"), make("ShaderNodeCombineXYZ"), make("NodeGroupOutput")
    line.inputs["Count"].default_value = count
    source.inputs["Object"].default_value = piece
    source.inputs["As Instance"].default_value = True
    for output_socket, input_socket in (
        (line.outputs["Mesh"], place.inputs["Points"]),
        (source.outputs["Geometry"], place.inputs["Instance"]),
        (place.outputs["Instances"], turn.inputs["Instances"]),
        (time.outputs["Seconds"], spin.inputs["X"]),
        (spin.outputs[0], turn.inputs["Rotation"]),
        (turn.outputs["Instances"], output.inputs[0]),
    ):
        tree.links.new(output_socket, input_socket)
    _link("Host", bpy.data.meshes.new("Host")).modifiers.new("Scatter", "NODES").node_group = tree


def particles(count: int) -> None:
    """Particles that fall, each an object."""
    scene = _stage()
    bpy.ops.mesh.primitive_plane_add(size=10.0)
    emitter = bpy.context.object
    emitter.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = emitter.particle_systems[0].settings
    settings.count, settings.frame_start, settings.frame_end, settings.lifetime = count, 1, 1, 2 * FRAMES
    settings.render_type, settings.instance_object = "OBJECT", _link("Piece", _piece())
    settings.particle_size = 1.0
    scene.frame_set(2)


SCENES: dict[str, tuple[Callable[[int], None], int]] = {
    "wave": (wave, 1_000_000),
    "shape_key": (shape_key, 1_000_000),
    "objects": (objects, 5_000),
    "collections": (collections, 5_000),
    "geometry_nodes": (geometry_nodes, 5_000),
    "particles": (particles, 5_000),
}
"""Each with how many triangles or instances it is measured with."""
