# SPDX-License-Identifier: GPL-3.0-or-later
"""Handlers of Blender's events, added and removed together."""

from collections.abc import Callable, Iterable

Handler = tuple[list[Callable[..., None]], Callable[..., None]]
"""A list of bpy.app.handlers and the function that the list is to hold."""


def add_handlers(pairs: Iterable[Handler]) -> None:
    """Add each function to its list of handlers."""
    for handlers, function in pairs:
        handlers.append(function)


def remove_handlers(pairs: Iterable[Handler]) -> None:
    """Remove each function from its list of handlers. Raises ValueError if one is not in its list."""
    for handlers, function in pairs:
        handlers.remove(function)
