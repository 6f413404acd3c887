# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of how much is rendered: samples, noise, time."""

import math
from dataclasses import dataclass

from .group import SettingGroup
from .setting_info import setting


@dataclass
class SamplingSettings(SettingGroup):
    """Samples of a render, and what ends it before the last one. Times in seconds."""

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
    """Noise of the noisiest block at which the render stops (integrator/film/noise_estimate.py)."""
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
    """Seconds. The render stops with the iteration that ends nearest; only the first one may end over 5 % later."""
    seed: int = setting(
        0,
        "Seed",
        "Start of the random numbers; the same seed gives the same noise",
        minimum=0,
        maximum=(1 << 31) - 1,
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
    """The paper's N_ipf."""

    @property
    def least_iterations(self) -> int:
        """Iterations before the noise can end a render; automatic as in Cycles: 64 for a threshold of 0.01."""
        return self.adaptive_min_samples or math.ceil(16.0 / self.adaptive_threshold**0.3)
