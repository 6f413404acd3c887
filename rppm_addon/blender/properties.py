# SPDX-License-Identifier: GPL-3.0-or-later
"""scene.rppm, view_layer.rppm, light.rppm and a viewport's shading.rppm.

The scene's names and defaults are those of RenderSettings.
"""

import functools

import bpy
from bpy import props

from ..scene import RenderSettings
from ..scene.passes import COMBINED, FILM_PASSES, PASSES


def _edited(owner: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Does nothing, but that there is it makes Blender take what scripts and presets set for edits, as it takes what
    users set: the data block is evaluated again and the window is drawn."""


BoolProperty = functools.partial(props.BoolProperty, update=_edited)
EnumProperty = functools.partial(props.EnumProperty, update=_edited)
FloatProperty = functools.partial(props.FloatProperty, update=_edited)
IntProperty = functools.partial(props.IntProperty, update=_edited)
PointerProperty = functools.partial(props.PointerProperty, update=_edited)

DEFAULTS = RenderSettings()
_MOST_PHOTONS = 1 << 22

VIEWPORT_PHOTONS = 1 << 14
"""In the viewport a quick first picture counts for more than how good it is."""
VIEWPORT_ITERATIONS = 4 * DEFAULTS.iterations
"""A viewport at rest goes on for longer, as its iterations have fewer photons."""


class RppmSceneProperties(bpy.types.PropertyGroup):
    """Settings of the photon mapper: those of RenderSettings and, from ``viewport_``, what the viewport has apart."""

    iterations: IntProperty(
        name="Iterations",
        description="Passes of the photon mapper; each makes the picture sharper and less noisy",
        default=DEFAULTS.iterations,
        min=1,
        soft_max=4096,
    )
    time_limit: FloatProperty(
        name="Time Limit",
        description="Stop after this time even if iterations are left; 0 is no limit",
        default=DEFAULTS.time_limit,
        min=0.0,
        soft_max=3600.0,
        step=100,
        subtype="TIME_ABSOLUTE",
        unit="TIME_ABSOLUTE",
    )
    photons: IntProperty(
        name="Photons",
        description=(
            "Photons emitted in each iteration, shared among the lights by their power and photon share; "
            "0 is automatic: as many as the picture has pixels, within limits"
        ),
        default=DEFAULTS.photons,
        min=0,
        max=_MOST_PHOTONS,
        step=1024,
    )
    viewport_iterations: IntProperty(
        name="Viewport Iterations",
        description="Iterations after which a viewport at rest is finished and leaves the graphics device alone",
        default=VIEWPORT_ITERATIONS,
        min=1,
        soft_max=4096,
    )
    viewport_photons: IntProperty(
        name="Viewport Photons",
        description=(
            "Photons emitted in each iteration of the viewport: fewer show a changed view sooner, "
            "more make its first pictures smoother; 0 is automatic, as in a final render"
        ),
        default=VIEWPORT_PHOTONS,
        min=0,
        max=_MOST_PHOTONS,
        step=1024,
    )
    viewport_paused: BoolProperty(
        name="Pause Viewport",
        description="Hold the picture of all rendered viewports and leave the graphics device alone",
        default=False,
    )
    camera_path_length: IntProperty(
        name="Camera Paths",
        description="Segments of camera paths through glass and mirrors, the one from the camera being the first",
        default=DEFAULTS.camera_path_length,
        min=1,
        max=64,
        soft_max=32,
    )
    photon_path_length: IntProperty(
        name="Photon Paths",
        description="Segments of photon paths, the one that leaves the light being the first",
        default=DEFAULTS.photon_path_length,
        min=1,
        max=64,
        soft_max=32,
    )
    alpha: FloatProperty(
        name="Alpha",
        description=(
            "Share of the new photons that are kept as the radius shrinks: "
            "low values sharpen quickly and stay noisy, high values stay smooth and blurred"
        ),
        default=DEFAULTS.alpha,
        min=0.01,
        max=0.99,
        subtype="FACTOR",
    )
    radius_scale: FloatProperty(
        name="Initial Radius",
        description=(
            "The first iteration gathers photons over a disk as large as a square of this side, in pixels of a "
            "1 megapixel picture; larger and smaller pictures scale it"
        ),
        default=DEFAULTS.radius_scale,
        min=0.01,
        soft_min=1.0,
        soft_max=50.0,
        subtype="PIXEL",
    )
    adaptive_radius: BoolProperty(
        name="Adaptive Radius",
        description=(
            "Begin with three times the radius for caustics, and come back to the initial one where photons are many: "
            "less noise where they are few. Without effect where Minimum or Maximum is set"
        ),
        default=DEFAULTS.adaptive_radius,
    )
    radius_minimum: FloatProperty(
        name="Minimum",
        description="Smallest radius in the first iteration, shrinking from there; 0 is automatic",
        default=DEFAULTS.radius_minimum,
        min=0.0,
        soft_max=1.0,
        precision=4,
        subtype="DISTANCE",
        unit="LENGTH",
    )
    radius_maximum: FloatProperty(
        name="Maximum",
        description="Largest radius in the first iteration, shrinking from there; 0 is automatic",
        default=DEFAULTS.radius_maximum,
        min=0.0,
        soft_max=1.0,
        precision=4,
        subtype="DISTANCE",
        unit="LENGTH",
    )
    specular_roughness: FloatProperty(
        name="Specular Roughness",
        description=(
            "Surfaces up to this roughness, as their node shows it, are followed as mirrors and glass; "
            "rougher ones gather photons"
        ),
        default=DEFAULTS.specular_roughness,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    direct_light: EnumProperty(
        name="Direct Light",
        description="How light that comes straight from a source is estimated",
        items=[
            ("RAYS", "Rays", "Follow a ray to a light from each point: less noise", 0),
            ("PHOTONS", "Photons", "Use the photons that come straight from the lights, as the paper does", 1),
        ],
        default=DEFAULTS.direct_light.name,
    )
    final_gather: BoolProperty(
        name="Final Gather",
        description=(
            "Look for light from other surfaces along one ray from each point, and take only direct light and "
            "caustics from the photons there: fine noise in place of blotches, slower iterations"
        ),
        default=DEFAULTS.final_gather,
    )
    splat_roulette: BoolProperty(
        name="Splat Roulette",
        description="Leave out half of the splats at random and count the others twice: faster iterations, more noise",
        default=DEFAULTS.splat_roulette,
    )
    density_estimation: EnumProperty(
        name="Density Estimation",
        description="How photons and the points that take them find each other: any way gives the same picture",
        items=[
            ("AUTOMATIC", "Automatic", "Try both with the first photons and take the faster one", 0),
            ("RASTERIZED", "Rasterized", "Splat photons onto pixels by rasterization, as the paper does", 1),
            ("GRID", "Photon Grid", "Sort photons into grids of cells, and look for them in the cells around", 2),
        ],
        default=DEFAULTS.density_estimation.name,
    )
    first_photon_hits: EnumProperty(
        name="First Photon Hits",
        description="How it is found where photons from lamps and suns hit first: any way gives the same picture",
        items=[
            ("AUTOMATIC", "Automatic", "Trace the first iterations, then try both and take the faster one", 0),
            ("RASTERIZED", "Rasterized", "Rasterize what lamps and suns see, as the paper does", 1),
            ("TRACED", "Traced", "Trace rays through the deep cubemap", 2),
        ],
        default=DEFAULTS.first_photon_hits.name,
    )
    filter_width: FloatProperty(
        name="Filter Width",
        description="Width of the Blackman-Harris pixel filter; 0 looks through the middle of pixels only",
        default=DEFAULTS.filter_width,
        min=0.0,
        max=20.0,
        soft_max=10.0,
        subtype="PIXEL",
    )
    iterations_per_frame: IntProperty(
        name="Iterations per Frame",
        description=(
            "Iterations before a picture is shown: while an animation plays in the viewport more make each "
            "frame smoother and the playback slower; final renders show their progress as often"
        ),
        default=DEFAULTS.iterations_per_frame,
        min=1,
        soft_max=64,
    )
    seed: IntProperty(
        name="Seed",
        description="Start of the random numbers; the same seed gives the same noise",
        default=DEFAULTS.seed,
        min=0,
    )
    animate_seed: BoolProperty(
        name="Animate Seed",
        description=(
            "Give each frame noise of its own, which a film averages to the eye and a denoiser over time removes; "
            "otherwise the noise stands still while things move"
        ),
        default=False,
    )
    cubemap_resolution: IntProperty(
        name="Cubemap Resolution",
        description=(
            "The most cells along a side of the deep cubemap's faces, a power of two from 16 to 16384. "
            "They are that fine only where many triangles crowd; fewer take less memory, and rays take "
            "longer; 0 is automatic"
        ),
        default=DEFAULTS.cubemap_resolution,
        min=0,
        max=16384,
    )
    cubemap_centre_object: PointerProperty(
        name="Cubemap Centre",
        description=(
            "The deep cubemap's centre goes where this object is, for instance into the middle of what most "
            "light reaches; without one it goes to the camera"
        ),
        type=bpy.types.Object,
    )


class RppmLightProperties(bpy.types.PropertyGroup):
    """Settings of a light."""

    photon_share: FloatProperty(
        name="Photon Share",
        description=(
            "Weight of this light, on top of its power, when photons are shared out; "
            "more photons make its light smoother, never brighter"
        ),
        default=1.0,
        min=0.0,
        soft_max=10.0,
    )


class RppmViewLayerProperties(bpy.types.PropertyGroup):
    """Switches of the passes for which Blender's view layers have none."""

    __annotations__ = {
        entry.own_switch: BoolProperty(name=entry.name, description=entry.description)
        for entry in PASSES
        if entry.own_switch
    }


class RppmShadingProperties(bpy.types.PropertyGroup):
    """What a rendered viewport shows."""

    render_pass: EnumProperty(
        name="Render Pass",
        description="The pass that the viewport shows",
        items=[(COMBINED, COMBINED, "")] + [(entry.name, entry.name, "") for entry in FILM_PASSES],
        default=COMBINED,
    )


_CLASSES = (RppmSceneProperties, RppmLightProperties, RppmViewLayerProperties, RppmShadingProperties)


def register() -> None:
    """Add the settings."""
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.rppm = props.PointerProperty(type=RppmSceneProperties, name="RPPM")
    bpy.types.Light.rppm = props.PointerProperty(type=RppmLightProperties, name="RPPM")
    bpy.types.View3DShading.rppm = props.PointerProperty(type=RppmShadingProperties, name="RPPM")
    bpy.types.ViewLayer.rppm = props.PointerProperty(type=RppmViewLayerProperties, name="RPPM")


def unregister() -> None:
    """Take out the settings."""
    del bpy.types.ViewLayer.rppm
    del bpy.types.View3DShading.rppm
    del bpy.types.Light.rppm
    del bpy.types.Scene.rppm
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
