# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings that leave out or blur light which makes noise, as Cycles has them: clamping, caustics, Filter Glossy."""

import enum
import math
from dataclasses import dataclass

from .group import SettingGroup
from .setting_info import setting


class CausticKind(enum.IntFlag):
    """Kinds of caustics, by the lobe that sent the light to a diffuse surface; 0 is none."""

    REFLECTED = 1
    REFRACTED = 2


@dataclass
class LightFilterSettings(SettingGroup):
    """Light of paths that is limited, left out or blurred."""

    sample_clamp_direct: float = setting(
        0.0,
        "Clamp Direct",
        "Largest mean of red, green and blue of a sample of direct light, W/(m^2 sr), as in Cycles",
        minimum=0.0,
        zero="no limit",
    )
    sample_clamp_indirect: float = setting(
        0.0,
        "Clamp Indirect",
        "Largest mean of red, green and blue of a sample of indirect light, W/(m^2 sr), as in Cycles; of photons and "
        "the final gather it limits what a sample finds",
        minimum=0.0,
        zero="no limit",
    )
    caustics_reflective: bool = setting(
        True,
        "Reflective Caustics",
        "Caustics by reflection: light that glossy surfaces and mirrors send to diffuse ones. Without, as in Cycles, "
        "surfaces that diffuse ones see reflect nothing",
    )
    caustics_refractive: bool = setting(
        True,
        "Refractive Caustics",
        "Caustics by refraction: light that glass sends to diffuse surfaces. Without, as in Cycles, glass that diffuse "
        "surfaces see lets nothing through",
    )
    blur_glossy: float = setting(
        0.0,
        "Filter Glossy",
        "How strongly reflections and refractions are blurred that blurred bounces see, as in Cycles. It takes noise, "
        "and the sharpness of caustics",
        minimum=0.0,
        maximum=10.0,
        zero="no blur",
    )
    """The name is that of Cycles."""

    @property
    def clamp_direct(self) -> float:
        """Largest mean of a contribution's channels, W/(m^2 sr), of direct light."""
        return self.sample_clamp_direct or math.inf

    @property
    def clamp_indirect(self) -> float:
        """Largest mean of a contribution's channels, W/(m^2 sr), of indirect light."""
        return self.sample_clamp_indirect or math.inf

    @property
    def dropped_caustics(self) -> int:
        """Kinds of caustics that are left out, as a CausticKind."""
        return (0 if self.caustics_reflective else CausticKind.REFLECTED) | (
            0 if self.caustics_refractive else CausticKind.REFRACTED
        )

    @property
    def filter_pdf_scale(self) -> float:
        """Factor on a path's least pdf, sr, that gives what Filter Glossy compares with 1; 0 without blur."""
        return 1.0 / self.blur_glossy if self.blur_glossy > 0.0 else 0.0

    @property
    def gathered_alpha(self) -> float:
        """Least alpha of lobes that photons meet, and rays of the final gather: the mean of 0.5 sqrt(max(1 - scale pdf,
        0)) over the directions of a diffuse bounce, whose pdf is cos / pi, and whose cosines have the density 2 cos."""
        if self.blur_glossy <= 0.0:
            return 0.0
        slope = self.filter_pdf_scale / math.pi
        left = 1.0 - min(slope, 1.0)
        return (2.0 / 3.0 * (1.0 - left**1.5) - 2.0 / 5.0 * (1.0 - left**2.5)) / slope**2
