# SPDX-License-Identifier: GPL-3.0-or-later
"""Storage blocks that are read as texel buffers."""

import contextlib

import numpy as np
import pytest

from rppm_addon.gl.buffers.buffers import GrowingBuffer
from rppm_addon.gl.buffers.records import Record
from rppm_addon.gl.buffers.storage_blocks import StorageBlock
from rppm_addon.gl.buffers.texel_buffers import MAX_ADDED, allocated_size
from rppm_addon.gl.programs import sources
from rppm_addon.gl.programs.program import ComputeProgram
from rppm_addon.gl.programs.program_maker import ProgramMaker
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.gl.programs.sources import expand
from rppm_addon.gl.programs.texel_sources import MAX_IMAGES
from rppm_addon.scene.errors import DeviceError

COUNT = 37
"""No multiple of the words of a texel."""
WORDS = 26
"""Words that the shader writes for an item."""
SHADER = """#version 430 core
layout(local_size_x = 64) in;
readonly buffer Things;
readonly buffer Pairs { uvec2 pairs[]; };
restrict readonly buffer Order { uint order[]; };
writeonly buffer Found { uint found[]; };
void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= COUNT) return;
    uint at = index * WORDS;
    Thing thing = things[order[order[index]]];
    for (int k = 0; k < 16; ++k) found[at + k] = floatBitsToUint(thing.turn[k / 4][k % 4]);
    found[at + 16u] = floatBitsToUint(thing.place.x);
    found[at + 17u] = floatBitsToUint(thing.place.z);
    found[at + 18u] = thing.kind;
    found[at + 19u] = uint(things[index].offset.y);
    found[at + 20u] = floatBitsToUint(thing.size);
    found[at + 21u] = pairs[order[index]].x;
    found[at + 22u] = pairs[index].y;
    found[at + 23u] = order[index];
    found[at + 24u] = floatBitsToUint(things[order[index]].parts[order[index] & 1u].color.y);
    found[at + 25u] = floatBitsToUint(thing.parts[1].weight);
}
"""


@pytest.fixture
def shader(tmp_path, monkeypatch):
    """A shader that reads blocks."""
    monkeypatch.setattr(sources, "SHADER_FOLDER", tmp_path)
    for kind in (Record, StorageBlock):
        monkeypatch.setattr(kind, "registry", {})
    part = Record("Part", color="vec3", weight="float")
    Record("Thing", turn="mat4", place="vec3", kind="uint", offset="ivec2", size="float", parts=(part, 2))
    StorageBlock("Things", "Thing things[];")
    (tmp_path / "own.comp").write_text(SHADER)
    return "own.comp"


