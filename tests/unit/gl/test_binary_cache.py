# SPDX-License-Identifier: GPL-3.0-or-later
"""Cache of linked programs: it returns nothing but what was kept for the same key, by the same user."""

import ctypes
import logging
import os
import sys
from types import SimpleNamespace

import pytest

from rppm_addon.gl.programs import binary_cache
from rppm_addon.gl.programs.binary_cache import BinaryCache, pack_entry, unpack_entry

KEY, OTHER = b"k" * 32, b"o" * 32


def test_an_entry_is_its_keys_alone_and_whole():
    entry = pack_entry(KEY, 7, b"code")
    assert unpack_entry(KEY, entry) == (7, b"code")
    assert unpack_entry(OTHER, entry) is None
    for length in range(len(entry)):
        assert unpack_entry(KEY, entry[:length]) is None
    for place in range(len(entry)):
        spoiled = bytearray(entry)
        spoiled[place] ^= 1
        assert unpack_entry(KEY, bytes(spoiled)) is None


def integer(reference):
    """The C integer that a function of GL is to set."""
    return ctypes.cast(reference, ctypes.POINTER(ctypes.c_int)).contents


class Driver:
    """A driver whose programs are numbers, and their binaries these numbers as bytes."""

    def __init__(self, version="1.0"):
        self.has_program_binaries = True
        self.information = SimpleNamespace(name="Device", driver=version)
        self.linked = []

    def function(self, name, *_):
        return getattr(self, name)

    def glGetProgramiv(self, program, parameter, value):
        integer(value).value = 1 if parameter == 0x8B82 else 4

    def glGetProgramBinary(self, program, length, written, kind, data):
        integer(written).value, integer(kind).value = 4, 3
        ctypes.memmove(data, program.to_bytes(4, "little"), 4)

    def glProgramBinary(self, program, kind, data, length):
        self.linked.append((kind, int.from_bytes(data[:length], "little")))


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("RPPM_CACHE", str(tmp_path / "programs"))
    return tmp_path / "programs"


def test_programs_come_back(folder):
    driver = Driver()
    cache = BinaryCache(driver)
    cache.store(5, "five")
    assert cache.load(1, "five") and driver.linked == [(3, 5)]
    assert not BinaryCache(Driver("2.0")).load(1, "five")
    if sys.platform != "win32":
        assert folder.stat().st_mode & 0o777 == 0o700


def test_swapped_files_are_refused(folder, caplog):
    driver = Driver()
    cache = BinaryCache(driver)
    cache.store(5, "five")
    (five,) = folder.glob("*.bin")
    cache.store(6, "six")
    (six,) = (path for path in folder.glob("*.bin") if path != five)
    five.replace(six)
    assert not cache.load(1, "six") and driver.linked == []
    assert "compiled again" in caplog.text
    cache.store(6, "six")
    assert cache.load(1, "six") and driver.linked == [(3, 6)]


@pytest.mark.skipif(sys.platform == "win32", reason="folders have no such modes")
def test_what_others_may_have_written_is_refused(folder, caplog, monkeypatch):
    caplog.set_level(logging.WARNING)
    BinaryCache(Driver()).store(5, "five")
    (file,) = folder.glob("*.bin")
    file.chmod(0o666)
    assert not BinaryCache(Driver()).load(1, "five")
    file.chmod(0o600)
    folder.chmod(0o777)
    cache = BinaryCache(Driver())
    assert not cache.available and str(folder) in caplog.text
    assert not cache.load(1, "five") and not cache.holds("five")
    folder.chmod(0o700)
    user = folder.stat().st_uid
    monkeypatch.setattr(os, "getuid", lambda: user + 1)
    assert BinaryCache(Driver()).available == (user == 0)


def test_a_full_disk_leaves_nothing_behind(folder, monkeypatch):
    class Full:
        def __init__(self, file):
            self._file, self.name = file, file.name

        def write(self, data):
            raise OSError(28, "No space left on device")

        def __enter__(self):
            return self

        def __exit__(self, *_):
            self._file.close()

    make = binary_cache.tempfile.NamedTemporaryFile
    monkeypatch.setattr(binary_cache.tempfile, "NamedTemporaryFile", lambda **given: Full(make(**given)))
    cache = BinaryCache(Driver())
    cache.store(5, "five")
    assert list(folder.iterdir()) == [] and not cache.load(1, "five")
