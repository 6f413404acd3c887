# SPDX-License-Identifier: GPL-3.0-or-later
"""All settings of a render.

Each is declared once, in the module of its subject: Blender's properties, the command line, saved scenes and
docs/settings.md follow. Fields have the paper's names; where Cycles has another name for users, ``property_name`` tells
it.
"""

from dataclasses import dataclass

from ..passes import RenderPass, passes_named, with_divisors
from .acceleration import AccelerationSettings
from .denoising import DenoisingSettings
from .film import FilmSettings
from .light_filters import LightFilterSettings
from .light_paths import LightPathSettings
from .photons import PhotonSettings
from .sampling import SamplingSettings


@dataclass
class RenderSettings(
    DenoisingSettings,
    FilmSettings,
    AccelerationSettings,
    LightFilterSettings,
    LightPathSettings,
    PhotonSettings,
    SamplingSettings,
):
    """Settings of the photon mapper: one record of all subjects, which begins with the fields of its last base."""

    @property
    def rendered_passes(self) -> tuple[RenderPass, ...]:
        """Passes that are rendered: the requested ones, their divisors, and those that denoising needs."""
        names = dict.fromkeys((*with_divisors(self.passes), *self.denoising_features))
        return passes_named(tuple(names)) + self.passes_named_by_users
