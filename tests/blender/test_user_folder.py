# SPDX-License-Identifier: GPL-3.0-or-later
"""Folders of the log and of compiled programs, from source and as an extension."""

from pathlib import Path

import bpy
import pytest

from rppm_addon.blender import user_folder
from rppm_addon.blender.render_client import renderer_process
from rppm_addon.gl.programs.binary_cache import VARIABLE, cache_folder


@pytest.fixture
def extension(monkeypatch):
    """Blender has loaded the add-on as an extension; returns the packages that it is asked for."""
    asked = []
    monkeypatch.setattr(bpy.utils, "extension_path_user", lambda package: asked.append(package) or "/folder")
    monkeypatch.setattr(user_folder, "__package__", "bl_ext.user_default.rppm.rppm_addon.blender")
    monkeypatch.delenv(VARIABLE, raising=False)
    yield asked
    user_folder.unregister()
    assert VARIABLE not in user_folder.os.environ


def test_from_source_the_log_is_among_the_data_files(monkeypatch):
    assert renderer_process.log_path() == Path(bpy.utils.user_resource("DATAFILES")) / "rppm" / "renderer.log"
    monkeypatch.delenv(VARIABLE, raising=False)
    user_folder.register()
    assert VARIABLE not in user_folder.os.environ


def test_an_extension_has_all_in_its_own_folder(extension):
    user_folder.register()
    assert renderer_process.log_path() == Path("/folder/renderer.log")
    assert cache_folder() == Path("/folder/programs")
    assert set(extension) == {"bl_ext.user_default.rppm"}


def test_the_environment_chooses_the_folder_of_programs(extension, monkeypatch):
    monkeypatch.setenv(VARIABLE, "/programs")
    user_folder.register()
    assert cache_folder() == Path("/programs")
    user_folder.unregister()
    assert cache_folder() == Path("/programs")
    monkeypatch.delenv(VARIABLE)
