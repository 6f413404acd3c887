# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of denoising, with Cycles' names and choices."""

import enum
from dataclasses import dataclass

from ..passes import DENOISING_ALBEDO, DENOISING_NORMAL
from .group import SettingGroup
from .setting_info import setting


class DenoisingInputPasses(enum.Enum):
    """Passes that guide denoising; the names are those of Cycles."""

    RGB = "RGB"
    RGB_ALBEDO = "RGB_ALBEDO"
    RGB_ALBEDO_NORMAL = "RGB_ALBEDO_NORMAL"


class DenoisingPrefilter(enum.Enum):
    """Treatment of noise in the passes that guide denoising."""

    NONE = "NONE"
    FAST = "FAST"
    ACCURATE = "ACCURATE"


class DenoisingQuality(enum.Enum):
    """Quality of denoising, and the time that it may take."""

    HIGH = "HIGH"
    BALANCED = "BALANCED"
    FAST = "FAST"


@dataclass
class DenoisingSettings(SettingGroup):
    """Denoising of a picture, or of a viewport, by Open Image Denoise."""

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
    denoising_use_gpu: bool = setting(
        False,
        "Denoise on GPU",
        "Denoise on the first GPU that Open Image Denoise can use, if there is one; meanwhile rendering has less "
        "of the GPU's time and memory",
    )
    denoising_start_sample: int = setting(
        1,
        "Denoising Start Sample",
        "First sample of a viewport whose picture is denoised",
        minimum=0,
        maximum=1 << 24,
        where="Sampling > Viewport > Denoise > Start Sample (scene.rppm.preview_denoising_start_sample)",
    )

    @property
    def denoising_features(self) -> tuple[str, ...]:
        """Names of the passes that guide denoising; none where nothing is denoised."""
        if not self.use_denoising:
            return ()
        return {
            DenoisingInputPasses.RGB: (),
            DenoisingInputPasses.RGB_ALBEDO: (DENOISING_ALBEDO,),
            DenoisingInputPasses.RGB_ALBEDO_NORMAL: (DENOISING_ALBEDO, DENOISING_NORMAL),
        }[self.denoising_input_passes]
