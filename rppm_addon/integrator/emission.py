# SPDX-License-Identifier: GPL-3.0-or-later
"""Light sources on the GPU, their shares of the photons, and the photons that leave them."""

import logging
import math

import moderngl
import numpy as np

from ..gl.buffers import GrowingBuffer
from ..gl.context import Context
from ..gl.programs import ProgramLibrary
from ..gl.records import Record
from ..materials.tables import MaterialTables
from ..scene.errors import SceneError
from ..scene.lights import Light, LightKind
from ..scene.meshes import RayVisibility
from ..scene.scene import Scene
from .emitters import Emitters
from .environment import Environment
from .geometry import Geometry
from .guide import Guide
from .lamp_maps import LampMaps
from .light_gbuffer import LightGBuffer
from .light_tree import LIGHT_TREE_PARAMETERS, LightTree
from .records import LIGHT, LIGHT_SOFT, LightShape
from .resolve import Resolve
from .sources import SURFACES, SURROUNDINGS, source_name
from .targets import caustic_targets

log = logging.getLogger(__name__)

_LEARNED = ("photon_count", "first_photon", "cells", "first_cell")
"""Of a light's record, what follows from what photons were good for."""

LIGHT_PARAMETERS = {
    "scene_centre": "vec3",
    "scene_radius": "float",
    "world_radiance": "vec3",
    "light_count": "uint",
    "environment_width": "uint",
    "environment_height": "uint",
    "emissive_triangle_count": "uint",
    "mesh_selection": "float",
    "world_selection": "float",
    "environment_irradiance": "float",
    "mesh_light": "uint",
    "world_light": "uint",
    **LIGHT_TREE_PARAMETERS,
    "seed": "uint",
    "iteration": "uint",
}
"""Parameters of every program that includes shaders/emission/lights.glsl. ``mesh_selection`` and
``world_selection`` are the probabilities of choosing the emissive meshes and the world for direct light, as MIS
weights take them; ``mesh_light`` and ``world_light`` their numbers; ``environment_irradiance`` what the world may
give, W/m^2."""

Record("EmitParameters", **LIGHT_PARAMETERS, count="uint", target_count="uint")
Record("FalloffParameters", **LIGHT_PARAMETERS, count="uint")


def spot_share(cosine_cone: float, blend: float) -> float:
    """Power of a spot over its axial intensity: integral of its falloff over solid angle, sr."""
    cosine = np.linspace(cosine_cone, 1.0, 4097)
    x = np.clip((cosine - cosine_cone) / max((1 - cosine_cone) * blend, 1e-9), 0, 1)
    return float(2 * math.pi * np.mean(x * x * (3 - 2 * x)) * (1 - cosine_cone))


def spread_constants(spread: float) -> tuple[float, float]:
    """Tangent of half the spread and the factor of Cycles' falloff; (0, 1) for a diffuse light."""
    half = 0.5 * spread
    if half >= 0.5 * math.pi - 1e-4:
        return 0.0, 1.0
    half = max(half, 1e-3)
    return math.tan(half), 1.0 / (math.tan(half) - half)


def _spread_share(tangent: float, scale: float) -> float:
    """Flux of a spread light over radiance times area, sr."""
    if tangent <= 0.0:
        return math.pi
    theta = np.linspace(0.0, math.atan(tangent), 4097)
    values = np.maximum(0.0, (tangent - np.tan(theta)) * scale) * np.cos(theta) * np.sin(theta)
    return float(2 * math.pi * np.mean(values) * math.atan(tangent))


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


