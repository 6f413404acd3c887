# SPDX-License-Identifier: GPL-3.0-or-later
"""A large image that is read while an export in slices goes on with other things."""

from collections.abc import Callable, Hashable
from typing import Any

import numpy as np

from ....scene.images import Image
from ..common.slices import Slices


class LateImage:
    """Blender writes the image's numbers to memory that a thread has made ready, as writing to it for the first time
    may take several times as long, and a thread encodes them."""

    def __init__(
        self,
        shape: tuple[int, int, int],
        read: Callable[[np.ndarray], bool],
        encode: Callable[[np.ndarray], Image],
        limit: Callable[[Image], Image],
    ) -> None:
        """Begin nothing yet.

        Args:
            shape: height, width and channels.
            read: has Blender write to an array of the shape; returns whether there were numbers. It holds nothing of
                Blender.
            encode: makes an image of the array.
            limit: makes the image as small as it is to be.
        """
        self._shape, self._read, self._encode, self._limit = shape, read, encode, limit
        self._record: dict[Hashable, Any] = {}
        self.image: Image | None = None
        """The image once it is there; None, too, where Blender had no numbers."""
        self.whole: Image | None = None
        """The image before it was limited."""

    def advance(self, slices: Slices, waits: bool) -> bool:
        """Do what there is to be done and return whether it is all.

        waits: wait for threads until the slice is over, and raise Unfinished then. Else those go on meanwhile, and
        Unfinished is raised only for what needs a slice of its own.
        """
        computed, record = slices.computed if waits else slices.computed_so_far, self._record
        if "is read" not in record and computed(record, "memory", lambda: np.ones(self._shape, np.float32)) is None:
            return False
        if not slices.step_alone(record, "is read", lambda: self._read(record["memory"])):
            return True
        stored = record["memory"]
        self.whole = computed(record, "encoded", lambda: self._encode(stored))
        if self.whole is not None:
            self.image = computed(record, "limited", lambda: self._limit(self.whole))
        return self.image is not None
