# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes of the surface, the object and images that are more than their sockets and options."""

import functools
import pathlib
import re

import bpy
import numpy as np

from .....materials.ies import FLAT_PROFILE, ProfileError, profile_table
from .....materials.nodes.geometry import CAST_ATTRIBUTE
from .....materials.sky.picture import sky_picture
from .....scene import Image, Link
from .....scene.common.whole_files import is_no_file
from .....scene.common.working_space import WorkingSpace
from .....scene.sky import Sky
from ...geometry.meshes.attributes import (
    ACTIVE_COLOR,
    GENERATED,
    INSTANCER_GENERATED,
    INSTANCER_UV,
    ISLAND,
    NO_ATTRIBUTE,
    POINTINESS,
    TANGENT,
    attribute_of,
)
from ...geometry.strands.attributes import (
    CURVE_RANDOM,
    INTERCEPT,
    LENGTH,
    POINT_PLACE,
    POINT_RADIUS,
    POINT_RANDOM,
    THICKNESS,
)
from ...images.color_spaces import working_space
from ...images.image_look import is_associated
from .graphs import GraphExporter, handles, snake_case
from .links import Path
from .texture_mapping import is_mapped


def _subsurface_method(node: bpy.types.Node, name: str) -> dict[str, str]:
    """The option of that name: before Blender 5.2, Random Walk is what is a legacy there."""
    methods = node.bl_rna.properties[name].enum_items
    is_legacy = getattr(node, name) == "RANDOM_WALK" and "RANDOM_WALK_LEGACY" not in methods
    return {name: "RANDOM_WALK_LEGACY"} if is_legacy else {}


