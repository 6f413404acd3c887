# SPDX-License-Identifier: GPL-3.0-or-later
"""Every property that a Blender scene may hold, and a change of each to another value and back.

A property has a key: the RNA type that declares it and its identifier, as in ``Light.energy`` and
``CyclesRenderSettings.samples``.
"""

import contextlib
import itertools
import re
from collections.abc import Iterator
from dataclasses import dataclass

import bpy

OF_ALL = {prop.identifier for prop in bpy.types.ID.bl_rna.properties} | {"rna_type", "name", "rppm", "rppm_switches"}
"""Properties that are of data blocks as such, and RPPM's own."""
FOLLOWED = {
    "cycles", "cycles_curves", "cycles_visibility", "data", "dof", "color_ramp", "colorspace_settings", "elements",
    "image_user", "iris_fisheye", "inputs", "layer_collection", "light_linking", "light_settings", "lightgroups",
    "mapping", "material_slots", "mist_settings", "node_tree", "nodes", "outputs", "particle_systems", "render",
    "settings", "stereo", "texture_mapping", "view_layers", "views", "world", "materials", "image", "grids", "aovs",
    "children", "motion_blur_shutter_curve", "interface", "color_mapping", "links", "render_shape",
}  # fmt: skip
"""Pointers and collections through which a scene's blocks are walked."""

_OWNERS_OF_GROUPS = ("Camera", "Light", "Material", "Object", "Scene", "ViewLayer", "World")
"""Types to which Cycles adds property groups."""


@dataclass(frozen=True)
class Change:
    """Another value of a property of a struct."""

    key: str
    owner: bpy.types.bpy_struct
    name: str
    value: object

    @contextlib.contextmanager
    def made(self) -> Iterator[None]:
        """Give the property the value in a with block; what Blender refuses is not given."""
        before = _plain(getattr(self.owner, self.name))
        with contextlib.suppress(TypeError):
            setattr(self.owner, self.name, self.value)
        _tag(self.owner)
        try:
            yield
        finally:
            with contextlib.suppress(TypeError):
                setattr(self.owner, self.name, before)
            _tag(self.owner)


def _tag(owner: bpy.types.bpy_struct) -> None:
    """Have Blender take note of an edit, as it does of one in a window."""
    block = owner.id_data
    if block is not None:
        block.update_tag()


def _plain(value: object) -> object:
    if isinstance(value, (str, set)) or not hasattr(value, "__len__") or isinstance(value, bpy.types.bpy_struct):
        return value
    return tuple(_plain(entry) for entry in value)


def rna_of(name: str) -> bpy.types.Struct:
    """Return the RNA of a type by its name, of the property groups of Cycles as well."""
    found = getattr(bpy.types, name, None)
    if found is not None:
        return found.bl_rna
    owners = (getattr(bpy.types, owner).bl_rna for owner in _OWNERS_OF_GROUPS)
    groups = (prop.fixed_type for owner in owners for prop in owner.properties if prop.identifier.startswith("cycles"))
    return next(group for group in groups if group.identifier == name)


def settable(rna: bpy.types.Struct) -> list[str]:
    """Keys of the properties of a type that users can set, those of its base types with these."""
    keys = []
    for prop in rna.properties:
        if not prop.is_readonly and prop.type != "COLLECTION" and prop.identifier not in OF_ALL:
            declaring = rna
            while declaring.base is not None and prop.identifier in declaring.base.properties:
                declaring = declaring.base
            keys.append(f"{declaring.identifier}.{prop.identifier}")
    return keys


def changes_of(owner: bpy.types.bpy_struct) -> Iterator[Change]:
    """Yield changes of all that can be set in a struct, several of one property where one may not be enough."""
    for key in settable(owner.bl_rna):
        name = key.partition(".")[2]
        prop = owner.bl_rna.properties[name]
        try:
            if owner.is_property_readonly(name):
                continue
            values = list(_others(owner, prop, getattr(owner, name)))
        except (AttributeError, ValueError, TypeError, RuntimeError):
            continue
        for value in values:
            yield Change(key, owner, name, value)


def _others(owner: bpy.types.bpy_struct, prop: bpy.types.Property, value: object) -> Iterator[object]:
    if prop.type == "ENUM":
        if prop.is_enum_flag:
            for item in prop.enum_items:
                yield value ^ {item.identifier}
            return
        yield from (item for item in _choices(owner, prop) if item != value)
    elif prop.type == "POINTER":
        kind = prop.fixed_type.identifier
        if value is not None:
            yield None
        yield from itertools.islice((block for block in _blocks(kind) if block != value), _MOST_BLOCKS)
    elif prop.type == "STRING":
        yield f"{value}other"
    elif getattr(prop, "is_array", False):
        plain = _plain(value)
        if plain and not isinstance(plain[0], tuple):
            yield tuple(_other(prop, entry) for entry in plain)
            yield (_other(prop, plain[0]), *plain[1:])
    else:
        yield _other(prop, value)
        if prop.type == "INT" and abs(value) < 1000:
            yield max(min(value + 4, prop.hard_max), prop.hard_min)
        if prop.type == "FLOAT":
            far = value + (prop.soft_max - prop.soft_min) / 3 if prop.soft_max < 1e4 else 3.0 * value + 7.0
            yield max(min(far, prop.hard_max), prop.hard_min)


def _choices(owner: bpy.types.bpy_struct, prop: bpy.types.Property) -> list[str]:
    """Return the choices of a property; those that a function gives are in what Blender says of a wrong one."""
    if len(prop.enum_items):
        return [item.identifier for item in prop.enum_items]
    try:
        setattr(owner, prop.identifier, "no choice")
    except TypeError as error:
        return re.findall(r"'(\w+)'", str(error).partition("not found in")[2])
    return []


def _other(prop: bpy.types.Property, value: object) -> object:
    if prop.type == "BOOLEAN":
        return not value
    if prop.type == "INT":
        return value + 1 if value < prop.hard_max else value - 1
    further = value * 1.3 if abs(value) > 1e-3 else value + 0.3
    further = min(further, prop.hard_max)
    return further if further != value else max(prop.hard_min, 0.6 * value)


_MOST_BLOCKS = 3
"""Data blocks that are tried for a property that holds one."""
_COLLECTIONS = {
    "Object": "objects", "Material": "materials", "World": "worlds", "Camera": "cameras", "Collection": "collections",
    "Image": "images", "Scene": "scenes", "Texture": "textures", "ShaderNodeTree": "node_groups", "Mesh": "meshes",
    "NodeTree": "node_groups", "Text": "texts",
}  # fmt: skip


def _blocks(kind: str) -> Iterator[bpy.types.ID]:
    if kind in _COLLECTIONS:
        yield from getattr(bpy.data, _COLLECTIONS[kind])


def structs_of(scene: bpy.types.Scene) -> list[bpy.types.bpy_struct]:
    """The scene and all structs that can be reached from it, and the blocks of its objects, each once."""
    found: dict[int, bpy.types.bpy_struct] = {}
    waiting = [scene, *scene.objects, *(block for block in bpy.data.particles if block.users)]
    while waiting:
        struct = waiting.pop(0)
        key = (struct.as_pointer(), struct.bl_rna.identifier)
        if key in found:
            continue
        found[key] = struct
        for prop in struct.bl_rna.properties:
            if prop.identifier not in FOLLOWED:
                continue
            value = getattr(struct, prop.identifier, None)
            held = value if prop.type == "COLLECTION" else [value]
            waiting += [entry for entry in held or () if isinstance(entry, bpy.types.bpy_struct)]
    return list(found.values())
