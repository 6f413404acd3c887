# SPDX-License-Identifier: GPL-3.0-or-later
"""A viewport's frames, from the renderer's process to Blender: three slots in shared memory.

Beside its picture a slot has a guard, a generation, a sequence number and a size. The writer makes the guard odd,
writes the slot, and makes it even; then it announces the slot. The reader copies the slot between two readings of the
guard. It uses the copy only if both are the same even number and the slot is the announced one, so that no torn or
older frame is shown. While a frame is copied, two more can be written.
"""

from dataclasses import dataclass

import numpy as np

from .arrays import natural
from .protocol import ProtocolError
from .shared_memory import SharedBlock

SLOTS = 3
_MOST_PIXELS = 1 << 30
_ANNOUNCED = ("generation", "sequence", "width", "height")
_HEADER = np.dtype([(name, np.int64) for name in ("guard", *_ANNOUNCED)])
_HEADER_BYTES = 64


@dataclass(frozen=True)
class SharedFrame:
    """A complete picture of a viewport."""

    generation: int
    """Generation of the scene that the frame shows."""
    sequence: int
    """Greater than that of every frame of the session before it."""
    width: int
    height: int
    combined: np.ndarray
    """(height, width, 4) float32, scene-linear Rec.709, premultiplied alpha, row 0 at the bottom."""
    progress: float
    """Fraction of the iterations done, 0 to 1."""


class _Slots:
    """Views of the slots that lie in a block."""

    def __init__(self, block: SharedBlock, capacity: int) -> None:
        self.block = block
        self.capacity = capacity
        stride = slot_bytes(capacity)
        memory = block.memory
        self.headers: list[np.ndarray] = [np.ndarray((), _HEADER, memory, slot * stride) for slot in range(SLOTS)]
        self.pixels: list[np.ndarray] = [
            np.ndarray((4 * capacity,), np.float32, memory, slot * stride + _HEADER_BYTES) for slot in range(SLOTS)
        ]


def slot_bytes(capacity: int) -> int:
    """Bytes of a slot for pictures of up to ``capacity`` pixels."""
    return _HEADER_BYTES + -(-16 * capacity // 64) * 64


class FrameWriter:
    """In the renderer's process: writes one session's frames."""

    def __init__(self) -> None:
        self._slots: _Slots | None = None
        self._sequence = 0

    def reserve(self, pixels: int) -> dict | None:
        """Make room for pictures of so many pixels. Returns the message about new slots; None if the old ones suffice.

        Raises OSError when there is not enough shared memory.
        """
        if self._slots is not None and pixels <= self._slots.capacity:
            return None
        self.release()
        self._slots = _Slots(SharedBlock.create(SLOTS * slot_bytes(pixels)), pixels)
        return {"block": self._slots.block.name, "capacity": pixels}

    def write(self, generation: int, combined: np.ndarray) -> dict:
        """Write the next frame, (height, width, 4) float32. Returns the message about it, without its progress."""
        self._sequence += 1
        slot = self._sequence % SLOTS
        header = self._slots.headers[slot]
        height, width = combined.shape[:2]
        header["guard"] += 1
        header["generation"], header["sequence"] = generation, self._sequence
        header["width"], header["height"] = width, height
        self._slots.pixels[slot][: combined.size] = combined.reshape(-1)
        header["guard"] += 1
        return {
            "slot": slot, "generation": generation, "sequence": self._sequence, "width": width, "height": height,
        }  # fmt: skip

    def release(self) -> None:
        """Give the memory back; the reader keeps what it has open."""
        if self._slots is not None:
            self._slots.block.withdraw()
            self._slots = None


class FrameReader:
    """In Blender's process: reads the slots of one session."""

    def __init__(self, block: str, capacity: int) -> None:
        """Open the slots that the writer has announced.

        Raises FileNotFoundError when the writer has replaced them, and ProtocolError when they cannot be slots.
        """
        if not 0 < natural(capacity, "a capacity") <= _MOST_PIXELS:
            raise ProtocolError(f"slots of {capacity} pixels cannot be")
        try:
            opened = SharedBlock.open(block, SLOTS * slot_bytes(capacity))
        except FileNotFoundError:
            raise
        except (OSError, ValueError, TypeError) as error:
            raise ProtocolError(f"a session's frames cannot be opened ({error})") from error
        self._slots = _Slots(opened, capacity)

    def read(self, slot: int, generation: int, sequence: int, width: int, height: int) -> np.ndarray | None:
        """A copy of an announced frame, or None if it is being, or has been, written over.

        Raises ProtocolError for a frame that does not fit its slot.
        """
        announced = (generation, sequence, width, height)
        for name, value in zip(("slot", *_ANNOUNCED), (slot, *announced), strict=True):
            natural(value, f"a {name}")
        if not (slot < SLOTS and 0 < width * height <= self._slots.capacity):
            raise ProtocolError(f"a frame of {width} x {height} pixels in slot {slot} cannot be")
        header = self._slots.headers[slot]
        guard = int(header["guard"])
        if guard % 2 or tuple(int(header[name]) for name in _ANNOUNCED) != announced:
            return None
        combined = self._slots.pixels[slot][: 4 * width * height].reshape(height, width, 4).copy()
        return combined if int(header["guard"]) == guard else None
