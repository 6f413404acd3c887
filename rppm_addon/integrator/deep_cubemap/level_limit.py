# SPDX-License-Identifier: GPL-3.0-or-later
"""The finest level of cells that the device has room for, learned from builds that it had no room for."""

import logging

import numpy as np

from .build_buffers import LevelTooFineError

log = logging.getLogger(__name__)


class LevelLimit:
    """A limit on the levels of builds with at least as many triangles as a build that did not fit."""

    def __init__(self) -> None:
        self._triangle_count, self._last_level = 1 << 32, 0

    def apply(self, parameters: np.void) -> None:
        """Limit the levels of a build, in its STATE, as far as is known."""
        if parameters["triangle_count"] >= self._triangle_count:
            parameters["last_level"] = min(parameters["last_level"], self._last_level)

    def lower(self, parameters: np.void, error: LevelTooFineError) -> None:
        """Take a level or more from a build, in its STATE, that did not fit. Raises DeviceError if there is none."""
        if parameters["last_level"] > parameters["base_level"]:
            parameters["last_level"] = min(error.level, int(parameters["last_level"])) - 1
        elif parameters["base_level"] > 1:
            parameters["base_level"] = parameters["last_level"] = 1
        else:
            raise error.cause from None
        self._triangle_count, self._last_level = int(parameters["triangle_count"]), int(parameters["last_level"])
        log.warning(
            "%s; for now cells stay at a resolution of %d, which slows rays down",
            error.cause,
            1 << int(parameters["root_exponent"] + 2 * parameters["last_level"]),
        )
