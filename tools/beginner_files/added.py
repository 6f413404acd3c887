# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that the menus of Add give, each with its defaults, and primitives shaded in each way."""

import functools

import bpy
import numpy as np

from .files import ball, cube, file, monkey, paint, plain, start

MESHES = ("plane", "cube", "circle", "uv_sphere", "ico_sphere", "cylinder", "cone", "torus", "grid", "monkey")
CURVES = ("bezier_curve", "bezier_circle", "nurbs_curve", "nurbs_circle", "nurbs_path")
SURFACES = ("curve", "circle", "surface", "cylinder", "sphere", "torus")


def _mesh(kind: str, shading: str) -> None:
    start()
    getattr(bpy.ops.mesh, f"primitive_{kind}_add")(rotation=(0.2, 0.1, 0.3))
    paint(bpy.context.object)
    if shading == "smooth":
        bpy.ops.object.shade_smooth()
    elif shading == "by_angle":
        bpy.ops.object.shade_smooth_by_angle()


for kind in MESHES:
    for shading in ("flat", "smooth", "by_angle"):
        file(f"add_mesh_{kind}_{shading}", functools.partial(_mesh, kind, shading))


def _curve(kind: str, change: str) -> None:
    start()
    getattr(bpy.ops.curve, f"primitive_{kind}_add")()
    data = paint(bpy.context.object).data
    if change == "bevel":
        data.bevel_depth = 0.15
    elif change == "extrude":
        data.extrude = 0.3
    elif change == "2d":
        data.dimensions, data.fill_mode = "2D", "BOTH"
    elif change == "bevel_profile":
        data.bevel_mode, data.bevel_depth, data.use_fill_caps = "PROFILE", 0.2, True
    elif change == "tilt":
        data.extrude, data.splines[0].bezier_points[0].tilt = 0.3, 1.0
    elif change == "half":
        data.bevel_depth, data.fill_mode, data.bevel_factor_end = 0.15, "HALF", 0.6


for kind in CURVES:
    file(f"add_curve_{kind}", functools.partial(_curve, kind, ""))
    file(f"add_curve_{kind}_bevel", functools.partial(_curve, kind, "bevel"))
for change in ("extrude", "2d", "bevel_profile", "tilt", "half"):
    file(f"add_curve_bezier_circle_{change}", functools.partial(_curve, "bezier_circle", change))


def _curve_objects(kind: str) -> None:
    start()
    bpy.ops.curve.primitive_bezier_circle_add(radius=0.2)
    profile = bpy.context.object
    profile.location = (0.0, 3.0, 0.0)
    bpy.ops.curve.primitive_bezier_curve_add()
    data = paint(bpy.context.object).data
    if kind == "bevel_object":
        data.bevel_mode, data.bevel_object = "OBJECT", profile
    else:
        data.extrude, data.taper_object = 0.3, profile


for kind in ("bevel_object", "taper_object"):
    file(f"add_curve_{kind}", functools.partial(_curve_objects, kind))


def _surface(kind: str) -> None:
    start()
    getattr(bpy.ops.surface, f"primitive_nurbs_surface_{kind}_add")()
    paint(bpy.context.object)


for kind in SURFACES:
    file(f"add_surface_{kind}", functools.partial(_surface, kind))


def _metaball(kind: str) -> None:
    start()
    bpy.ops.object.metaball_add(type=kind, radius=1.2)
    paint(bpy.context.object)


for kind in ("BALL", "CAPSULE", "PLANE", "ELLIPSOID", "CUBE"):
    file(f"add_metaball_{kind.lower()}", functools.partial(_metaball, kind))


def _two_metaballs() -> None:
    start()
    for x, color in ((-0.6, (0.8, 0.1, 0.1)), (0.6, (0.1, 0.1, 0.8))):
        bpy.ops.object.metaball_add(type="BALL", radius=1.0, location=(x, 0.0, 0.0))
        paint(bpy.context.object, plain(color))


file("add_metaball_two_joined", _two_metaballs)


def _text(change: str) -> None:
    start()
    bpy.ops.object.text_add(location=(-0.8, -0.3, 0.0), rotation=(0.9, 0.0, 0.7))
    data = paint(bpy.context.object).data
    if change == "solid":
        data.extrude, data.bevel_depth = 0.1, 0.03
    elif change == "lines":
        data.body, data.align_x, data.offset = "One\ntwo äß\nthree", "CENTER", 0.01
    elif change == "materials":
        data.materials.append(plain((0.1, 0.2, 0.9)))
        data.extrude = 0.1
        for letter in data.body_format[2:]:
            letter.material_index = 1
    elif change == "underline":
        for letter in data.body_format:
            letter.use_underline = True


