# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether states of renders and their arrays are the same bit for bit, NaNs included."""

import dataclasses
from collections.abc import Mapping

import numpy as np

from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.integrator.state import RenderState
from rppm_addon.scene import Scene


def assert_same_array(mine: np.ndarray, other: np.ndarray, name: str) -> None:
    """Assert that two arrays of 32-bit elements are the same, bit by bit."""
    assert mine.dtype == other.dtype and mine.shape == other.shape, name
    np.testing.assert_array_equal(mine.view(np.uint32), other.view(np.uint32), name)


def assert_same_arrays(mine: Mapping[str, np.ndarray], other: Mapping[str, np.ndarray]) -> None:
    """By name, in the same order."""
    assert list(mine) == list(other)
    for name, values in mine.items():
        assert_same_array(values, other[name], name)


def assert_same_state(mine: RenderState, other: RenderState, *names: str) -> None:
    """All fields, or those of the names."""
    for field in dataclasses.fields(RenderState):
        if names and field.name not in names:
            continue
        a, b = getattr(mine, field.name), getattr(other, field.name)
        if isinstance(a, dict):
            assert_same_arrays(a, b)
        elif isinstance(a, np.ndarray):
            assert_same_array(a, b, field.name)
        else:
            assert a == b, field.name


def assert_goes_on(
    mapper: ProgressivePhotonMapper,
    scene: Scene,
    *names: str,
    iterations: int = 4,
    stops: tuple[int, ...] = (2,),
    other: ProgressivePhotonMapper | None = None,
) -> RenderState:
    """A render that is begun anew from the state after some iterations ends as the one that was not, which it returns.

    names: fields of the states that must be equal, all by default; other: mapper that goes on, by default the same.
    """
    mapper.build(scene)
    states = [run_until(mapper, iteration) for iteration in range(1, iterations + 1)]
    for stop in stops:
        again = other or mapper
        again.build(scene)
        again.resume(states[stop - 1])
        assert_same_state(run_until(again, iterations), states[-1], *names)
    return states[-1]


def run_until(mapper: ProgressivePhotonMapper, iteration: int) -> RenderState:
    while mapper.iteration < iteration:
        mapper.iterate()
    return mapper.state()
