# SPDX-License-Identifier: GPL-3.0-or-later
"""scene.rppm carries exactly the render settings."""

import dataclasses

import bpy
import pytest
from blender_scenes import add_light, add_object, export

from rppm_addon.blender.export.view_layer.settings import export_settings
from rppm_addon.blender.properties import VIEWPORT_APART, VIEWPORT_DENOISING, VIEWPORT_SAMPLING, viewport_property
from rppm_addon.scene import DensityEstimation, DirectLight, FirstPhotonHits, PixelFilter, RenderSettings
from rppm_addon.scene.settings.setting_info import settings_of

# properties that Blender itself has, what viewports alone have, and what benchmarks alone set
ELSEWHERE = {"film_transparent", "passes", "aovs", "light_groups", "denoising_start_sample", "use_splat_roulette"}
# what a bake holds, what makes the seed another one, a member of the scene, an object of Blender's, exported as a
# point, and what viewports have apart
BESIDES = {
    "bake_type", "use_animated_seed", "film_exposure", "checkpoint_path", "cubemap_center_object", "preview_samples",
    "preview_photons", "preview_pause", "use_layer_samples", *(viewport_property(name) for name in VIEWPORT_APART),
}  # fmt: skip


def test_properties_are_the_settings_with_their_defaults(scene):
    names = {field.name for field in dataclasses.fields(RenderSettings)}
    infos = settings_of(RenderSettings)
    assert infos.keys() == names
    properties = {item.identifier for item in scene.rppm.bl_rna.properties} - {"rna_type", "name"}
    assert properties == {infos[name].property_of(name) for name in names - ELSEWHERE} | BESIDES
    found, expected = export(scene).settings, RenderSettings()
    for name in names - {"passes"}:
        value = getattr(expected, name)
        value = pytest.approx(value, rel=1e-6) if isinstance(value, float) else value
        assert getattr(found, name) == value, name


def test_every_property_has_a_description(scene):
    for item in (*scene.rppm.bl_rna.properties, *bpy.data.lights.new("L", "POINT").rppm.bl_rna.properties):
        if item.identifier not in {"rna_type", "name"}:
            assert len(item.description) > 20 and not item.description.endswith("."), item.identifier


def test_values_are_exported(scene):
    scene.rppm.samples, scene.rppm.photons, scene.rppm.alpha, scene.rppm.seed = 7, 1234, 0.5, 5
    scene.rppm.direct_light, scene.rppm.cubemap_resolution = "PHOTONS", 64
    scene.render.film_transparent = True
    scene.rppm.film_exposure = 2.5
    scene.rppm.pixel_filter_type = "GAUSSIAN"
    scene.rppm.use_adaptive_sampling, scene.rppm.adaptive_threshold = True, 0.05
    exported = export(scene)
    settings = exported.settings
    assert (settings.iterations, settings.photons, settings.alpha, settings.seed) == (7, 1234, 0.5, 5)
    assert settings.direct_light is DirectLight.PHOTONS and settings.cubemap_resolution == 64
    assert settings.film_transparent and exported.exposure == 2.5
    assert settings.pixel_filter_type is PixelFilter.GAUSSIAN
    assert settings.use_adaptive_sampling and settings.adaptive_threshold == pytest.approx(0.05)


def test_a_viewport_has_settings_of_its_own(scene):
    settings, default = export_settings(scene, viewport=True), RenderSettings()
    # Sooner a first picture, and at rest more of them.
    assert settings.iterations > default.iterations
    assert settings.photons < default.photons_for(256, 256)
    scene.rppm.time_limit, scene.rppm.alpha = 5.0, 0.5
    scene.rppm.preview_samples, scene.rppm.preview_photons = 3, 77
    layer = scene.view_layers[0]
    layer.rppm.use_pass_deep_cubemap = layer.use_pass_z = True
    viewport, final = export_settings(scene, layer, viewport=True), export_settings(scene, layer)
    assert (viewport.iterations, viewport.photons, viewport.time_limit) == (3, 77, 0.0)
    assert viewport.passes == () and {"Depth", "Deep Cubemap"} <= set(final.passes)
    assert (final.iterations, final.photons, final.time_limit) == (default.iterations, default.photons, 5.0)
    differing = {f.name for f in dataclasses.fields(final) if getattr(final, f.name) != getattr(viewport, f.name)}
    apart = {"denoising_input_passes", "denoising_prefilter", "denoising_quality", "adaptive_threshold"}
    assert differing == {"iterations", "photons", "time_limit", "passes"} | apart


