# SPDX-License-Identifier: GPL-3.0-or-later
"""Which device a user's words mean, and what the kernel says of devices."""

import dataclasses
from types import SimpleNamespace

import moderngl
import pytest

from rppm_addon.gl.context import context as context_module
from rppm_addon.gl.context.context import Context, driver_version, short_name
from rppm_addon.gl.context.devices import Device, choose, list_devices
from rppm_addon.gl.context.kernel_devices import DeviceKind, kernel_device
from rppm_addon.scene.errors import DeviceError

CHIP = Device(0, "8086:9a49@0000:00:02.0", "integrated", "Chip")
CARD = Device(1, "10de:1e07@0000:01:00.0", "discrete", "Card")
TWIN = Device(2, "10de:1e07@0000:02:00.0", "discrete", "Card")
SOFTWARE = Device(3, "software", "software", "llvmpipe")
ALL = [CHIP, CARD, TWIN, SOFTWARE]


@pytest.fixture(autouse=True)
def unforced(monkeypatch):
    monkeypatch.delenv("LIBGL_ALWAYS_SOFTWARE", raising=False)


@pytest.mark.parametrize(
    ("text", "numbers"),
    [("", [1, 2, 0]), ("0", [0]), ("software", [3]), ("discrete", [1, 2]), (TWIN.identity, [2]), ("3?", [3, 1, 2, 0])],
)
def test_words_for_devices(text, numbers):
    choice = choose(text, ALL)
    assert [device.number for device in choice.devices] == numbers and not choice.is_missing


def test_software_only_where_there_is_nothing_else_or_it_is_forced(monkeypatch):
    assert choose("", [SOFTWARE]).devices == [SOFTWARE] and choose("", []).devices == []
    monkeypatch.setenv("LIBGL_ALWAYS_SOFTWARE", "1")
    assert choose("", ALL).devices == [SOFTWARE]


def test_what_must_be_there_and_is_not():
    with pytest.raises(DeviceError, match=r"no device '7'; choose one .*3 or software: llvmpipe"):
        choose("7", ALL)
    moved = CARD.identity.replace("01:", "05:")
    with pytest.raises(DeviceError, match="no device"):
        choose(moved, [CHIP, CARD])


def test_what_should_be_there_and_is_not():
    choice = choose("10de:9999@0000:01:00.0?My Card", ALL)
    assert choice.is_missing and choice.devices == [CARD, TWIN, CHIP]
    assert choice.wish == "My Card (10de:9999@0000:01:00.0)"
    moved = CARD.identity.replace("01:", "05:") + "?"
    assert choose(moved, [CHIP, CARD]).devices == [CARD, CHIP] and not choose(moved, [CHIP, CARD]).is_missing
    assert choose(moved, ALL).is_missing  # which of the two is it?


@pytest.fixture
def opened(monkeypatch):
    """Devices that no driver is asked for; those of the set cannot be opened."""
    broken = set()

    def create_context(device_index, **_):
        if device_index in broken:
            raise RuntimeError(f"{ALL[device_index].name} is broken")
        info = {"GL_RENDERER": ALL[device_index].name, "GL_VENDOR": "Vendor", "GL_VERSION": "4.6"}
        return SimpleNamespace(info=info, version_code=460, extensions=set())

    monkeypatch.setattr(moderngl, "create_context", create_context)
    monkeypatch.setattr(context_module, "list_devices", lambda: [dataclasses.replace(device) for device in ALL])
    monkeypatch.setattr(context_module, "load_project_mesa", lambda: None)
    monkeypatch.setattr(Context, "integers", lambda *_: [0] * 4)
    return broken


def test_a_device_that_stands_in_is_named(opened):
    context = Context.create("10de:9@0000:07:00.0?Mine")
    assert context.information.number == 1
    (warning,) = context.information.warnings
    assert "Mine (10de:9@0000:07:00.0) is not there: rendering on Card instead" in warning
    assert Context.create("1?Mine").information.warnings == []


def test_the_next_is_tried_but_not_the_processor(opened):
    opened.add(1)
    context = Context.create("")
    assert context.information.number == 2 and "(Card is broken)" in context.information.warnings[0]
    with pytest.raises(DeviceError, match="broken"):
        Context.create("1")
    opened |= {0, 2}
    with pytest.raises(DeviceError, match="[(]Chip is broken[)]"):
        Context.create("")


@pytest.mark.parametrize(
    ("uevent", "kind", "identity"),
    [
        ("DRIVER=i915\nPCI_ID=8086:9A49\nPCI_SLOT_NAME=0000:00:02.0", "integrated", "8086:9a49@0000:00:02.0"),
        ("DRIVER=xe\nPCI_ID=8086:56A0\nPCI_SLOT_NAME=0000:03:00.0", "discrete", "8086:56a0@0000:03:00.0"),
        ("DRIVER=nvidia\nPCI_ID=10DE:1E07\nPCI_SLOT_NAME=0000:01:00.0", "discrete", "10de:1e07@0000:01:00.0"),
        ("DRIVER=amdgpu\nPCI_ID=1002:73BF\nPCI_SLOT_NAME=0000:03:00.0", "discrete", "1002:73bf@0000:03:00.0"),
        ("DRIVER=virtio-pci\nPCI_ID=1AF4:1050\nPCI_SLOT_NAME=0000:00:01.0", "virtual", "1af4:1050@0000:00:01.0"),
        ("DRIVER=msm_dpu\nOF_NAME=gpu", "integrated", "platform@device"),
    ],
)
def test_what_the_kernel_says(tmp_path, uevent, kind, identity):
    file = tmp_path / "renderD128"
    file.touch()  # with the device number 0:0
    folder = tmp_path / "dev" / "char" / "0:0" / "device"
    folder.mkdir(parents=True)
    (folder / "uevent").write_text(f"{uevent}\n")
    (folder / "mem_info_vram_total").write_text("17163091968\n")
    known = kernel_device(str(file), tmp_path)
    assert (known.kind, known.identity) == (kind, identity) and known.driver in uevent
    assert known.memory == (None if kind == DeviceKind.INTEGRATED and "OF_NAME" in uevent else 17163091968)


def test_no_device_behind_a_file(tmp_path):
    assert kernel_device(str(tmp_path / "renderD128")) is None


@pytest.mark.parametrize(
    ("name", "short"),
    [
        ("AMD Radeon RX 6800 (radeonsi, navi21, LLVM 15.0.6, DRM 3.49, 6.1)", "AMD Radeon RX 6800"),
        ("NVIDIA GeForce RTX 2080 Ti/PCIe/SSE2", "NVIDIA GeForce RTX 2080 Ti"),
        ("llvmpipe (LLVM 15.0.6, 256 bits)", "llvmpipe"),
        ("Mesa Intel(R) Iris(R) Xe Graphics (TGL GT2)", "Mesa Intel(R) Iris(R) Xe Graphics (TGL GT2)"),
    ],
)
def test_names_without_what_drivers_say_of_themselves(name, short):
    assert short_name(name) == short


def test_versions_of_drivers():
    assert driver_version("NVIDIA Corporation 4.6.0 NVIDIA 550.54.14") == "NVIDIA 550.54.14"


def test_this_machine_lists_its_devices():
    devices = list_devices()
    assert devices and all(device.name and " " not in device.identity for device in devices)
