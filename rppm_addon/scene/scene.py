# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene: everything a render needs."""

import dataclasses
import itertools
import logging
from dataclasses import dataclass, field

import numpy as np

from .camera import Camera
from .common.declared import declared
from .common.garbage import collector_paused
from .common.working_space import REC709, WORKING_SPACES, WorkingSpace
from .errors import SceneError
from .images import Image
from .lights import Light, World
from .materials import Material
from .meshes import DicingView, Instance, InstanceArray, Mesh
from .motion import Shutter
from .settings import RenderSettings

log = logging.getLogger(__name__)


@dataclass
class Scene:
    """Scene to be rendered, in a right-handed world in meters."""

    camera: Camera
    meshes: list[Mesh] = field(default_factory=list)
    instances: list[Instance] = field(default_factory=list)
    """Instances that are in no array. Indices into the instances count those of arrays as well (expanded())."""
    materials: list[Material] = field(default_factory=list)
    lights: list[Light] = field(default_factory=list)
    world: World = field(default_factory=World)
    images: list[Image] = field(default_factory=list)
    settings: RenderSettings = field(default_factory=RenderSettings)
    exposure: float = field(default=1.0, metadata=declared(minimum=0.0, maximum=1e12))
    """Factor on every radiance of the film (Cycles' film exposure)."""
    pass_alpha_threshold: float = field(default=0.5, metadata=declared(minimum=0.0, maximum=1.0))
    """Alpha of a surface from which on passes that show the first surface show it; 0 is any."""
    working_space: str = field(default=REC709.name, metadata=declared(choices=tuple(WORKING_SPACES)))
    """Name of the linear space of all colors."""
    dicing_view: DicingView = field(default_factory=DicingView)
    cubemap_center: np.ndarray | None = field(default=None, metadata=declared(3))
    """(3,) meters where the deep cubemap's center goes; None is automatic."""
    world_origin: np.ndarray | None = field(default=None, metadata=declared(3))
    """(3,) meters in Blender's world, from which all places but those of suns and particles are counted; None is 0."""
    shutter: Shutter | None = None
    """Motion while the picture is taken; None where nothing moves."""
    neighbors: Shutter | None = None
    """Where things are in the frames before (time 0) and after (1), for the pass Vector; its curve says nothing."""
    instance_arrays: list[InstanceArray] = field(default_factory=list)
    """Further instances, each array with many of one mesh. The renderer takes scenes without arrays."""
    asset_names: dict[str, str] = field(default_factory=dict)
    """Names of topmost parents, by the names of the objects that have one; only where CryptoAsset is rendered."""
    stamps: dict[str, str] = field(default_factory=dict)
    """Metadata in files of pictures that says where these come from, by Blender's names: Camera, Frame ..."""
    warnings: list[str] = field(default_factory=list)
    """Messages about features that are rendered only in part, a line each, naming object or material and node."""

    def warn(self, text: str) -> None:
        """Record and log a warning once."""
        if text not in self.warnings:
            self.warnings.append(text)
            log.warning(text)

    @property
    def color_space(self) -> WorkingSpace:
        """The linear space of all colors."""
        return WORKING_SPACES[self.working_space]

    @property
    def photon_count(self) -> int:
        """Photons of the first iteration; where automatic, later ones may have fewer."""
        return self.settings.photons_for(*self.camera.resolution)

    @property
    def world_offset(self) -> np.ndarray:
        """Offset of Blender's world: places in the scene lack it, (3,) meters."""
        return np.zeros(3) if self.world_origin is None else self.world_origin

    @property
    def triangle_count(self) -> int:
        """Triangles with all instances expanded."""
        many = sum(self.meshes[array.first.mesh].triangle_count * len(array) for array in self.instance_arrays)
        return many + sum(self.meshes[instance.mesh].triangle_count for instance in self.instances)

    @property
    def instance_count(self) -> int:
        """Instances, those of arrays included."""
        return len(self.instances) + sum(map(len, self.instance_arrays))

    @collector_paused()
    def expanded(self, before: "Scene | None" = None) -> "Scene":
        """The scene with the instances of arrays among the others, each in its place, and without arrays; the scene
        itself where it has none.

        Arrays that scenes share give them the same instances. ``before``: a scene that was expanded, with which this
        one shares further instances that say the same: those of arrays that follow each other alike in both.
        Raises SceneError where two instances have one place, or none is in one.
        """
        if not self.instance_arrays:
            return self
        count = self.instance_count
        places = np.concatenate([array.places for array in self.instance_arrays])
        is_free = np.ones(count, bool)
        if len(places) and not (places.min() >= 0 and places.max() < count):
            raise SceneError(f"an instance of an array has a place that is none of {count}; export the scene again")
        is_free[places] = False
        if is_free.sum() != len(self.instances):
            raise SceneError("two instances of arrays have the same place; export the scene again")
        instances: list[Instance] = [None] * count  # type: ignore[list-item]
        members = [(np.flatnonzero(is_free), self.instances)]
        arrays_before = [] if before is None else before.instance_arrays
        pairs = itertools.zip_longest(self.instance_arrays, arrays_before[: len(self.instance_arrays)])
        members += [(array.places, array.instances(old)) for array, old in pairs]
        for indices, placed in members:
            for index, instance in zip(indices.tolist(), placed, strict=True):
                instances[index] = instance
        return dataclasses.replace(self, instances=instances, instance_arrays=[])
