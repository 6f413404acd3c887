# SPDX-License-Identifier: GPL-3.0-or-later
"""The lights of a scene on the device: their table, what chooses one of them, and how many photons each gets."""

import math
import operator
from collections.abc import Mapping

import moderngl
import numpy as np

from ...gl.buffer_sets import BufferSet, Part, StorageBuffer
from ...gl.context.context import Context
from ...gl.programs.program import Bindable
from ...gl.programs.programs import ProgramLibrary
from ...materials.tables import MaterialTables
from ...scene.lights import UNLIMITED_BOUNCES
from ...scene.meshes import Instance, RayVisibility
from ...scene.scene import Scene
from ..common.require import require
from ..surfaces.geometry import Geometry
from ..surfaces.resolve import Resolve
from .caustic_casters import caustic_targets
from .emitters.candidates import refuse_too_many
from .emitters.emitters import Emitters
from .environment import Environment
from .guide import Guide
from .light_list import LightList
from .light_maps import LightMaps
from .light_records import LIGHT, LIGHT_LINK, LIGHT_NODE, NO_LIGHT_GROUP, LightFlag, LightShape
from .light_tree import LIGHT_TREE_PARAMETERS, LightTree
from .photon_allocation import PhotonAllocation
from .portals import PORTAL_PARAMETERS, Portals

_LEARNED = ("photon_count", "first_photon", "cells", "first_cell")
"""Members of a LIGHT record that follow from which photons contributed."""

LIGHT_PARAMETERS = {
    "scene_center": "vec3",
    "scene_radius": "float",
    "world_radiance": "vec3",
    "light_count": "uint",
    "environment_width": "uint",
    "environment_height": "uint",
    "environment_is_fine": "uint",
    "emissive_triangle_count": "uint",
    "gathers_lights": "uint",
    "world_selection": "float",
    "environment_irradiance": "float",
    "mesh_light": "uint",
    "world_light": "uint",
    **LIGHT_TREE_PARAMETERS,
    **PORTAL_PARAMETERS,
    "links_lights": "uint",
    "world_visibility": "uint",
    "world_bounces": "uint",
}
"""Parameters of every program that includes shaders/lights/lights.glsl. ``gathers_lights``: whether gathering rays
find lights that shadow rays find as well (shadows_are_of_all); ``world_selection`` is the probability of choosing the
world for direct light, as MIS weights take it; ``mesh_light`` and ``world_light`` are the numbers of lights;
``environment_irradiance`` what the world may give, W/m^2, ``links_lights``
Lights', ``world_visibility`` the rays that see the world, ``world_bounces`` its max_bounces."""


_BOUNCED = RayVisibility.DIFFUSE | RayVisibility.GLOSSY | RayVisibility.TRANSMISSION | RayVisibility.SHADOW


def shadows_are_of_all(scene: Scene) -> bool:
    """Whether shadow rays meet the same objects as rays that surfaces scatter, so that both find the same light."""
    instances = scene.instances
    seen = np.fromiter(map(operator.attrgetter("visibility"), instances), np.int64, len(instances))
    meet_all = bool((seen & int(_BOUNCED) == int(_BOUNCED)).all())
    return meet_all and not any(map(operator.attrgetter("shadow_catcher"), instances))


