# SPDX-License-Identifier: GPL-3.0-or-later
"""The device that renders take, of the environment or of the preferences."""

import platform
from types import SimpleNamespace

import bpy
import pytest

from rppm_addon.blender import chosen_device, preferences, renderer_process
from rppm_addon.gl.devices import device_names


@pytest.fixture
def stored(monkeypatch):
    """Preferences of a user, which no environment overrules."""
    monkeypatch.delenv("RPPM_DEVICE", raising=False)
    monkeypatch.setattr(renderer_process, "_process", SimpleNamespace(device=None))
    changes = []
    monkeypatch.setattr(renderer_process, "device_changed", lambda: changes.append(True))
    return SimpleNamespace(devices="", changes=changes)


def test_each_machine_has_its_own(stored, monkeypatch):
    monkeypatch.setattr(platform, "node", lambda: "farm")
    preferences._choose_device(stored, 3)
    monkeypatch.setattr(platform, "node", lambda: "desk")
    assert preferences._device_of(stored) == 0
    preferences._choose_device(stored, 1)
    assert chosen_device.device_here(stored.devices) == "0"
    monkeypatch.setattr(platform, "node", lambda: "farm")
    assert chosen_device.device_here(stored.devices) == "2" and preferences._device_of(stored) == 3
    preferences._choose_device(stored, 0)
    assert chosen_device.device_here(stored.devices) == "" and len(stored.changes) == 3
    for nonsense in ("", "[1]", "{", '{"farm": "x"}', '{"farm": 1}'):
        assert chosen_device.device_here(nonsense) == ""


def test_the_menu_has_what_was_found_and_what_was_chosen(stored):
    stored.devices = chosen_device.with_device_here("", "5")
    assert [item[:2] for item in preferences._device_items(stored, None)] == [
        ("DEFAULT", "Default"), ("5", "5: not looked for yet"),
    ]  # fmt: skip
    renderer_process._process.device = SimpleNamespace(devices=["a card", "another"])
    shown = [(item[1], item[3]) for item in preferences._device_items(stored, None)]
    assert shown == [("Default", 0), ("0: a card", 1), ("1: another", 2), ("5: not there", 6)]


def test_the_environment_wins(scene, stored, monkeypatch):
    here = SimpleNamespace(preferences=SimpleNamespace(devices=chosen_device.with_device_here("", "2")))
    context = SimpleNamespace(preferences=SimpleNamespace(addons={chosen_device.root_package(): here}))
    monkeypatch.setattr(chosen_device, "bpy", SimpleNamespace(context=context))
    assert chosen_device.chosen_device() == "2"
    monkeypatch.setenv("RPPM_DEVICE", "4")
    assert chosen_device.chosen_device() == "4"
    context.preferences.addons = {}
    monkeypatch.delenv("RPPM_DEVICE")
    assert chosen_device.chosen_device() == ""
    assert bpy.context is not context


def test_this_machine_lists_its_devices():
    names = device_names()
    assert names and all(names)
