# SPDX-License-Identifier: GPL-3.0-or-later
"""The device that renders take, of the environment or of the preferences."""

import dataclasses
import platform
from types import SimpleNamespace

import bpy
import pytest

from rppm_addon.blender.render_client.chosen_device import chosen_device
from rppm_addon.gl.context.devices import Device
from rppm_addon.session.client.client import ProcessState

CARD = Device(0, "1002:73bf@0000:03:00.0", "discrete", "A card", "Mesa 25", 16 << 30)
CHIP = Device(1, "8086:9a49@0000:00:02.0", "integrated", "A chip")


@pytest.fixture
def preferences(process, monkeypatch):
    """RPPM's preferences as Blender keeps them, which no environment overrules, of a process that runs."""
    monkeypatch.delenv("RPPM_DEVICE", raising=False)
    process.state = ProcessState.RUNNING
    addon = bpy.context.preferences.addons.new()
    addon.module = "rppm_addon"
    yield addon.preferences
    bpy.context.preferences.addons.remove(addon)


def found(*devices):
    return SimpleNamespace(devices=list(devices))


def test_each_machine_has_its_own(preferences, process, monkeypatch):
    process.device = found(CARD, CHIP)
    monkeypatch.setattr(platform, "node", lambda: "farm")
    preferences.device = CHIP.identity
    monkeypatch.setattr(platform, "node", lambda: "desk")
    assert preferences.device == "AUTOMATIC" and chosen_device() == ""
    preferences.device = CARD.identity
    assert chosen_device() == f"{CARD.identity}?A card"
    monkeypatch.setattr(platform, "node", lambda: "farm")
    assert chosen_device() == f"{CHIP.identity}?A chip" and preferences.device == CHIP.identity
    preferences.device = CHIP.identity  # which changes nothing
    preferences.device = "AUTOMATIC"
    assert chosen_device() == "" and process.restarted == 3
    for nonsense in ("", "[1]", "{", '{"farm": "x"}', '{"farm": ["", "x"]}', '{"farm": [1, 2]}'):
        preferences.devices = nonsense
        assert chosen_device() == "", nonsense


def test_the_menu_has_what_was_found_and_what_was_chosen(preferences, process):
    old = dataclasses.replace(CARD, identity="10de:1@0000:01:00.0", name="Old")

    def labels():
        identities = ("AUTOMATIC", CARD.identity, CHIP.identity, old.identity)
        return [bpy.types.UILayout.enum_item_name(preferences, "device", identity) for identity in identities]

    process.device = found(old)
    preferences.device = old.identity
    process.device = None
    assert labels() == ["Automatic", "", "", "Old, not looked for yet"]
    again = dataclasses.replace(CARD, number=2, name="The card, by another driver")
    process.device = found(CARD, CHIP, again)
    assert labels() == ["Automatic", "A card (discrete, 16.00 GiB, Mesa 25)", "A chip (integrated)", "Old, not there"]
    assert preferences.device == old.identity


def test_the_environment_wins(preferences, process, monkeypatch):
    process.device = found(CARD)
    preferences.device = CARD.identity
    monkeypatch.setenv("RPPM_DEVICE", "4")
    assert chosen_device() == "4"
