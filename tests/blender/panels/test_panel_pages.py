# SPDX-License-Identifier: GPL-3.0-or-later
"""The pages of docs/panels say what the panels show."""

import bpy
import pytest

from tools import panel_pages
from tools.setting_pairs import PAIRS, PICTURES

pytestmark = pytest.mark.skipif(bpy.app.version[:2] != (5, 0), reason="tooltips differ between versions of Blender")


def test_pages_show_the_panels_as_they_are():
    for path, text in panel_pages.pages().items():
        assert path.is_file() and path.read_text(encoding="utf-8") == text, "run python tools/panel_pages.py"


def test_each_pair_is_of_a_setting_that_a_page_shows_and_has_its_picture():
    texts = "".join(path.read_text(encoding="utf-8") for path in panel_pages.FOLDER.glob("*.md"))
    for pair in PAIRS.values():
        assert f"settings/{pair.setting}.jpg" in texts and (PICTURES / f"{pair.setting}.jpg").is_file(), pair.path
    assert {path.stem for path in PICTURES.iterdir()} == {pair.setting for pair in PAIRS.values()}
