# SPDX-License-Identifier: GPL-3.0-or-later
"""Values that are there only once something has come before."""

from typing import TypeVar

Value = TypeVar("Value")


def require(value: Value | None) -> Value:
    """A value that is there by now, as what was built of a scene. RuntimeError where it is not: a call was left out."""
    if value is None:
        raise RuntimeError("this is known only once a scene was built, and iterations are run")
    return value
