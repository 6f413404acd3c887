# SPDX-License-Identifier: GPL-3.0-or-later
"""Functions of shaders that nothing calls."""

from rppm_addon.gl.programs.functions import put_together
from rppm_addon.gl.programs.sources import expand

SHADER = """#version 430 core
#define TWICE(x) twice_of(x)
const float START = start();
float start() { return 1.0; }
float twice_of(float x) { if (x > 0.0) { return 2.0 * x; } return 0.0; }
float unused(float x) { return start() * helper(x); }
float helper(
        float x) {
    if (x > 0.0) {  // as unused() does
        return x;
    }
    return 0.0;
}
#ifdef A
vec3 bright(vec3 color) { return color; }
#else
vec3 bright(float value) {
    return vec3(deep(value));
}
#endif
float deep(float x) { return helper(x); }
float odd(float x) { if (x > 0.0) {
    return x; }
    return 0.0;
}
void main() {
    color = bright(TWICE(1.0));
}
"""


def test_what_main_leads_to_stays_where_it_is():
    text = put_together([SHADER])
    lines = SHADER.replace("  // as unused() does", "").split("\n")
    assert lines.pop(5).startswith("float unused")
    left = text.split("\n")
    assert left.pop(5) == ""
    assert left == lines


def test_what_only_unused_functions_call_goes_with_them():
    text = put_together(["float a() { return b(); }\nfloat b() {\n    return 1.0;\n}\nvoid main() {}\n"])
    assert text == "\n\n\n\nvoid main() {}\n"


def test_files_without_main_stay_whole():
    text = "float a() { return 1.0; }\nfloat b() { return 1.0; }"
    assert put_together([text]) == text


def test_shaders_lose_what_they_do_not_call(tmp_path):
    (tmp_path / "most.glsl").write_text("float least() { return 0.0; }\nfloat most() { return 1.0; }\n")
    path = tmp_path / "main.comp"
    path.write_text(f'#version 430 core\n#include "{tmp_path}/most.glsl"\nvoid main() {{ float x = most(); }}\n')
    text = expand(str(path)).text
    assert "most()" in text and "least()" not in text
    assert "least()" in expand(str(path), whole=True).text
    (number,) = [line.split()[1] for line in text.split("void main")[0].splitlines() if line.endswith(" 0")][-1:]
    assert number == "3"  # of the line behind the include
