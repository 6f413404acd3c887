# SPDX-License-Identifier: GPL-3.0-or-later
"""Features that a file may use and no picture of RPPM shows, so that no export leaves them out in silence.

Nodes say so where they are exported (shading/nodes/), as do objects of kinds that have no
surface (instances/instance_reader.py).
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import bpy

from .common.report import Report, listed
from .common.slices import Slices
from .geometry.meshes.dicing import adaptive_modifier
from .view_layer.passes import passes_of_cycles_only

_AT_ONCE = 32
"""Objects between which nobody looks at the clock."""


@dataclass(frozen=True)
class Omission:
    """Something that Cycles renders and RPPM does not, or does in another way."""

    title: str
    """As Blender's panels have it."""
    consequence: str
    """Consequence: what the picture shows instead, and the remedy where there is one."""
    reads: tuple[str, ...]
    """Paths of the properties that say whether it is used, from the block on."""
    is_used: Callable[[bpy.types.ID], bool]
    """By an evaluated object, or by a scene."""


def _cycles(block: bpy.types.bpy_struct, name: str, default: object) -> object:
    """A property of Cycles', which may be switched off, or have none of that name in this version."""
    return getattr(getattr(block, "cycles", None), name, default)


OF_OBJECTS = (
    Omission(
        "Adaptive Subdivision",
        "what is displaced is divided evenly, into a million triangles at most; other surfaces are as their modifiers "
        "have them for renders",
        ("cycles.use_adaptive_subdivision", "modifiers"),
        lambda source: adaptive_modifier(source) is not None,
    ),
    Omission(
        "Shadow Catcher",
        "light that other objects reflect onto it is left out: shadows next to bright objects are darker",
        ("is_shadow_catcher",),
        lambda source: source.is_shadow_catcher and source.type != "LIGHT",  # whose shadows on catchers it is about
    ),
)
"""By what an evaluated object uses."""


def _has_transparent_glass_of_cycles_only(scene: bpy.types.Scene) -> bool:
    own = getattr(getattr(scene, "rppm", None), "film_transparent_glass", False)
    return scene.render.film_transparent and bool(_cycles(scene, "film_transparent_glass", False)) and not own


def _has_moving_volumes(scene: bpy.types.Scene) -> bool:
    return scene.render.use_motion_blur and any(_has_velocity(volume) for volume in bpy.data.volumes if volume.users)


def _has_velocity(volume: bpy.types.Volume) -> bool:
    names = {volume.velocity_grid, volume.velocity_x_grid, volume.velocity_y_grid, volume.velocity_z_grid} - {""}
    return volume.grids.load() and any(grid.name in names for grid in volume.grids)


OF_SCENES = (
    Omission(
        "Rolling Shutter",
        "all of the picture is exposed at once",
        ("render.use_motion_blur", "cycles.rolling_shutter_type"),
        lambda scene: scene.render.use_motion_blur and _cycles(scene, "rolling_shutter_type", "NONE") != "NONE",
    ),
    Omission(
        "Motion Blur of volumes by their velocity",
        "their grids are sharp; motion of the objects blurs them",
        ("render.use_motion_blur",),
        _has_moving_volumes,
    ),
    Omission(
        "Biased volumes",
        "light passes voxels exactly, as in Cycles without Biased; Step Rate and Max Steps have no effect",
        ("cycles.volume_biased",),
        lambda scene: bool(_cycles(scene, "volume_biased", False)),
    ),
    Omission(
        "Transparent Glass",
        "on for Cycles only, so that glass is opaque in the transparent film; switch it on in Film, or take all of "
        "Cycles' settings with Sampling > Advanced > Copy from Cycles",
        ("render.film_transparent", "cycles.film_transparent_glass"),
        _has_transparent_glass_of_cycles_only,
    ),
)
"""By what a scene uses."""


PASSES = {
    "use_pass_shadow": "Shadow",
    "use_pass_subsurface_direct": "Subsurface Direct",
    "use_pass_subsurface_indirect": "Subsurface Indirect",
    "use_pass_subsurface_color": "Subsurface Color",
    "use_pass_grease_pencil": "Grease Pencil",
    "cycles.use_pass_volume_scatter": "Volume Scatter",
    "cycles.use_pass_volume_transmit": "Volume Transmit",
    "cycles.use_pass_volume_majorant": "Volume Majorant",
    "cycles.pass_render_time": "Render Time",
}
"""Labels of the passes that RPPM does not have, by the switch of a view layer."""


def _passes_without(layer: bpy.types.ViewLayer) -> list[str]:
    return [
        label
        for path, label in PASSES.items()
        if (
            _cycles(layer, path.removeprefix("cycles."), False)
            if path.startswith("cycles.")
            else getattr(layer, path, False)
        )
    ]


class OmissionList:
    """List of the omissions that the objects of a depsgraph and its scene use."""

    def __init__(self) -> None:
        self._users: dict[Omission, dict[int, str]] = {}
        """By what they use, the names of objects by session_uid."""
        self._known: set[int] = set()
        """session_uid of those that were looked at."""

    def look_at_all(self, depsgraph: bpy.types.Depsgraph, slices: Slices) -> None:
        """Take note of the objects of a depsgraph that it does not know. Raises Unfinished when the slice is over."""
        for source in objects_of(depsgraph):
            if source.original.session_uid not in self._known:
                self.look_at([source])
                if len(self._known) % _AT_ONCE == 0:
                    slices.rest()

    def look_at(self, sources: Iterable[bpy.types.Object]) -> None:
        """Take note of evaluated objects, anew of those that it knows."""
        for source in sources:
            uid = source.original.session_uid
            self._known.add(uid)
            for omission in OF_OBJECTS:
                if omission.is_used(source):
                    self._users.setdefault(omission, {})[uid] = source.name
                elif omission in self._users:
                    self._users[omission].pop(uid, None)

    def warn(self, depsgraph: bpy.types.Depsgraph, report: Report) -> None:
        """Have the report name what the objects so far, the scene and its view layer use, each once."""
        scene, layer = depsgraph.scene_eval, depsgraph.view_layer_eval
        without, switched_off = _passes_without(layer), passes_of_cycles_only(layer)
        with report.about("omissions"):
            for omission, users in self._users.items():
                if users:
                    report.warn(f"{omission.title} ({listed(users.values())}): {omission.consequence}")
            for omission in OF_SCENES:
                if omission.is_used(scene):
                    report.warn(f"{omission.title}: {omission.consequence}")
            if without:
                report.warn(f"Passes that RPPM does not have: {', '.join(without)}; links from them stay black")
            if switched_off:
                report.warn(
                    f"Passes that are on for Cycles only: {', '.join(switched_off)}; switch them on in View Layer > "
                    "Passes, or take all of Cycles' settings with Sampling > Advanced > Copy from Cycles"
                )


def objects_of(depsgraph: bpy.types.Depsgraph) -> Iterator[bpy.types.Object]:
    """The evaluated objects that a depsgraph holds, what is multiplied included."""
    return (block for block in depsgraph.ids if isinstance(block, bpy.types.Object))
