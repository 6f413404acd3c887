# SPDX-License-Identifier: GPL-3.0-or-later
"""Render settings, each declared once: Blender's properties, the command line and docs/settings.md follow.

Fields have the paper's names; where Cycles has another name for users, ``property_name`` tells it.
"""

import dataclasses
import enum
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .errors import SettingsError
from .passes import (
    DENOISING_ALBEDO,
    DENOISING_NORMAL,
    RenderPass,
    aov_passes,
    light_group_passes,
    passes_named,
    with_divisors,
)
from .setting_info import setting, settings_of

CUBEMAP_COSTS = ("steps", "tests", "list", "entries")
"""Costs of a ray in the deep cubemap: cells looked at; triangles tested; entries in the cell of the hit, 0 where
nothing is hit; entries read."""

MOST_PHOTONS = 1 << 22
_FEWEST_AUTOMATIC_PHOTONS, _MOST_AUTOMATIC_PHOTONS = 1 << 13, 1 << 18
"""Fewer take next to no less time; more take longer than one waits for an iteration where there is no GPU."""
_MOST_BOUNCES = 1024
MOST_SEGMENTS = 1024
"""Rays of a path, whatever the limits: as many as a photon's record can tell apart."""
_MOST_PASSED = 32
"""Segments of a path that lead through what is not there for it, such as objects hidden from the camera, and which no
limit counts."""


class DirectLight(enum.Enum):
    """How light that comes straight from a source is estimated; never both."""

    RAYS = "RAYS"
    PHOTONS = "PHOTONS"


class DensityEstimation(enum.Enum):
    """How photons and the points that take them find each other: the same picture, at different speed."""

    AUTOMATIC = "AUTOMATIC"
    """Whichever is faster, found by trying both."""
    RASTERIZED = "RASTERIZED"
    """Photons are splatted by rasterization, as in the paper."""
    GRID = "GRID"
    """Photons are gathered from hashed grids."""


class AccelerationStructure(enum.Enum):
    """Structure that rays are traced through: the same hits, at different speed."""

    AUTOMATIC = "AUTOMATIC"
    """The BVH where the processor stands in for a GPU, otherwise the deep cubemap."""
    DEEP_CUBEMAP = "DEEP_CUBEMAP"
    """Built by rasterization, as in the paper."""
    BVH = "BVH"
    """A bounding volume hierarchy."""


class FirstCameraHits(enum.Enum):
    """How the first hits of cameras without depth of field are found: nearly the same ones, at different speed."""

    AUTOMATIC = "AUTOMATIC"
    """Traced where the processor stands in for a GPU, otherwise rasterized."""
    RASTERIZED = "RASTERIZED"
    """The camera rasterizes what it sees, as in the paper."""
    TRACED = "TRACED"
    """Through the acceleration structure, like all later segments."""


class FirstPhotonHits(enum.Enum):
    """How the first hits of photons are found: the same ones, at different speed."""

    AUTOMATIC = "AUTOMATIC"
    """Traced at first, then whichever is faster, found by trying both."""
    RASTERIZED = "RASTERIZED"
    """Point lights, spots and suns rasterize what they see, as in the paper."""
    TRACED = "TRACED"
    """Through the acceleration structure, like all later segments."""


class PixelFilter(enum.Enum):
    """How light from beside a pixel counts. Names are Cycles'."""

    BOX = "BOX"
    GAUSSIAN = "GAUSSIAN"
    BLACKMAN_HARRIS = "BLACKMAN_HARRIS"


class DenoisingInputPasses(enum.Enum):
    """Passes that guide denoising. Names are Cycles'."""

    RGB = "RGB"
    RGB_ALBEDO = "RGB_ALBEDO"
    RGB_ALBEDO_NORMAL = "RGB_ALBEDO_NORMAL"


class DenoisingPrefilter(enum.Enum):
    """Treatment of noise in the passes that guide denoising."""

    NONE = "NONE"
    FAST = "FAST"
    ACCURATE = "ACCURATE"


