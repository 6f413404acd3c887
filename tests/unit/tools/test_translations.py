# SPDX-License-Identifier: GPL-3.0-or-later
"""Texts of the interface are literals, or templates that Blender translates before values are put into them."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
FILES = sorted((ROOT / "rppm_addon" / "blender").rglob("*.py"))
_FIRST_TEXTS = {"reading": 1, "paragraph": 1, "draw_setting": 3}
"""Functions of RPPM whose arguments are shown from one on; of Blender's, ``text`` and ``heading`` are."""


def name_of(call: ast.Call) -> str:
    return getattr(call.func, "attr", getattr(call.func, "id", ""))


def is_literal(node: ast.expr) -> bool:
    if isinstance(node, ast.IfExp):
        return is_literal(node.body) and is_literal(node.orelse)
    return isinstance(node, ast.Constant)


def has_words(node: ast.expr) -> bool:
    """Whether an f-string has letters of its own."""
    parts = node.values if isinstance(node, ast.JoinedStr) else []
    return any(isinstance(part, ast.Constant) and any(map(str.isalpha, part.value)) for part in parts)


def untranslatable(tree: ast.AST) -> list[int]:
    """Lines of calls that show a text which Blender cannot find among its translations, or would look up wrongly."""
    lines = set()
    for call in (node for node in ast.walk(tree) if isinstance(node, ast.Call)):
        keywords = {keyword.arg: keyword.value for keyword in call.keywords}
        first = _FIRST_TEXTS.get(name_of(call), len(call.args))
        shown = [*call.args[first:], *(keywords[name] for name in ("text", "heading") if name in keywords)]
        lines |= {call.lineno for node in shown if has_words(node)}
        if name_of(call) == "label" and "text" in keywords and not is_literal(keywords["text"]):
            is_from_table = isinstance(keywords["text"], ast.Name | ast.Subscript)  # of literals
            if "translate" not in keywords and not is_from_table:
                lines.add(call.lineno)
        if name_of(call) == "report" and ast.unparse(call.func) == "self.report":
            lines |= {call.lineno for node in call.args if has_words(node)}
    return sorted(lines)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_texts_can_be_translated(path):
    assert untranslatable(ast.parse(path.read_text(encoding="utf-8"))) == []


@pytest.mark.parametrize(
    "text",
    [
        'layout.label(text=f"{count} more")',
        "layout.label(text=thing.name)",
        'reading(column, "Samples", f"{done} of {all}")',
        "self.report({'ERROR'}, f'{path} is not there')",
    ],
)
def test_texts_that_cannot_are_found(text):
    assert untranslatable(ast.parse(text)) == [1]
