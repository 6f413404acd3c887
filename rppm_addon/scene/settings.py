# SPDX-License-Identifier: GPL-3.0-or-later
"""Render settings; the Blender properties and the CLI's --set use the same names."""

import dataclasses
import enum
import math
from dataclasses import dataclass

from .errors import SettingsError
from .passes import passes_named

CUBEMAP_COSTS = ("steps", "tests", "list", "entries")
"""What a ray costs in the deep cubemap: cells looked at; triangles tested; entries in the cell of the hit, 0 where
nothing is hit; entries read."""

_FEWEST_AUTOMATIC_PHOTONS, _MOST_AUTOMATIC_PHOTONS = 1 << 13, 1 << 18
"""Fewer take next to no less time; more take longer than one waits for an iteration where there is no GPU."""
_MOST_AUTOMATIC_SEGMENTS = 1 << 21
"""Photon records that take 128 MiB, the largest buffer that all drivers have."""


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


class FirstPhotonHits(enum.Enum):
    """How the first hits of photons are found: the same ones, at different speed."""

    AUTOMATIC = "AUTOMATIC"
    """Traced at first, then whichever is faster, found by trying both."""
    RASTERIZED = "RASTERIZED"
    """Lamps and suns rasterize what they see, as in the paper."""
    TRACED = "TRACED"
    """Through the deep cubemap, like all later segments."""


@dataclass
class RenderSettings:
    """Settings of the photon mapper. Lengths in metres, times in seconds."""

    iterations: int = 128
    time_limit: float = 0.0
    """Stop with the iteration that ends nearest to so many seconds; 0 is no limit."""
    photons: int = 0
    """Photons emitted in each iteration, shared among the lights; 0 is automatic (photons_for)."""
    camera_path_length: int = 8
    """d_eye: camera path segments, the primary ray being the first."""
    photon_path_length: int = 8
    """d_photon: photon path segments, the first leaving the light."""
    alpha: float = 0.7
    """Eq. 2: the share of photons kept as the radius shrinks, in (0, 1)."""
    radius_scale: float = 10.0
    """s_r of Eq. 3: first radius in pixels of a 1 megapixel frame, scaled with the frame."""
    adaptive_radius: bool = True
    """Whether pixels begin with a wider radius for caustics than Eq. 3's and come back to it where photons are many;
    not where r_min or r_max is given."""
    radius_minimum: float = 0.0
    """r_min of the first iteration; 0 is automatic."""
    radius_maximum: float = 0.0
    """r_max of the first iteration; 0 is automatic."""
    specular_roughness: float = 0.5
    """Lobes with at most this roughness (the user's, not its square) are traced as specular;
    rougher ones store photons."""
    direct_light: DirectLight = DirectLight.RAYS
    final_gather: bool = True
    """Whether light that other surfaces send to a point is looked for along one ray, at whose end photons count."""
    splat_roulette: bool = False
    """Whether half of the splats are left out and the others count twice (paper section 4.2, Fig. 5)."""
    density_estimation: DensityEstimation = DensityEstimation.AUTOMATIC
    first_photon_hits: FirstPhotonHits = FirstPhotonHits.AUTOMATIC
    iterations_per_frame: int = 1
    """N_ipf: iterations between two pictures shown."""
    seed: int = 0
    cubemap_resolution: int = 0
    """The most cells along a side of DIRT's cube faces, a power of two; 0 is automatic."""
    filter_width: float = 1.5
    """Width of the Blackman-Harris pixel filter in pixels, as Cycles counts it; 0 looks through
    pixel centres only."""
    film_transparent: bool = False
    passes: tuple[str, ...] = ("Depth", "Normal")
    """Render passes beside Combined, by name (scene/passes.py)."""

    def validate(self) -> None:
        """Raise SettingsError naming the first setting that cannot be used, and its range."""

        def need(name: str, good: bool, what: str) -> None:
            if not good:
                raise SettingsError(f"{name} is {getattr(self, name)}; set it to {what}")

        need("iterations", self.iterations >= 1, "1 or more")
        need("time_limit", math.isfinite(self.time_limit) and self.time_limit >= 0.0, "0 (no limit) or seconds")
        need("photons", 0 <= self.photons <= 1 << 22, "0 (automatic) or 1 to 4194304")
        need("camera_path_length", 1 <= self.camera_path_length <= 64, "1 to 64")
        need("photon_path_length", 1 <= self.photon_path_length <= 64, "1 to 64")
        need("alpha", 0.0 < self.alpha < 1.0, "a value between 0 and 1")
        need("radius_scale", math.isfinite(self.radius_scale) and self.radius_scale > 0.0, "more than 0 pixels")
        need(
            "radius_minimum",
            math.isfinite(self.radius_minimum) and self.radius_minimum >= 0.0,
            "0 (automatic) or metres",
        )
        need(
            "radius_maximum",
            math.isfinite(self.radius_maximum) and self.radius_maximum >= 0.0,
            "0 (automatic) or metres",
        )
        if 0.0 < self.radius_maximum < self.radius_minimum:
            raise SettingsError(
                f"radius_maximum is {self.radius_maximum}, less than radius_minimum {self.radius_minimum}; raise it"
            )
        need("specular_roughness", 0.0 <= self.specular_roughness <= 1.0, "0 to 1")
        need("filter_width", math.isfinite(self.filter_width) and 0.0 <= self.filter_width <= 20.0, "0 to 20 pixels")
        need("iterations_per_frame", self.iterations_per_frame >= 1, "1 or more")
        need("seed", 0 <= self.seed < 1 << 31, "0 to 2147483647")
        passes_named(self.passes)
        resolution = self.cubemap_resolution
        need(
            "cubemap_resolution",
            resolution == 0 or (16 <= resolution <= 16384 and resolution & (resolution - 1) == 0),
            "0 (automatic) or a power of two from 16 to 16384",
        )

    def photons_for(self, width: int, height: int) -> int:
        """Photons of an iteration that renders so many pixels: where automatic, one a pixel within limits.

        Depends on nothing that another machine or another run would find otherwise.
        """
        if self.photons:
            return self.photons
        most = min(_MOST_AUTOMATIC_PHOTONS, _MOST_AUTOMATIC_SEGMENTS // self.photon_path_length)
        return max(min(width * height, most), _FEWEST_AUTOMATIC_PHOTONS)

    def with_values(self, **values: object) -> "RenderSettings":
        """A copy with some settings replaced; values may be text, as from the command line.

        Raises SettingsError for an unknown name or a value of the wrong kind.
        """
        fields = {field.name: field for field in dataclasses.fields(self)}
        converted = {}
        for name, value in values.items():
            if name not in fields:
                raise SettingsError(f"there is no setting {name}; the settings are {', '.join(fields)}")
            kind = type(getattr(self, name))
            try:
                if kind is bool and isinstance(value, str):
                    converted[name] = {"true": True, "1": True, "false": False, "0": False}[value.lower()]
                elif kind is tuple:
                    names = value.split(",") if isinstance(value, str) else value
                    converted[name] = tuple(text for item in names if (text := item.strip()))
                elif issubclass(kind, enum.Enum):
                    converted[name] = value if isinstance(value, kind) else kind[str(value).upper()]
                else:
                    converted[name] = kind(value)
            except (KeyError, ValueError, TypeError) as error:
                raise SettingsError(f"{name} cannot be {value!r}; it takes a {kind.__name__}") from error
        return dataclasses.replace(self, **converted)
