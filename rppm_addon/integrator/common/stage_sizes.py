# SPDX-License-Identifier: GPL-3.0-or-later
"""Sizes and features of a scene that determine the lengths of the stages' buffers."""

import itertools
import operator
from dataclasses import dataclass, field

from ...materials.traits.subsurface import has_subsurface
from ...scene.passes import CAUSTICS, SCATTERED_LIGHT, VOLUME_LIGHT, RenderPass
from ...scene.scene import Scene
from ...scene.settings import FirstCameraHits, Instancing, RenderSettings
from .active_paths import SEGMENTS_AT_ONCE
from .band import Band, bands_of, rows_of_bands
from .camera_view import is_rasterized
from .shader_features import ShaderFeatures
from .viewport_demands import NO_DEMANDS, ViewportDemands, with_filtered


@dataclass(frozen=True)
class StageSizes:
    """Scenes that agree in these are rendered in the same buffers."""

    width: int
    height: int
    photons: int = 0
    """Largest number of photons of an iteration."""
    photon_segments: int = 0
    """Segments of a photon path without transparent surfaces, the first leaving the light."""
    passes: tuple[RenderPass, ...] = ()
    has_catchers: bool = False
    """Whether objects catch shadows."""
    first_camera_hits: FirstCameraHits | None = FirstCameraHits.AUTOMATIC
    """Route to the camera's first hits; None where these do not lie on a raster."""
    has_texels: bool = False
    """Whether camera paths begin at texels of a mesh (baking)."""
    measures_noise: bool = False
    """Whether the noise threshold ends the render."""
    is_filtered: bool = False
    """Whether the film keeps what the noise filter of viewports takes."""
    links_lights: bool = False
    """Whether lights may shine on some objects only, or pass through some."""
    has_subsurface: bool = False
    """Whether light may go below surfaces."""
    features: ShaderFeatures = field(default_factory=ShaderFeatures)
    """Features that programs are compiled for."""
    has_rolling_shutter: bool = False
    """True where rows are exposed one after the other."""

    @classmethod
    def of(cls, scene: Scene, demands: ViewportDemands = NO_DEMANDS) -> "StageSizes":
        """Return the sizes of a scene."""
        width, height = scene.camera.resolution
        passes = scene.settings.rendered_passes
        if demands.is_filtered:
            passes = with_filtered(passes)
        is_rolling = scene.shutter is not None and scene.shutter.is_rolling
        return cls(
            width,
            height,
            scene.photon_count,
            scene.settings.photon_bounces + 1,
            passes,
            any(map(operator.attrgetter("shadow_catcher"), scene.instances)),
            _first_camera_hits(scene.settings, is_rolling) if is_rasterized(scene.camera) else None,
            scene.camera.texels is not None,
            scene.settings.use_adaptive_sampling,
            demands.is_filtered,
            _links_lights(scene),
            demands.has_subsurface or any(has_subsurface(material.graph) for material in scene.materials),
            ShaderFeatures.of(scene, demands),
            is_rolling,
        )

    @property
    def has_scattered_light(self) -> bool:
        """Whether any pass shows light by what scatters it first on its way from the camera: a surface or a medium."""
        return any(entry in SCATTERED_LIGHT or entry in VOLUME_LIGHT for entry in self.passes)

    @property
    def has_caustics(self) -> bool:
        """Whether the pass Caustics is rendered."""
        return CAUSTICS in self.passes

    @property
    def light_groups(self) -> tuple[str, ...]:
        """Light groups that have passes."""
        return tuple(entry.light_group for entry in self.passes if entry.light_group)

    @property
    def bands(self) -> list[Band]:
        """Bands of the film, from below; the first has the most rows."""
        return bands_of(self.width, self.height, self.has_rolling_shutter)


def _first_camera_hits(settings: RenderSettings, is_rolling: bool) -> FirstCameraHits:
    """Return the route: where two levels are asked for, the camera has no world triangles to rasterize, and a rolling
    shutter has many bands, for each of which all triangles would be drawn."""
    route, in_levels = settings.first_camera_hits, settings.instancing is Instancing.TWO_LEVELS
    return FirstCameraHits.TRACED if (in_levels or is_rolling) and route is FirstCameraHits.AUTOMATIC else route


def _links_lights(scene: Scene) -> bool:
    linking = map(operator.attrgetter("linking"), scene.instances)
    return any(light.linking is not None or not light.casts_shadow for light in scene.lights) or any(
        map(operator.is_not, linking, itertools.repeat(None))
    )


def film_pixels(sizes: StageSizes) -> int:
    """Return the number of pixels of the region that is rendered."""
    return sizes.width * sizes.height


def band_pixels(sizes: StageSizes) -> int:
    """Return the number of pixels of the largest band of rows."""
    return sizes.width * rows_of_bands(sizes.width, sizes.height, sizes.has_rolling_shutter)


def aov_channels(sizes: StageSizes) -> int:
    """Return the number of channels of all passes of AOV Output nodes together."""
    return sum(len(entry.channels) for entry in sizes.passes if entry.is_aov)


def split_pixels(sizes: StageSizes) -> int:
    """Return the number of pixels of the largest band where passes show scattered light or caustics apart; else 0."""
    return band_pixels(sizes) if sizes.has_scattered_light or sizes.has_caustics else 0


def grouped_pixels(sizes: StageSizes) -> int:
    """Return the number of pixels of the largest band where light groups have passes; else 0."""
    return band_pixels(sizes) if sizes.light_groups else 0


def subsurface_walks(sizes: StageSizes) -> int:
    """Return the largest number of subsurface walks, one for each camera path of a band or each photon of an
    iteration."""
    return max(band_pixels(sizes), sizes.photons)


def exiting_pixels(sizes: StageSizes) -> int:
    """Return the number of pixels of the largest band where light may go below surfaces; else 0."""
    return band_pixels(sizes) if sizes.has_subsurface else 0


def photon_paths(sizes: StageSizes) -> int:
    """Return the largest number of photon paths of an iteration."""
    return sizes.photons


def photon_slots(sizes: StageSizes) -> int:
    """Return the number of photons for which memory is allocated at first: a few segments of each path. Longer paths
    make the buffer grow."""
    return sizes.photons * min(sizes.photon_segments, SEGMENTS_AT_ONCE)
