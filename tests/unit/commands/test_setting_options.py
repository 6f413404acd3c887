# SPDX-License-Identifier: GPL-3.0-or-later
"""Options of the rppm program that are render settings."""

import pytest

from rppm_addon.commands.options.arguments import parser
from rppm_addon.commands.options.options import values_and_limits
from rppm_addon.scene import PixelFilter, RenderSettings
from rppm_addon.scene.errors import SettingsError
from rppm_addon.scene.settings.setting_info import settings_of

RENDER = ("render", "scene.npz", "-o", "picture.exr")


def settings_from(*words, command=RENDER):
    values, data_values = values_and_limits(parser().parse_args([*command, *words]))
    assert not data_values
    return RenderSettings().with_properties(values)


@pytest.mark.parametrize("command", [RENDER, ("farm", "scene.blend", "-o", "####.exr", "--frames", "1..2")])
def test_every_setting_of_final_renders_is_an_option(command):
    usage = parser().parse_args(command)
    names = {info.property_of(name) for name, info in settings_of(RenderSettings).items()}
    assert names - {"denoising_start_sample"} == names & vars(usage).keys()
    assert settings_from(command=command) == RenderSettings()


def test_values_are_read_as_the_settings_are():
    found = settings_from(
        "--samples", "7", "--max-camera-bounces", "4", "--no-use-final-gather", "--pixel-filter-type", "gaussian",
        "--passes", "Depth,Mist", "--alpha", "0.5", "--set", "rppm.seed=3", "--set", "rppm.alpha=0.6",
    )  # fmt: skip
    assert (found.iterations, found.camera_path_length, found.alpha, found.seed) == (7, 5, 0.5, 3)
    assert found.pixel_filter_type is PixelFilter.GAUSSIAN and not found.use_final_gather
    assert found.passes == ("Depth", "Mist") and not found.use_adaptive_sampling


def test_a_noise_threshold_is_used_when_it_is_given():
    assert settings_from("--adaptive-threshold", "0.02").use_adaptive_sampling
    off = settings_from("--adaptive-threshold", "0.02", "--no-use-adaptive-sampling")
    assert not off.use_adaptive_sampling and off.adaptive_threshold == 0.02


@pytest.mark.parametrize(
    "words", [("--alpha", "2"), ("--photons", "many"), ("--direct-light", "SUN"), ("--samples", "4", "--seconds", "2")]
)
def test_wrong_values_are_told_at_once(words, capsys):
    with pytest.raises(SystemExit) as ended:
        settings_from(*words)
    told = capsys.readouterr().err
    assert ended.value.code == 2 and words[0] in told and told.count("\n") == 1


@pytest.mark.parametrize(
    ("name", "value"), [("passes", [None]), ("passes", 5), ("samples", float("inf")), ("samples", None), ("alpha", [])]
)
def test_values_of_no_kind_are_refused(name, value):
    with pytest.raises(SettingsError, match=f"^{name} cannot be"):
        RenderSettings().with_properties({name: value})