for change in ("", "solid", "lines", "materials", "underline"):
    file(f"add_text{'_' * bool(change)}{change}", functools.partial(_text, change))


def _none_of_which_render(operator: str, options: dict) -> None:
    start()
    cube()
    group, name = operator.split(".")
    getattr(getattr(bpy.ops, group), name)(**options)


for name, operator, options in (
    ("empty_axes", "object.empty_add", {}),
    ("empty_image", "object.empty_add", {"type": "IMAGE"}),
    ("armature", "object.armature_add", {}),
    ("lattice", "object.add", {"type": "LATTICE"}),
    ("speaker", "object.speaker_add", {}),
    ("camera", "object.camera_add", {}),
    ("light_probe_sphere", "object.lightprobe_add", {"type": "SPHERE"}),
    ("light_probe_plane", "object.lightprobe_add", {"type": "PLANE"}),
    ("light_probe_volume", "object.lightprobe_add", {"type": "VOLUME"}),
    ("force_field", "object.effector_add", {"type": "WIND"}),
    ("force_field_guide", "object.effector_add", {"type": "GUIDE"}),
    ("grease_pencil_blank", "object.grease_pencil_add", {"type": "EMPTY"}),
    ("grease_pencil_stroke", "object.grease_pencil_add", {"type": "STROKE"}),
    ("grease_pencil_monkey", "object.grease_pencil_add", {"type": "MONKEY"}),
    ("hair_curves_empty", "object.curves_empty_hair_add", {}),
    ("curves_random", "object.curves_random_add", {}),
    ("point_cloud_random", "object.pointcloud_random_add", {}),
    ("volume_empty", "object.volume_add", {}),
):
    file(f"add_{name}", functools.partial(_none_of_which_render, operator, options))


def _collection_instance() -> None:
    scene = start()
    cube(0.6)
    thing = bpy.context.object
    collection = bpy.data.collections.new("Group")
    scene.collection.children.link(collection)
    collection.objects.link(thing)
    collection.instance_offset = (0.1, 0.0, 0.0)
    bpy.ops.object.collection_instance_add(collection="Group", location=(1.2, 0.0, 0.3), rotation=(0.3, 0.4, 0.5))
    bpy.ops.object.collection_instance_add(collection="Group", location=(-1.2, 0.0, 0.3), scale=(-1.0, 1.0, 1.0))


file("add_collection_instance", _collection_instance)


def _loose() -> None:
    """Vertices and edges without faces beside a face."""
    start()
    mesh = bpy.data.meshes.new("Loose")
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0.5), (-1, -1, 0), (-1, 0, 1)], [(3, 4)], [(0, 1, 2)])
    thing = bpy.data.objects.new("Loose", mesh)
    bpy.context.scene.collection.objects.link(thing)
    paint(thing)


file("mesh_loose_edges", _loose)


def _bad_faces() -> None:
    """Faces without area, double vertices, an n-gon that is concave and one that is bent."""
    start()
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0.3), (0.4, 0.3, 0), (0, 1, 0), (0, 0, 0), (0.5, 0, 0), (1, 0, 0)]
    mesh = bpy.data.meshes.new("Bad")
    mesh.from_pydata(points, [], [(0, 1, 2, 3, 4), (5, 6, 7)])
    thing = bpy.data.objects.new("Bad", mesh)
    bpy.context.scene.collection.objects.link(thing)
    paint(thing)


file("mesh_bad_faces", _bad_faces)


def _custom_normals() -> None:
    start()
    mesh = monkey().data
    normals = np.random.default_rng(3).normal(size=(len(mesh.loops), 3)) * 0.15
    normals += np.array([corner.vector for corner in mesh.corner_normals])
    mesh.normals_split_custom_set([tuple(normal / np.linalg.norm(normal)) for normal in normals])


file("mesh_custom_normals", _custom_normals)


def _sharp_edges() -> None:
    start()
    mesh = ball().data
    for edge in mesh.edges:
        edge.use_edge_sharp = edge.index % 7 == 0


file("mesh_sharp_edges", _sharp_edges)


def _slots(kind: str) -> None:
    """More or fewer materials than faces ask for, on object or mesh."""
    start()
    thing = monkey()
    thing.data.materials.append(plain((0.1, 0.5, 0.2)))
    for face in thing.data.polygons:
        face.material_index = face.index % (2 if kind != "beyond" else 4)
    if kind == "on_object":
        thing.material_slots[1].link = "OBJECT"
        thing.material_slots[1].material = plain((0.1, 0.1, 0.8))
    elif kind == "empty":
        thing.material_slots[1].material = None
    elif kind == "none":
        thing.data.materials.clear()


for kind in ("two", "on_object", "empty", "none", "beyond"):
    file(f"material_slots_{kind}", functools.partial(_slots, kind))