class Lights(BufferSet):
    """The lights of a scene: buffers for the shaders that include lights/lights.glsl."""

    _lights = StorageBuffer("lights", LIGHT, block="Lights")
    emitters = Part(Emitters)
    targets = StorageBuffer("photon targets", "vec4", block="Targets")
    """Spheres that photons are aimed at (caustic_casters.py)."""
    environment = Part(Environment)
    light_maps = Part(LightMaps)
    guide = Part(Guide)
    _light_tree = Part(LightTree)
    links = StorageBuffer("light links", LIGHT_LINK, block="LightLinks")
    """Sets of linked lights by number, where ``links_lights``."""
    group_table = StorageBuffer("table of light groups", "uint", block="LightGroupTable")
    """LightGroupTable, where there are any."""

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        super().__init__(context, library)
        self.target_count = 0
        self.table = LIGHT.zeros(0)
        """LIGHT records, all lights'."""
        self.has_falloff = False
        """Whether the light of any falls off otherwise than by the square of the distance."""
        self.are_cut = False
        """True where surfaces lie within the radius of any soft light."""
        self.limits_bounces = False
        """Whether the light of any is scattered less often than the paths allow."""
        self._portals: Portals | None = None
        self._allocation: PhotonAllocation | None = None
        self._list = LightList()
        self._max_photons = 1
        """Largest number of photons of an iteration."""
        self.parameters: dict[str, object] = {}
        """Values of LIGHT_PARAMETERS."""
        self._triangles: moderngl.Buffer | None = None
        self.scene_radius = 0.0
        """Meters, a little more than the geometry's."""
        self.times_built = 0
        self.world_visibility = RayVisibility.ALL
        """The rays that see the world."""
        self.world_group = NO_LIGHT_GROUP
        """The world's light group by number."""

    @property
    def links_lights(self) -> bool:
        """Whether any light does not shine on everything, or is not stopped by everything."""
        return bool(self.parameters.get("links_lights"))

    @property
    def portals(self) -> Portals:
        """Portals of the scene, once it was built."""
        return require(self._portals)

    @property
    def blocks(self) -> dict[str, Bindable]:
        """Storage blocks and textures of lights/lights.glsl, lights/light_tree.glsl and photon_emission/emit.comp."""
        return {
            **super().blocks,
            **self.environment.textures,
            "light_maps": self.light_maps.texture,
            "Triangles": require(self._triangles),
        }

    def linking_blocks(self, contributions: moderngl.Buffer) -> dict[str, moderngl.Buffer] | None:
        """Storage blocks of shadow rays that ask what may be in their way; None where everything is."""
        return {"Contributions": contributions, "LightLinks": self.links.buffer} if self.links_lights else None

    @property
    def source_watts(self) -> dict[str, float]:
        """Power within the scene, the channels' mean, by source: lights (source_name), SURFACES and ENVIRONMENT."""
        return self._by_source(self._list.powers)

    @property
    def source_photons(self) -> dict[str, int]:
        """Photons of the current iteration by source."""
        return self._by_source(self.table["photon_count"].tolist())

    def _by_source(self, values: list) -> dict:
        sums: dict[str, float] = {}
        for name, value in zip(self._list.names, values):
            sums[name] = sums.get(name, 0) + value
        return sums

    def build(
        self,
        scene: Scene,
        geometry: Geometry,
        materials: MaterialTables,
        resolve: Resolve,
        photons: int,
        keep_world: bool = False,
        keep_light_objects: bool = False,
        keep_learned: bool = False,
    ) -> None:
        """Lay out all lights and allocate the photons of an iteration to them.

        photons: of that iteration, no more than the scene's. keep_world, keep_light_objects: the world, or
        all light objects, are those of the last call. keep_learned: the lights are those of the last call at another
        time, and what was learned of them holds.
        Raises SceneError when all lights have a photon weight of 0, and DeviceError where more triangles emit than the
        device has room for.
        """
        self.times_built += 1
        self.scene_radius = radius = max(geometry.radius * 1.001, 1e-6)
        if not keep_light_objects:
            self.light_maps.build(scene.lights, scene.images, materials)
        lights = LightList()
        lights.add_light_objects(scene, geometry, self.light_maps, radius, materials.media.materials)
        refuse_too_many(
            scene, geometry, materials, lambda triangles: self._light_tree.refuse(len(scene.lights), triangles)
        )
        self.emitters.build(scene, geometry, materials, resolve, lights.links)
        lights.add_surfaces(self.emitters.power)
        lights.add_media(scene, materials.media.emissive.listed, geometry.placements)
        if not keep_world:
            self.environment.build(scene.world, scene.images, materials)
            if self.environment.shown_width < self.environment.image_width:
                scene.warn(
                    f"The world's image is {self.environment.image_width} pixels wide, of which the device shows "
                    f"{self.environment.shown_width}; save it smaller"
                )
        self.world_visibility = scene.world.visibility
        lights.add_world(scene, self.environment, radius)
        shown_through = scene.lights if lights.has_world else []
        self._portals = Portals(shown_through, self.environment, radius, self._portals)
        if self._portals.power > 0.0:
            lights.add_portals(scene, self.environment, self._portals.power)
        lights.complete(scene, self.environment)
        self._allocate_first(lights, scene.photon_count, photons, keep_learned)
        targets = caustic_targets(scene, geometry)
        self.target_count = len(targets)
        self.targets.upload(targets if len(targets) else np.zeros(4, np.float32))
        self._triangles = geometry.triangles.buffer
        self._list_groups(scene, lights.groups, geometry.placements.instances)
        self.links.upload(lights.links.records)
        sets = lights.links.records["light_sets"]
        self.emitters.leaves["light_sets"] = sets[self.emitters.links]
        trees = [mesh.nodes for mesh in self.emitters.instances.meshes]
        first_tree = self._light_tree.build(self.table, self.emitters.leaves, self.emitters.order, sets, trees)
        self.emitters.instances.upload(geometry.instanced, first_tree)
        self.emitters.leaves = LIGHT_NODE.zeros(0)  # as large as the triangles themselves
        self.parameters = self._parameters(scene, geometry, lights)

    def _allocate_first(self, lights: LightList, max_photons: int, photons: int, keep_learned: bool) -> None:
        """Take the table of the lights, with so many photons; what was learned is kept for the same lights."""
        table, names = lights.table, self._list.names
        kept = self.table if keep_learned and lights.names == names else None
        self._list = lights
        self.table, self._max_photons = table, max_photons
        soft, cut = LightFlag.SOFT, LightFlag.SOFT | LightFlag.HOLDS_SURFACES
        self.has_falloff = bool((table["flags"] & soft).any() or table["falloff"].any() or table["smoothing"].any())
        self.are_cut = bool(((table["flags"] & cut) == cut).any())
        self.limits_bounces = bool((table["max_bounces"] < UNLIMITED_BOUNCES).any())
        if kept is not None and np.array_equal(kept["kind"], table["kind"]):
            for column in _LEARNED:
                table[column] = kept[column]
            require(self._allocation).photon_count = photons
            self._upload_table()
        else:
            powers = np.array([*lights.powers[:-1], lights.powers[-1] or self.portals.power])
            self._allocation = PhotonAllocation(powers, np.array(lights.weights), self.portals.power > 0.0)
            self.begin(photons)

    def _parameters(self, scene: Scene, geometry: Geometry, lights: LightList) -> dict[str, object]:
        """Return the values of LIGHT_PARAMETERS."""
        kinds = self.table["kind"]
        return {
            "scene_center": geometry.center,
            "scene_radius": self.scene_radius,
            "world_radiance": self.environment.radiance,
            "light_count": len(self.table),
            "environment_width": self.environment.width,
            "environment_height": self.environment.height,
            "environment_is_fine": self.environment.is_fine,
            "emissive_triangle_count": self.emitters.count,
            "gathers_lights": shadows_are_of_all(scene),
            "world_selection": float(lights.selection[kinds == LightShape.WORLD].sum()),
            "environment_irradiance": 2 * math.pi * float(np.mean(np.abs(self.environment.mean_radiance))),
            "mesh_light": int(np.argmax(kinds == LightShape.MESH)),
            "world_light": int(np.argmax(kinds == LightShape.WORLD)),
            **self._light_tree.parameters,
            **self.portals.parameters,
            "portal_light": len(self.table) - 1,
            "links_lights": lights.links.any,
            "world_visibility": int(self.world_visibility),
            "world_bounces": UNLIMITED_BOUNCES if self.environment.is_even else scene.world.max_bounces,
        }

    def _list_groups(self, scene: Scene, of_lights: list[str], placed: list[Instance]) -> None:
        """of_lights: names of the light groups of the lights; placed: instances, which have names as well."""
        numbers = {name: number for number, name in enumerate(scene.settings.light_groups)}
        self.world_group = numbers.get(scene.world.light_group, NO_LIGHT_GROUP)
        if numbers:
            names = [*of_lights, *map(operator.attrgetter("light_group"), placed)]
            self.group_table.upload(np.array([numbers.get(name, NO_LIGHT_GROUP) for name in names], np.uint32))
        else:
            self.group_table.release()

    def begin(self, photons: int) -> None:
        """Forget what photons contributed, as before the first iteration, and allocate so many to the lights."""
        self._allocate(self._max_photons)
        self.guide.build(self.table, self._max_photons)
        if photons != self._max_photons:
            self._allocate(photons)
        self._upload_table()

    def _upload_table(self) -> None:
        records = LIGHT.zeros(len(self.table) + len(self.portals.records))
        records[: len(self.table)], records[len(self.table) :] = self.table, self.portals.records
        self._lights.upload(records)

    def _allocate(self, photons: int, contributions: np.ndarray | None = None) -> None:
        """Allocate photons to the lights by what the guide has learned of them, or before it has learned anything."""
        allocation = require(self._allocation)
        if contributions is None:
            counts = allocation.allocate(photons)
        else:
            fraction = allocation.portal_fraction(self.guide.even_contribution)
            counts = allocation.allocate(photons, contributions, fraction)
        self.table["photon_count"] = counts
        self.table["first_photon"] = np.concatenate([[0], np.cumsum(counts)[:-1]])

    def tally(self, photons: Mapping[str, Bindable], slots: int) -> None:
        """Tally what an iteration's photons contributed, once they have been splatted (Guide.tally)."""
        self.guide.tally(photons, slots, require(self._allocation).photon_count)

    def learn(self, photons: int) -> float:
        """Learn from the tallies where to send the photons of the next iterations, so many in each.

        Lights get photons by the power that contributes (guide.py), and a part by how many contribute. Returns how many
        times more photons should contribute from now on.
        """
        weights, contributed = self.guide.learn()
        before = self.table["photon_count"] @ contributed[:, 0]
        self._allocate(photons, weights)
        self._upload_table()
        return float(self.table["photon_count"] @ contributed[:, 1] / before)

    def restore(self, tallies: np.ndarray, learned: np.ndarray | None, photons: int) -> None:
        """Restore what the guide of this scene's lights had learned when the last iteration had so many photons.

        Raises as Guide.restore does."""
        weights = self.guide.restore(tallies, learned)
        if weights is not None:
            self._allocate(photons, weights)
            self._upload_table()

    @property
    def photon_flux(self) -> float:
        """Mean flux of the iteration's photons as they leave their lights, W, the channels' mean."""
        return sum(self._list.powers) / require(self._allocation).photon_count
