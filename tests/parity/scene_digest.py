# SPDX-License-Identifier: GPL-3.0-or-later
"""A digest of all that the current Blender scene tells a render engine.

What Blender keeps for its windows is left out, as are RPPM's own settings and the last bits of numbers, which differ
between processors.
"""

import functools
import hashlib
import sys
import warnings
from pathlib import Path

import bpy
import numpy as np

_ROOMS = (
    "actions", "armatures", "cameras", "collections", "curves", "fonts", "hair_curves", "images", "lattices",
    "lightprobes", "lights", "materials", "meshes", "metaballs", "movieclips", "node_groups", "objects", "particles",
    "pointclouds", "scenes", "shape_keys", "texts", "textures", "volumes", "worlds",
)  # fmt: skip
"""Collections of bpy.data that the digest covers."""
_LEFT_OUT = {
    # Of windows and of files.
    "rna_type", "bl_rna", "id_data", "preview", "asset_data", "session_uid", "users", "original", "is_evaluated", "tag",
    "is_missing", "is_library_indirect", "name_full", "library", "library_weak_reference", "override_library",
    "filepath", "filepath_raw", "filepath_from_user", "bindcode", "is_dirty", "packed_file", "packed_files",
    "tool_settings", "unit_settings", "cursor", "display", "eevee", "grease_pencil", "shading", "safe_areas",
    "transform_orientation_slots", "sequence_editor", "keying_sets", "keying_sets_all", "timeline_markers",
    "node_tree_editor", "depsgraph", "evaluated_depsgraph", "view_center", "interface", "ui_units_x", "ui_units_y",
    # Follows from the rest, or leads back.
    "matrix_world", "matrix_local", "matrix_parent_inverse_world", "bound_box", "dimensions", "children",
    "children_recursive", "users_collection", "users_scene", "all_objects", "rigidbody_world", "parent_type",
    "internal_links", "color_tag", "location_absolute", "warning_propagation", "active", "active_index", "select",
    "width", "height", "is_active_output", "is_updated", "is_updated_data", "pixels", "has_data", "render_slots",
    "frame_duration", "error_message", "links", "threads", "threads_mode", "preview_texture", "compositor_device",
}  # fmt: skip
_GEOMETRY = {
    "vertices", "edges", "loops", "polygons", "loop_triangles", "loop_triangle_polygons", "vertex_normals",
    "polygon_normals", "corner_normals", "uv_layers", "color_attributes", "vertex_colors", "skin_vertices",
    "sculpt_vertex_colors", "position_data", "points", "curves", "curve_offset_data", "normals", "attributes",
}  # fmt: skip
"""Geometry of meshes and the like, whose attributes tell it. Normals of curves differ across CPUs by more than bits."""
_WITH_ATTRIBUTES = (bpy.types.Mesh, bpy.types.Curves, bpy.types.PointCloud)
_VALUES = {
    "FLOAT": ("value", 1), "INT": ("value", 1), "BOOLEAN": ("value", 1), "INT8": ("value", 1),
    "FLOAT_VECTOR": ("vector", 3), "FLOAT2": ("vector", 2), "FLOAT_COLOR": ("color", 4), "BYTE_COLOR": ("color", 4),
    "INT32_2D": ("value", 2), "INT16_2D": ("value", 2), "QUATERNION": ("value", 4), "FLOAT4X4": ("value", 16),
}  # fmt: skip

_COORDINATES = ("MeshUVLoop", "Float2AttributeValue")
"""Items of UV maps, of which there are thousands."""


@functools.lru_cache(maxsize=1 << 16)
def _few_bits(value: float) -> bytes:
    """Return one number without its last 8 bits, as _Digest.numbers has those of an array."""
    (bits,) = np.float32([0.0 if abs(np.float32(value)) < np.float32(1e-6) else value]).view(np.uint32)
    return (((int(bits) + 0x4B) >> 8) & 0xFFFFFFFF).to_bytes(4, sys.byteorder)


def _few_bits_of(values: object) -> np.ndarray:
    """Return the numbers of an array without their last 8 bits, flat, uint32."""
    bits = np.ascontiguousarray(values, np.float32).ravel()
    bits = np.where(np.abs(bits) < 1e-6, np.float32(0.0), bits).view(np.uint32)
    return ((bits.astype(np.uint64) + 0x4B) >> 8).astype(np.uint32)


