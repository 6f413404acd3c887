# SPDX-License-Identifier: GPL-3.0-or-later
"""The camera, resolved to a window in front of it."""

import enum
import math
from dataclasses import dataclass, field

import numpy as np

from .common.declared import declared

SHEARED = 1e-4
"""Cosine between axes from which on pictures show that they are not at right angles: .1 pixels of a thousand."""


class PanoramaKind(enum.Enum):
    """How directions are laid out in a panorama; the names are Blender's."""

    EQUIRECTANGULAR = "EQUIRECTANGULAR"
    EQUIANGULAR_CUBEMAP_FACE = "EQUIANGULAR_CUBEMAP_FACE"
    MIRRORBALL = "MIRRORBALL"
    FISHEYE_EQUIDISTANT = "FISHEYE_EQUIDISTANT"
    FISHEYE_EQUISOLID = "FISHEYE_EQUISOLID"
    FISHEYE_LENS_POLYNOMIAL = "FISHEYE_LENS_POLYNOMIAL"
    CENTRAL_CYLINDRICAL = "CENTRAL_CYLINDRICAL"


@dataclass
class Panorama:
    """A projection that no plane in front of the camera holds; each kind uses what it needs."""

    kind: PanoramaKind
    longitude: tuple[float, float] = (-math.pi, math.pi)
    """Left and right edge, radians, 0 straight ahead (EQUIRECTANGULAR, CENTRAL_CYLINDRICAL)."""
    latitude: tuple[float, float] = (-0.5 * math.pi, 0.5 * math.pi)
    """Lower and upper edge, radians (EQUIRECTANGULAR)."""
    height: tuple[float, float] = (-1.0, 1.0)
    """Lower and upper edge over the cylinder's radius (CENTRAL_CYLINDRICAL)."""
    field_of_view: float = math.pi
    """Radians across the circle of a fisheye."""
    lens: float = 10.5
    """Focal length, millimeters (FISHEYE_EQUISOLID)."""
    sensor: tuple[float, float] = (36.0, 36.0)
    """Width and height of what the frame covers, millimeters (FISHEYE_EQUISOLID, FISHEYE_LENS_POLYNOMIAL)."""
    polynomial: tuple[float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0)
    """k0 to k4: minus the angle off the axis, radians, by powers of millimeters (FISHEYE_LENS_POLYNOMIAL)."""

    @property
    def angle(self) -> float:
        """Radians across the frame."""
        if self.kind in {PanoramaKind.EQUIRECTANGULAR, PanoramaKind.CENTRAL_CYLINDRICAL}:
            return self.longitude[1] - self.longitude[0]
        return 2.0 * math.pi if self.kind is PanoramaKind.MIRRORBALL else self.field_of_view


@dataclass
class Aperture:
    """A thin lens: what lies at the distance of focus is sharp."""

    radius: float = field(metadata=declared(minimum=0.0))
    """Meters."""
    focus_distance: float
    """Meters: along the view axis, or in a panorama along the ray."""
    blades: int = 0
    """Corners of the opening; less than 3 is a disk."""
    rotation: float = 0.0
    """Rotation of the opening, radians."""
    ratio: float = 1.0
    """Height over width of the opening."""


@dataclass
class SphericalStereo:
    """One of two eyes that look around: in each direction it stands to the side of that direction."""

    offset: float
    """Meters from the camera to the right of where the eye looks; negative is to the left."""
    convergence_distance: float | None = None
    """Distance at which both eyes see the same, meters; None is parallel."""
    pole_merge: tuple[float, float] | None = None
    """Angles above and below the horizon, radians, from which on the offset fades and at which it ends."""


@dataclass
class Texels:
    """Places on a mesh of which a picture is taken, in place of what lies before a camera: a texture that is baked.

    Arrays have a row for each of the camera's region, row 0 at the bottom.
    """

    instance: int = field(metadata=declared(below="instances"))
    """Index into Scene.instances."""
    triangles: np.ndarray = field(metadata=declared("height", "width", types="int32", minimum=-1))
    """(height, width) int32, the triangle of the instance's mesh; -1 is none."""
    barycentrics: np.ndarray = field(metadata=declared("height", "width", 2, types="float32", finite=False))
    """(height, width, 2) float32, weights of the triangle's second and third corner."""
    differentials: np.ndarray = field(metadata=declared("height", "width", 4, types="float32", finite=False))
    """(height, width, 4) float32, what these change by over half a texel: the second's to the right and upward, then
    the third's. All 0: not a texel but a vertex."""
    viewer: tuple[float, float, float, float] | None = None
    """From where surfaces are seen, meters and 1; or the direction there, and 0. None is straight from above."""
    see_environment: bool = False
    """Whether what lies behind everything is pictured, as seen from the origin in the directions of the places."""


@dataclass
class Camera:
    """A camera that looks along its local -Z axis, Y up.

    Sensor fit, shift and pixel aspect are already in the window.
    """

    matrix: np.ndarray = field(metadata=declared(4, 4))
    """(4, 4) float64, camera to world, its axes of length 1: a rigid motion, or mirrored or sheared by parents."""
    window: tuple[float, float, float, float]
    """left, right, bottom, top of the whole frame: tangents (perspective, at distance 1), meters
    (orthographic), or fractions of the frame, 0 to 1 without a shift (panorama)."""
    width: int = field(metadata=declared(minimum=1, maximum=(1 << 31) - 1))
    """Pixels of the whole frame."""
    height: int = field(metadata=declared(minimum=1, maximum=(1 << 31) - 1))
    orthographic: bool = False
    clip_start: float = 0.1
    """Meters along the view axis, or in a panorama along the ray, as ``clip_end``."""
    clip_end: float = 1000.0
    crop: tuple[int, int, int, int] | None = None
    """x_min, y_min, x_max, y_max in pixels, row 0 at the bottom; None is the whole frame."""
    panorama: Panorama | None = None
    """None is a perspective or orthographic camera."""
    aperture: Aperture | None = None
    """None is a pinhole: everything is in focus."""
    stereo: SphericalStereo | None = None
    """None is a camera whose rays come from one point, or from its aperture."""
    texels: Texels | None = None
    """Places on a mesh that are pictured in place of the view; the window is then in texels, and orthographic."""

    @property
    def is_sheared(self) -> bool:
        """True where the axes are not at right angles."""
        axes = self.matrix[:3, :3] / np.linalg.norm(self.matrix[:3, :3], axis=0)
        return bool(np.abs(axes.T @ axes - np.eye(3)).max() > SHEARED)

    @property
    def pixel_size(self) -> float:
        """Width of a pixel: meters (orthographic) or radians; the mean where the projection stretches."""
        across = self.window[1] - self.window[0]
        if self.panorama is not None:
            across *= self.panorama.angle
        return across / self.width

    @property
    def region(self) -> tuple[int, int, int, int]:
        """The pixels that are rendered: x_min, y_min, x_max, y_max."""
        return self.crop if self.crop is not None else (0, 0, self.width, self.height)

    @property
    def resolution(self) -> tuple[int, int]:
        """Width and height of the rendered region in pixels."""
        x_min, y_min, x_max, y_max = self.region
        return x_max - x_min, y_max - y_min
