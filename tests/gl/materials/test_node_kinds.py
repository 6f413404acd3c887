# SPDX-License-Identifier: GPL-3.0-or-later
"""All kinds of nodes in the program that resolves hits."""

import pytest
from support.every_node import SOURCES, programs

TEXTS = programs()


@pytest.mark.parametrize("source", SOURCES)
def test_kinds_of_a_file_compile(library, source):
    library.compute("surfaces/resolve/resolve.comp", inserts={"materials/generated.glsl": TEXTS[source]})


def test_kinds_have_no_names_in_common(library):
    """All files in one program: no function or constant may have the name of another's."""
    text = "".join(f'#include "materials/nodes/{source}"\n' for source in SOURCES)
    text += "void evaluate_material(Surface surface, uint first, inout ClosureBuilder builder) {}\n"
    library.compute("surfaces/resolve/resolve.comp", inserts={"materials/generated.glsl": text})
