# SPDX-License-Identifier: GPL-3.0-or-later
"""Photometric profiles of luminaires (ANSI/IES LM-63) as tables for shaders/materials/nodes/ies.glsl.

What the standard leaves open, and files that it does not allow, are read as Cycles reads them.
"""

import numpy as np

from ..scene.errors import RppmError

_WATTS_PER_CANDELA = 4.0 * np.pi / 177.83
"""A lamp's power in W for each W/sr, of light with the luminous efficacy of D65 in lm/W."""
_LUMINAIRE_NUMBERS = 10
"""From the count of lamps to the luminaire's height."""
_CLOSE = 1e-4
"""Degrees."""


FLAT_PROFILE = np.array([2.0, 2.0, -1.0, 7.0, -1.0, 4.0, *(100.0,) * 16], np.float32)
"""A table of 100 in all directions, which is what Cycles takes for a profile that it cannot read."""


class ProfileError(RppmError):
    """A text is no IES profile."""


def profile_table(text: str) -> np.ndarray:
    """(n,) float32: the counts of horizontal and vertical angles, these angles in radians, and the intensities, a row
    a horizontal angle. Rows and columns have one more entry on both ends, for cubic interpolation.

    Raises ProfileError.
    """
    kind, horizontal, vertical, intensity = _read(text)
    convert = {1: _type_c, 2: _type_b, 3: _type_a}.get(kind)
    if convert is None:
        raise ProfileError(f"its photometric type is {kind}, not 1, 2 or 3")
    horizontal, vertical, intensity = convert(horizontal, vertical, intensity)
    around, down = (np.radians(angles).astype(np.float32) for angles in (horizontal, vertical))
    # As Cycles does, whose comparison with a whole turn fails by rounding: no neighbors across 360 degrees.
    rows = [0, *range(len(around)), max(len(around) - 2, 0)]
    above = min(1, len(down) - 1) if down[0] < 1e-7 else 0
    columns = [above, *range(len(down)), len(down) - 1]
    padded = intensity[rows][:, columns]
    return np.concatenate([[len(around), len(down)], around, down, padded.ravel()]).astype(np.float32)


def _read(text: str) -> tuple[int, np.ndarray, np.ndarray, np.ndarray]:
    """Photometric type, horizontal and vertical angles in degrees, (horizontal, vertical) intensities in W."""
    _, found, rest = text.replace("\r", "").replace(",", " ").partition("\nTILT=")
    if not found:
        raise ProfileError("it has no line TILT=")
    tilt, _, rest = rest.partition("\n")
    if tilt.startswith("INCLUDE"):
        rest = f"{tilt.removeprefix('INCLUDE')}\n{rest}"
    words = iter(rest.split())

    def numbers(count: int) -> np.ndarray:
        try:
            found = np.array([float(next(words)) for _ in range(count)])
        except StopIteration:
            raise ProfileError("it ends before its last number") from None
        except ValueError as error:
            raise ProfileError(f"it has something else where a number should be ({error})") from None
        if not np.isfinite(found).all():
            raise ProfileError("a number is not finite")
        return found

    if tilt.startswith("INCLUDE"):
        numbers(2 * int(numbers(2)[1]))
    _, _, factor, down, around, kind, *_ = numbers(_LUMINAIRE_NUMBERS)
    ballast, photometric, _ = numbers(3)
    down, around = int(down), int(around)
    if down < 1 or around < 1:
        raise ProfileError("it has no angles")
    vertical, horizontal = numbers(down), numbers(around)
    intensity = numbers(down * around).reshape(around, down) * (factor * ballast * photometric * _WATTS_PER_CANDELA)
    return int(kind), horizontal, vertical, intensity


def _is(angle: float, wanted: float) -> bool:
    return abs(angle - wanted) < _CLOSE


def _type_a(horizontal: np.ndarray, vertical: np.ndarray, intensity: np.ndarray) -> tuple[np.ndarray, ...]:
    """Angles from the axis of a headlamp: to the sides and up."""
    around, rows = 180.0 - horizontal[::-1], intensity[::-1]
    if _is(horizontal[0], 0.0):
        around, rows = np.concatenate([around, 180.0 + horizontal[1:]]), np.concatenate([rows, intensity[1:]])
    return around, vertical + 90.0, rows


def _type_b(horizontal: np.ndarray, vertical: np.ndarray, intensity: np.ndarray) -> tuple[np.ndarray, ...]:
    """The polar axis lies level: both kinds of angles change places, and users turn the lamp."""
    horizontal, vertical, intensity = vertical, horizontal, intensity.T
    if _is(horizontal[0], 0.0):
        horizontal, intensity = _both_sides(horizontal), np.concatenate([intensity[:0:-1], intensity])
    if _is(vertical[0], 0.0):
        vertical, intensity = _both_sides(vertical), np.concatenate([intensity[:, :0:-1], intensity], axis=1)
    return horizontal + 90.0, vertical + 90.0, intensity


def _both_sides(angles: np.ndarray) -> np.ndarray:
    return np.concatenate([-angles[:0:-1], angles])


def _type_c(horizontal: np.ndarray, vertical: np.ndarray, intensity: np.ndarray) -> tuple[np.ndarray, ...]:
    """Angles around the vertical and from straight down. Quarters and halves stand for all of their like."""
    if _is(horizontal[0], 90.0):
        horizontal = horizontal - 90.0
    if len(horizontal) == 1:
        return np.array([0.0, 360.0]), vertical, intensity[[0, 0]]
    for part in (90.0, 180.0):
        if _is(horizontal[-1], part):
            horizontal = np.concatenate([horizontal, 2.0 * part - horizontal[-2::-1]])
            intensity = np.concatenate([intensity, intensity[-2::-1]])
    gap = 360.0 - horizontal[-1]
    steps = horizontal[1] - horizontal[0], horizontal[-1] - horizontal[-2]
    if _is(horizontal[0], 0.0) and not _is(gap, 0.0) and any(_is(step, gap) for step in steps):
        horizontal, intensity = np.append(horizontal, 360.0), np.concatenate([intensity, intensity[:1]])
    return horizontal, vertical, intensity
