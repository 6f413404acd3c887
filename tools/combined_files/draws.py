# SPDX-License-Identifier: GPL-3.0-or-later
"""Random choices that a seed determines."""

import colorsys
import random
from collections.abc import Sequence
from typing import TypeVar

T = TypeVar("T")


class Draws(random.Random):
    """A generator of the parameters of a file."""

    def between(self, low: float, high: float) -> float:
        """A number from a range, all equally likely."""
        return self.uniform(low, high)

    def maybe(self, probability: float = 0.5) -> bool:
        """True with a probability."""
        return self.random() < probability

    def pick(self, choices: Sequence[T]) -> T:
        """One of the choices."""
        return self.choice(choices)

    def vector(self, low: float, high: float) -> tuple[float, float, float]:
        """Three numbers from a range."""
        return (self.uniform(low, high), self.uniform(low, high), self.uniform(low, high))

    def color(self, saturation: float = 0.6, value: tuple[float, float] = (0.2, 0.8)) -> tuple[float, ...]:
        """An RGBA color of any hue, with saturations up to a limit and values in a range."""
        return (*colorsys.hsv_to_rgb(self.random(), self.uniform(0.0, saturation), self.uniform(*value)), 1.0)
