# SPDX-License-Identifier: GPL-3.0-or-later
"""Sets of buffers: what is declared once is made, reported, forecast and given back."""

from dataclasses import dataclass

import moderngl
import pytest

from rppm_addon.gl.buffer_sets import BufferSet, ComputeShader, Part, StorageBuffer
from rppm_addon.gl.buffers.buffers import SMALLEST
from rppm_addon.gl.context.context import Context
from rppm_addon.integrator.common.active_paths import PathList
from rppm_addon.integrator.common.records.rays import RAY
from rppm_addon.scene.errors import DeviceError


@dataclass(frozen=True)
class Sizes:
    rocks: int
    sticks: int = 0


class Inner(BufferSet):
    remedy = "carry fewer"
    rocks = StorageBuffer("rocks", RAY, lambda sizes: sizes.rocks)


class Outer(BufferSet):
    inner = Part(Inner)
    sticks = StorageBuffer("sticks", "uint", lambda sizes: sizes.sticks, header="uvec4")
    found = StorageBuffer("found", "vec3")
    few = StorageBuffer("few", "uint", 2)


class Derived(Outer):
    more = StorageBuffer("more", "vec4", lambda sizes: 2 * sizes.rocks)


def test_what_is_expected_is_what_is_made(context, library):
    sizes = Sizes(100, 50)
    expected = {"rocks": 100 * RAY.size, "sticks": 16 + 4 * 50, "few": SMALLEST, "more": 200 * 16}
    assert Derived.expected_bytes(sizes) == expected
    made = Derived(context, library, sizes)
    assert made.memory_bytes == expected
    assert made.sticks.capacity == 50 and made.inner.rocks.capacity == 100
    made.release()


def test_of_what_nothing_is_asked_nothing_is_made(context, library):
    made = Outer(context, library, Sizes(8))
    assert Outer.expected_bytes(Sizes(8)).keys() == made.memory_bytes.keys() == {"rocks", "few"}
    made.found.require_items(5)
    assert made.memory_bytes["found"] == 5 * 16
    assert made.sticks.buffer.size >= SMALLEST  # to be bound it has to be something
    assert "sticks" not in made.memory_bytes
    made.release()


def test_sets_have_buffers_of_their_own(context, library):
    first, second = (Inner(context, library, Sizes(count)) for count in (10, 20))
    assert first.rocks is not second.rocks and (first.rocks.capacity, second.rocks.capacity) == (10, 20)
    for each in (first, second):
        each.release()


def test_textures_are_reported_and_all_is_given_back(context, library):
    made = Outer(context, library, Sizes(8))
    texture = made.own(context.moderngl.texture((8, 4), 2, dtype="f4"), "pictures")
    depth = made.own(context.moderngl.depth_texture((8, 4)), "pictures")
    framebuffer = made.own(context.moderngl.framebuffer([texture], depth))
    assert made.memory_bytes["pictures"] == 8 * 4 * 12
    made.disown(framebuffer)
    made.disown(texture)
    assert made.memory_bytes["pictures"] == 8 * 4 * 4 and isinstance(texture.mglo, moderngl.InvalidObject)
    buffer = made.inner.rocks.buffer
    made.release()
    assert isinstance(buffer.mglo, moderngl.InvalidObject) and isinstance(depth.mglo, moderngl.InvalidObject)
    assert made.memory_bytes == {}


def test_the_remedy_is_the_set_s(context, library):
    with pytest.raises(DeviceError, match="rocks needs .* carry fewer"):
        Inner(context, library, Sizes(context.storage_block_limit // RAY.size + 1))
    with pytest.raises(AttributeError, match=r"BufferSet.__init__"):
        _ = object.__new__(Inner).rocks


class ListedAndMore(BufferSet):
    remedy = "carry fewer"
    stones = StorageBuffer("stones", "vec4", lambda sizes: sizes.rocks)
    listed = PathList("sticks", lambda sizes: sizes.sticks, to_keep=True)
    inner = Part(Inner)


def test_what_is_too_large_is_refused_before_anything_is_made(context, monkeypatch):
    limit = context.storage_block_limit
    ListedAndMore.refuse_large(context, Sizes(1, 1))
    most = limit // RAY.size
    ListedAndMore.refuse_large(context, Sizes(most, 1))  # stones are smaller than rays
    for sizes, name in (
        (Sizes(most + 1), "rocks"),
        (Sizes(limit // 16 + 1), "stones"),
        (Sizes(1, limit // 4), "sticks"),
        (Sizes(1 << 62), "stones"),
    ):
        with pytest.raises(DeviceError, match=f"^{name} needs .* in one buffer; carry fewer$"):
            ListedAndMore.refuse_large(context, sizes)
    monkeypatch.setattr(Context, "available_memory", 1 << 20)
    with pytest.raises(DeviceError, match=r"^\d+ MiB are needed but the device .* has 1 MiB left; carry fewer$"):
        ListedAndMore.refuse_large(context, Sizes(1 << 15))


class Optional(BufferSet):
    marks = StorageBuffer("marks", "uint", lambda sizes: sizes.sticks, block="Marks", zeroed=True)
    program = ComputeShader("common/active_paths/fill.comp")

    @classmethod
    def is_needed(cls, sizes):
        return sizes.sticks > 1


class WithOptional(BufferSet):
    optional = Part(Optional)


def test_a_set_that_is_not_needed_has_empty_buffers_and_no_program(context, library):
    made = library.made
    off, on = (WithOptional(context, library, Sizes(1, sticks)) for sticks in (1, 3))
    assert off.memory_bytes == WithOptional.expected_bytes(Sizes(1, 1)) == {}
    assert on.memory_bytes == WithOptional.expected_bytes(Sizes(1, 3)) == {"marks": SMALLEST}
    assert "Marks" in off.blocks  # for programs that others have
    assert not off.optional.is_on and on.optional.is_on
    assert not on.optional.marks.read("u4", 3).any()
    with pytest.raises(AttributeError, match="it is off"):
        _ = off.optional.program
    assert library.made <= made + 1
    WithOptional.refuse_large(context, Sizes(1, 1))
    on.release()
    assert on.optional.program is library.compute("common/active_paths/fill.comp")  # it belongs to the library
    off.release()