@handles("SUBSURFACE_SCATTERING")
def _subsurface(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> object:
    return exporter.add("subsurface_scattering", node, path, "bssrdf", options=_subsurface_method(node, "falloff"))


@handles("BSDF_PRINCIPLED")
def _principled(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> object:
    under = next((socket for socket in node.inputs if socket.identifier == "Subsurface Weight"), None)
    has_subsurface = under is not None and (exporter.is_linked(under, path) or exporter.value(under, path) != 0.0)
    if has_subsurface and node.subsurface_method == "BURLEY":
        exporter.warn(node, "has the subsurface method Christensen-Burley, for which a random walk stands in")
    method = _subsurface_method(node, "subsurface_method")
    wall = next((socket for socket in node.inputs if socket.identifier == "Thin Wall"), None)
    value = False if wall is None else exporter.value(wall, path)  # sockets of Blender 5.2 on
    if not isinstance(value, Link):
        options = {"thin_wall": bool(np.max(value) > 0.0)} | method
        return exporter.add("bsdf_principled", node, path, "bsdf", options=options)
    # What varies chooses one of two surfaces. As in Cycles it is cut to an integer before it is asked whether it is 0.
    thick, thin = (
        exporter.append("bsdf_principled", node, path, "bsdf", options={"thin_wall": thin} | method)
        for thin in (False, True)
    )
    for operation in ("TRUNC", "ABSOLUTE"):
        value = exporter.graph.add(
            "math", "value", name=exporter.name_of(node), options={"operation": operation}, value=value
        )
    return exporter.graph.add(
        "mix_shader", "shader", name=exporter.name_of(node), fac=value, shader=thick, shader_001=thin
    )


_OF_INSTANCERS = {"generated": INSTANCER_GENERATED, "uv": INSTANCER_UV}


@handles("TEX_COORD")
def _coordinates(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> object:
    name = snake_case(output.identifier)
    if node.from_instancer and name in _OF_INSTANCERS:
        return exporter.shared("attribute", "vector", _OF_INSTANCERS[name], exporter.name_of(node))
    if name == "generated":
        return exporter.shared("generated_coord", "generated", GENERATED)
    if name == "object" and node.object is not None:
        rows = np.array(node.object.matrix_world.inverted_safe())
        return exporter.graph.add(
            "object_coord", "object", name=exporter.name_of(node), row0=tuple(rows[0, :3]), row1=tuple(rows[1, :3]),
            row2=tuple(rows[2, :3]), offset=tuple(rows[:3, 3]),
        )  # fmt: skip
    return exporter.shared("tex_coord", name)


@handles("NEW_GEOMETRY")
def _geometry(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> object:
    name = snake_case(output.identifier)
    if name == "random_per_island":
        return exporter.shared("random_per_island", name, ISLAND)
    if name == "pointiness":
        return exporter.shared("attribute", "fac", POINTINESS)
    return exporter.shared("new_geometry", name)


@handles("UVMAP")
def _uv_map(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> object:
    if node.from_instancer:
        return exporter.shared("attribute", "vector", INSTANCER_UV, exporter.name_of(node))
    if not node.uv_map:
        return exporter.shared("tex_coord", "uv")
    return exporter.shared("uvmap", "uv", node.uv_map, exporter.name_of(node))


@handles("VERTEX_COLOR")
def _color_attribute(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> object:
    attribute, name = node.layer_name or ACTIVE_COLOR, exporter.name_of(node)
    return exporter.shared("attribute", snake_case(output.identifier), attribute, name)


_STANDARD = {"generated": GENERATED, "pointiness": POINTINESS}
"""Attributes that Cycles computes, by the names under which it finds them."""


@handles("ATTRIBUTE")
def _attribute(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> object:
    if node.attribute_type == "VIEW_LAYER":
        return _view_layer_attribute(exporter, node, output)
    is_geometry, attribute = node.attribute_type == "GEOMETRY", node.attribute_name
    attribute = _STANDARD.get(attribute, attribute) if is_geometry else f"{node.attribute_type}:{attribute}"
    name = exporter.name_of(node)
    return exporter.shared("attribute", snake_case(output.identifier), attribute or NO_ATTRIBUTE, name)


def _view_layer_attribute(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket) -> object:
    """A property of the view layer, the scene or the world, which is one value for all surfaces."""
    exporter.context.owner_reads += 1
    for owner in exporter.context.owners:
        value = attribute_of(owner, node.attribute_name)
        if value is not None:
            color = (*value, *(1.0,) * 4)[:4] if len(value) > 1 else (value[0],) * 3 + (1.0,)
            return {"Alpha": color[3], "Fac": sum(color[:3]) / 3.0}.get(output.identifier, color[:3])
    return 0.0


@handles("TANGENT")
def _tangent(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> object:
    attribute = GENERATED if node.direction_type == "RADIAL" else TANGENT + node.uv_map
    return exporter.add("tangent", node, path, "tangent", attribute=attribute)


@handles("NORMAL_MAP")
def _normal_map(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> object:
    return exporter.add("normal_map", node, path, "normal", attribute=TANGENT + node.uv_map)


@handles("VECTOR_DISPLACEMENT")
def _vector_displacement(
    exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path
) -> object:
    attribute = TANGENT if node.space == "TANGENT" else NO_ATTRIBUTE
    return exporter.add("vector_displacement", node, path, "displacement", attribute=attribute)


@handles("AMBIENT_OCCLUSION")
def _ambient_occlusion(
    exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path
) -> object:
    reach = next(socket for socket in node.inputs if socket.identifier == "Distance")
    inputs = {}
    if not exporter.is_linked(reach, path) and exporter.value(reach, path) == 0.0:  # the world's, as in Cycles
        exporter.context.owner_reads += 1
        worlds = [owner for owner in exporter.context.owners if isinstance(owner, bpy.types.World)]
        inputs["distance"] = worlds[0].light_settings.distance if worlds else 0.0
    return exporter.add("ambient_occlusion", node, path, snake_case(output.identifier), inputs=inputs)


@handles("MATERIAL_RAYCAST")  # of Blender 5.1; the attributes that it samples are of 5.2
def _raycast(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> object:
    found = re.fullmatch(r"Attribute_(\d+)(_Alpha)?", output.identifier)
    if found is None:
        return exporter.add("raycast", node, path, snake_case(output.identifier))
    named = next(socket for socket in node.inputs if socket.identifier == f"Value_{found[1]}")
    name = exporter.text(named, path)
    if not name:
        return 0.0 if output.type == "VALUE" else (0.0, 0.0, 0.0)
    ray = exporter.add("raycast", node, path).node
    member = "alpha" if found[2] else {"VECTOR": "vector", "RGBA": "color"}.get(output.type, "fac")
    return exporter.graph.add(
        CAST_ATTRIBUTE, member, name=exporter.name_of(node), attribute=name,
        triangle=Link(ray, "hit_triangle"), barycentrics=Link(ray, "hit_barycentrics"),
    )  # fmt: skip


@handles("OBJECT_INFO")
def _object_info(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> object:
    name = snake_case(output.identifier)
    if name == "material_index":
        return float(exporter.pass_index)
    return exporter.shared("object_info", name)


@handles("TEX_IMAGE")
def _image_texture(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> object:
    warn = functools.partial(exporter.warn, node)
    tiles = exporter.images.tiles(node, warn)
    image = exporter.images.of_node(node, warn) if tiles is None else -1
    # Only now is the image loaded: before, a movie has no color space.
    unassociate = is_associated(node.image) and any(
        socket.identifier == "Alpha" and socket.is_linked for socket in node.outputs
    )
    options = {"unassociate": unassociate}
    name = snake_case(output.identifier)
    if tiles is not None:
        return exporter.add("tex_image_tiles", node, path, name, options=options, table=tiles,
                            inputs={"tiles": float(len(tiles))})  # fmt: skip
    blend = {"projection_blend": node.projection_blend}
    return exporter.add("tex_image", node, path, name, options=options, image=image, inputs=blend)


@handles("TEX_ENVIRONMENT")
def _environment_texture(
    exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path
) -> object:
    image = exporter.images.of_node(node, functools.partial(exporter.warn, node))
    return exporter.add("tex_environment", node, path, "color", image=image)


@handles("TEX_IES")
def _ies_texture(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> object:
    vector = next(socket for socket in node.inputs if socket.identifier == "Vector")
    inputs = {}
    if not exporter.is_given(vector, path):
        incoming = exporter.shared("new_geometry", "incoming")
        inputs["vector"] = exporter.graph.add(
            "vector_transform", "vector", name=exporter.name_of(node), vector=incoming,
            options={"vector_type": "NORMAL", "convert_from": "WORLD", "convert_to": "OBJECT"},
        )  # fmt: skip
    try:
        table = profile_table(_profile(node, exporter.user_node(node).id_data.library))
    except (ProfileError, OSError) as error:
        exporter.warn(node, f"has no IES profile that can be read ({error}); its value is 100, as in Cycles")
        table = FLAT_PROFILE
    return exporter.add("tex_ies", node, path, "fac", table=table, inputs=inputs)


def _profile(node: bpy.types.Node, library: bpy.types.Library | None) -> str:
    """The text of the IES profile of a node that comes from a library. Raises OSError."""
    if node.mode == "INTERNAL":
        return "" if node.ies is None else node.ies.as_string()
    file = pathlib.Path(bpy.path.abspath(node.filepath, library=library))
    if is_no_file(file):
        raise OSError(f"{file} is no file")
    return file.read_text(encoding="latin-1")


@handles("HAIR_INFO")
def _hair_info(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> object:
    name = snake_case(output.identifier)
    if name in _OF_STRANDS:
        return exporter.shared(*_OF_STRANDS[name])
    return exporter.shared("hair_info", name)


@handles("BSDF_HAIR_PRINCIPLED")
def _principled_hair(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> object:
    """Strands have random numbers of their own where none are given, and where they make a difference."""
    inputs: dict[str, object] = {}
    sockets = {socket.identifier: socket for socket in node.inputs if socket.enabled}
    factors = [sockets[name] for name in ("Random Color", "Random Roughness") if name in sockets]
    if not exporter.is_linked(sockets["Random"], path) and any(
        exporter.is_linked(factor, path) or factor.default_value != 0.0 for factor in factors
    ):
        inputs["strand_random"] = exporter.shared(*_OF_STRANDS["random"])
    return exporter.add("bsdf_hair_principled", node, path, "bsdf", inputs=inputs)


@handles("POINT_INFO")
def _point_info(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> object:
    return exporter.shared(*_OF_POINTS[snake_case(output.identifier)])


_OF_STRANDS = {
    "intercept": ("strand_value", "value", INTERCEPT),
    "length": ("strand_value", "value", LENGTH),
    "thickness": ("round_size", "size", THICKNESS),
    "random": ("strand_value", "value", CURVE_RANDOM),
}
"""Kind and output of the nodes that give Hair Info's outputs, and the attribute that they read."""
_OF_POINTS = {
    "position": ("point_position", "position", POINT_PLACE),
    "radius": ("round_size", "size", POINT_RADIUS),
    "random": ("strand_value", "value", POINT_RANDOM),
}
"""Likewise of Point Info's."""


@handles("UVALONGSTROKE")
def _other_geometry(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> object:
    return 0.0 if output.type == "VALUE" else (0.0, 0.0, 0.0)


@handles("TEX_SKY")
def _sky_texture(exporter: GraphExporter, node: bpy.types.Node, output: bpy.types.NodeSocket, path: Path) -> Link:
    sky = sky_of(node)
    name = exporter.name_of(node)
    space = working_space()
    image = exporter.images.computed((name, sky), lambda: _sky_image(name, sky, space))
    vector = exporter.coordinates_of(node, path)
    is_direction = exporter.is_world and exporter.given_coordinates(node, path) is None and not is_mapped(node)
    if not exporter.is_world and sky.scatters and sky.sun_disc and sky.sun_intensity > 0.0:
        exporter.warn(node, "has a sun, which is rendered in worlds alone; it is left out")
    options = {} if is_direction else {"projection": "SKY"}
    link = exporter.graph.add("tex_environment", "color", name=name, options=options, image=image, vector=vector)
    exporter.skies[link.node] = sky
    return link


@functools.lru_cache(maxsize=8)
def _sky_image(name: str, sky: Sky, space: WorkingSpace) -> Image:
    """Simulating an atmosphere takes up to a second: frames whose sky stays the same share its picture."""
    return Image(name, sky_picture(sky, space=space))


def sky_of(node: bpy.types.Node) -> Sky:
    """Return the sky that a Sky Texture node describes."""
    values = {name: getattr(node, name) for name in Sky.__dataclass_fields__ if hasattr(node, name)}
    values["sun_direction"] = tuple(values.get("sun_direction", (0.0, 0.0, 1.0)))
    if values["sky_type"] == "NISHITA":  # Blender 4
        values["sky_type"] = "SINGLE_SCATTERING"
        values["aerosol_density"] = node.dust_density
    return Sky(**values)
