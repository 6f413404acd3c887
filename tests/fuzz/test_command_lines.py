# SPDX-License-Identifier: GPL-3.0-or-later
"""Command lines that nobody means."""

import contextlib
import io

import hypothesis.strategies as st
from hypothesis import given

from fuzz.counting import COUNTS, fuzzed, may_refuse
from fuzz.values import NUMBERS, TEXTS, VALUES
from rppm_addon.cli import main
from rppm_addon.commands.options.arguments import parser
from rppm_addon.commands.options.options import split_values
from rppm_addon.scene import RenderSettings
from rppm_addon.scene.errors import SettingsError
from rppm_addon.scene.settings.setting_info import settings_of

_NAMES = sorted(info.property_of(name) for name, info in settings_of(RenderSettings).items())
_RANGES = st.sampled_from(["1..100", "5..1", "1..9..0", "0:4", "4:0", "16x12", "0x5", "1e9x2"])
_TEXTS = st.one_of(NUMBERS.map(str), TEXTS, _RANGES)
_OPTIONS = """-o --json --samples --seconds --frames --frame --resolution --set --snapshots --resume --checkpoint
--checkpoint-minutes --samples-range --parts --workers --devices --chunk --retries --photons --incomplete --quantity
--scene --debug --overwrite"""
OPTIONS = st.sampled_from(_OPTIONS.split())
WORDS = st.one_of(OPTIONS, _TEXTS, st.sampled_from(["a.exr", "a.png", "absent.npz", "absent.blend", "rppm.alpha=nan"]))
COMMANDS = st.sampled_from(["render", "merge", "farm", "export", "inspect", "compile", "info", "", "rend"])


@fuzzed
@given(command=COMMANDS, words=st.lists(WORDS, max_size=8))
def test_arguments(command, words):
    """Understood, or exit status 2 and a line that says why not."""
    count = COUNTS.setdefault("arguments", [0, 0])
    count[0] += 1
    errors = io.StringIO()
    with contextlib.redirect_stderr(errors), contextlib.redirect_stdout(io.StringIO()):
        try:
            options = parser().parse_args([command, *words])
        except SystemExit as end:
            count[1] += 1
            assert end.code in (0, 2)
            assert end.code == 0 or errors.getvalue().startswith("rppm")
            return
    assert options.command == command


@fuzzed
@given(words=st.lists(WORDS, max_size=5))
def test_renders_of_nothing(tmp_path_factory, words):
    """A line on standard error and a status, whatever else is asked of a scene that is not there."""
    folder = tmp_path_factory.getbasetemp()
    count = COUNTS.setdefault("renders-of-nothing", [0, 0])
    count[0] += 1
    errors = io.StringIO()
    with contextlib.redirect_stderr(errors), contextlib.redirect_stdout(io.StringIO()), contextlib.chdir(folder):
        try:
            status = main(["render", "absent.npz", "-o", "a.exr", *(word for word in words if word != "--debug")])
        except SystemExit as end:
            status = end.code
    assert status in (0, 1, 2) and "unexpected" not in errors.getvalue(), errors.getvalue()
    count[1] += status != 0


@fuzzed
@given(
    values=st.dictionaries(st.sampled_from([*_NAMES, "nonsense"]), st.one_of(VALUES, _TEXTS), max_size=4),
    text=st.one_of(TEXTS, st.tuples(TEXTS, TEXTS).map("=".join)),
)
def test_settings(values, text):
    with may_refuse("settings", SettingsError):
        split_values([text])
    with may_refuse("settings", SettingsError):
        settings = RenderSettings().with_properties(values)
        settings.validate()
        assert settings.iterations >= 1 and 0.0 < settings.alpha < 1.0 and settings.photons_for(640, 480) > 0