class Emission:
    """The lights of a scene: buffers for the shaders that include emission/lights.glsl."""

    def __init__(self, context: Context, library: ProgramLibrary) -> None:
        self._program = library.compute("emission/emit.comp")
        self._falloff_program = library.compute("emission/falloff.comp")
        self._lights = GrowingBuffer(context, "lights")
        self.emitters = Emitters(context, library)
        self._targets = GrowingBuffer(context, "photon targets")
        self._target_count = 0
        self.environment = Environment(context)
        self.lamp_maps = LampMaps(context)
        self.guide = Guide(context, library)
        self._light_tree = LightTree(context)
        self._table = LIGHT.zeros(0)
        self._weights = np.zeros(0)
        self._names: list[str] = []
        self._powers: list[float] = []
        self._parameters: dict[str, object] = {}
        self._triangles: moderngl.Buffer | None = None
        self.has_falloff = False
        self._power, self._photons, self._most_photons = 0.0, 1, 1

    @property
    def buffers(self) -> dict[str, moderngl.Buffer]:
        """Storage blocks of emission/lights.glsl."""
        return {
            "Lights": self._lights.buffer,
            "EmissiveTriangles": self.emitters.triangles.buffer,
            "Triangles": self._triangles,
            "EnvironmentDistribution": self.environment.distribution.buffer,
        }

    @property
    def tree_buffers(self) -> dict[str, moderngl.Buffer]:
        """Storage blocks of emission/light_tree.glsl."""
        return {**self.buffers, "LightNodes": self._light_tree.nodes.buffer}

    @property
    def memory_bytes(self) -> dict[str, int]:
        return {
            "lights": self._lights.size,
            **self.emitters.memory_bytes,
            "photon targets": self._targets.size,
            "light tree": self._light_tree.nodes.size,
            "environment": self.environment.memory_bytes,
            "lamp maps": self.lamp_maps.memory_bytes,
            **self.guide.memory_bytes,
        }

    @property
    def source_watts(self) -> dict[str, float]:
        """Power within the scene, the channels' mean, by source: lights (source_name), SURFACES and SURROUNDINGS."""
        return self._by_source(self._powers)

    @property
    def source_photons(self) -> dict[str, int]:
        """Photons of the current iteration by source."""
        return self._by_source(self._table["photon_count"].tolist())

    def _by_source(self, values: list) -> dict:
        sums: dict[str, float] = {}
        for name, value in zip(self._names, values):
            sums[name] = sums.get(name, 0) + value
        return sums

    def use_maps(self) -> None:
        """Bind the textures of programs that include emission/lights.glsl."""
        self.environment.use()
        self.lamp_maps.use()

    def parameters(self, seed: int, iteration: int) -> dict[str, object]:
        """Values of LIGHT_PARAMETERS."""
        return {**self._parameters, "seed": seed, "iteration": iteration}

    def build(
        self,
        scene: Scene,
        geometry: Geometry,
        materials: MaterialTables,
        resolve: Resolve,
        photons: int,
        keep_world: bool = False,
        keep_lamps: bool = False,
        keep_learned: bool = False,
    ) -> None:
        """Lay out all lights and share the photons of an iteration among them.

        photons: of that iteration, no more than the scene's. keep_world, keep_lamps: the world, or all light objects,
        are those of the last call. keep_learned: the lights are those of the last call at another time, and what was
        learned of them holds.
        Raises SceneError when all lights have a photon share of 0.
        """
        radius = max(geometry.radius * 1.001, 1e-6)
        names: list[str] = []
        entries: list[np.ndarray] = []
        powers: list[float] = []
        weights: list[float] = []

        def add(name: str, entry: np.ndarray, power: np.ndarray, share: float = 1.0) -> None:
            if np.isfinite(power).all() and np.max(power) > 0:
                names.append(name)
                entries.append(entry)
                powers.append(float(np.mean(power)))
                weights.append(float(np.mean(power)) * max(share, 0.0))

        if not keep_lamps:
            self.lamp_maps.build(scene.lights, scene.images, materials)
        for index, light in enumerate(scene.lights):
            entry, power = _light_entry(light, radius)
            nodes = self.lamp_maps.nodes.get(index)
            if nodes is not None:
                entry["strength"] *= nodes.scale
                entry["falloff"], entry["smoothing"] = nodes.falloff, nodes.smoothing
                if nodes.shape is not None:
                    entry["map_shape"], entry["map_extent"], entry["map"] = nodes.shape, nodes.extent, nodes.place
                power = power * nodes.mean / (1.0 + nodes.smoothing)
            add(source_name(light.name), entry, power, light.photon_weight)
        self.emitters.build(scene, geometry, materials, resolve)
        entry = LIGHT.zeros(1)[0]
        entry["kind"], entry["flags"] = LightShape.MESH, int(RayVisibility.ALL)
        add(SURFACES, entry, self.emitters.power)
        if not keep_world:
            self.environment.build(scene.world, scene.images, materials)
        entry = LIGHT.zeros(1)[0]
        entry["kind"], entry["flags"] = LightShape.WORLD, int(RayVisibility.ALL)
        add(SURROUNDINGS, entry, 4 * math.pi**2 * radius**2 * self.environment.mean_radiance)
        if not entries:
            # As in an animation whose lights go out: the picture is black, as Cycles' is.
            log.warning("nothing in the scene emits light; add a light, or give a material or the world some emission")
            entries, powers, weights = [entry], [1.0], [1.0]
        if sum(weights) <= 0:
            raise SceneError("all lights have photon share 0; raise the share of one")

        kept = self._table if keep_learned and names == self._names else None
        self._names, self._powers, self._power = names, powers, sum(powers)
        # By power, half of it evenly: what does not choose by the point, and MIS weights.
        selection = 0.5 * np.array(powers) / sum(powers) + 0.5 / len(powers)
        table = np.array(entries, LIGHT.dtype)
        table["selection_probability"] = selection
        table["selection_end"] = np.cumsum(selection)
        table["selection_end"][-1] = 1.0
        self.has_falloff = bool(
            (table["flags"] & LIGHT_SOFT).any() or table["falloff"].any() or table["smoothing"].any()
        )
        self._table, self._photons, self._most_photons = table, photons, scene.photon_count
        if kept is not None and np.array_equal(kept["kind"], table["kind"]):
            for column in _LEARNED:
                table[column] = kept[column]
            self._lights.upload(table)
        else:
            self._weights = np.array(weights)
            self.begin(photons)
        targets = caustic_targets(scene, geometry)
        self._target_count = len(targets)
        self._targets.upload(targets if len(targets) else np.zeros(4, np.float32))
        self._triangles = geometry.triangles.buffer
        self._light_tree.build(table, self.emitters.leaves)
        self._parameters = {
            "scene_centre": geometry.centre,
            "scene_radius": radius,
            "world_radiance": self.environment.radiance,
            "light_count": len(entries),
            "environment_width": self.environment.width,
            "environment_height": self.environment.height,
            "emissive_triangle_count": self.emitters.count,
            "mesh_selection": float(selection[table["kind"] == LightShape.MESH].sum()),
            "world_selection": float(selection[table["kind"] == LightShape.WORLD].sum()),
            "environment_irradiance": 2 * math.pi * float(np.mean(self.environment.mean_radiance)),
            "mesh_light": int(np.argmax(table["kind"] == LightShape.MESH)),
            "world_light": int(np.argmax(table["kind"] == LightShape.WORLD)),
            **self._light_tree.parameters,
        }

    def rasterize_views(self, gbuffer: LightGBuffer, geometry: Geometry) -> bool:
        """Have what the lights see rasterized; whether any of them has a view. Raises DeviceError."""
        return gbuffer.build(self._table, geometry.centre, self._parameters["scene_radius"], geometry) > 0

    def begin(self, photons: int) -> None:
        """Forget what photons were good for, as before the first iteration, and share so many among the lights."""
        self._share_photons(self._weights, self._most_photons)
        self.guide.build(self._table, self._most_photons)
        if photons != self._most_photons:
            self._share_photons(self._weights, photons)
        self._lights.upload(self._table)

    def _share_photons(self, weights: np.ndarray, photons: int) -> None:
        self._photons = photons
        counts = share_out(weights, photons)
        self._table["photon_count"] = counts
        self._table["first_photon"] = np.concatenate([[0], np.cumsum(counts)[:-1]])

    def tally(self, photons: moderngl.Buffer, segments: int) -> None:
        """Count what an iteration's photons were good for, once they have been splatted."""
        self.guide.tally(photons, self._photons, segments)

    def learn(self, photons: int) -> float:
        """Of what has been tallied, learn where to send the photons of the next iterations, so many in each.

        Lights get photons by the power that is of use; see guide.py. Returns how many times more photons should be
        of use from now on.
        """
        weights, useful = self.guide.learn()
        before = self._table["photon_count"] @ useful[:, 0]
        self._share_photons(self._weights * weights, photons)
        self._lights.upload(self._table)
        return float(self._table["photon_count"] @ useful[:, 1] / before)

    def restore(self, tallies: np.ndarray, learnt: np.ndarray | None, photons: int) -> None:
        """Know what the guide of this scene's lights knew (Guide.restore, which tells what is raised) when the last
        iteration had so many photons."""
        weights = self.guide.restore(tallies, learnt)
        if weights is not None:
            self._share_photons(self._weights * weights, photons)
            self._lights.upload(self._table)

    @property
    def photon_flux(self) -> float:
        """Mean flux of the iteration's photons as they leave their lights, W, the channels' mean."""
        return self._power / self._photons

    def run(
        self,
        rays: moderngl.Buffer,
        photon_paths: moderngl.Buffer,
        world_radiances: moderngl.Buffer,
        count: int,
        seed: int,
        iteration: int,
    ) -> None:
        """Emit ``count`` photons: their first rays, the flux they carry, and how bright the world is there."""
        self.use_maps()
        self._program.run(
            count,
            {
                **self.buffers,
                **self.guide.buffers,
                "Rays": rays,
                "PhotonPaths": photon_paths,
                "WorldRadiances": world_radiances,
                "Targets": self._targets.buffer,
            },
            {**self.parameters(seed, iteration), "count": count, "target_count": self._target_count},
        )

    def fall_off(
        self,
        rays: moderngl.Buffer,
        hits: moderngl.Buffer,
        photon_paths: moderngl.Buffer,
        count: int,
        seed: int,
        iteration: int,
    ) -> None:
        """Where photons hit first: end those that a soft light does not send there, and let the distance count."""
        self._falloff_program.run(
            count,
            {**self.buffers, "Rays": rays, "Hits": hits, "PhotonPaths": photon_paths},
            {**self.parameters(seed, iteration), "count": count},
        )

    def release(self) -> None:
        self._lights.release()
        self.emitters.release()
        self._targets.release()
        self._light_tree.nodes.release()
        self.guide.release()
        self.lamp_maps.release()
        self.environment.release()