@pytest.fixture
def buffers(context, shader, tmp_path, monkeypatch):
    """Buffers that the shader reads and writes; that of Things has more bytes than a storage block."""
    monkeypatch.setenv("RPPM_CACHE", str(tmp_path))
    monkeypatch.setitem(context.limits, "GL_MAX_SHADER_STORAGE_BLOCK_SIZE", COUNT * WORDS * 4)
    random = np.random.default_rng(1)
    size = Record.registry["Thing"].size
    contents = {
        "Things": random.integers(0, 1 << 32, 2 * COUNT * size // 4, np.uint32),  # denormal, infinite, and none
        "Pairs": random.integers(0, 1 << 32, 2 * COUNT, np.uint32),
        "Order": random.permutation(COUNT).astype(np.uint32),
    }
    buffers = {name: GrowingBuffer(context, name, texel_bytes=16) for name in (*contents, "Found")}
    for name, array in contents.items():
        buffers[name].upload(array)
    buffers["Found"].require(COUNT * WORDS * 4)
    yield buffers
    for buffer in buffers.values():
        buffer.release()


DEFINES = {"COUNT": f"{COUNT}u", "WORDS": f"{WORDS}u"}


@contextlib.contextmanager
def program_of(context, monkeypatch, name, large=(), reads_texels=False):
    """A program that reads large blocks, or all, as texels, as where what is larger than a block cannot be bound."""
    source = expand(name, DEFINES, reads_texels=reads_texels, large=large)
    program = ComputeProgram(context, ProgramMaker(context), source, links_later=False)
    with monkeypatch.context() as patch:  # llvmpipe binds what is larger than a block all the same
        patch.setattr(context, "large_buffers", 0)
        yield program, source.texel_buffers
    program.release()


def words_of(buffer):
    return buffer.read(np.uint32, buffer.size // 4).copy()


def found_by(program, buffers):
    assert program.blocks == buffers.keys()
    buffers["Found"].clear()
    program.run(COUNT, {name: buffer.buffer for name, buffer in buffers.items()})
    return buffers["Found"].read(np.uint32, COUNT * WORDS)


def test_texels_have_the_bits_of_blocks(context, shader, buffers, monkeypatch):
    found = []
    for reads_texels, large in ((False, ()), (True, ()), (False, ("Pairs", "Order", "Found")), (True, ("Things",))):
        with program_of(context, monkeypatch, shader, large, reads_texels) as (program, texels):
            assert set(texels) == ({"Things", "Pairs", "Order"} if reads_texels else {*large})
            assert all(texels[name].texel_bytes == (4 if name == "Found" else 16) for name in large)
            found.append(found_by(program, buffers))
    for one in found:
        np.testing.assert_array_equal(one, found[0])
    things, order = words_of(buffers["Things"]), words_of(buffers["Order"])[:COUNT]
    things = things.reshape(2 * COUNT, -1)[order[order]]
    assert np.array_equal(found[0].reshape(COUNT, WORDS)[:, :16], things[:, :16])


def test_arrays_that_are_larger_than_a_block_are_read_as_texels(context, shader, buffers, monkeypatch):
    monkeypatch.setattr(context, "is_software", False)
    library, program = library_with(context, shader)
    assert buffers["Things"].buffer.size > context.storage_block_limit + MAX_ADDED and context.large_buffers == 1
    found = found_by(program, buffers)
    assert library.made == 2
    with monkeypatch.context() as patch:
        patch.setattr(context, "large_buffers", 0)
        np.testing.assert_array_equal(found, found_by(program, buffers))
    assert library.made == 2
    library.release()


def test_words_that_are_more_than_texels_lie_four_in_one(context, shader, buffers, monkeypatch):
    monkeypatch.setattr(context, "is_software", True)
    library, program = library_with(context, shader)
    expected = found_by(program, buffers)
    assert library.made == 1
    order = GrowingBuffer(context, "long order", texel_bytes=16)
    order.upload(np.resize(buffers["Order"].read(np.uint32, COUNT), 800))
    monkeypatch.setattr(context, "max_texels", 640)  # those of Things are 592
    np.testing.assert_array_equal(found_by(program, {**buffers, "Order": order}), expected)
    assert library.made == 2
    monkeypatch.setattr(context, "max_texels", 560)
    with pytest.raises(DeviceError, match="takes more of Order, Things at once than the device .*; simplify the scene"):
        found_by(program, {**buffers, "Order": order})
    order.release()
    library.release()


def test_what_is_written_takes_no_more_than_texels_of_its_items(context, shader, buffers, monkeypatch):
    with pytest.raises(DeviceError, match="found needs .* in one buffer"):
        GrowingBuffer(context, "found").require(context.storage_block_limit + 1)
    library, program = library_with(context, shader)
    monkeypatch.setattr(context, "max_texels", 1000)
    with pytest.raises(DeviceError, match="takes more of Found at once"):
        program.run(1, {name: buffers["Things" if name == "Found" else name].buffer for name in program.blocks})
    library.release()


COPY = """#version 430 core
layout(local_size_x = 64) in;
readonly buffer Things;
readonly buffer Order { uint order[]; };
restrict writeonly buffer Copies { Thing copies[]; };
writeonly buffer Sizes { float sizes[]; };
void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= COUNT) return;
    Thing thing = things[index];
    copies[order[order[index]]] = thing;
    if (index != order[index]) sizes[order[index]] = thing.place[uint(index) % 3u];
    else sizes[index] = 2.0;
}
"""


def test_items_of_what_is_only_written_are_stored(context, shader, buffers, tmp_path, monkeypatch):
    (tmp_path / "copy.comp").write_text(COPY)
    copies, sizes = (GrowingBuffer(context, name, texel_bytes=16) for name in ("copies", "sizes"))
    copies.require(buffers["Things"].size)
    sizes.require(4 * COUNT)
    blocks = {"Things": buffers["Things"], "Order": buffers["Order"], "Copies": copies, "Sizes": sizes}
    found = []
    for large in ((), ("Copies", "Sizes", "Things")):
        copies.clear()
        with program_of(context, monkeypatch, "copy.comp", large) as (program, texels):
            assert texels.keys() == set(large)
            program.run(COUNT, {name: buffer.buffer for name, buffer in blocks.items()})
        found.append([words_of(buffer) for buffer in (copies, sizes)])
    (things, sizes_found), (stored, sizes_stored) = found
    things, stored = (np.delete(copied.reshape(2 * COUNT, -1), 23, 1) for copied in (things, stored))  # no member's
    assert things[:COUNT].any() and not things[COUNT:].any()
    np.testing.assert_array_equal(stored, things)
    np.testing.assert_array_equal(sizes_stored, sizes_found)
    copies.release()
    sizes.release()


CHANGE = """#version 430 core
layout(local_size_x = 64) in;
buffer Things;
writeonly buffer Sizes { float sizes[]; };
void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= COUNT) return;  // things[index] stands in a comment
    sizes[index] = things[index + COUNT].size;
    if (index % 3u == 0u) things[index] = things[index + COUNT];
    else if (index % 3u == 1u) things[index].place = vec3(things[index + COUNT].offset, index);
    else things[things[index + COUNT].kind % COUNT].offset.x = 3;
}
"""


def test_items_and_members_of_what_is_read_as_well_are_stored(context, shader, buffers, tmp_path, monkeypatch):
    text = CHANGE.replace("offset.x = 3", "kind = 7u")
    (tmp_path / "change.comp").write_text(text.replace("things[index + COUNT].kind % COUNT", "index"))
    before, sizes = words_of(buffers["Things"]), GrowingBuffer(context, "s")
    sizes.require(4 * COUNT)
    found = []
    for large in ((), ("Things",)):
        buffers["Things"].upload(before)
        with program_of(context, monkeypatch, "change.comp", large) as (program, texels):
            assert texels.keys() == set(large)
            program.run(COUNT, {"Things": buffers["Things"].buffer, "Sizes": sizes.buffer})
        found.append([words_of(buffer) for buffer in (buffers["Things"], sizes)])
    assert (found[0][0] != before).any()
    for one, other in zip(*found, strict=True):
        np.testing.assert_array_equal(one, other)
    sizes.release()


@pytest.mark.parametrize("change", ["size += 1.0", "offset.x = 3", "kind++"])
def test_what_is_changed_in_other_ways_stays_a_block(context, shader, tmp_path, change):
    (tmp_path / "change.comp").write_text(CHANGE.replace("offset.x = 3", change))
    assert not expand("change.comp", {"COUNT": "8u"}, large=["Things"]).texel_buffers


def library_with(context, shader):
    library = ProgramLibrary(context)
    return library, library.compute(shader, DEFINES)


def test_what_has_no_unit_stays_a_block(shader, tmp_path):
    blocks = "".join(f"readonly buffer Block{k} {{ vec4 block{k}[]; }};\n" for k in range(20))
    (tmp_path / "own.comp").write_text(f"#version 430 core\n{blocks}")
    source = expand(shader, reads_texels=True)
    assert list(source.texel_buffers) == [f"Block{k}" for k in range(MAX_IMAGES)]
    assert list(source.blocks) == [f"Block{k}" for k in range(MAX_IMAGES, 20)]


def test_what_is_written_stays_a_block(shader, tmp_path):
    (tmp_path / "own.comp").write_text(
        "#version 430 core\nbuffer Things;\n"
        "writeonly buffer Found { uint found[]; };\n"
        "readonly buffer List { uint count; uint items[]; };\n"
    )
    assert not expand(shader, reads_texels=True).texel_buffers


def test_what_is_asked_for_its_length_stays_a_block(shader, tmp_path):
    text = SHADER.replace("if (index >= COUNT)", "if (index >= pairs.length())")
    (tmp_path / "own.comp").write_text(text)
    assert set(expand(shader, {"COUNT": "8u"}, reads_texels=True).texel_buffers) == {"Things", "Order"}


def test_no_size_asks_for_code_of_its_own():
    sizes = [1 << bits for bits in range(6, 31)]
    for size in [*range(16, 2048, 4), *sizes, *(size + 256 for size in sizes), *(size - 16 for size in sizes)]:
        allocated = allocated_size(size)
        assert size <= allocated <= size + 512
        assert allocated & (allocated - 1) and allocated & 0xFF and allocated & 0xFF00
