# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs linked past moderngl, and what drivers say of them."""

import logging
import uuid

import pytest

from rppm_addon.gl.programs.linking import Linker
from rppm_addon.gl.programs.sources import CompileError, Source

_HEAD = """#version 430 core
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Values { uint values[]; };
"""


def source(body, name="values.comp"):
    return Source(f"{_HEAD}{body}\n", [name])


@pytest.fixture
def program(context):
    program = context.moderngl.compute_shader("#version 430 core\nlayout(local_size_x = 1) in;\nvoid main() {}\n")
    yield program
    program.release()


def test_a_program_is_linked_anew_in_place_of_what_it_was(context, program):
    linker, values = Linker(context), context.moderngl.buffer(bytes(4))
    for expected in (7, 9):
        linker.link(program.glo, [source(f"void main() {{ values[0] = {expected}u; }}")])
        values.bind_to_storage_buffer(0)
        program.run(1)
        context.barrier()
        assert int.from_bytes(values.read(), "little") == expected
    values.release()


def test_what_is_refused_names_file_and_line(context, program):
    with pytest.raises(CompileError, match=r"values\.comp:4"):
        Linker(context).link(program.glo, [source("void main() { values[0] = absent; }")])


def test_what_the_link_refuses_names_the_file(context, program):
    with pytest.raises(CompileError, match=r"values\.comp: "):
        Linker(context).link(program.glo, [source("void absent(); void main() { absent(); }")])


def test_what_the_driver_says_is_logged_unless_it_is_a_false_alarm(context, program, caplog, monkeypatch):
    """The false alarm is Mesa's for a variable of the whole shader, which main sets before it calls the function."""
    caplog.set_level(logging.DEBUG, "rppm_addon")
    own = source("uint own; void set() { values[0] = own; } void main() { own = 1u; set(); }")
    Linker(context).link(program.glo, [own])
    assert all(record.levelno < logging.WARNING for record in caplog.records)
    text = _HEAD.replace("core\n", "core\n#extension GL_AN_extension_that_is_not_there : warn\n")
    text += f"void main() {{}} // {uuid.uuid4()}\n"  # of a text that it has compiled before Mesa says nothing
    Linker(context).link(program.glo, [Source(text, ["values.comp"])])
    warnings = [record for record in caplog.records if record.levelno == logging.WARNING]
    assert len(warnings) == 1 and warnings[0].getMessage().startswith("values.comp: ")
