# SPDX-License-Identifier: GPL-3.0-or-later
"""The lights of a scene on the device: their table, what chooses one of them, and how many photons each gets."""

import logging
import math
from collections.abc import Mapping

import moderngl
import numpy as np

from ...gl.buffer_sets import BufferSet, Part, StorageBuffer
from ...gl.context import Context
from ...gl.program import Bindable
from ...gl.programs import ProgramLibrary
from ...materials.tables import MaterialTables
from ...scene.errors import SceneError
from ...scene.lights import UNLIMITED_BOUNCES
from ...scene.meshes import RayVisibility
from ...scene.scene import Scene
from ..common.require import require
from ..surfaces.geometry import Geometry
from ..surfaces.resolve import Resolve
from .caustic_casters import caustic_targets
from .emitters import Emitters, refuse_too_many
from .environment import Environment
from .guide import Guide
from .light_entry import light_entry
from .light_links import LightLinkTable
from .light_maps import LightMaps
from .light_records import LIGHT, LIGHT_LINK, LIGHT_NODE, NO_LIGHT_GROUP, LightFlag, LightShape
from .light_tree import LIGHT_TREE_PARAMETERS, LightTree
from .portals import FIRST_PHOTON_FRACTION, PORTAL_PARAMETERS, Portals, is_portal, photon_fraction
from .sources import ENVIRONMENT, SURFACES, photon_shares, source_name
from .spheres import holds_surfaces

log = logging.getLogger(__name__)

_LEARNED = ("photon_count", "first_photon", "cells", "first_cell")
"""Members of a LIGHT record that follow from which photons contributed."""