class DenoisingQuality(enum.Enum):
    """Quality of denoising, and so the time that it may take."""

    HIGH = "HIGH"
    BALANCED = "BALANCED"
    FAST = "FAST"


@dataclass
class RenderSettings:
    """Settings of the photon mapper. Lengths in meters, times in seconds."""

    iterations: int = setting(
        128,
        "Samples",
        "Each sample sends photons and looks at every pixel once, and makes the picture sharper and less noisy",
        property_name="samples",
        minimum=1,
        soft_maximum=4096,
    )
    use_adaptive_sampling: bool = setting(
        False,
        "Noise Threshold",
        "Stop before the last sample once every part of the picture is less noisy than the threshold. The blur of the "
        "photons' radius is no noise and does not count",
    )
    adaptive_threshold: float = setting(
        0.01,
        "Noise Threshold",
        "Noise at which the render stops, in Cycles' unit: the error of red, green and blue over the square root of "
        "their sum, the mean of 16 x 16 pixels. Lower values take longer: half the noise about four times the samples",
        minimum=0.0001,
        maximum=1.0,
        soft_minimum=0.001,
        precision=4,
    )
    """Noise of the noisiest block at which the render stops (integrator/stages/noise_estimate.py)."""
    adaptive_min_samples: int = setting(
        0,
        "Min Samples",
        "Samples that are rendered however low the noise is; 0 is automatic, by the threshold",
        minimum=0,
        maximum=4096,
        zero="automatic",
    )
    time_limit: float = setting(
        0.0,
        "Time Limit",
        "Stop after this time even if samples are left; 0 is no limit",
        minimum=0.0,
        soft_maximum=3600.0,
        unit="s",
        zero="no limit",
    )
    """Stop with the iteration that ends nearest to so many seconds, and at most 5 % later but for the first one."""
    photons: int = setting(
        0,
        "Photons",
        "Photons emitted in each sample, allocated to the lights by their power and photon weight; "
        "0 is automatic: as many as the picture has pixels, within limits, and fewer after the second sample "
        "where they make little of the noise",
        minimum=0,
        maximum=MOST_PHOTONS,
        zero="automatic",
        step=1024,
    )
    """In each iteration; automatic: photons_for."""
    max_bounces: int = setting(
        32,
        "Max Bounces",
        "Most bounces of light on its way from what it lights first to the camera, as Cycles counts them: those of "
        "photons, of the final gather and of camera rays together. 0 is direct light only",
        minimum=0,
        maximum=_MOST_BOUNCES,
        soft_maximum=64,
    )
    transparent_max_bounces: int = setting(
        8,
        "Transparent Max Bounces",
        "Most transparent surfaces that light passes on its way to the camera, which are no bounces",
        minimum=0,
        maximum=_MOST_BOUNCES,
        soft_maximum=64,
    )
    """Name and default are Cycles'."""
    camera_path_length: int = setting(
        1 + _MOST_BOUNCES,
        "Max Camera Bounces",
        "Most bounces of camera rays and of the final gather, which Max Bounces limits as well; behind the last one "
        "rays see what shines and nothing else",
        property_name="max_camera_bounces",
        property_offset=-1,
        minimum=1,
        maximum=1 + _MOST_BOUNCES,
        soft_maximum=64,
    )
    """d_eye: camera path segments that may leave importons, the primary ray being the first."""
    photon_path_length: int = setting(
        1 + _MOST_BOUNCES,
        "Max Photon Bounces",
        "Most bounces of photons off any surface, which Max Bounces limits as well",
        property_name="max_photon_bounces",
        property_offset=-1,
        minimum=1,
        maximum=1 + _MOST_BOUNCES,
        soft_maximum=64,
    )
    """d_photon: photon path segments, the first leaving the light; transparent surfaces do not count."""
    alpha: float = setting(
        0.7,
        "Alpha",
        "Fraction of the new photons that are kept as the radius shrinks: low values sharpen quickly and stay noisy, "
        "high values stay smooth and blurred",
        minimum=0.01,
        maximum=0.999999,
        soft_maximum=0.99,
        unit="fraction",
    )
    """Eq. 2."""
    radius_scale: float = setting(
        10.0,
        "Initial Radius",
        "The first sample gathers photons over a disk as large as a square of this side, in pixels of a 1 megapixel "
        "picture; larger and smaller pictures scale it",
        minimum=0.01,
        soft_minimum=1.0,
        soft_maximum=50.0,
        unit="pixels",
    )
    """s_r of Eq. 3."""
    use_adaptive_radius: bool = setting(
        True,
        "Adaptive Radius",
        "Begin with up to four times the radius for caustics, by how far apart photons are, and come back to the "
        "initial one where they are many: less noise where they are few. Without effect where Minimum Radius "
        "or Maximum Radius is set",
    )
    radius_minimum: float = setting(
        0.0,
        "Minimum Radius",
        "Smallest radius in the first sample, shrinking from there; 0 is automatic",
        minimum=0.0,
        soft_maximum=1.0,
        unit="m",
        zero="automatic",
    )
    """r_min of the first iteration."""
    radius_maximum: float = setting(
        0.0,
        "Maximum Radius",
        "Largest radius in the first sample, shrinking from there; 0 is automatic",
        minimum=0.0,
        soft_maximum=1.0,
        unit="m",
        zero="automatic",
    )
    """r_max of the first iteration."""
    specular_roughness: float = setting(
        0.5,
        "Specular Roughness",
        "Surfaces up to this roughness, as their node shows it, are followed as mirrors and glass; rougher ones "
        "gather photons",
        minimum=0.0,
        maximum=1.0,
        unit="fraction",
    )
    """The user's roughness, not its square."""
    direct_light: DirectLight = setting(
        DirectLight.RAYS,
        "Direct Light",
        "How light that comes straight from a source is estimated",
        choices={
            DirectLight.RAYS: ("Rays", "Follow a ray to a light from each point: less noise"),
            DirectLight.PHOTONS: (
                "Photons",
                "Use the photons that come straight from the lights, as the paper does",
            ),
        },
    )
    use_final_gather: bool = setting(
        True,
        "Final Gather",
        "Look for light from other surfaces along one ray from each point, and take only direct light and caustics "
        "from the photons there: fine noise in place of blotches, slower samples",
    )
    use_splat_roulette: bool = setting(
        False,
        "Splat Roulette",
        "Leave out half of the splats at random and count the others twice: faster samples, more noise",
        where="nowhere",
    )
    """Paper section 4.2, Fig. 5, which `make bench` measures. At equal time, the variance is three times that without
    it on two of three scenes."""
    density_estimation: DensityEstimation = setting(
        DensityEstimation.AUTOMATIC,
        "Density Estimation",
        "How photons and the points that take them find each other: any way gives the same picture",
        choices={
            DensityEstimation.AUTOMATIC: ("Automatic", "Try both with the first photons and take the faster one"),
            DensityEstimation.RASTERIZED: (
                "Rasterized",
                "Splat photons onto pixels by rasterization, as the paper does",
            ),
            DensityEstimation.GRID: (
                "Photon Grid",
                "Sort photons into grids of cells, and look for them in the cells around",
            ),
        },
    )
    first_camera_hits: FirstCameraHits = setting(
        FirstCameraHits.AUTOMATIC,
        "First Camera Hits",
        "How it is found what cameras without depth of field see: pictures differ by rounding at edges only",
        choices={
            FirstCameraHits.AUTOMATIC: (
                "Automatic",
                "Trace where the processor stands in for a GPU, otherwise rasterize",
            ),
            FirstCameraHits.RASTERIZED: ("Rasterized", "Rasterize what the camera sees, as the paper does"),
            FirstCameraHits.TRACED: ("Traced", "Trace rays, as for all later hits"),
        },
    )
    first_photon_hits: FirstPhotonHits = setting(
        FirstPhotonHits.AUTOMATIC,
        "First Photon Hits",
        "How it is found where photons from point lights, spots and suns hit first: any way gives the same picture",
        choices={
            FirstPhotonHits.AUTOMATIC: (
                "Automatic",
                "Trace the first samples, then try both and take the faster one",
            ),
            FirstPhotonHits.RASTERIZED: (
                "Rasterized",
                "Rasterize what point lights, spots and suns see, as the paper does",
            ),
            FirstPhotonHits.TRACED: ("Traced", "Trace rays, as for all later hits"),
        },
    )
    acceleration_structure: AccelerationStructure = setting(
        AccelerationStructure.AUTOMATIC,
        "Acceleration Structure",
        "What rays are traced through: any structure gives the same picture",
        choices={
            AccelerationStructure.AUTOMATIC: (
                "Automatic",
                "The BVH where the processor stands in for a GPU, otherwise the deep cubemap",
            ),
            AccelerationStructure.DEEP_CUBEMAP: (
                "Deep Cubemap",
                "A cubemap of lists of triangles, which is built by rasterization, as in the paper",
            ),
            AccelerationStructure.BVH: (
                "BVH",
                "A bounding volume hierarchy, which the processor builds; it takes less memory",
            ),
        },
    )
    iterations_per_frame: int = setting(
        1,
        "Samples per Frame",
        "Samples before a picture is shown: while an animation plays in the viewport more make each frame smoother "
        "and the playback slower; final renders show their progress as often",
        property_name="samples_per_frame",
        minimum=1,
        soft_maximum=64,
    )
    """N_ipf."""
    seed: int = setting(
        0,
        "Seed",
        "Start of the random numbers; the same seed gives the same noise",
        minimum=0,
        maximum=(1 << 31) - 1,
    )
    cubemap_resolution: int = setting(
        0,
        "Cubemap Resolution",
        "The most cells along a side of the deep cubemap's faces, a power of two from 16 to 16384. They are that fine "
        "only where many triangles crowd; fewer take less memory, and rays take longer; 0 is automatic",
        minimum=0,
        maximum=16384,
        zero="automatic",
    )
    pixel_filter_type: PixelFilter = setting(
        PixelFilter.BLACKMAN_HARRIS,
        "Filter Type",
        "Pixel filter: how much light from beside a pixel counts for it",
        choices={
            PixelFilter.BOX: ("Box", "What is within a pixel counts alike: sharp, and jagged where things are small"),
            PixelFilter.GAUSSIAN: ("Gaussian", "A Gaussian of the filter's width"),
            PixelFilter.BLACKMAN_HARRIS: ("Blackman-Harris", "A Blackman-Harris window of the filter's width"),
        },
    )
    filter_width: float = setting(
        1.5,
        "Filter Width",
        "Width of the pixel filter, a box being as wide as the pixel; 0 looks through the middle of pixels only",
        minimum=0.0,
        maximum=20.0,
        soft_maximum=10.0,
        unit="pixels",
    )
    """As Cycles counts it."""
    use_denoising: bool = setting(
        False,
        "Denoise",
        "Take the noise out of the picture by Intel's Open Image Denoise once it is rendered; the picture with its "
        "noise is kept as the pass Noisy Image",
    )
    denoising_input_passes: DenoisingInputPasses = setting(
        DenoisingInputPasses.RGB_ALBEDO_NORMAL,
        "Denoising Passes",
        "Passes by which denoising tells noise from textures and edges",
        choices={
            DenoisingInputPasses.RGB: ("None", "The picture alone"),
            DenoisingInputPasses.RGB_ALBEDO: ("Albedo", "Keep what is seen in the surfaces' colors"),
            DenoisingInputPasses.RGB_ALBEDO_NORMAL: (
                "Albedo and Normal",
                "Keep what is seen in the surfaces' colors and normals",
            ),
        },
    )
    denoising_prefilter: DenoisingPrefilter = setting(
        DenoisingPrefilter.ACCURATE,
        "Denoising Prefilter",
        "What is done against noise in the passes that guide denoising",
        choices={
            DenoisingPrefilter.NONE: ("None", "Nothing: for passes without noise"),
            DenoisingPrefilter.FAST: ("Fast", "Denoise the picture and the passes together"),
            DenoisingPrefilter.ACCURATE: ("Accurate", "Denoise the passes first: takes longest"),
        },
    )
    denoising_quality: DenoisingQuality = setting(
        DenoisingQuality.HIGH,
        "Denoising Quality",
        "Quality of denoising, and the time that it takes",
        choices={
            DenoisingQuality.HIGH: ("High", "Best quality"),
            DenoisingQuality.BALANCED: ("Balanced", "Between quality and speed"),
            DenoisingQuality.FAST: ("Fast", "Least time"),
        },
    )
    denoising_start_sample: int = setting(
        1,
        "Denoising Start Sample",
        "First sample of a viewport whose picture is denoised",
        minimum=0,
        maximum=1 << 24,
        where="Sampling > Viewport > Denoise > Start Sample (scene.rppm.preview_denoising_start_sample)",
    )
    film_transparent: bool = setting(
        False,
        "Transparent",
        "Whether the background is transparent",
        where="Film > Transparent (render.film_transparent)",
    )
    passes: tuple[str, ...] = setting(
        ("Depth", "Normal"),
        "Passes",
        "Render passes beside Combined, by name",
        where="the switches of the view layer",
    )
    """By name (scene/passes.py)."""
    aovs: tuple[str, ...] = setting(
        (),
        "AOVs",
        "Passes that AOV Output nodes of materials give: NAME.RGBA of colors, NAME.X of values",
        where="View Layer > Passes > Shader AOV (view_layer.aovs)",
    )
    light_groups: tuple[str, ...] = setting(
        (),
        "Light Groups",
        "Groups of lights, objects and the world whose light has a pass of its own, by name",
        where="View Layer > Passes > Light Groups (view_layer.lightgroups)",
    )

    def validate(self) -> None:
        """Raise SettingsError naming the first setting that cannot be used, and its range."""
        for name, info in settings_of(RenderSettings).items():
            if not info.accepts(getattr(self, name)):
                raise SettingsError(f"{info.shown(name, getattr(self, name))}; set it to {info.range_text}")
        if 0.0 < self.radius_maximum < self.radius_minimum:
            raise SettingsError(
                f"radius_maximum is {self.radius_maximum}, less than radius_minimum {self.radius_minimum}; raise it"
            )
        taken = {entry.name for entry in (*passes_named(self.passes), *light_group_passes(self.light_groups))}
        for entry in aov_passes(self.aovs):
            if entry.name in taken:
                raise SettingsError(f"the AOV {entry.name} has the name of another pass; give it a name of its own")
        resolution = self.cubemap_resolution
        if resolution and (resolution < 16 or resolution & (resolution - 1)):
            raise SettingsError(
                f"cubemap_resolution is {resolution}; set it to 0 (automatic) or a power of two from 16 to 16384"
            )

    @property
    def least_iterations(self) -> int:
        """Before the noise can end a render. Where automatic, as Cycles has it: 64 for a threshold of 0.01."""
        return self.adaptive_min_samples or math.ceil(16.0 / self.adaptive_threshold**0.3)

    @property
    def denoising_features(self) -> tuple[str, ...]:
        """The passes that guide denoising, by name; none where nothing is denoised."""
        if not self.use_denoising:
            return ()
        return {
            DenoisingInputPasses.RGB: (),
            DenoisingInputPasses.RGB_ALBEDO: (DENOISING_ALBEDO,),
            DenoisingInputPasses.RGB_ALBEDO_NORMAL: (DENOISING_ALBEDO, DENOISING_NORMAL),
        }[self.denoising_input_passes]

    @property
    def film_passes(self) -> tuple[str, ...]:
        """Names of the passes that are found: those asked for, what they are divided by, and what denoising needs."""
        return tuple(dict.fromkeys((*with_divisors(self.passes), *self.denoising_features)))

    @property
    def picture_passes(self) -> tuple[RenderPass, ...]:
        """The passes that were asked for."""
        return passes_named(self.passes) + self._named_by_users

    @property
    def found_passes(self) -> tuple[RenderPass, ...]:
        """Passes that are found: those asked for, those that they are divided by, and those that denoising needs."""
        return passes_named(self.film_passes) + self._named_by_users

    @property
    def _named_by_users(self) -> tuple[RenderPass, ...]:
        return aov_passes(self.aovs) + light_group_passes(self.light_groups)

    @property
    def camera_bounces(self) -> int:
        """Bounces of a camera path to the last vertex at which light is estimated."""
        return min(self.max_bounces, self.camera_path_length - 1)

    @property
    def photon_bounces(self) -> int:
        """Bounces of a photon to the last surface that stores it."""
        return min(self.max_bounces, self.photon_path_length - 1)

    @property
    def camera_segments(self) -> int:
        """Rays of a camera path, the most: one behind the last bounce sees what shines."""
        return min(self.camera_bounces + 2 + self.transparent_max_bounces + _MOST_PASSED, MOST_SEGMENTS)

    @property
    def photon_segments(self) -> int:
        """Rays of a photon path, the most."""
        return min(self.photon_bounces + 1 + self.transparent_max_bounces + _MOST_PASSED, MOST_SEGMENTS)

    def photons_for(self, width: int, height: int) -> int:
        """Photons of an iteration that renders so many pixels. Where automatic, one a pixel within limits: those of
        the first iteration, which later ones do not exceed (integrator/common/photon_counts.py).

        Depends on nothing that another machine or another run would find otherwise.
        """
        if self.photons:
            return self.photons
        return max(min(width * height, _MOST_AUTOMATIC_PHOTONS), _FEWEST_AUTOMATIC_PHOTONS)

    def with_values(self, **values: object) -> "RenderSettings":
        """A copy with some fields replaced; enumerations may be given by name.

        Raises SettingsError for an unknown name or a value of the wrong kind.
        """
        known = settings_of(RenderSettings)
        for name in values:
            if name not in known:
                raise SettingsError(f"there is no setting {name}; the settings are {', '.join(known)}")
        changed = {name: _converted(name, type(getattr(self, name)), value) for name, value in values.items()}
        return dataclasses.replace(self, **changed)

    def with_properties(self, values: Mapping[str, object]) -> "RenderSettings":
        """A copy with some settings replaced by the names that users know them by; values may be text, as from the
        command line.

        Raises SettingsError for an unknown name or a value of the wrong kind.
        """
        fields = {info.property_of(name): (name, info) for name, info in settings_of(RenderSettings).items()}
        converted: dict[str, Any] = {}
        for given, value in values.items():
            if given not in fields:
                raise SettingsError(f"there is no setting {given}; the settings are {', '.join(fields)}")
            name, info = fields[given]
            converted[name] = _converted(given, type(getattr(self, name)), value, info.property_offset)
        return dataclasses.replace(self, **converted)


def _converted(name: str, kind: type[Any], value: Any, offset: int = 0) -> Any:
    """A value, perhaps text, as the field has it; ``offset``: what users see more."""
    try:
        if kind is bool and isinstance(value, str):
            return {"true": True, "1": True, "false": False, "0": False}[value.lower()]
        if kind is tuple:
            names = value.split(",") if isinstance(value, str) else value
            return tuple(text for item in names if (text := item.strip()))
        if issubclass(kind, enum.Enum):
            return value if isinstance(value, kind) else kind[str(value).upper()]
        return kind(value) - offset if offset else kind(value)
    except (KeyError, ValueError, TypeError, AttributeError, OverflowError) as error:
        raise SettingsError(f"{name} cannot be {value!r}; it takes a {kind.__name__}") from error
