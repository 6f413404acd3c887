# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of the film: its pixel filter, background and passes."""

import enum
from dataclasses import dataclass

from ..errors import SettingsError
from ..passes import RenderPass, aov_passes, light_group_passes, passes_named
from .group import SettingGroup
from .setting_info import setting


class PixelFilter(enum.Enum):
    """Weight of light around a pixel's center; the names are those of Cycles."""

    BOX = "BOX"
    GAUSSIAN = "GAUSSIAN"
    BLACKMAN_HARRIS = "BLACKMAN_HARRIS"


@dataclass
class FilmSettings(SettingGroup):
    """Pixel filter, background and passes of the film."""

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
    """Width in pixels, as Cycles counts it."""
    film_transparent: bool = setting(
        False,
        "Transparent",
        "Whether the background is transparent",
        where="Film > Transparent (render.film_transparent)",
    )
    film_transparent_glass: bool = setting(
        False,
        "Transparent Glass",
        "Whether a transparent film shows the background behind surfaces that transmit light clearly, for compositing "
        "glass over another background",
    )
    film_transparent_roughness: float = setting(
        0.1,
        "Roughness Threshold",
        "Roughness of glass, as its node shows it, above which it stays opaque in a transparent film",
        minimum=0.0,
        maximum=1.0,
        unit="fraction",
    )
    passes: tuple[str, ...] = setting(
        ("Depth", "Normal"),
        "Passes",
        "Render passes beside Combined, by name",
        where="the switches of the view layer",
    )
    """Names of entries in the pass table (scene/passes.py)."""
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
        """Raise SettingsError for a value out of its range, or an AOV with the name of another pass."""
        super().validate()
        taken = {entry.name for entry in (*passes_named(self.passes), *light_group_passes(self.light_groups))}
        for entry in aov_passes(self.aovs):
            if entry.name in taken:
                raise SettingsError(f"the AOV {entry.name} has the name of another pass; give it a name of its own")

    @property
    def picture_passes(self) -> tuple[RenderPass, ...]:
        """The passes that were asked for."""
        return passes_named(self.passes) + self.passes_named_by_users

    @property
    def passes_named_by_users(self) -> tuple[RenderPass, ...]:
        """The passes of AOVs and light groups."""
        return aov_passes(self.aovs) + light_group_passes(self.light_groups)
