# SPDX-License-Identifier: GPL-3.0-or-later
"""State of a render that a renderer's process hands over, so that another process continues it if this one ends."""

import logging
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...scene.storage.documents import decode, encode
from ..checkpoints.continuation import Pause
from .arrays import pack
from .shared_memory import SharedBlock

log = logging.getLogger(__name__)


@dataclass
class KeptRender:
    """State as it came from a process; only the next process decodes it."""

    document: dict[str, Any]
    arrays: list[np.ndarray]
    seconds: float
    """Seconds that the render has taken so far."""

    def message(self, reason: str) -> tuple[dict[str, Any], SharedBlock | None]:
        """Return the content of "resume", and the block that is kept until it is read. Raises OSError without memory.

        reason: why the process ended.
        """
        arrays, block = pack(self.arrays)
        return {"document": self.document, "arrays": arrays, "seconds": self.seconds, "reason": reason}, block


def described(pause: Pause) -> tuple[dict[str, Any], dict[str, Any], SharedBlock | None]:
    """Return a pause's document, its arrays as messages have them, and their block. Raises OSError without memory."""
    arrays: list[np.ndarray] = []

    def keep(array: np.ndarray) -> int:
        arrays.append(array)
        return len(arrays) - 1

    document: Any = encode(pause, keep)
    return document, *pack(arrays)


def pause_of(document: dict[str, Any], arrays: list[np.ndarray]) -> Pause | None:
    """Return the pause that a document describes; None for another document: the render then begins anew."""
    try:
        return decode(document, Pause, arrays)
    except (LookupError, TypeError, ValueError, AttributeError):
        log.warning("the state that another process has left of a render cannot be read", exc_info=True)
        return None
