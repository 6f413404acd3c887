# SPDX-License-Identifier: GPL-3.0-or-later
"""scene.rppm, view_layer.rppm, light.rppm, material.rppm and a viewport's shading.rppm.

The scene's properties are made of what RenderSettings says of its fields.
"""

import enum
import functools
from collections.abc import Callable

import bpy
from bpy import props

from ..scene import RenderSettings
from ..scene.passes import COMBINED, FILM_PASSES, PASSES
from ..scene.settings import MOST_PHOTONS, DenoisingInputPasses, DenoisingPrefilter, DenoisingQuality
from ..scene.settings.setting_info import SettingInfo, settings_of
from ..session.render.bake_passes import BAKE_TYPES


def _edited(owner: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Does nothing, but that there is it makes Blender take what scripts and presets set for edits, as it takes what
    users set: the data block is evaluated again and the window is drawn."""


def _passes_edited(owner: bpy.types.PropertyGroup, _context: bpy.types.Context) -> None:
    """There is a pass more or less, which the compositor's nodes have sockets for."""
    for layer in owner.id_data.view_layers:
        layer.update_render_passes()


BoolProperty = functools.partial(props.BoolProperty, update=_edited)
EnumProperty = functools.partial(props.EnumProperty, update=_edited)
FloatProperty = functools.partial(props.FloatProperty, update=_edited)
IntProperty = functools.partial(props.IntProperty, update=_edited)
StringProperty = functools.partial(props.StringProperty, update=_edited)
PointerProperty = functools.partial(props.PointerProperty, update=_edited)

DEFAULTS = RenderSettings()
_INFOS = settings_of(RenderSettings)

VIEWPORT_PHOTONS = 1 << 14
"""In the viewport a quick first picture counts for more than how good it is."""
VIEWPORT_ITERATIONS = 4 * DEFAULTS.iterations
"""A viewport at rest goes on for longer, as its iterations have fewer photons."""

VIEWPORT_SAMPLING = {"use_adaptive_sampling": False, "adaptive_threshold": 0.1, "adaptive_min_samples": 0}
VIEWPORT_DENOISING = {
    "use_denoising": False,
    "denoising_input_passes": DenoisingInputPasses.RGB_ALBEDO,
    "denoising_prefilter": DenoisingPrefilter.FAST,
    "denoising_quality": DenoisingQuality.BALANCED,
    "denoising_use_gpu": False,
    "denoising_start_sample": DEFAULTS.denoising_start_sample,
}
VIEWPORT_APART = {**VIEWPORT_SAMPLING, **VIEWPORT_DENOISING}
"""Defaults of settings that viewports have apart, by field of RenderSettings: Cycles', but for what is off at first."""

_UNITS = {
    "": {},
    "m": {"subtype": "DISTANCE", "unit": "LENGTH", "precision": 4},
    "s": {"subtype": "TIME_ABSOLUTE", "unit": "TIME_ABSOLUTE", "step": 100},
    "pixels": {"subtype": "PIXEL"},
    "fraction": {"subtype": "FACTOR"},
}


def viewport_property(name: str) -> str:
    """The property of scene.rppm by which viewports have the field ``name`` apart, named as Cycles names them."""
    return "use_preview_" + name.removeprefix("use_") if name.startswith("use_") else f"preview_{name}"


def setting_property(info: SettingInfo, default: object) -> object:
    """The Blender property of a setting whose field has this default."""
    texts = {"name": info.label, "description": info.description}
    if isinstance(default, bool):
        return BoolProperty(**texts, default=default)
    if isinstance(default, enum.Enum):
        items = [(member.name, *words, number) for number, (member, words) in enumerate(info.choices.items())]
        return EnumProperty(**texts, items=items, default=default.name)
    ends = {
        "min": info.minimum,
        "max": info.maximum,
        "soft_min": info.soft_minimum,
        "soft_max": info.soft_maximum,
    }
    ends = {name: end + info.property_offset for name, end in ends.items() if end is not None}
    shown = {name: value for name, value in (("step", info.step), ("precision", info.precision)) if value}
    make: Callable = IntProperty if isinstance(default, int) else FloatProperty
    return make(**texts, **ends, **_UNITS[info.unit], **shown, default=default + info.property_offset)


class RppmSceneProperties(bpy.types.PropertyGroup):
    """Settings of the photon mapper: those of RenderSettings and, from ``preview_``, what the viewport has apart."""

    __annotations__ = {
        info.property_of(name): setting_property(info, getattr(DEFAULTS, name))
        for name, info in _INFOS.items()
        if not info.where
    } | {
        "preview_samples": IntProperty(
            name="Viewport Samples",
            description="Samples after which a viewport at rest is finished and leaves the graphics device alone",
            default=VIEWPORT_ITERATIONS,
            min=1,
            soft_max=4096,
        ),
        "preview_photons": IntProperty(
            name="Viewport Photons",
            description=(
                "Photons emitted in each sample of the viewport: fewer show a changed view sooner, "
                "more make its first pictures smoother; 0 is automatic, as in a final render"
            ),
            default=VIEWPORT_PHOTONS,
            min=0,
            max=MOST_PHOTONS,
            step=1024,
        ),
        "use_denoising": BoolProperty(
            name=_INFOS["use_denoising"].label,
            description=_INFOS["use_denoising"].description,
            default=DEFAULTS.use_denoising,
            update=_passes_edited,
        ),
        **{
            viewport_property(name): setting_property(_INFOS[name], default) for name, default in VIEWPORT_APART.items()
        },
        "film_exposure": FloatProperty(
            name="Exposure",
            description="Factor on the brightness of the whole picture and of all passes that are light",
            default=1.0,
            min=0.0,
            max=10.0,
        ),
        "checkpoint_path": StringProperty(
            name="Checkpoint",
            description=(
                "File (.exr) that a final render is kept in every five minutes and when it is stopped. The next render "
                "goes on from it, bit for bit; of another scene or other settings it begins anew. Animations need a "
                "place for the frame's number, as in still_####.exr"
            ),
            subtype="FILE_PATH",
        ),
        "preview_pause": BoolProperty(
            name="Pause Preview",
            description="Hold the picture of all rendered viewports and leave the graphics device alone",
            default=False,
        ),
        "bake_type": EnumProperty(
            name="Bake Type",
            description="What the texels of a baked texture or the colors of vertices are to hold",
            items=[(kind, label, "") for kind, label in BAKE_TYPES.items()],
            default="COMBINED",
        ),
        "use_animated_seed": BoolProperty(
            name="Use Animated Seed",
            description=(
                "Give each frame noise of its own, which a film averages to the eye and a denoiser over time removes; "
                "otherwise the noise stands still while things move"
            ),
            default=False,
        ),
        "use_layer_samples": EnumProperty(
            name="Layer Samples",
            description="How the samples that a view layer has of its own count beside those of the scene",
            items=[
                ("USE", "Use", "A view layer's samples stand in place of the scene's"),
                ("BOUNDED", "Bounded", "A view layer's samples stand in place of the scene's where they are fewer"),
                ("IGNORE", "Ignore", "The scene's samples count for all view layers"),
            ],
            default="USE",
        ),
        "cubemap_center_object": PointerProperty(
            name="Cubemap Center",
            description=(
                "The deep cubemap's center goes where this object is, for instance into the middle of what most "
                "light reaches; without one it goes to the camera"
            ),
            type=bpy.types.Object,
        ),
    }


class RppmLightProperties(bpy.types.PropertyGroup):
    """Settings of a light."""

    photon_weight: FloatProperty(
        name="Photon Weight",
        description=(
            "Weight of this light, on top of its power, when photons are allocated to lights; "
            "more photons make its light smoother, never brighter"
        ),
        default=1.0,
        min=0.0,
        soft_max=10.0,
    )


class RppmMaterialProperties(bpy.types.PropertyGroup):
    """Settings of a material."""

    use_dispersion: BoolProperty(
        name="Dispersion",
        description="Refract each wavelength by an index of its own, so that glass spreads white light into colors",
        default=False,
    )
    abbe_number: FloatProperty(
        name="Abbe Number",
        description=(
            "How little the glass disperses light, V_d: crown glass 64, diamond 55, dense flint glass 30; smaller "
            "numbers spread colors further. The nodes' IOR is that of yellow light (587.6 nm)"
        ),
        default=64.0,
        min=1.0,
        soft_min=10.0,
        soft_max=100.0,
        step=100,
        precision=1,
    )


class RppmViewLayerProperties(bpy.types.PropertyGroup):
    """Switches of denoising and of the passes for which Blender's view layers have none."""

    __annotations__ = {
        entry.own_switch: BoolProperty(name=entry.label, description=entry.description, update=_passes_edited)
        for entry in PASSES
        if entry.own_switch
    } | {
        "use_denoising": BoolProperty(
            name="Denoising",
            description="Denoise final renders of this view layer where the scene's are denoised",
            default=True,
            update=_passes_edited,
        )
    }


class RppmShadingProperties(bpy.types.PropertyGroup):
    """Settings of what a rendered viewport shows."""

    render_pass: EnumProperty(
        name="Render Pass",
        description="The pass that the viewport shows",
        items=[(COMBINED, COMBINED, "")] + [(entry.name, entry.name, "") for entry in FILM_PASSES],
        default=COMBINED,
    )


_OWNERS = {
    bpy.types.Scene: RppmSceneProperties,
    bpy.types.Light: RppmLightProperties,
    bpy.types.Material: RppmMaterialProperties,
    bpy.types.ViewLayer: RppmViewLayerProperties,
    bpy.types.View3DShading: RppmShadingProperties,
}


def register() -> None:
    """Give scenes, lights, materials, view layers and viewports their ``rppm``."""
    for owner, properties in _OWNERS.items():
        bpy.utils.register_class(properties)
        owner.rppm = props.PointerProperty(type=properties, name="RPPM")


def unregister() -> None:
    """Take it away again; files keep what it says."""
    for owner, properties in _OWNERS.items():
        del owner.rppm
        bpy.utils.unregister_class(properties)
