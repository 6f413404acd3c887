# SPDX-License-Identifier: GPL-3.0-or-later
"""The GL layer against what the driver itself says."""

import itertools

import numpy as np
import pytest

from rppm_addon.gl.buffers.buffers import GrowingBuffer
from rppm_addon.gl.buffers.records import Record
from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs import binary_cache, sources
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.integrator import stage_set  # noqa: F401  registers the records
from rppm_addon.scene.errors import DeviceError

KINDS = ("float", "uint", "int", "vec2", "vec3", "vec4", "uvec2", "uvec3", "uvec4", "ivec2", "ivec3", "ivec4", "mat4")
BASE = {"f": "float", "u": "uint", "i": "int"}


def component_expressions(name: str, kind: str) -> list[tuple[str, str]]:
    """GLSL expression and bit cast to uint of each 32-bit component of a member, in NumPy's order."""
    scalar = {"u": "uint", "i": "int"}.get(kind[0], "float")
    if kind == "mat4":
        # a GLSL matrix is indexed by column: the stored order is column by column
        parts = [f"{name}[{c}][{r}]" for c, r in itertools.product(range(4), range(4))]
        return [(part, "float") for part in parts]
    if kind[-1].isdigit():
        return [(f"{name}.{'xyzw'[i]}", scalar) for i in range(int(kind[-1]))]
    return [(name, scalar)]


def member_expressions(name: str, record: Record) -> list[tuple[str, str]]:
    """The same of all members of a record, those of arrays of others part by part."""
    found = []
    for member in record.members:
        names = [f"{name}.{member.name}[{k}]" for k in range(member.count)]
        found += [e for part in names for e in member_expressions(part, Record.registry[member.kind])]
        found += [] if names else component_expressions(f"{name}.{member.name}", member.kind)
    return found


def columns(array: np.ndarray) -> list[np.ndarray]:
    """Views of an array's members in that order."""
    if array.dtype.names is None:
        return [array]
    parts = array.reshape(len(array), -1).T
    return [column for part in parts for name in array.dtype.names for column in columns(part[name])]


