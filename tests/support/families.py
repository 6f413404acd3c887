# SPDX-License-Identifier: GPL-3.0-or-later
"""Families of tests of which some run each time."""

from collections.abc import Callable, Iterable

import pytest


def some_each_time(values: Iterable, each_time: Callable[..., bool]) -> list:
    """Values, or tuples of values, as parameters of a test; with the long tests those of which it is not true that they
    are tried each time (CONTRIBUTING.md)."""
    every = [value if isinstance(value, tuple) else (value,) for value in values]
    return [pytest.param(*value, marks=[] if each_time(*value) else [pytest.mark.long]) for value in every]
