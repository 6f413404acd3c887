# SPDX-License-Identifier: GPL-3.0-or-later
"""The pass table: every render pass beside Combined, declared once.

From it follow the film's buffers, what ``shaders/film/passes.comp`` writes, checkpoints, merging, EXR layers, what
Blender registers and shows in its panels and menus, and the names that the command line takes.

To add a pass, declare it here and write its value in ``shaders/film/passes.comp``: by write_pass, or by add_to_pass
where it accumulates as SUM.
"""

import enum
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from .errors import SettingsError

NOTHING_HIT = 1e10
"""Depth where nothing is hit, as Cycles writes it."""


class Accumulation(enum.Enum):
    """Way in which the values of a pixel in all iterations make its value in the pass."""

    MEAN = 0
    """Mean over all iterations of the first surface's value, with ``nothing`` where there is no surface."""
    FIRST = 1
    """Value of the first surface in the first iteration that has one, as in Cycles: a mean of indices is none."""
    SUM = 2
    """Mean over all iterations of a sum along the camera path: any segment may add to it."""
    INSPECTION = 3
    """Computed once, from the deep cubemap and not from iterations."""
    COVERAGE = 4
    """Pairs of an identifier and the fraction of the pixel that it covers, a mean over all iterations. The film keeps
    them in the order of their first appearance, a frame the largest first (scene/cryptomatte.py)."""
    SURFACE_MEAN = 5
    """Mean of the first surface's value over the iterations that have a surface."""


class PassKind(enum.Enum):
    """Meaning of a pass's channels, as Blender's RenderEngine.register_pass has it."""

    VALUE = "VALUE"
    VECTOR = "VECTOR"
    COLOR = "COLOR"


@dataclass(frozen=True)
class RenderPass:
    """One render pass."""

    name: str
    """As Blender and Cycles spell it; also the layer's name in EXR files."""
    channels: str
    """A letter each: Z, XYZ, RGB ..."""
    kind: PassKind
    accumulation: Accumulation
    switch: str = ""
    """The property of Blender's view layers that turns it on; "" where Blender has none and the add-on adds one."""
    nothing: float = 0.0
    """Its value where there is no surface."""
    is_radiance: bool = False
    """Whether it is radiance, W/(m^2 sr), which the film's exposure scales."""
    divided_by: str = ""
    """Pass by which frames divide it: scattered light by the color of its lobes. The film keeps the product."""
    group: str = ""
    """The label of the switch that the add-on adds, where several passes share one."""
    description: str = ""
    """The tooltip of a switch that the add-on adds."""
    is_aov: bool = False
    """Whether AOV Output nodes of materials give it (aov_passes)."""
    light_group: str = ""
    """Light group whose light the pass shows (light_group_passes); "" is none."""
    level: int = 0
    """Number of pairs of lower levels that come before its own (COVERAGE)."""

    @property
    def is_accumulated(self) -> bool:
        """Whether the film accumulates it over the iterations."""
        return self.accumulation is not Accumulation.INSPECTION

    @property
    def identifier(self) -> str:
        """The name as an identifier: ``deep_cubemap``."""
        return self.name.lower().replace(" ", "_")

    @property
    def layers(self) -> tuple[str, ...]:
        """Names of its channels in EXR files."""
        return tuple(f"{self.name}.{channel}" for channel in self.channels)

    @property
    def own_switch(self) -> str:
        """The property that the add-on adds to view layers, where Blender has none."""
        return "" if self.switch else "use_pass_" + self.label.lower().replace(" ", "_")

    @property
    def label(self) -> str:
        """Label of its switch."""
        return self.group or self.name


def _for_denoisers(name: str, channels: str, kind: PassKind) -> RenderPass:
    description = (
        "Passes that denoisers take: albedo, normal and depth of the first surface that is not specular, seen through "
        "mirrors and glass"
    )
    return RenderPass(name, channels, kind, Accumulation.SUM, group="Denoising Data", description=description)


CRYPTOMATTE_PAIRS = 2
"""Pairs of an identifier and a fraction in the four channels of a pass."""
CRYPTOMATTE_LEVELS = 16
"""The most pairs that Blender knows."""