class _Digest:
    def __init__(self) -> None:
        self.hash = hashlib.sha256()
        self.inside: set[int] = set()
        self.properties: dict[type, list[tuple[str, str, bool]]] = {}

    def text(self, *words: object) -> None:
        self.hash.update("\0".join(map(str, words)).encode() + b"\1")

    def numbers(self, values: object) -> None:
        """Floats but for the last 8 bits; what is next to nothing is nothing."""
        if isinstance(values, list):  # of a property: few, and there are thousands of these
            self.hash.update(b"".join(map(_few_bits, values)))
            return
        self.hash.update(_few_bits_of(values).tobytes())

    def members(self, owner: bpy.types.bpy_struct) -> list[tuple[str, str, bool]]:
        """Identifier, type and whether it is an array, of what counts."""
        kind = type(owner)
        if kind not in self.properties:
            left_out = _LEFT_OUT | (_GEOMETRY if isinstance(owner, _WITH_ATTRIBUTES) else set())
            if not isinstance(owner, bpy.types.Scene | bpy.types.RenderSettings | bpy.types.ImageFormatSettings):
                left_out = left_out - {"display"}
            if isinstance(owner, bpy.types.ImageFormatSettings):
                left_out |= {entry.identifier for entry in owner.bl_rna.properties}
            self.properties[kind] = sorted(
                (entry.identifier, entry.type, getattr(entry, "is_array", False))
                for entry in owner.bl_rna.properties
                if entry.identifier not in left_out
                and not entry.identifier.startswith(("rppm", "show_", "select_", "ui_"))
            )
        return self.properties[kind]

    def struct(self, owner: bpy.types.bpy_struct) -> None:
        """All that an RNA struct holds; other data blocks by their names."""
        pointer = owner.as_pointer()
        if pointer in self.inside:
            return
        self.inside.add(pointer)
        self.text(type(owner).__name__)
        for name, kind, is_array in self.members(owner):
            try:
                value = getattr(owner, name)
            except (AttributeError, RuntimeError, ValueError):
                continue
            if kind in ("POINTER", "COLLECTION"):
                self.text(name)
                if kind == "COLLECTION" and self.coordinates(value):
                    continue
                for one in [value] if kind == "POINTER" else value:
                    self.reference(one)
            elif is_array:
                self.text(name)
                self.numbers([*np.ravel(value)])
            elif kind == "FLOAT":
                self.text(name)
                self.numbers([value])
            else:
                self.text(name, sorted(value) if isinstance(value, set) else value)
        if isinstance(owner, bpy.types.NodeTree):
            for link in owner.links:
                ends = (link.from_node.name, link.from_socket.identifier, link.to_node.name, link.to_socket.identifier)
                self.text(*ends, link.is_muted)
        if isinstance(owner, bpy.types.Object):  # whose linking has the same address
            for name in ("receiver_collection", "blocker_collection"):
                if (collection := getattr(owner.light_linking, name)) is not None:
                    self.text(name, collection.name)
        self.inside.remove(pointer)

    def coordinates(self, items: bpy.types.bpy_prop_collection) -> bool:
        """Hash all items of a UV map at once, as struct() does one by one; return False, without a hash, for others."""
        kind = type(items[0]).__name__ if len(items) else ""
        if kind not in _COORDINATES:
            return False
        parts = [f"{kind}\1".encode()]
        for name, _, is_array in self.members(items[0]):
            if is_array:
                values = np.zeros(2 * len(items), np.float32)
                items.foreach_get(name, values)
                parts += [f"{name}\1".encode(), _few_bits_of(values).reshape(-1, 2).view(np.uint8)]
            else:
                flags = np.zeros(len(items), bool)
                items.foreach_get(name, flags)
                if flags.any() != flags.all():
                    return False
                parts.append(f"{name}\0{flags[0]}\1".encode())
        columns = [
            np.broadcast_to(np.frombuffer(part, np.uint8), (len(items), len(part))) if isinstance(part, bytes) else part
            for part in parts
        ]
        self.hash.update(np.hstack(columns).tobytes())
        return True

    def reference(self, value: object) -> None:
        if isinstance(value, bpy.types.ID) and not getattr(value, "is_embedded_data", False):
            self.text(type(value).__name__, value.name)
        elif isinstance(value, bpy.types.bpy_struct):
            self.struct(value)
        else:
            self.text(value)

    def geometry(self, data: bpy.types.ID) -> None:
        """Hash a mesh, point cloud or curves; the order of edges, which changes from run to run, is left out."""
        for attribute in sorted(data.attributes, key=lambda attribute: attribute.name):
            if attribute.name.startswith(".") or attribute.domain == "EDGE":
                continue
            name, width = _VALUES.get(attribute.data_type, (None, 0))
            self.text(attribute.name, attribute.domain, attribute.data_type)
            if name is not None and len(attribute.data):
                values = np.zeros(len(attribute.data) * width, np.float32)
                attribute.data.foreach_get(name, values)
                self.numbers(values)
        if isinstance(data, bpy.types.Mesh):
            starts, corners = np.zeros(len(data.polygons), np.int32), np.zeros(len(data.loops), np.int32)
            data.polygons.foreach_get("loop_start", starts)
            data.loops.foreach_get("vertex_index", corners)
            self.hash.update(starts.tobytes() + corners.tobytes())
        elif isinstance(data, bpy.types.Curves):
            starts = np.zeros(len(data.curve_offset_data), np.int32)
            data.curve_offset_data.foreach_get("value", starts)
            self.hash.update(starts.tobytes())

    def image(self, image: bpy.types.Image) -> None:
        """Bytes of the file, or pixels of what has none."""
        path = Path(bpy.path.abspath(image.filepath))
        if not image.filepath:
            self.numbers(image.pixels[:])
        elif path.is_file():
            self.hash.update(path.read_bytes())
        elif image.packed_file:
            self.numbers(image.pixels[:])
        else:  # tiles and sequences
            for part in sorted(path.parent.glob(path.name.split(".")[0].split("<")[0] + "*")):
                self.hash.update(part.read_bytes())


def scene_digest() -> str:
    """Return the digest of the current scene and this Blender, in hexadecimal."""
    digest = _Digest()
    digest.text(bpy.app.version_string, bpy.context.scene.name)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of members that Blender 6 will not have
        _add_data(digest)
    space = getattr(getattr(bpy.data, "colorspace", None), "working_space", "Linear Rec.709")
    if space != "Linear Rec.709":
        digest.text("working space", space)
    return digest.hash.hexdigest()[:32]


def _add_data(digest: _Digest) -> None:
    for room in _ROOMS:
        for block in getattr(bpy.data, room, ()):
            if isinstance(block, bpy.types.Image) and block.source == "VIEWER":
                continue  # the render before this one
            digest.text(room, block.name)
            digest.struct(block)
            if hasattr(block, "attributes"):
                digest.geometry(block)
            if isinstance(block, bpy.types.Image):
                digest.image(block)