LIGHT_PARAMETERS = {
    "scene_center": "vec3",
    "scene_radius": "float",
    "world_radiance": "vec3",
    "light_count": "uint",
    "environment_width": "uint",
    "environment_height": "uint",
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
share lights with shadow rays (shadows_are_of_all); ``world_selection`` is the probability of choosing the world for
direct light, as MIS weights take it; ``mesh_light`` and ``world_light`` are the numbers of lights;
``environment_irradiance`` what the world may give, W/m^2, ``direct_world_flux`` Iteration's, ``links_lights``
Lights', ``world_visibility`` the rays that see the world, ``world_bounces`` its max_bounces."""


def share_out(weights: np.ndarray, photons: int) -> np.ndarray:
    """Split photons by weights, (n,) int64 summing to ``photons``; a positive weight gets at least one
    while there are enough (largest remainders)."""
    if len(weights) == 0 or weights.sum() <= 0:
        return np.zeros(len(weights), np.int64)
    exact = photons * (weights / weights.sum())
    counts = np.floor(exact).astype(np.int64)
    by_remainder = np.argsort(counts - exact, kind="stable")
    counts[by_remainder[: photons - counts.sum()]] += 1
    for index in np.nonzero((counts == 0) & (weights > 0))[0]:
        richest = np.argmax(counts)
        if counts[richest] > 1:
            counts[richest] -= 1
            counts[index] = 1
    return counts


_BOUNCED = RayVisibility.DIFFUSE | RayVisibility.GLOSSY | RayVisibility.TRANSMISSION | RayVisibility.SHADOW


def shadows_are_of_all(scene: Scene) -> bool:
    """Whether shadow rays meet the same objects as rays that surfaces scatter, so that both find the same light."""
    return all(
        instance.visibility & _BOUNCED == _BOUNCED and not instance.shadow_catcher for instance in scene.instances
    )


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
    """By number, where ``links_lights``."""
    group_table = StorageBuffer("table of light groups", "uint", block="LightGroupTable")
    """LightGroupTable, where there are any."""

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        super().__init__(context, library)
        self.target_count = 0
        self.table = LIGHT.zeros(0)
        """LIGHT records, all lights'."""
        self._portals: Portals | None = None
        self._weights = np.zeros(0)
        self._names: list[str] = []
        self._powers: list[float] = []
        self._first_powers = np.zeros(0)
        """When what is learned began, as for weights: lights that move share photons alike at all times, so that
        a render that goes on does as well. The last is what leaves through portals, where there are any."""
        self.parameters: dict[str, object] = {}
        """Values of LIGHT_PARAMETERS."""
        self._triangles: moderngl.Buffer | None = None
        self.has_falloff = False
        self.are_cut = False
        """True where surfaces lie within the radius of any soft light."""
        self.links_lights = False
        """Whether any light does not shine on everything, or is not stopped by everything."""
        self.limits_bounces = False
        """Whether the light of any is scattered less often than the paths allow."""
        self._power, self._photons, self._most_photons = 0.0, 1, 1
        self.scene_radius = 0.0
        """Meters, a little more than the geometry's."""
        self.times_built = 0
        self.world_visibility = RayVisibility.ALL
        """The rays that see the world."""
        self.world_group = NO_LIGHT_GROUP
        """The world's light group by number."""

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
        return self._by_source(self._powers)

    @property
    def source_photons(self) -> dict[str, int]:
        """Photons of the current iteration by source."""
        return self._by_source(self.table["photon_count"].tolist())

    def _by_source(self, values: list) -> dict:
        sums: dict[str, float] = {}
        for name, value in zip(self._names, values):
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
        names: list[str] = []
        entries: list[np.ndarray] = []
        powers: list[float] = []
        weights: list[float] = []
        groups: list[str] = []
        links = LightLinkTable()

        def add(name: str, entry: np.ndarray, power: np.ndarray, weight: float = 1.0, group: str = "") -> None:
            if np.isfinite(power).all() and np.any(power):
                names.append(name)
                entries.append(entry)
                powers.append(float(np.mean(np.abs(power))))
                weights.append(max(weight, 0.0))
                groups.append(group)

        if not keep_light_objects:
            self.light_maps.build(scene.lights, scene.images, materials)
        for index, light in enumerate(scene.lights):
            if is_portal(light):
                continue
            entry, power = light_entry(light, radius)
            entry["flags"] |= LightFlag.HOLDS_SURFACES * holds_surfaces(light, scene, geometry)
            entry["link"] = links.of_light(light)
            nodes = self.light_maps.nodes.get(index)
            if nodes is not None:
                entry["strength"] *= nodes.scale
                entry["falloff"], entry["smoothing"] = nodes.falloff, nodes.smoothing
                if nodes.shape is not None:
                    entry["map_shape"], entry["map_extent"], entry["map"] = nodes.shape, nodes.extent, nodes.place
                power = power * nodes.mean / (1.0 + nodes.smoothing)
            add(source_name(light.name), entry, power, light.photon_weight, light.light_group)
        refuse_too_many(
            scene, geometry, materials, lambda triangles: self._light_tree.refuse(len(scene.lights), triangles)
        )
        self.emitters.build(scene, geometry, materials, resolve, links)
        entry = LIGHT.zeros(1)[0]
        entry["kind"], entry["flags"] = LightShape.MESH, int(RayVisibility.ALL)
        entry["max_bounces"] = UNLIMITED_BOUNCES
        add(SURFACES, entry, self.emitters.power)
        if not keep_world:
            self.environment.build(scene.world, scene.images, materials)
        entry = LIGHT.zeros(1)[0]
        self.world_visibility = scene.world.visibility
        entry["kind"], entry["flags"] = LightShape.WORLD, int(self.world_visibility)
        world_bounces = UNLIMITED_BOUNCES if self.environment.is_even else scene.world.max_bounces
        entry["max_bounces"] = world_bounces
        power = 4 * math.pi**2 * radius**2 * self.environment.mean_radiance
        add(ENVIRONMENT, entry, power, group=scene.world.light_group)
        shown_through = scene.lights if names[-1:] == [ENVIRONMENT] else []
        self._portals = Portals(shown_through, self.environment, radius, self._portals)
        if self._portals.power > 0.0:
            # The same light as the world's, which all but its photons take by that one: so it has no power.
            through = entry.copy()
            through["flags"] |= LightFlag.THROUGH_PORTALS
            add(ENVIRONMENT, through, np.full(3, self._portals.power), group=scene.world.light_group)
            powers[-1] = 0.0
        if not entries:
            # As in an animation whose lights go out: the picture is black, as Cycles' is.
            log.warning("nothing in the scene emits light; add a light, or give a material or the world some emission")
            entries, powers, weights, groups = [entry], [1.0], [1.0], [""]
        if sum(weights) <= 0:
            raise SceneError("all lights have a photon weight of 0; raise that of one")

        kept = self.table if keep_learned and names == self._names else None
        self._names, self._powers, self._power = names, powers, sum(powers)
        # By power, half of it evenly: what does not choose by the point, and MIS weights.
        shining = np.array(powers) > 0
        selection = np.where(shining, 0.5 * np.array(powers) / sum(powers) + 0.5 / shining.sum(), 0.0)
        table = np.array(entries, LIGHT.dtype)
        table["selection_probability"] = selection
        table["selection_end"] = np.cumsum(selection)
        table["selection_end"][-1] = 1.0
        self.has_falloff = bool(
            (table["flags"] & LightFlag.SOFT).any() or table["falloff"].any() or table["smoothing"].any()
        )
        cut = LightFlag.SOFT | LightFlag.HOLDS_SURFACES
        self.are_cut = bool(((table["flags"] & cut) == cut).any())
        self.table, self._photons, self._most_photons = table, photons, scene.photon_count
        if kept is not None and np.array_equal(kept["kind"], table["kind"]):
            for column in _LEARNED:
                table[column] = kept[column]
            self._upload_table()
        else:
            self._weights = np.array(weights)
            self._first_powers = np.array([*powers[:-1], powers[-1] or self._portals.power])
            self.begin(photons)
        targets = caustic_targets(scene, geometry)
        self.target_count = len(targets)
        self.targets.upload(targets if len(targets) else np.zeros(4, np.float32))
        self._triangles = geometry.triangles.buffer
        self._list_groups(scene, [*groups, *(placed.instance.light_group for placed in geometry.placements)])
        self.links_lights = links.any
        self.links.upload(links.records)
        sets = links.records["light_sets"]
        self.emitters.leaves["light_sets"] = sets[self.emitters.links]
        self._light_tree.build(table, self.emitters.leaves, self.emitters.order, sets)
        self.emitters.leaves = LIGHT_NODE.zeros(0)  # as large as the triangles themselves
        self.parameters = {
            "scene_center": geometry.center,
            "scene_radius": radius,
            "world_radiance": self.environment.radiance,
            "light_count": len(entries),
            "environment_width": self.environment.width,
            "environment_height": self.environment.height,
            "emissive_triangle_count": self.emitters.count,
            "gathers_lights": shadows_are_of_all(scene),
            "world_selection": float(selection[table["kind"] == LightShape.WORLD].sum()),
            "environment_irradiance": 2 * math.pi * float(np.mean(np.abs(self.environment.mean_radiance))),
            "mesh_light": int(np.argmax(table["kind"] == LightShape.MESH)),
            "world_light": int(np.argmax(table["kind"] == LightShape.WORLD)),
            **self._light_tree.parameters,
            **self._portals.parameters,
            "portal_light": len(entries) - 1,
            "links_lights": self.links_lights,
            "world_visibility": int(self.world_visibility),
            "world_bounces": world_bounces,
        }
        self.limits_bounces = bool((table["max_bounces"] < UNLIMITED_BOUNCES).any())

    def _list_groups(self, scene: Scene, names: list[str]) -> None:
        """names: of the light groups of the lights and the instances."""
        numbers = {name: number for number, name in enumerate(scene.settings.light_groups)}
        self.world_group = numbers.get(scene.world.light_group, NO_LIGHT_GROUP)
        if numbers:
            self.group_table.upload(np.array([numbers.get(name, NO_LIGHT_GROUP) for name in names], np.uint32))
        else:
            self.group_table.release()

    def begin(self, photons: int) -> None:
        """Forget what photons were good for, as before the first iteration, and share so many among the lights."""
        even = np.ones(len(self._weights))
        self._share_photons(even, self._most_photons)
        self.guide.build(self.table, self._most_photons)
        if photons != self._most_photons:
            self._share_photons(even, photons)
        self._upload_table()

    def _upload_table(self) -> None:
        records = LIGHT.zeros(len(self.table) + len(self.portals.records))
        records[: len(self.table)], records[len(self.table) :] = self.table, self.portals.records
        self._lights.upload(records)

    def _share_photons(self, contributions: np.ndarray, photons: int, fraction: float = FIRST_PHOTON_FRACTION) -> None:
        """fraction: of the world's photons, those that leave through portals, where there are any."""
        self._photons = photons
        powers, worth = self._first_powers, self._weights * contributions
        if self.portals.power > 0.0:
            shares = photon_shares(powers[:-1], worth[:-1])
            shares = np.append(shares[:-1], shares[-1] * np.array([1.0 - fraction, fraction]))
        else:
            shares = photon_shares(powers, worth)
        counts = share_out(shares, photons)
        self.table["photon_count"] = counts
        self.table["first_photon"] = np.concatenate([[0], np.cumsum(counts)[:-1]])

    def tally(self, photons: Mapping[str, Bindable], slots: int) -> None:
        """Count what an iteration's photons were good for, once they have been splatted (Guide.tally)."""
        self.guide.tally(photons, slots, self._photons)

    def learn(self, photons: int) -> float:
        """Learn from the tallies where to send the photons of the next iterations, so many in each.

        Lights get photons by the power that contributes (guide.py), and a part by how many contribute. Returns how many
        times more photons should contribute from now on.
        """
        weights, contributed = self.guide.learn()
        before = self.table["photon_count"] @ contributed[:, 0]
        self._share_photons(weights, photons, self._portal_fraction)
        self._upload_table()
        return float(self.table["photon_count"] @ contributed[:, 1] / before)

    def restore(self, tallies: np.ndarray, learned: np.ndarray | None, photons: int) -> None:
        """Know what the guide of this scene's lights knew (Guide.restore, which tells what is raised) when the last
        iteration had so many photons."""
        weights = self.guide.restore(tallies, learned)
        if weights is not None:
            self._share_photons(weights, photons, self._portal_fraction)
            self._upload_table()

    @property
    def _portal_fraction(self) -> float:
        """photon_fraction, as the guide knows it."""
        if not self.portals.power > 0.0:
            return 0.0
        return photon_fraction(self._first_powers[-2:] * self.guide.even_contribution[-2:])

    @property
    def photon_flux(self) -> float:
        """Mean flux of the iteration's photons as they leave their lights, W, the channels' mean."""
        return self._power / self._photons

    @property
    def world_photon_flux(self) -> float:
        """Mean flux of those of the world's photons that contribute, W, the channels' mean; 0 where there are none."""
        worlds = np.flatnonzero((self.table["kind"] == LightShape.WORLD) & (self.table["photon_count"] > 0))
        return sum(
            self._powers[index] / int(self.table["photon_count"][index]) / float(self.guide.gains[index])
            for index in worlds
        )