def _cryptomatte(layer: str, switch: str) -> tuple[RenderPass, ...]:
    # Small letters, as Cycles has them: files are then known to hold no colors, and keep all bits.
    return tuple(
        RenderPass(f"{layer}{number:02d}", "rgba", PassKind.COLOR, Accumulation.COVERAGE, switch, level=2 * number)
        for number in range(CRYPTOMATTE_LEVELS // CRYPTOMATTE_PAIRS)
    )


def _of_lobes(name: str) -> tuple[RenderPass, ...]:
    """Light that the first surface scatters by lobes of a kind: from lights, from other surfaces, and its color."""
    color = f"{name} Color"

    def entry(part: str, **options: Any) -> RenderPass:
        switch = f"use_pass_{name}_{part}".lower()
        return RenderPass(f"{name} {part}", "RGB", PassKind.COLOR, Accumulation.SUM, switch, **options)

    return (
        entry("Direct", is_radiance=True, divided_by=color),
        entry("Indirect", is_radiance=True, divided_by=color),
        entry("Color"),
    )


def _of_media(part: str, light: str) -> RenderPass:
    """Light that media scatter toward the camera, before any surface but transparent ones has scattered it."""
    description = f"A pass of {light} that volumes scatter straight to the camera"
    return RenderPass(
        f"Volume {part}", "RGB", PassKind.COLOR, Accumulation.SUM, is_radiance=True, description=description
    )


PASSES = (
    RenderPass("Depth", "Z", PassKind.VALUE, Accumulation.FIRST, "use_pass_z", NOTHING_HIT),
    RenderPass("Mist", "Z", PassKind.VALUE, Accumulation.MEAN, "use_pass_mist", 1.0),
    RenderPass("Position", "XYZ", PassKind.VECTOR, Accumulation.FIRST, "use_pass_position"),
    RenderPass("Normal", "XYZ", PassKind.VECTOR, Accumulation.MEAN, "use_pass_normal"),
    RenderPass("Vector", "XYZW", PassKind.VECTOR, Accumulation.SURFACE_MEAN, "use_pass_vector"),
    RenderPass("UV", "UVA", PassKind.VECTOR, Accumulation.MEAN, "use_pass_uv"),
    RenderPass("Object Index", "X", PassKind.VALUE, Accumulation.FIRST, "use_pass_object_index"),
    RenderPass("Material Index", "X", PassKind.VALUE, Accumulation.FIRST, "use_pass_material_index"),
    *(entry for name in ("Diffuse", "Glossy", "Transmission") for entry in _of_lobes(name)),
    _of_media("Direct", "the light of lights"),
    _of_media("Indirect", "the light of surfaces, and of other places in volumes,"),
    RenderPass("Emission", "RGB", PassKind.COLOR, Accumulation.SUM, "use_pass_emit", is_radiance=True),
    RenderPass("Environment", "RGB", PassKind.COLOR, Accumulation.SUM, "use_pass_environment", is_radiance=True),
    RenderPass("Ambient Occlusion", "RGB", PassKind.COLOR, Accumulation.SUM, "use_pass_ambient_occlusion"),
    RenderPass(
        "Roughness",
        "X",
        PassKind.VALUE,
        Accumulation.MEAN,
        description="A pass of the mean roughness of first surfaces, as Cycles bakes it; 1 where all light is diffuse",
    ),
    RenderPass(
        "Shadow Catcher",
        "RGB",
        PassKind.COLOR,
        Accumulation.SUM,
        nothing=1.0,
        description="A pass to multiply a background with: the fraction of the light that arrives at catchers, else 1",
    ),
    RenderPass(
        "Debug Sample Count",
        "X",
        PassKind.VALUE,
        Accumulation.SUM,
        description="A pass that shows the fraction of all samples that each pixel has got",
    ),
    RenderPass(
        "Caustics",
        "RGB",
        PassKind.COLOR,
        Accumulation.SUM,
        is_radiance=True,
        description=(
            "A pass of the light that Cycles leaves out where its Caustics are off: what glossy and transmissive "
            "surfaces send to diffuse ones, and where it goes from there. It is a part of the indirect passes, too"
        ),
    ),
    _for_denoisers("Denoising Albedo", "RGB", PassKind.COLOR),
    _for_denoisers("Denoising Normal", "XYZ", PassKind.VECTOR),
    _for_denoisers("Denoising Depth", "Z", PassKind.VALUE),
    *_cryptomatte("CryptoObject", "use_pass_cryptomatte_object"),
    *_cryptomatte("CryptoMaterial", "use_pass_cryptomatte_material"),
    *_cryptomatte("CryptoAsset", "use_pass_cryptomatte_asset"),
    RenderPass(
        "Deep Cubemap",
        "XYZ",
        PassKind.VECTOR,
        Accumulation.INSPECTION,
        description=(
            "A pass that shows what the camera's rays cost: cells looked at, triangles tested, and entries "
            "listed in the cell that is hit, as X, Y and Z"
        ),
    ),
)
_APART = {Accumulation.INSPECTION, Accumulation.COVERAGE, Accumulation.SURFACE_MEAN}
FILM_PASSES = tuple(entry for entry in PASSES if entry.accumulation not in _APART)
"""Passes whose values shaders/film/passes.comp writes, and viewports show."""
CAUSTICS = next(entry for entry in PASSES if entry.name == "Caustics")
AMBIENT_OCCLUSION = next(entry for entry in PASSES if entry.name == "Ambient Occlusion")
ROUGHNESS = next(entry for entry in PASSES if entry.name == "Roughness")
DEEP_CUBEMAP = next(entry for entry in PASSES if entry.name == "Deep Cubemap")
COMBINED = "Combined"
NOISY_IMAGE = RenderPass("Noisy Image", "RGBA", PassKind.COLOR, Accumulation.MEAN)
"""Combined before it was denoised: what comes with each denoised picture, and cannot be asked for by itself."""
ALWAYS_TAKEN = frozenset({COMBINED, NOISY_IMAGE.name, *(entry.name for entry in PASSES if entry.group)})
"""Names that AOVs cannot have whatever was asked for: passes come with pictures that are denoised."""
VECTOR, SHADOW_CATCHER = "Vector", "Shadow Catcher"
DENOISING_ALBEDO, DENOISING_NORMAL, DENOISING_DEPTH = "Denoising Albedo", "Denoising Normal", "Denoising Depth"
"""Passes that guide denoising."""
SCATTERED_LIGHT = tuple(entry for entry in PASSES if entry.divided_by)
"""Light that first surfaces scatter. Times their colors, it adds up with VOLUME_LIGHT, Emission and Environment to
Combined."""
VOLUME_LIGHT = tuple(entry for entry in PASSES if entry.name in {"Volume Direct", "Volume Indirect"})
"""Light that media scatter straight to the camera."""


def passes_named(names: Sequence[str]) -> tuple[RenderPass, ...]:
    """The passes of these names in the table's order. Raises SettingsError for a name that is none."""
    known = {entry.name for entry in PASSES}
    for name in names:
        if name not in known:
            raise SettingsError(f"there is no pass {name}; the passes are {', '.join(sorted(known))}")
    return tuple(entry for entry in PASSES if entry.name in names)


_AOV_KINDS = {"X": PassKind.VALUE, "RGBA": PassKind.COLOR}


def aov_passes(aovs: Sequence[str]) -> tuple[RenderPass, ...]:
    """The passes of AOV Output nodes: each by its name, which users choose, a point, and its channels, X or RGBA.

    Raises SettingsError for one without name or channels, and for names that come twice.
    """
    found: dict[str, RenderPass] = {}
    for aov in aovs:
        name, _, channels = aov.rpartition(".")
        if not name or channels not in _AOV_KINDS:
            raise SettingsError(f"the AOV {aov} is none; write NAME.X for values and NAME.RGBA for colors")
        if name in found or name in ALWAYS_TAKEN:
            raise SettingsError(f"the AOV {name} has the name of another pass; give it a name of its own")
        found[name] = RenderPass(name, channels, _AOV_KINDS[channels], Accumulation.SUM, is_aov=True)
    return tuple(found.values())


def light_group_passes(groups: Sequence[str]) -> tuple[RenderPass, ...]:
    """The passes of light groups, each by its name, which users choose. Raises SettingsError for names that come twice
    or cannot stand in files."""
    for group in groups:
        if not group or "." in group or groups.count(group) > 1:
            raise SettingsError(f'the light group "{group}" cannot be; give it a name of its own without a point')
    return tuple(
        RenderPass(f"{COMBINED}_{group}", "RGB", PassKind.COLOR, Accumulation.SUM, is_radiance=True, light_group=group)
        for group in groups
    )


def with_divisors(names: Sequence[str]) -> tuple[str, ...]:
    """Names of passes, and of the passes that divide them. Raises SettingsError."""
    divisors = (entry.divided_by for entry in passes_named(names) if entry.divided_by)
    return tuple(dict.fromkeys((*names, *divisors)))
