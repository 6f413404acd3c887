# SPDX-License-Identifier: GPL-3.0-or-later
"""Linear color spaces in which scenes are rendered, by Blender's names for them.

Blender stores colors of sockets, lights and attributes in the working space already. Colors that are computed from
spectra, and those of image files, are converted where they enter; pictures say in which space they are.
"""

from dataclasses import dataclass, field

import numpy as np

_BRADFORD = np.array([(0.8951, 0.2664, -0.1614), (-0.7502, 1.7135, 0.0367), (0.0389, -0.0685, 1.0296)])
_D65 = (0.3127, 0.3290)


def _xyz(chromaticity: tuple[float, float]) -> np.ndarray:
    """(3,) CIE XYZ of luminance 1."""
    x, y = chromaticity
    return np.array([x / y, 1.0, (1.0 - x - y) / y])


def _to_xyz(primaries: tuple[tuple[float, float], ...], white: tuple[float, float]) -> np.ndarray:
    """(3, 3) from a space of primaries to CIE XYZ, whose white is D65, by Bradford's adaptation."""
    columns = np.stack([_xyz(primary) for primary in primaries], axis=1)
    matrix = columns * np.linalg.solve(columns, _xyz(white))
    adaptation = np.diag((_BRADFORD @ _xyz(_D65)) / (_BRADFORD @ _xyz(white)))
    return np.linalg.inv(_BRADFORD) @ adaptation @ _BRADFORD @ matrix


def _glsl(kind: str, numbers: np.ndarray) -> str:
    """A constant of GLSL; matrices column by column."""
    return f"{kind}({', '.join(f'{number:.8f}' for number in numbers.ravel())})"


@dataclass(frozen=True)
class WorkingSpace:
    """A space of linear red, green and blue."""

    name: str
    """Blender's name for it."""
    interop_id: str
    """Color Interop Forum's name, which EXR files state."""
    primaries: tuple[tuple[float, float], ...]
    """CIE x and y of red, green and blue."""
    white: tuple[float, float] = _D65
    """CIE x and y."""
    to_xyz: np.ndarray = field(init=False, compare=False)
    """(3, 3) float64 to CIE XYZ with white D65."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "to_xyz", _to_xyz(self.primaries, self.white))

    @property
    def luminance(self) -> np.ndarray:
        """(3,) float64 weights of the luminance of a color."""
        return self.to_xyz[1]

    @property
    def from_xyz(self) -> np.ndarray:
        """(3, 3) float64 from CIE XYZ with white D65."""
        return np.linalg.inv(self.to_xyz)

    @property
    def defines(self) -> dict[str, object]:
        """Macros of programs that convert colors; none for Rec.709."""
        if self is REC709:
            return {}
        return {
            "WORKING_LUMINANCE": _glsl("vec3", self.luminance),
            "REC709_TO_WORKING": _glsl("mat3", (self.from_xyz @ REC709.to_xyz).T),
            "XYZ_TO_WORKING": _glsl("mat3", self.from_xyz.T),
        }

    def from_rec709(self, colors: np.ndarray) -> np.ndarray:
        """(..., 3) colors that were linear Rec.709, of the type given; the array itself where this is Rec.709."""
        if self is REC709:
            return colors
        return (colors @ (self.from_xyz @ REC709.to_xyz).T).astype(colors.dtype)

    def to_rec709(self, colors: np.ndarray) -> np.ndarray:
        """(..., 3) colors as linear Rec.709, of the type given; the array itself where this is Rec.709."""
        if self is REC709:
            return colors
        return (colors @ (REC709.from_xyz @ self.to_xyz).T).astype(colors.dtype)


REC709 = WorkingSpace("Linear Rec.709", "lin_rec709_scene", ((0.64, 0.33), (0.30, 0.60), (0.15, 0.06)))
REC2020 = WorkingSpace("Linear Rec.2020", "lin_rec2020_scene", ((0.708, 0.292), (0.170, 0.797), (0.131, 0.046)))
ACESCG = WorkingSpace("ACEScg", "lin_ap1_scene", ((0.713, 0.293), (0.165, 0.830), (0.128, 0.044)), (0.32168, 0.33767))
WORKING_SPACES = {space.name: space for space in (REC709, REC2020, ACESCG)}
"""All working spaces, by name, as Blender orders them."""


def space_of(interop_id: str) -> WorkingSpace:
    """Return the space of an EXR file's colorInteropID; Rec.709 where it names no working space."""
    return next((space for space in WORKING_SPACES.values() if space.interop_id == interop_id), REC709)
