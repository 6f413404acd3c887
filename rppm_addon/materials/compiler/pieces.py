# SPDX-License-Identifier: GPL-3.0-or-later
"""Long functions of nodes, in pieces that drivers compile one by one.

What drivers do with code that runs straight on grows faster than its length, and each place that reads a constant is
long. A loop ends a piece; that it has one round they cannot know. Its constants are read in one place, to an array.
docs/reliability.md has figures.
"""

import re
from collections.abc import Iterator, Sequence

PIECE = 32
"""Statements, at least: 12 and less take longer."""
MAX_PIECES = 32
"""Maximum number of pieces of a function: llvmpipe's work on loops grows with the square of their number."""
_MAX_HELD = 16
"""Constants a statement that are held in an array; nodes that others were made between may be far apart."""
_BEGIN = "for (uint once = 0u; once < uint(first != 0xFFFFFFFFu); ++once) {"
"""``first``, where the material's constants begin, is known to all functions of nodes."""
_CONSTANT = re.compile(r"constant_(float|vec3)\(first \+ (\d+)u\)")
_SIZES = {"float": 1, "vec3": 3}
_DECLARATION = re.compile(r"(float|vec3) (\w+)(?: = (.*))?;")


def in_pieces(lines: Sequence[str]) -> list[str]:
    """Lines of a function's body that do the same; those of a short one stay."""
    declared, statements = list[str](), list[list[str]]()
    for statement in _statements(lines):
        match = _DECLARATION.fullmatch(statement[0])
        if match is None:
            statements.append(statement)
            continue
        kind, name, value = match.groups()
        declared.append(f"{kind} {name};")
        if value is not None:
            statements.append([f"{name} = {value};"])
    if len(statements) <= 2 * PIECE:
        return list(lines)
    length = max(PIECE, -(-len(statements) // MAX_PIECES))
    starts = range(0, len(statements), length)
    pieces = [[line for statement in statements[k : k + length] for line in statement] for k in starts]
    ranges = [_constants(piece, _MAX_HELD * length) for piece in pieces]
    declared.append(f"float held[{max(1, *(count for _, count in ranges))}];")
    for piece, (lowest, count) in zip(pieces, ranges, strict=True):
        declared += [_BEGIN, *(f"    {line}" for line in _with_held_constants(piece, lowest, count)), "}"]
    return declared


def _constants(lines: Sequence[str], most: int) -> tuple[int, int]:
    """The first of the constants that lines read, and how many there are from it to the last; 0 where these are more
    than may be held."""
    places = [(int(place), _SIZES[kind]) for line in lines for kind, place in _CONSTANT.findall(line)]
    lowest = min((place for place, _ in places), default=0)
    count = max((place + size for place, size in places), default=0) - lowest
    return lowest, count if count <= most else 0


def _with_held_constants(lines: Sequence[str], lowest: int, count: int) -> list[str]:
    """The lines with their constants read in one place, in a loop, before."""
    if count == 0:
        return list(lines)

    def held(match: re.Match) -> str:
        at = int(match[2]) - lowest
        return f"held[{at}]" if match[1] == "float" else f"vec3({', '.join(f'held[{at + k}]' for k in range(3))})"

    return [
        f"for (uint k = 0u; k < (first != 0xFFFFFFFFu ? {count}u : 0u); ++k) "
        f"held[k] = constant_float(first + {lowest}u + k);",
        *(_CONSTANT.sub(held, line) for line in lines),
    ]


def _statements(lines: Sequence[str]) -> Iterator[list[str]]:
    """The lines of each; what braces hold together is one."""
    statement, depth = list[str](), 0
    for line in lines:
        statement.append(line)
        depth += line.count("{") - line.count("}")
        if depth == 0:
            yield statement
            statement = []
