# SPDX-License-Identifier: GPL-3.0-or-later
"""Context that all parts of an export share."""

from dataclasses import dataclass, field

import bpy

from .camera.culling import Culling
from .common.report import Report
from .geometry.meshes.base_meshes import BaseMeshes
from .geometry.strands.curve_settings import CurveSettings, curve_settings
from .geometry.volumes.velocities import VelocityBlur
from .images.images import ImageTable
from .images.texture_limit import texture_limit
from .view_layer.layers import LayerFilter, LayerMasks, world_of
from .view_layer.light_linking import LightLinks


@dataclass
class ExportContext:
    """Where warnings and images go, and what is the same for all that is exported."""

    report: Report
    viewport: bool = False
    """Whether what is exported is for a viewport, of which some settings are its own."""
    images: ImageTable = field(default_factory=ImageTable)
    owners: tuple[bpy.types.bpy_struct | None, ...] = ()
    """View layer, scene and world, in the order in which they are asked for attributes."""
    material_override: bpy.types.Material | None = None
    """Material that all surfaces of the view layer have in place of their own; None: they have their own."""
    masks: LayerMasks = field(default_factory=LayerMasks)
    culling: Culling = field(default_factory=Culling)
    """Culling of objects that the camera does not see; at first it leaves nothing out."""
    light_links: LightLinks = field(default_factory=LightLinks)
    filter: LayerFilter = field(default_factory=LayerFilter)
    velocity_blur: VelocityBlur | None = None
    """Time in which velocities blur volumes; None where they do not."""
    curves: CurveSettings = field(default_factory=CurveSettings)
    is_render: bool = True
    """Whether Blender evaluated what renders show, and not viewports."""
    has_light_groups: bool = False
    """Whether objects are asked for theirs."""
    base_meshes: BaseMeshes | None = None
    """Meshes with Adaptive Subdivision; None where none is divided."""
    owner_reads: int = 0
    """How often an attribute was read from the owners."""

    def __post_init__(self) -> None:
        self.images.slices = self.report.slices

    @property
    def may_have_hair(self) -> bool:
        """Whether any object may have particle systems with hair to be rendered."""
        return self.curves.shown and any(settings.type == "HAIR" for settings in bpy.data.particles)

    @property
    def untracked_reads(self) -> int:
        """Number of values read so far that can change without a report of the depsgraph."""
        return self.owner_reads + self.images.reads_by_frame

    def read_from(self, depsgraph: bpy.types.Depsgraph) -> None:
        """Read the state of a depsgraph as it is now; what is exported next comes from it."""
        scene = depsgraph.scene_eval
        self.images.frame = scene.frame_current
        self.images.longest_side = texture_limit(scene, self.viewport)
        layer = depsgraph.view_layer_eval
        self.owners = (layer, scene, world_of(depsgraph))
        self.curves, self.is_render = curve_settings(depsgraph), depsgraph.mode == "RENDER"
        if self.base_meshes is None:
            self.base_meshes = BaseMeshes(depsgraph, self.viewport)
        else:
            self.base_meshes.read_from(depsgraph, self.viewport)
        self.material_override = layer.material_override
        self.masks = LayerMasks(layer)
        self.filter = LayerFilter.of(layer)
        self.has_light_groups = len(depsgraph.view_layer.lightgroups) > 0
