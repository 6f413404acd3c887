# SPDX-License-Identifier: GPL-3.0-or-later
"""Long functions of nodes, in pieces that drivers compile one by one.

What drivers do with code that runs straight on grows with the square of its length: of 1,000 vector nodes llvmpipe
makes code for minutes, in pieces for seconds. A loop ends such a piece; that it has one round they cannot know.
"""

import re
from collections.abc import Iterator, Sequence

PIECE = 32
"""Statements; shorter and longer ones than 16 to 64 take longer."""
_BEGIN = "for (uint once = 0u; once < uint(first != 0xFFFFFFFFu); ++once) {"
"""``first``, where the material's constants begin, is known to all functions of nodes."""
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
    for first in range(0, len(statements), PIECE):
        piece = [line for statement in statements[first : first + PIECE] for line in statement]
        declared += [_BEGIN, *(f"    {line}" for line in piece), "}"]
    return declared


def _statements(lines: Sequence[str]) -> Iterator[list[str]]:
    """The lines of each; what braces hold together is one."""
    statement, depth = list[str](), 0
    for line in lines:
        statement.append(line)
        depth += line.count("{") - line.count("}")
        if depth == 0:
            yield statement
            statement = []
