# SPDX-License-Identifier: GPL-3.0-or-later
"""LightList: the lights of a scene by number, while they are collected."""

import logging
import math
from collections.abc import Sequence, Set

import numpy as np

from ...materials.media.emission import EmissiveMedium
from ...materials.media.voxel_evaluation import WORLD
from ...scene.errors import SceneError
from ...scene.lights import UNLIMITED_BOUNCES
from ...scene.meshes import RayVisibility
from ...scene.scene import Scene
from ..surfaces.geometry import Geometry
from ..surfaces.placements import Placement
from .environment import Environment
from .light_entry import light_entry
from .light_links import LightLinkTable
from .light_maps import LightMaps
from .light_records import LIGHT, LightFlag, LightShape
from .portals import is_portal
from .sources import ENVIRONMENT, SURFACES, VOLUMES, source_name
from .spheres import holds_medium, holds_surfaces

log = logging.getLogger(__name__)


class LightList:
    """Lights that emit, in the order of their numbers: light objects, emissive surfaces and media, the world, portals.

    ``links`` numbers what they illuminate and what blocks their light.
    """

    def __init__(self) -> None:
        self.names: list[str] = []
        """Source names (sources.py)."""
        self.powers: list[float] = []
        """W, the channels' mean."""
        self.weights: list[float] = []
        """Photon weights of the user."""
        self.groups: list[str] = []
        """Light groups by name."""
        self.links = LightLinkTable()
        self._records: list[np.ndarray] = []

    @property
    def has_world(self) -> bool:
        """Whether the last light is the world."""
        return self.names[-1:] == [ENVIRONMENT]

    def add_light_objects(
        self, scene: Scene, geometry: Geometry, maps: LightMaps, radius: float, media: Set[int]
    ) -> None:
        """Add the scene's light objects but for portals. radius: that of the scene, meters; media: materials that fill
        the inside of what they are on."""
        for index, light in enumerate(scene.lights):
            if is_portal(light):
                continue
            record, power = light_entry(light, radius)
            record["flags"] |= LightFlag.HOLDS_SURFACES * holds_surfaces(light, scene, geometry)
            record["flags"] |= LightFlag.HOLDS_MEDIUM * holds_medium(light, scene, geometry, media)
            record["link"] = self.links.of_light(light)
            if light.linking is not None and not light.linking.lights_media:
                record["flags"] = int(record["flags"]) & ~int(RayVisibility.VOLUME_SCATTER)
            nodes = maps.nodes.get(index)
            if nodes is not None:
                record["strength"] *= nodes.scale
                record["falloff"], record["smoothing"] = nodes.falloff, nodes.smoothing
                if nodes.shape is not None:
                    record["map_shape"], record["map_extent"], record["map"] = nodes.shape, nodes.extent, nodes.place
                power = power * nodes.mean / (1.0 + nodes.smoothing)
            self._add(source_name(light.name), record, power, light.photon_weight, light.light_group)

    def add_surfaces(self, power: np.ndarray) -> None:
        """Add all emissive surfaces as one light. power: (3,) W."""
        record = LIGHT.zeros(1)[0]
        record["kind"], record["flags"] = LightShape.MESH, int(RayVisibility.ALL)
        record["max_bounces"] = UNLIMITED_BOUNCES
        self._add(SURFACES, record, power)

    def add_media(self, scene: Scene, media: Sequence[EmissiveMedium], placements: Sequence[Placement]) -> None:
        """Add media that emit light, each as a light of its own. placements: what their numbers of instances mean."""
        for number, medium in enumerate(media):
            record = LIGHT.zeros(1)[0]
            record["position"], record["axis_u"], record["axis_v"], record["normal"] = medium.frame
            record["kind"], record["strength"], record["emissive_medium"] = LightShape.MEDIUM, medium.strength, number
            record["max_bounces"] = UNLIMITED_BOUNCES
            placed = None if medium.instance == WORLD else placements[medium.instance].instance
            record["flags"] = int(RayVisibility.ALL if placed is None else placed.visibility)
            group = scene.world.light_group if placed is None else placed.light_group
            self._add(VOLUMES, record, medium.power, group=group)

    def add_world(self, scene: Scene, environment: Environment, radius: float) -> None:
        """Add the world. radius: that of the scene, meters."""
        record = self._world_record(scene, environment)
        power = 4 * math.pi**2 * radius**2 * environment.mean_radiance
        self._add(ENVIRONMENT, record, power, group=scene.world.light_group)

    def add_portals(self, scene: Scene, environment: Environment, power: float) -> None:
        """Add the part of the world's light that passes portals, of which the power, W, is that of the world already.

        Nothing but its photons makes a difference between the two, so its own power is 0.
        """
        record = self._world_record(scene, environment)
        record["flags"] |= LightFlag.THROUGH_PORTALS
        self._add(ENVIRONMENT, record, np.full(3, power), group=scene.world.light_group)
        self.powers[-1] = 0.0

    def complete(self, scene: Scene, environment: Environment) -> None:
        """Check the list. Where nothing but media emits light, a black world is added, and where nothing does at all
        there is a warning in the log.

        Raises SceneError when all lights have a photon weight of 0.
        """
        if not self._records:
            # As in an animation whose lights go out: the picture is black, as Cycles' is.
            log.warning("nothing in the scene emits light; add a light, or give a material or the world some emission")
            self._records.append(self._world_record(scene, environment))
            self.powers, self.weights, self.groups = [1.0], [1.0], [""]
        elif not self._is_chosen.any():
            self._records.append(self._world_record(scene, environment))
            self.powers, self.weights, self.groups = [*self.powers, 0.0], [*self.weights, 0.0], [*self.groups, ""]
        if sum(self.weights) <= 0:
            raise SceneError("all lights have a photon weight of 0; raise that of one")

    @property
    def _is_chosen(self) -> np.ndarray:
        """(n,) bool, true for lights that shadow rays go to."""
        return np.array([record["kind"] != LightShape.MEDIUM for record in self._records])

    @property
    def selection(self) -> np.ndarray:
        """(n,) float64 probabilities of choosing each light where no point is known, and for MIS weights: by power,
        half of it evenly."""
        chosen = self._is_chosen
        powers = np.where(chosen, self.powers, 0.0)
        shining = powers > 0
        if not shining.any():
            return chosen / chosen.sum()
        return np.where(shining, 0.5 * powers / sum(powers.tolist()) + 0.5 / shining.sum(), 0.0)

    @property
    def table(self) -> np.ndarray:
        """(n,) LIGHT records, without photons."""
        table = np.array(self._records, LIGHT.dtype)
        table["selection_probability"] = self.selection
        table["selection_end"] = np.cumsum(self.selection)
        table["selection_end"][-1] = 1.0
        return table

    def _add(self, name: str, record: np.ndarray, power: np.ndarray, weight: float = 1.0, group: str = "") -> None:
        if np.isfinite(power).all() and np.any(power):
            self.names.append(name)
            self._records.append(record)
            self.powers.append(float(np.mean(np.abs(power))))
            self.weights.append(max(weight, 0.0))
            self.groups.append(group)

    @staticmethod
    def _world_record(scene: Scene, environment: Environment) -> np.ndarray:
        record = LIGHT.zeros(1)[0]
        record["kind"], record["flags"] = LightShape.WORLD, int(scene.world.visibility)
        record["max_bounces"] = UNLIMITED_BOUNCES if environment.is_even else scene.world.max_bounces
        return record
