# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that sources include by a define."""

import pytest

from rppm_addon.gl.programs import sources
from rppm_addon.gl.programs.sources import ShaderError, expand


@pytest.fixture
def shader(tmp_path, monkeypatch):
    """A shader of a line, beside two folders with a file each."""
    monkeypatch.setattr(sources, "SHADER_FOLDER", tmp_path)
    for folder in ("one", "two"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "part.glsl").write_text(f"int {folder};\n")

    def write(line: str) -> str:
        (tmp_path / "own.comp").write_text(f"#version 430 core\n{line}\nvoid main() {{}}\n")
        return "own.comp"

    return write


def test_a_file_by_its_define(shader):
    name = shader("#include PART")
    assert "int two;" in expand(name, {"PART": "two/part.glsl"}, whole=True).text
    with pytest.raises(ShaderError, match="own.comp:2: PART is not defined"):
        expand(name)


def test_a_file_in_place_of_one_that_is_there_otherwise(shader):
    name = shader('#include PARTS "one/part.glsl"')
    plain, other = expand(name, whole=True).text, expand(name, {"PARTS": "two"}, whole=True).text
    assert "int one;" in plain and "int two;" not in plain
    assert "int two;" in other and "int one;" not in other
