# SPDX-License-Identifier: GPL-3.0-or-later
"""The device that renders take, of the environment or of the preferences."""

import dataclasses
import platform
from types import SimpleNamespace

import bpy
import pytest

from rppm_addon.blender import preferences
from rppm_addon.blender.render_client import chosen_device, renderer_process
from rppm_addon.gl.context.devices import Device


@pytest.fixture
def stored(monkeypatch):
    """Preferences of a user, which no environment overrules."""
    monkeypatch.delenv("RPPM_DEVICE", raising=False)
    monkeypatch.setattr(renderer_process, "_process", SimpleNamespace(device=None))
    changes = []
    monkeypatch.setattr(renderer_process, "device_changed", lambda: changes.append(True))
    return SimpleNamespace(devices="", changes=changes)


CARD = Device(0, "1002:73bf@0000:03:00.0", "discrete", "A card", "Mesa 25", 16 << 30)
CHIP = Device(1, "8086:9a49@0000:00:02.0", "integrated", "A chip")


def test_each_machine_has_its_own(stored, monkeypatch):
    renderer_process._process.device = SimpleNamespace(devices=[CARD, CHIP])
    monkeypatch.setattr(platform, "node", lambda: "farm")
    preferences._choose_device(stored, 2)
    monkeypatch.setattr(platform, "node", lambda: "desk")
    assert preferences._device_of(stored) == 0
    preferences._choose_device(stored, 1)
    assert chosen_device.device_here(stored.devices) == (CARD.identity, "A card")
    monkeypatch.setattr(platform, "node", lambda: "farm")
    assert chosen_device.device_here(stored.devices) == (CHIP.identity, "A chip")
    assert preferences._device_of(stored) == 2
    preferences._choose_device(stored, 2)  # as Blender does when the same is chosen again
    preferences._choose_device(stored, 0)
    assert chosen_device.device_here(stored.devices) is None and len(stored.changes) == 3
    for nonsense in ("", "[1]", "{", '{"farm": "x"}', '{"farm": ["", "x"]}', '{"farm": [1, 2]}'):
        assert chosen_device.device_here(nonsense) is None


def test_the_menu_has_what_was_found_and_what_was_chosen(stored):
    stored.devices = chosen_device.with_device_here("", chosen_device.ChosenDevice("10de:1@0000:01:00.0", "Old"))
    assert [item[:2] for item in preferences._device_items(stored, None)] == [
        ("AUTOMATIC", "Automatic"), ("10de:1@0000:01:00.0", "Old, not looked for yet"),
    ]  # fmt: skip
    again = dataclasses.replace(CARD, number=2, name="The card, by another driver")
    renderer_process._process.device = SimpleNamespace(devices=[CARD, CHIP, again])
    labels = ("Automatic", "A card (discrete, 16.00 GiB, Mesa 25)", "A chip (integrated)", "Old, not there")
    shown = [(item[3], item[1]) for item in preferences._device_items(stored, None)]
    assert shown == list(enumerate(labels))
    assert preferences._device_of(stored) == 3


def test_the_environment_wins(scene, stored, monkeypatch):
    devices = chosen_device.with_device_here("", chosen_device.ChosenDevice("software", "llvmpipe"))
    here = SimpleNamespace(preferences=SimpleNamespace(devices=devices))
    context = SimpleNamespace(preferences=SimpleNamespace(addons={chosen_device.root_package(): here}))
    monkeypatch.setattr(chosen_device, "bpy", SimpleNamespace(context=context))
    assert chosen_device.chosen_device() == "software?llvmpipe"
    monkeypatch.setenv("RPPM_DEVICE", "4")
    assert chosen_device.chosen_device() == "4"
    context.preferences.addons = {}
    monkeypatch.delenv("RPPM_DEVICE")
    assert chosen_device.chosen_device() == ""
    assert bpy.context is not context
