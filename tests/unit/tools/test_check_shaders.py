# SPDX-License-Identifier: GPL-3.0-or-later
"""Complaints of `make lint` about long functions in shaders."""

from tools.check_shaders import FUNCTION_LINES, long_functions

_HEADER = "#version 430 core\nstruct Long {\n" + "    float x;\n" * FUNCTION_LINES + "};\n\n"


def function(lines: int, signature: str = "void main()") -> str:
    return signature + " {\n" + "    if (true) {\n    }\n" + "    x += 1.0;\n" * (lines - 4) + "}\n\n"


def test_long_functions_are_named_where_they_begin():
    two_lines = "vec3 other(vec3 position,\n           float x)"
    text = _HEADER + function(FUNCTION_LINES) + function(FUNCTION_LINES + 1, "float f(float x)")
    text += "// f(x) {\n" + function(FUNCTION_LINES + 2, two_lines)
    first = text[: text.index("float f(")].count("\n") + 1
    last = text[: text.index("vec3 other(")].count("\n") + 1
    assert long_functions(text) == [("f", first, FUNCTION_LINES + 1), ("other", last, FUNCTION_LINES + 3)]
