# SPDX-License-Identifier: GPL-3.0-or-later
"""Docstrings that leave their reader to guess are found, wherever they stand."""

import pytest

from tools.check_docstrings import riddles


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ('"""Photons of an iteration."""\n', []),
        ('"""Of an iteration, the photons."""\n', [1]),
        ('def count():\n    """What is stored."""\n', [2]),
        ('class Path:\n    """A path."""\n\n    depth = 0\n    """\n    Those of its bounces.\n    """\n', [5]),
        ("LEAST = 1\n'''That are tried.'''\n", [2]),
        ('"""Whatever a path carries, and Ofsted."""\nname = "Of"\n', []),
    ],
)
def test_riddles(text, lines):
    assert [line for line, _ in riddles(text)] == lines