def test_a_viewport_is_denoised_as_cycles_does_it(scene):
    names = {"use_preview_denoising", *(f"preview_{name}" for name in VIEWPORT_DENOISING if name != "use_denoising")}
    assert names == {viewport_property(name) for name in VIEWPORT_DENOISING} <= {*dir(scene.cycles)}
    for name in names - {"use_preview_denoising", "preview_denoising_use_gpu"}:  # off at first
        assert getattr(scene.rppm, name) == getattr(scene.cycles, name), name
    scene.rppm.use_preview_denoising, scene.rppm.preview_denoising_start_sample = True, 5
    scene.rppm.preview_denoising_quality, scene.rppm.denoising_quality = "FAST", "BALANCED"
    viewport, final = export_settings(scene, viewport=True), export_settings(scene)
    assert (viewport.use_denoising, viewport.denoising_start_sample) == (True, 5) and not final.use_denoising
    assert (viewport.denoising_quality.name, final.denoising_quality.name) == ("FAST", "BALANCED")
    assert not export_settings(scene, viewport=True, shown_pass="Depth").use_denoising


def test_a_viewport_ends_by_a_noise_of_its_own(scene):
    names = {viewport_property(name) for name in VIEWPORT_SAMPLING}
    assert names <= {*dir(scene.cycles)} and set(VIEWPORT_SAMPLING) <= {*dir(scene.cycles)}
    for name in ("adaptive_threshold", "adaptive_min_samples"):
        for shown in (name, f"preview_{name}"):
            assert getattr(scene.rppm, shown) == getattr(scene.cycles, shown), shown
    scene.rppm.use_preview_adaptive_sampling, scene.rppm.preview_adaptive_threshold = True, 0.25
    viewport, final = export_settings(scene, viewport=True), export_settings(scene)
    assert (viewport.use_adaptive_sampling, viewport.adaptive_threshold) == (True, 0.25)
    assert not final.use_adaptive_sampling


def test_what_scripts_and_presets_set_is_exported(scene):
    """Blender evaluates a scene anew for what users set, and not by itself for what Python sets."""
    light = add_light(scene, "POINT")
    before = export(scene)
    for item in scene.rppm.bl_rna.properties:  # one at a time: each is an edit by itself
        if item.type in {"INT", "FLOAT", "BOOLEAN"} and item.identifier not in BESIDES | {"cubemap_resolution"}:
            others = {"FLOAT": 0.25, "BOOLEAN": not item.default}
            if item.type == "INT":
                others["INT"] = item.default + (1 if item.default < item.hard_max else -1)
            setattr(scene.rppm, item.identifier, others[item.type])
            wanted = RenderSettings().with_properties({item.identifier: others[item.type]})
            assert wanted != RenderSettings()
            found = export(scene).settings
            infos = settings_of(RenderSettings).items()
            (name,) = (name for name, info in infos if info.property_of(name) == item.identifier)
            assert getattr(found, name) == getattr(wanted, name), item.identifier
    kinds = {
        "direct_light": DirectLight.PHOTONS,
        "density_estimation": DensityEstimation.RASTERIZED,
        "first_photon_hits": FirstPhotonHits.TRACED,
    }
    for name, value in kinds.items():
        setattr(scene.rppm, name, value.name)
        assert getattr(export(scene).settings, name) is value
    scene.rppm.cubemap_center_object = light
    assert export(scene).cubemap_center == pytest.approx([0.0, 0.0, 3.0])
    light.data.rppm.photon_weight = 3.0
    assert (before.lights[0].photon_weight, export(scene).lights[0].photon_weight) == (1.0, 3.0)


def test_the_ranges_of_the_properties_are_valid_settings(scene):
    for item in scene.rppm.bl_rna.properties:
        if item.type in {"INT", "FLOAT"} and item.identifier != "cubemap_resolution":
            if item.identifier == "film_exposure":
                continue
            for value in (item.hard_min, min(item.hard_max, 1e9)):
                kind = int if item.type == "INT" else float
                settings = RenderSettings().with_properties({item.identifier.removeprefix("preview_"): kind(value)})
                if item.identifier == "radius_minimum":
                    settings.radius_maximum = 0.0
                settings.validate()


def test_the_cubemap_center_follows_its_object(scene):
    assert export(scene).cubemap_center is None
    parent = add_object(scene, "parent", None, location=(1, 2, 3))
    empty = add_object(scene, "empty", None, location=(0.5, 0, 0), parent=parent)
    scene.rppm.cubemap_center_object = empty
    bpy.context.view_layer.update()
    assert export(scene).cubemap_center == pytest.approx([1.5, 2, 3])


def test_an_animated_seed_is_another_one_in_each_frame(scene):
    def seeds(seed, frames=range(-3, 30)):
        scene.rppm.seed = seed
        found = []
        for frame in frames:
            scene.frame_set(frame)
            found.append(export(scene).settings.seed)
        return found

    assert set(seeds(5)) == {5}
    scene.rppm.use_animated_seed = True
    first, second = seeds(5), seeds(6)
    assert first == seeds(5)
    assert len({*first, *second}) == len(first) + len(second)
    assert all(0 <= seed < 1 << 31 for seed in first)
    export(scene).settings.validate()
    # One bit of the frame turns about half of the bits.
    turned = [(a ^ b).bit_count() for a, b in zip(first, first[1:])]
    assert 12 <= sum(turned) / len(turned) <= 19