def words(column: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(column).reshape(len(column), -1).view(np.uint32)


def to_uint(expression: str, scalar: str) -> str:
    return {"float": f"floatBitsToUint({expression})", "int": f"uint({expression})", "uint": expression}[scalar]


def from_uint(expression: str, scalar: str) -> str:
    return {"float": f"uintBitsToFloat({expression})", "int": f"int({expression})", "uint": expression}[scalar]


def all_records() -> list[Record]:
    rng = np.random.default_rng(3)
    members = [{f"m{i}": str(rng.choice(KINDS)) for i in range(int(rng.integers(1, 9)))} for n in range(12)]
    made = [Record(f"Random{n}", **kinds) for n, kinds in enumerate(members)]
    return made + [r for name, r in Record.registry.items() if not name.startswith("Random")]


@pytest.mark.parametrize("record", all_records(), ids=lambda record: record.name)
def test_record_layouts_agree_both_ways(context, record):
    """NumPy writes, GLSL reads every component and writes it to a plain list; and back."""
    count = 5
    parts = member_expressions("records[i]", record)
    reads = "".join(f"flat_list[i * {len(parts)}u + {k}u] = {to_uint(e, s)};" for k, (e, s) in enumerate(parts))
    writes = "".join(f"{e} = {from_uint(f'flat_list[i * {len(parts)}u + {k}u]', s)};" for k, (e, s) in enumerate(parts))
    head = f"""#version 430 core
layout(local_size_x = 1) in;
{"".join(part.glsl() for part in record.parts)} {record.glsl()}
layout(std430, binding = 0) buffer Records {{ {record.name} records[]; }};
layout(std430, binding = 1) buffer Flat {{ uint flat_list[]; }};
void main() {{ uint i = gl_GlobalInvocationID.x; """
    gl = context.moderngl
    rng = np.random.default_rng(1)
    array = record.zeros(count)
    for column in columns(array):  # small whole numbers survive every cast exactly
        column[...] = rng.integers(1, 1000, column.shape)
    stored = gl.buffer(array.tobytes())
    listed = gl.buffer(reserve=4 * count * len(parts))
    stored.bind_to_storage_buffer(0)
    listed.bind_to_storage_buffer(1)
    gl.compute_shader(head + reads + "}").run(count)
    context.barrier()
    got = np.frombuffer(listed.read(), np.uint32).reshape(count, len(parts))
    expected = np.concatenate([words(column) for column in columns(array)], axis=1)
    np.testing.assert_array_equal(got, expected)
    stored.write(bytes(record.size * count))
    gl.compute_shader(head + writes + "}").run(count)
    context.barrier()
    back = np.frombuffer(stored.read(), record.dtype)
    for read, written in zip(columns(back), columns(array), strict=True):
        np.testing.assert_array_equal(read, written)


@pytest.fixture
def shader_folder(tmp_path, monkeypatch):
    monkeypatch.setattr(sources, "SHADER_FOLDER", tmp_path)
    monkeypatch.setenv("RPPM_CACHE", str(tmp_path / "cache"))
    return tmp_path


ONES, UNTURNED = np.ones((4, 4)), np.eye(4)
SCALE = Record("ScaleParameters", factor="float", offset="vec3", turn="mat4")
PROGRAM = """#version 430 core
layout(local_size_x = 4) in;
#include <ScaleParameters>
uniform Parameters { ScaleParameters parameters; };
buffer Values { vec4 values[]; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    values[i] = vec4(parameters.offset, 0.0) + parameters.factor * (parameters.turn * values[i]);
}
"""


@pytest.fixture
def scaled(context, shader_folder):
    """Function that runs a program of a library on points (4, 4), and returns where these come to lie."""
    (shader_folder / "scale.comp").write_text(PROGRAM)

    def scale(library, points=ONES, factor=1.0, offset=(0, 0, 0), turn=UNTURNED, defines=None):
        buffer = context.moderngl.buffer(points.astype(np.float32).tobytes())
        program, parameters = library.compute("scale.comp", defines), {"factor": factor, "offset": offset, "turn": turn}
        program.run(4, {"Values": buffer}, parameters)
        return np.frombuffer(buffer.read(), np.float32).reshape(4, 4)

    return scale


def test_parameters_reach_the_shader_and_binaries_are_kept(context, scaled):
    turn = np.arange(16.0).reshape(4, 4)
    points = np.random.default_rng(0).integers(0, 9, (4, 4))
    for _ in range(2):  # the second library reads the binary that the first one kept
        library = ProgramLibrary(context)
        np.testing.assert_allclose(scaled(library, points, 2.0, (1, 2, 3), turn), [1, 2, 3, 0] + 2 * points @ turn.T)
        library.release()
    kept = list(binary_cache.cache_folder().glob("*.bin"))
    assert len(kept) == (1 if context.has_program_binaries else 0)


def test_programs_are_told_of_before_they_first_run(context, scaled):
    library, told = ProgramLibrary(context), []
    library.on_start = lambda name: told.append((library.started, library.made, name))
    for defines in (None, {"UNUSED": 1}):
        library.compute("scale.comp", defines)
    assert told == []
    for defines in ({"UNUSED": 1}, None, {"UNUSED": 1}):
        scaled(library, defines=defines)
    assert told == [(1, 2, "scale"), (2, 2, "scale")]
    library.release()


def test_programs_that_have_run_are_compiled(context, scaled):
    library = ProgramLibrary(context)
    assert library.compilation_work() == (0, 0)
    library.compute("scale.comp")
    library.compute("scale.comp", {"UNUSED": 1})
    known = library.compilation_work().known
    assert known > 0
    scaled(library)
    assert library.compilation_work().compiled > 0 and library.compilation_work().known == known
    scaled(library, defines={"UNUSED": 1})
    assert library.compilation_work() == (known, known)
    library.release()


def test_a_spoiled_binary_is_compiled_again(context, scaled):
    scaled(ProgramLibrary(context))
    for path in binary_cache.cache_folder().glob("*.bin"):
        path.write_bytes(path.read_bytes()[:40])
    assert np.all(scaled(ProgramLibrary(context), factor=3.0) == 3.0)


def test_compile_errors_name_our_file_and_line(context, shader_folder):
    (shader_folder / "part.glsl").write_text("float good() { return 1.0; }\n\nfloat bad() { return missing_name; }\n")
    (shader_folder / "main.comp").write_text(
        '#version 430 core\nlayout(local_size_x = 1) in;\n#include "part.glsl"\nvoid main() { bad(); }\n'
    )
    with pytest.raises(sources.ShaderError, match=r"part\.glsl:3"):
        ProgramLibrary(context).compute("main.comp").run(1, {})
    (shader_folder / "main.comp").write_text(
        "#version 430 core\nlayout(local_size_x = 1) in;\n#include <Ray>\n\nvoid main() { wrong(); }\n"
    )
    with pytest.raises(sources.ShaderError, match=r"main\.comp:5"):
        ProgramLibrary(context).compute("main.comp", {"ANY": 1}).run(1, {})


@pytest.mark.parametrize("line", ['#include "absent.glsl"', "#include <AbsentRecord>"])
def test_missing_includes_name_the_line(shader_folder, line):
    (shader_folder / "main.comp").write_text(f"#version 430 core\n{line}\n")
    with pytest.raises(sources.ShaderError, match=r"main\.comp:2"):
        sources.expand("main.comp")


def test_a_forgotten_buffer_is_an_error(context, shader_folder):
    (shader_folder / "scale.comp").write_text(PROGRAM)
    with pytest.raises(ValueError, match="Values"):
        ProgramLibrary(context).compute("scale.comp").run(4, {}, {"factor": 1.0})


def test_growing_buffers_keep_to_the_limit(context):
    buffer = GrowingBuffer(context, "test buffer", remedy="take less")
    assert buffer.require(1000) and not buffer.require(500)
    with pytest.raises(DeviceError, match="test buffer needs .* MiB .*take less"):
        buffer.require(context.storage_block_limit + 1)
    buffer.upload(np.arange(5, dtype=np.uint32))
    np.testing.assert_array_equal(buffer.read(np.uint32, 5), np.arange(5))


def test_a_driver_without_memory_is_an_error_and_the_next_buffer_is_made(context, monkeypatch):
    monkeypatch.setattr(GrowingBuffer, "limit", 1 << 41)
    monkeypatch.setattr(Context, "available_memory", None)
    buffer = GrowingBuffer(context, "photons", "emit fewer")
    with pytest.raises(DeviceError, match="^photons needs 1048576 MiB, which the device does not have; emit fewer$"):
        buffer.require(1 << 40)
    assert buffer.size == 0 and not context.lacks_memory
    assert buffer.require(1 << 10) and buffer.size == 1 << 10
    context.moderngl.buffer(reserve=1 << 40)  # which moderngl says nothing of
    with pytest.raises(DeviceError, match="has run out of memory; lower"):
        buffer.require(1 << 11)
    buffer.release()


def test_a_buffer_larger_than_the_memory_left_is_an_error_in_time(context, monkeypatch):
    assert context.available_memory is None or context.available_memory > 1 << 20
    buffer = GrowingBuffer(context, "rocks", "carry fewer")
    buffer.require(1 << 10)
    monkeypatch.setattr(Context, "available_memory", 3 << 20)
    with pytest.raises(DeviceError, match="rocks needs 8 MiB but the device .* has 3 MiB left; carry fewer"):
        buffer.require(8 << 20)
    assert buffer.size == 1 << 10  # what there was is kept
    assert buffer.require(2 << 20)
    buffer.release()


HALF = (sources.SHADER_FOLDER / "common" / "half.glsl").read_text()
HALVES = """#version 430 core
layout(local_size_x = 64) in;
#include "half.glsl"
readonly buffer Words { uint words[]; };
writeonly buffer Unpacked { vec2 unpacked[]; };
void main() { unpacked[gl_GlobalInvocationID.x] = two_halves(words[gl_GlobalInvocationID.x]); }
"""


def test_every_half_is_the_float_that_numpy_has(context, shader_folder):
    (shader_folder / "half.glsl").write_text(HALF)
    (shader_folder / "all.comp").write_text(HALVES)
    halves = np.arange(1 << 16, dtype=np.uint16)
    words, unpacked = context.moderngl.buffer(halves.tobytes()), context.moderngl.buffer(reserve=4 << 16)
    ProgramLibrary(context).compute("all.comp").run(1 << 15, {"Words": words, "Unpacked": unpacked})
    found, expected = np.frombuffer(unpacked.read(), np.float32), halves.view(np.float16).astype(np.float32)
    numbers = ~np.isnan(expected)
    np.testing.assert_array_equal(found.view(np.uint32)[numbers], expected.view(np.uint32)[numbers])
    assert np.isnan(found[~numbers]).all()