def _unit(vector: np.ndarray) -> np.ndarray:
    size = np.linalg.norm(vector)
    return vector / size if size > 0 else np.array([0.0, 0.0, 1.0])


def _light_entry(light: Light, scene_radius: float) -> tuple[np.ndarray, np.ndarray]:
    """A light's record and its power, (3,) W, within the scene."""
    entry = LIGHT.zeros(1)[0]
    axes = np.asarray(light.matrix, np.float64)[:3, :3]
    entry["position"] = light.matrix[:3, 3]
    normal = -_unit(axes[:, 2])
    entry["normal"] = normal
    entry["strength"] = strength = np.maximum(light.strength, 0.0)
    entry["radius"] = max(light.radius, 0.0)
    soft = light.soft_falloff and light.radius > 0 and light.kind in (LightKind.POINT, LightKind.SPOT)
    entry["flags"] = int(light.visibility) | (LIGHT_SOFT if soft else 0)
    if light.kind is LightKind.POINT:
        entry["kind"] = LightShape.POINT
        return entry, 4 * math.pi * strength
    if light.kind is LightKind.SPOT:
        cosine = math.cos(0.5 * min(light.spot_angle, math.pi))
        lengths = np.maximum(np.linalg.norm(axes, axis=0), 1e-9)
        # A scaled spot has an elliptic cone: axes divided by their scale relative to the beam's.
        entry["kind"] = LightShape.SPOT
        entry["axis_u"] = axes[:, 0] / lengths[0] * (lengths[2] / lengths[0])
        entry["axis_v"] = axes[:, 1] / lengths[1] * (lengths[2] / lengths[1])
        entry["cosine_cone"], entry["blend"] = cosine, np.clip(light.spot_blend, 0.0, 1.0)
        # Photons go out in the round cone that holds the elliptic one.
        widest = math.atan(math.tan(min(math.acos(cosine), 1.57)) * max(1.0, max(lengths[:2]) / lengths[2]))
        entry["spread_scale"] = 1.0 - math.cos(widest) if cosine > 1e-3 else 1.0
        return entry, strength * spot_share(cosine, light.spot_blend)
    if light.kind is LightKind.SUN:
        entry["kind"] = LightShape.SUN
        cosine = math.cos(0.5 * min(max(light.sun_angle, 0.0), math.pi))
        entry["axis_u"], entry["axis_v"] = _unit(axes[:, 0]), _unit(axes[:, 1])
        # The irradiance counts cosines over the disk; GLSL takes radiance times its solid angle.
        entry["cosine_cone"], entry["strength"] = cosine, strength * 2.0 / (1.0 + cosine)
        return entry, entry["strength"] * math.pi * scene_radius**2
    width, height = light.size if light.shape in ("RECTANGLE", "ELLIPSE") else (light.size[0], light.size[0])
    entry["axis_u"], entry["axis_v"] = 0.5 * width * axes[:, 0], 0.5 * height * axes[:, 1]
    round_shape = light.shape in ("DISK", "ELLIPSE")
    entry["kind"] = LightShape.ELLIPSE if round_shape else LightShape.RECTANGLE
    spanned = np.linalg.norm(np.cross(entry["axis_u"], entry["axis_v"]))
    area = (math.pi if round_shape else 4.0) * spanned
    if spanned <= 0:
        return entry, np.zeros(3)
    normal = _unit(np.cross(entry["axis_u"], entry["axis_v"]).astype(np.float64))
    entry["normal"] = -normal if np.dot(normal, axes[:, 2]) > 0 else normal
    entry["area"] = area
    tangent, scale = spread_constants(light.spread)
    entry["spread_tangent"], entry["spread_scale"] = tangent, scale
    entry["cosine_cone"] = math.cos(math.atan(tangent))
    return entry, strength * area * _spread_share(tangent, scale)
