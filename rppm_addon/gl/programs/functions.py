# SPDX-License-Identifier: GPL-3.0-or-later
"""Functions of shaders: those that nothing calls are left out.

Files are included for a few of their functions, and drivers read all: of the program of a plain material 330, of which
it calls 90, half of the time to link it.
"""

import functools
import re
from collections.abc import Iterable
from dataclasses import dataclass

# At the beginning of a line; its end is that of the first line, or the first brace behind that begins one.
_FUNCTION = re.compile(
    r"^(?:\w+ )+(\w+)\([^(){};]*\)\s*\{(?:[^\n]*\}[^\S\n]*$|[^\n{}]*$.*?^\}[^\S\n]*$)", re.MULTILINE | re.DOTALL
)
_COMMENT = re.compile(r"[^\S\n]*//[^\n]*")
_WORD = re.compile(r"[A-Za-z_]\w*")


@dataclass(frozen=True)
class _Piece:
    """A part of a shader's text, and the words that it consists of."""

    text: str
    words: frozenset[str]
    function: str = ""
    """Its name, where the piece is a function and nothing else."""


@functools.lru_cache(maxsize=4096)
def _pieces(text: str) -> tuple[_Piece, ...]:
    """A text in pieces that, put together by newlines, are the text without its comments."""
    text = _COMMENT.sub("", text)
    found, begin = [], 0
    for match in _FUNCTION.finditer(text):
        if match[0].count("{") != match[0].count("}"):
            continue  # it ends elsewhere, and stays
        if match.start() > begin:
            found.append(_piece(text[begin : match.start() - 1]))
        found.append(_piece(match[0], match[1]))
        begin = match.end() + 1
    if begin <= len(text):
        found.append(_piece(text[begin:]))
    return tuple(found)


def _piece(text: str, function: str = "") -> _Piece:
    return _Piece(text, frozenset(_WORD.findall(text)), function)


def put_together(parts: Iterable[str], whole: bool = False) -> str:
    """The parts of a shader but for comments and for functions that main and what is no function do not lead to, whose
    lines are empty. whole: with these; so it is where there is no main.
    """
    shader = [piece for part in parts for piece in _pieces(part)]
    words_by_function: dict[str, frozenset[str]] = {}
    reached = {"main"}
    for piece in shader:
        if piece.function:  # several have one name
            words_by_function[piece.function] = words_by_function.get(piece.function, frozenset()) | piece.words
        else:
            reached |= piece.words
    reached &= words_by_function.keys()
    waiting = list(reached)
    while waiting:
        called = words_by_function[waiting.pop()] & words_by_function.keys() - reached
        reached |= called
        waiting += called
    whole = whole or "main" not in words_by_function
    return "\n".join(
        piece.text if whole or not piece.function or piece.function in reached else "\n" * piece.text.count("\n")
        for piece in shader
    )
