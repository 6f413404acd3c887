# SPDX-License-Identifier: GPL-3.0-or-later
"""Preferences, the buttons in them, and the names under which Blender finds them."""

import importlib.util
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import bpy
import pytest
from drawing import drawn, identifiers, preferences_context

from rppm_addon.blender import operators, preferences
from rppm_addon.blender.preferences import RppmPreferences
from rppm_addon.blender.render_client import renderer_process
from rppm_addon.gl.context.context import DeviceInformation
from rppm_addon.session.client.client import ProcessState

ROOT = Path(__file__).resolve().parents[3]


def shown():
    return drawn(RppmPreferences, preferences_context())


def test_before_the_renderer_was_needed(process):
    record = shown()
    assert record.labels[0] == "The renderer has not been needed yet"
    assert identifiers(record) == ["rppm.start_renderer", "rppm.open_log", "rppm.self_test"]
    assert str(process.log_path) in record.labels[-2] and process.restarted == 0


def test_the_device_that_was_found(process, monkeypatch):
    monkeypatch.setenv("RPPM_DEVICE", "1")
    limits = {"GL_MAX_SHADER_STORAGE_BLOCK_SIZE": 1 << 27, "GL_MAX_TEXTURE_SIZE": 16384, "GL_OTHER": 3}
    process.state = ProcessState.RUNNING
    process.device = DeviceInformation("Some GPU", "Some driver 1.0", "4.6", limits, ["float atomics"])
    labels = shown().labels
    assert {"Some GPU", "Some driver 1.0", "4.6", "128.0 MiB", "16,384", "float atomics"} <= set(labels)
    process.device.warnings.append("My card is not there")
    assert "My card is not there" in shown().labels
    assert "1, by the environment variable RPPM_DEVICE or --rppm-device" in labels


def test_why_the_renderer_does_not_run(timers, process):
    process.state, process.error = ProcessState.FAILED, "The renderer process ended with code 1"
    record = shown()
    assert record.labels[:2] == ["The renderer does not run", process.error]
    assert bpy.ops.rppm.start_renderer() == {"FINISHED"} and process.restarted == 1
    assert "The renderer is starting" in shown().labels
    *_, redraw = timers  # until the process has started and has listed the devices
    assert redraw() == operators.START_SHOWN_EVERY
    process.state, process.is_listing = ProcessState.RUNNING, True
    assert redraw() == operators.START_SHOWN_EVERY
    process.is_listing = False
    assert redraw() is None


def test_what_is_missing_is_named_with_the_remedy(scene, monkeypatch):
    assert preferences.missing() == []
    find = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == "moderngl" else find(name))
    monkeypatch.setattr(sys, "platform", "darwin")
    record = shown()
    text = " ".join(record.labels)
    assert "does not find moderngl: install" in text and "macOS" in text and not record.operators


def test_the_log_is_opened(process, monkeypatch):
    opened = []
    monkeypatch.setattr(type(bpy.ops.wm.path_open), "__call__", lambda self, **values: opened.append(values))
    assert bpy.types.RPPM_OT_open_log is operators.RPPM_OT_open_log
    said = []
    button = SimpleNamespace(report=lambda kind, text: said.append(text))
    assert operators.RPPM_OT_open_log.execute(button, None) == {"CANCELLED"}
    assert "no log yet" in said[0] and not opened
    process.log_path.write_text("started")
    assert operators.RPPM_OT_open_log.execute(button, None) == {"FINISHED"}
    assert opened == [{"filepath": str(process.log_path)}]


def test_the_log_lies_in_a_folder_of_the_users(scene, monkeypatch, tmp_path):
    assert preferences.root_package() == RppmPreferences.bl_idname == "rppm_addon"
    monkeypatch.setattr(bpy.utils, "user_resource", lambda kind, path="", create=False: str(tmp_path / path))
    assert renderer_process.log_path() == tmp_path / "rppm" / "renderer.log"


@pytest.mark.parametrize("package", ["bl_ext.user_default.rppm", "rppm"])
def test_the_preferences_are_those_of_the_root_package(package):
    """As Blender imports the extension, below a repository's name, and as an add-on's folder."""
    parents = package.split(".")[:-1]
    for count in range(1, len(parents) + 1):
        sys.modules[".".join(parents[:count])] = SimpleNamespace(__path__=[])
    specification = importlib.util.spec_from_file_location(
        package, ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    module = importlib.util.module_from_spec(specification)
    sys.modules[package] = module
    try:
        specification.loader.exec_module(module)
        assert module.register.__module__ == module.unregister.__module__ == f"{package}.rppm_addon"
        loaded = importlib.import_module(f"{package}.rppm_addon.blender.preferences")
        assert loaded.RppmPreferences.bl_idname == package
    finally:
        for name in [name for name in sys.modules if name == package or name.startswith(f"{package}.")]:
            del sys.modules[name]
        for count in range(1, len(parents) + 1):
            del sys.modules[".".join(parents[:count])]


def test_checking_the_device_starts_the_real_process(timers, scene, monkeypatch, tmp_path):
    process = renderer_process.renderer_process()
    monkeypatch.setattr(process.launcher, "log_path", tmp_path / "renderer.log")
    try:
        assert bpy.ops.rppm.start_renderer() == {"FINISHED"}
        end = time.monotonic() + 90.0
        while process.state is ProcessState.STARTING and time.monotonic() < end:
            time.sleep(0.05)
        assert process.state is ProcessState.RUNNING, process.error
        labels = shown().labels
        assert {process.device.name, process.device.driver, "Largest Buffer", "Texture Size"} <= set(labels)
        assert "The renderer is running" in labels and (tmp_path / "renderer.log").is_file()
    finally:
        process.close()
    assert process.state is ProcessState.STOPPED and process.device is None
