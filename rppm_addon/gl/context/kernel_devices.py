# SPDX-License-Identifier: GPL-3.0-or-later
"""Graphics devices as Linux describes them: their places, makers, drivers, memory and kinds."""

import contextlib
import ctypes
import enum
import os
from dataclasses import dataclass
from pathlib import Path


class DeviceKind(enum.StrEnum):
    """Where a device's memory and its computing stand."""

    DISCRETE = "discrete"
    """A card with memory of its own."""
    INTEGRATED = "integrated"
    """Part of the processor, whose memory it shares."""
    VIRTUAL = "virtual"
    """A device of a virtual machine."""
    SOFTWARE = "software"
    """The processor itself."""
    UNKNOWN = "unknown"


@dataclass(frozen=True)
class KernelDevice:
    """Facts about a device that are known without opening it."""

    kind: DeviceKind
    driver: str
    """The kernel's driver, such as amdgpu."""
    maker: str
    """Empty where it is none of those that are known."""
    identity: str
    """VENDOR:DEVICE@ADDRESS of the PCI bus; elsewhere platform@NAME."""
    memory: int | None
    """Bytes of its own, where the kernel's driver reports them."""


_MAKERS = {"1002": "AMD", "10de": "NVIDIA", "8086": "Intel"}
_INTEL_INTEGRATED = "0000:00:02.0"
"""Where processors of Intel have it on the PCI bus, and no card can be."""


def kernel_device(file: str, sysfs: Path = Path("/sys")) -> KernelDevice | None:
    """Read the kernel's facts about the device of a file such as /dev/dri/renderD128; None where it reports nothing."""
    try:
        number = Path(file).stat().st_rdev
        folder = sysfs / "dev" / "char" / f"{os.major(number)}:{os.minor(number)}" / "device"
        lines = (folder / "uevent").read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return None
    facts = dict(line.split("=", 1) for line in lines if "=" in line)
    driver = facts.get("DRIVER", "")
    if "PCI_SLOT_NAME" not in facts:  # of a system on a chip
        return KernelDevice(DeviceKind.INTEGRATED, driver, "", f"platform@{folder.resolve().name}", None)
    pci_id, address = facts.get("PCI_ID", "").lower(), facts["PCI_SLOT_NAME"]
    vendor = pci_id.partition(":")[0]
    memory = None
    with contextlib.suppress(OSError, ValueError):
        memory = int((folder / "mem_info_vram_total").read_text(encoding="ascii"))
    kind = DeviceKind.VIRTUAL
    if vendor in _MAKERS:
        is_integrated = address == _INTEL_INTEGRATED if vendor == "8086" else _is_fused(file, folder, driver)
        kind = DeviceKind.INTEGRATED if is_integrated else DeviceKind.DISCRETE
    return KernelDevice(kind, driver, _MAKERS.get(vendor, ""), f"{pci_id}@{address}", memory)


_AMDGPU_INFO = 0x40206445
"""DRM_IOCTL_AMDGPU_INFO of the kernel's amdgpu_drm.h."""
_DEVICE_INFORMATION, _FLAGS_OFFSET, _FUSION = 0x16, 136, 1
"""Its query AMDGPU_INFO_DEV_INFO, whose answer has ids_flags at this offset, and AMDGPU_IDS_FLAGS_FUSION."""


class _Request(ctypes.Structure):
    """struct drm_amdgpu_info."""

    _fields_ = (
        ("address", ctypes.c_uint64),
        ("size", ctypes.c_uint32),
        ("query", ctypes.c_uint32),
        ("more", ctypes.c_uint32 * 4),
    )


def _is_fused(file: str, folder: Path, driver: str) -> bool:
    """Whether a device of AMD is part of a processor, by its driver's word: its address and memory do not show it."""
    if driver != "amdgpu":
        return False
    with contextlib.suppress(OSError):
        if (folder / "power" / "runtime_status").read_text(encoding="ascii").strip() == "suspended":
            return False  # as cards alone are, and to ask would wake it
    answer = ctypes.create_string_buffer(1024)  # more than any kernel answers: not all heed the size
    request = _Request(ctypes.addressof(answer), len(answer), _DEVICE_INFORMATION)
    try:
        import fcntl  # there is none on Windows

        opened = os.open(file, os.O_RDWR | os.O_CLOEXEC)
        try:
            fcntl.ioctl(opened, _AMDGPU_INFO, request)
        finally:
            os.close(opened)
    except (ImportError, OSError):
        return False
    return bool(int.from_bytes(answer.raw[_FLAGS_OFFSET : _FLAGS_OFFSET + 8], "little") & _FUSION)
