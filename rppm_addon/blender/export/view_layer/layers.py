# SPDX-License-Identifier: GPL-3.0-or-later
"""Effects of a view layer on a scene: other materials, another world, and collections that are masks."""

from collections.abc import Iterator
from dataclasses import dataclass

import bpy

from ....scene import RayVisibility

_Mask = tuple[str, bool, bool]


@dataclass(frozen=True)
class LayerFilter:
    """Kinds of things that a view layer has, by its panel Filter."""

    environment: bool = True
    """True where it has the world's light."""
    surfaces: bool = True
    volumes: bool = True
    """True where it has volume objects and the gas of fluid domains. Volumes of materials are there anyway."""

    @classmethod
    def of(cls, layer: bpy.types.ViewLayer) -> "LayerFilter":
        """Return what a view layer has."""
        return cls(layer.use_sky, layer.use_solid, layer.use_volumes)


def world_of(depsgraph: bpy.types.Depsgraph) -> bpy.types.World | None:
    """The world of the depsgraph's view layer, evaluated."""
    return getattr(depsgraph.view_layer_eval, "world_override", None) or depsgraph.scene_eval.world


def overrides_of(depsgraph: bpy.types.Depsgraph) -> tuple[object, ...]:
    """Return values that are equal where a depsgraph's view layer makes the same of its scene as before."""
    layer = depsgraph.view_layer_eval
    override, world = layer.material_override, getattr(layer, "world_override", None)
    blocks = [None if block is None else block.original.session_uid for block in (override, world)]
    groups = _light_groups(depsgraph.view_layer, world_of(depsgraph))
    return (*blocks, LayerFilter.of(layer), *_masks(layer.layer_collection), *groups)


def light_group_of(owner: bpy.types.Object | bpy.types.World) -> str:
    """The name of its light group. Blender neither reports that it changes nor evaluates it anew."""
    return owner.original.lightgroup


def _light_groups(layer: bpy.types.ViewLayer, world: bpy.types.World | None) -> Iterator[tuple[object, ...]]:
    """Yield the names of the light groups, then the session_uid and group of each member; nothing without groups."""
    if len(layer.lightgroups) == 0:
        return
    yield tuple(layer.lightgroups.keys())
    for owner in (*([world] if world is not None else []), *layer.objects):
        if group := light_group_of(owner):
            yield owner.original.session_uid, group


def _masks(collection: bpy.types.LayerCollection) -> Iterator[_Mask]:
    if collection.holdout or collection.indirect_only:
        yield collection.name, collection.holdout, collection.indirect_only
    for child in collection.children:
        yield from _masks(child)


class LayerMasks:
    """Which objects are holes in the picture, or are not seen by the camera, because a collection of theirs is."""

    def __init__(self, layer: bpy.types.ViewLayer | None = None) -> None:
        # Each object is only asked where any collection is one.
        self._layer = layer if layer is not None and any(_masks(layer.layer_collection)) else None

    @property
    def any(self) -> bool:
        """Whether there are such collections."""
        return self._layer is not None

    def of(self, owner: bpy.types.Object, visibility: RayVisibility, holdout: bool) -> tuple[RayVisibility, bool]:
        """Visibility and holdout of what an object brings, itself or what it multiplies, from those of its own. As in
        Cycles, a holdout is seen by the camera."""
        if self._layer is None:
            return visibility, holdout
        holdout = holdout or owner.holdout_get(view_layer=self._layer)
        if not holdout and owner.indirect_only_get(view_layer=self._layer):
            visibility &= ~RayVisibility.CAMERA
        return visibility, holdout
