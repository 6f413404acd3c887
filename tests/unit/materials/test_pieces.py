# SPDX-License-Identifier: GPL-3.0-or-later
"""Long functions of nodes in pieces."""

import re

from support.graphs import chain

from rppm_addon.materials.compiler.compiler import compile_graph
from rppm_addon.materials.compiler.pieces import PIECE, in_pieces
from rppm_addon.scene import NodeGraph


def test_short_functions_stay():
    lines = [line for number in range(2 * PIECE) for line in (f"float n{number};", f"node(n{number});")]
    assert in_pieces(lines) == lines


def test_long_ones_declare_first_and_do_the_same_in_the_same_order():
    lines = ["surface.normal = material_normal(surface, first);"]
    for number in range(PIECE):
        lines += [f"vec3 n{number};", f"node(n{number});", f"float w{number} = n{number}.x + 1.0;"]
        lines += ["{ vec3 inside;", "  for (int k = 0; k < 3; ++k) {", "    float height = inside.x;", "  } }"]
    made = in_pieces(lines)
    count = 1 + 3 * PIECE
    assert made.pop(2 * PIECE) == "float held[1];"
    assert made[: 2 * PIECE] == [f"{kind}{n};" for n in range(PIECE) for kind in ("vec3 n", "float w")]
    assert sum("once" in line for line in made) == -(-count // PIECE)
    kept = [line.removeprefix("    ") for line in made[2 * PIECE :] if "once" not in line and line != "}"]
    expected = [re.sub(r"^float (w\d+ = )", r"\1", line) for line in lines if not line.startswith("vec3 n")]
    assert kept == expected
    assert "\n".join(made).count("{") == "\n".join(made).count("}")


def test_constants_are_read_in_one_place_of_a_piece():
    count = 3 * PIECE
    lines = []
    for number in range(count):
        values = f"constant_float(first + {4 * number}u), constant_vec3(first + {4 * number + 1}u)"
        lines += [f"float n{number};", f"node({values}, n{number});"]
    text = "\n".join(in_pieces(lines))
    assert f"float held[{4 * PIECE}];" in text and text.count("constant_float(first") == 3
    assert "constant_vec3" not in text and f"k < (first != 0xFFFFFFFFu ? {4 * PIECE}u : 0u)" in text
    assert f"constant_float(first + {4 * PIECE}u + k)" in text
    assert f"node(held[4], vec3(held[5], held[6], held[7]), n{PIECE + 1});" in text
    far = ["float m;", "node(constant_float(first + 100000u), m);", *lines]
    assert "constant_float(first + 100000u), m)" in "\n".join(in_pieces(far))  # for which no array would do


def test_graphs_of_usual_length_are_as_they_were():
    graph = NodeGraph()
    graph.surface = graph.add("emission", "emission", color=chain(graph, 30))
    assert "once" not in compile_graph(graph).text
