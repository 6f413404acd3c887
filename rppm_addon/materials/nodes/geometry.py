# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes about the place, the object, the path and the normal."""

from typing import Any

from ...gl.buffers.constants import Constants
from .node_kinds import BOOLEAN, COLOR, FLOAT, VECTOR, NodeKind

CAST_ATTRIBUTE = "cast_attribute"
"""The kind that reads an attribute of other surfaces than its own."""
_UP = (0.0, 0.0, 1.0)
_NORMAL_MAP_SPACES = ("TANGENT", "OBJECT", "WORLD", "BLENDER_OBJECT", "BLENDER_WORLD")
_DISPLACEMENT_SPACES = ("OBJECT", "WORLD")
_VECTOR_DISPLACEMENT_SPACES = ("TANGENT", "OBJECT", "WORLD")
Constants(
    "NormalSpaces",
    NORMAL_MAP=_NORMAL_MAP_SPACES,
    DISPLACEMENT=_DISPLACEMENT_SPACES,
    VECTOR_DISPLACEMENT=_VECTOR_DISPLACEMENT_SPACES,
)


def _geometry(outputs: dict, **members: Any) -> NodeKind:
    return NodeKind("geometry.glsl", outputs=outputs, surface=True, **members)


KINDS = {
    "tex_coord": _geometry(dict.fromkeys(("normal", "uv", "object", "camera", "window", "reflection"), VECTOR)),
    "generated_coord": _geometry({"generated": VECTOR}, resources=("attribute",)),
    "object_coord": _geometry(
        {"object": VECTOR},
        inputs={
            "row0": (VECTOR, (1.0, 0.0, 0.0)),
            "row1": (VECTOR, (0.0, 1.0, 0.0)),
            "row2": (VECTOR, _UP),
            "offset": (VECTOR, 0.0),
        },
    ),
    "uvmap": _geometry({"uv": VECTOR}, resources=("attribute",)),
    "attribute": _geometry(
        {"color": COLOR, "vector": VECTOR, "fac": FLOAT, "alpha": FLOAT}, resources=("attribute",)
    ),
    # Of a grid of a volume: 1 where there is none of that name.
    "grid_attribute": _geometry({"color": COLOR, "fac": FLOAT}, resources=("attribute",)),
    "new_geometry": _geometry(
        {
            **dict.fromkeys(("position", "normal", "tangent", "true_normal", "incoming", "parametric"), VECTOR),
            "backfacing": FLOAT,
        },
    ),
    "random_per_island": _geometry({"random_per_island": FLOAT}, resources=("attribute",)),
    "tangent": _geometry(
        {"tangent": VECTOR},
        options={"direction_type": ("RADIAL", "UV_MAP"), "axis": ("X", "Y", "Z")},
        resources=("attribute",),
    ),
    "strand_value": _geometry({"value": FLOAT}, resources=("attribute",)),
    "hair_info": _geometry({"is_strand": FLOAT, "tangent_normal": VECTOR}),
    "point_position": _geometry({"position": VECTOR}, resources=("attribute",)),
    "round_size": _geometry({"size": FLOAT}, resources=("attribute",)),
    "object_info": _geometry(
        {
            "location": VECTOR, "color": COLOR, "alpha": FLOAT, "object_index": FLOAT, "material_index": FLOAT,
            "random": FLOAT,
        },
        inputs={"material_index": (FLOAT, 0.0)},
    ),
    "particle_info": _geometry(
        {
            "index": FLOAT, "random": FLOAT, "age": FLOAT, "lifetime": FLOAT, "location": VECTOR, "size": FLOAT,
            "velocity": VECTOR, "angular_velocity": VECTOR,
        },
    ),
    "camera": _geometry({"view_vector": VECTOR, "view_z_depth": FLOAT, "view_distance": FLOAT}),
    "light_path": _geometry(
        dict.fromkeys(
            (
                "is_camera_ray", "is_shadow_ray", "is_diffuse_ray", "is_glossy_ray", "is_singular_ray",
                "is_reflection_ray", "is_transmission_ray", "is_volume_scatter_ray", "ray_length", "ray_depth",
                "diffuse_depth", "glossy_depth", "transparent_depth", "transmission_depth", "portal_depth",
            ),
            FLOAT,
        )
    ),
    "wireframe": _geometry(
        {"fac": FLOAT}, options={"use_pixel_size": BOOLEAN}, inputs={"size": (FLOAT, 0.01)}
    ),
    "normal_map": NodeKind(
        "normals.glsl",
        inputs={"strength": (FLOAT, 1.0), "color": (COLOR, (0.5, 0.5, 1.0))},
        outputs={"normal": VECTOR},
        options={"space": _NORMAL_MAP_SPACES},
        resources=("attribute",),
        surface=True,
    ),
    "bump": NodeKind(
        "normals.glsl",
        inputs={
            "strength": (FLOAT, 1.0), "distance": (FLOAT, 1.0), "filter_width": (FLOAT, 0.1), "height": (FLOAT, 1.0),
            "normal": (VECTOR, "normal"),
        },
        outputs={"normal": VECTOR},
        options={"invert": BOOLEAN},
        surface=True,
    ),
    "displacement": NodeKind(
        "normals.glsl",
        inputs={
            "height": (FLOAT, 0.0), "midlevel": (FLOAT, 0.5), "scale": (FLOAT, 1.0), "normal": (VECTOR, "normal"),
        },
        outputs={"displacement": VECTOR},
        options={"space": _DISPLACEMENT_SPACES},
        surface=True,
    ),
    "vector_displacement": NodeKind(
        "normals.glsl",
        inputs={"vector": (VECTOR, 0.0), "midlevel": (FLOAT, 0.0), "scale": (FLOAT, 1.0)},
        outputs={"displacement": VECTOR},
        options={"space": _VECTOR_DISPLACEMENT_SPACES},
        resources=("attribute",),
        surface=True,
    ),
    "displacement_height": NodeKind(
        "normals.glsl", inputs={"displacement": (VECTOR, 0.0)}, outputs={"height": FLOAT}, surface=True
    ),
    "bevel": NodeKind(
        "ray_nodes.glsl",
        inputs={"radius": (FLOAT, 0.05), "normal": (VECTOR, "normal"), "samples": (FLOAT, 4.0)},
        outputs={"normal": VECTOR},
        surface=True,
        ray_places=1,
    ),
    "ambient_occlusion": NodeKind(
        "ray_nodes.glsl",
        inputs={
            "color": (COLOR, 1.0), "distance": (FLOAT, 1.0), "normal": (VECTOR, "normal"), "samples": (FLOAT, 16.0),
        },
        outputs={"color": COLOR, "ao": FLOAT},
        options={"inside": BOOLEAN, "only_local": BOOLEAN},
        surface=True,
        ray_places=1,
    ),
    "raycast": NodeKind(
        "raycast.glsl",
        inputs={"position": (VECTOR, "position"), "direction": (VECTOR, "normal"), "length": (FLOAT, 1.0)},
        outputs={
            "is_hit": FLOAT, "self_hit": FLOAT, "hit_distance": FLOAT, "hit_position": VECTOR, "hit_normal": VECTOR,
            "hit_triangle": VECTOR, "hit_barycentrics": VECTOR,
        },
        options={"only_local": BOOLEAN},
        surface=True,
        ray_places=2,
    ),
    # Of what a raycast hit, whose last two outputs it takes.
    CAST_ATTRIBUTE: NodeKind(
        "cast_attribute.glsl",
        inputs={"triangle": (VECTOR, 0.0), "barycentrics": (VECTOR, 0.0)},
        outputs={"color": COLOR, "vector": VECTOR, "fac": FLOAT, "alpha": FLOAT},
        resources=("attribute",),
        surface=True,
    ),
}  # fmt: skip
