# SPDX-License-Identifier: GPL-3.0-or-later
"""Storage blocks: declared once, and no more of them in a stage than every driver offers."""

import collections
import re
from pathlib import Path

import pytest
from support.shader_declarations import variants

from rppm_addon.gl.buffers.records import Record
from rppm_addon.gl.buffers.storage_blocks import StorageBlock
from rppm_addon.gl.context.requirements import NEEDS, refuse_small_devices
from rppm_addon.gl.programs import sources
from rppm_addon.gl.programs.sources import SHADER_FOLDER, ShaderError, expand
from rppm_addon.scene.errors import DeviceError

MOST_BLOCKS = 16
"""In one stage: what every driver tried so far offers, and bindings 0 to 15."""


@pytest.fixture
def shader(tmp_path, monkeypatch):
    """A shader of a text."""
    monkeypatch.setattr(sources, "SHADER_FOLDER", tmp_path)
    for kind in (Record, StorageBlock):
        monkeypatch.setattr(kind, "registry", {})

    def write(text: str) -> str:
        (tmp_path / "own.comp").write_text(text)
        return "own.comp"

    return write


def test_members_and_records_come_with_the_name(shader):
    Record("Dot", place="vec3")
    StorageBlock("Dots", "Dot dots[];")
    source = expand(shader("readonly buffer Dots;  // all\nvoid main() {}\n"))
    assert source.text.splitlines() == [
        "struct Dot { vec3 place; }; layout(std430, binding = 0) readonly buffer Dots { Dot dots[]; };",
        "void main() {}",
    ]
    assert source.blocks == {"Dots": 0}


def test_names_get_numbers_in_their_order(shader):
    StorageBlock("Dots", "vec4 dots[];")
    source = expand(
        shader(
            "uniform Parameters { vec4 parameters; };\nuniform sampler2D first;\nuniform sampler2D second;\n"
            "writeonly buffer Found {\n    uint found[];\n};\n"
            "#ifdef ABSENT\nbuffer Dots;\n#else\nbuffer Dots;\n#endif\n"
            "restrict readonly buffer Others { uint others[]; };\n"
        )
    )
    assert source.blocks == {"Found": 0, "Dots": 1, "Others": 2}
    assert source.textures == {"first": 0, "second": 1}
    assert "layout(std140, binding = 0) uniform Parameters {" in source.text


def test_both_stages_of_a_program_have_the_same_numbers(shader):
    StorageBlock("Dots", "vec4 dots[];")
    vertex = expand(shader("buffer Others { uint others[]; };\nbuffer Dots;\n"))
    fragment = expand(shader("buffer Third { uint third; };\nbuffer Dots;\n"), beside=vertex)
    assert (vertex.blocks, fragment.blocks) == ({"Others": 0, "Dots": 1}, {"Third": 2, "Dots": 1})


def test_a_struct_comes_once(shader):
    Record("Dot", place="vec3")
    StorageBlock("Dots", "Dot dots[];")
    StorageBlock("Others", "Dot others[];")
    text = "#include <Dot>\nbuffer Dots;\nbuffer Others;\n"
    assert expand(shader(text)).text.count("struct Dot") == 1


def test_unknown_block(shader):
    with pytest.raises(ShaderError, match="own.comp:2: there is no storage block Dots"):
        expand(shader("\nbuffer Dots;\n"))


def test_one_name_has_one_meaning(shader):
    StorageBlock("Dots", "vec4 dots[];")
    StorageBlock("Dots", "vec4 dots[];")
    with pytest.raises(ValueError, match="Dots"):
        StorageBlock("Dots", "vec3 dots[];")


def test_no_block_is_spelled_out_twice():
    spelled = re.compile(r"\bbuffer\s+(\w+)\s*\{")
    counts = collections.Counter(
        name for path in SHADER_FOLDER.rglob("*.*") for name in spelled.findall(path.read_text(encoding="utf-8"))
    )
    variants()  # declares all
    assert not {name for name, count in counts.items() if count > 1 or name in StorageBlock.registry}


def test_every_block_is_in_use():
    text = "".join(path.read_text(encoding="utf-8") for path in SHADER_FOLDER.rglob("*.*"))
    variants()  # declares all
    assert not {name for name in StorageBlock.registry if not re.search(rf"\bbuffer\s+{name};", text)}


STAGES = {"comp": "COMPUTE", "frag": "FRAGMENT", "vert": "VERTEX"}


def test_needs_are_those_of_the_shaders():
    needed = collections.Counter()
    for variant in variants():
        source = variant.expand()
        stage = f"GL_MAX_{STAGES[Path(variant.name).suffix[1:]]}_SHADER_STORAGE_BLOCKS"
        needed[stage] = max(needed[stage], len(source.blocks))
        if variant.name.endswith(".comp"):
            assert source.local_size <= 1024, variant.name
        texels = [line for line in source.text.splitlines() if re.search(r"uniform [iu]?image", line)]
        # Those of software drivers, and those for which programs have no storage block left.
        known = "C|MediumVoxels;|PhaseFunctions;|EmitterInstances;"
        assert all(re.search(rf"uniform uimageBuffer ({known})", line) for line in texels)
        assert all(int(unit) < 16 for unit in re.findall(r"binding = (\d+)\) uniform \w*sampler", source.text))
    drawn = needed["GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS"] + needed["GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS"]
    together = max(needed["GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS"], drawn)
    needed["GL_MAX_COMBINED_SHADER_STORAGE_BLOCKS"] = together
    needed["GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS"] = together
    assert {limit: least for limit, (least, _) in NEEDS.items()} == needed
    assert max(needed.values()) <= MOST_BLOCKS


@pytest.mark.parametrize("limit", NEEDS)
def test_a_device_that_offers_less_is_refused_in_one_line(limit):
    offered = {name: least for name, (least, _) in NEEDS.items()}
    refuse_small_devices("Old Card", offered)
    refuse_small_devices("Silent Card", {})
    offered[limit] -= 1
    with pytest.raises(
        DeviceError, match=rf"Old Card offers {offered[limit]} .*RPPM needs {NEEDS[limit][0]}"
    ) as raised:
        refuse_small_devices("Old Card", offered)
    assert "\n" not in str(raised.value)
