# SPDX-License-Identifier: GPL-3.0-or-later
"""A camera's record for the GPU: what a band of its frame looks at."""

import math

import numpy as np

from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock
from ...scene.camera import Camera, Panorama, PanoramaKind
from ...scene.errors import SceneError
from .band import MAX_RASTER_PIXELS

PROJECTIONS = ("PERSPECTIVE", "ORTHOGRAPHIC", *(kind.name for kind in PanoramaKind))
"""Names of the projections of cameras, by number."""
Constants("Projections", PROJECTION={name: number for number, name in enumerate(PROJECTIONS)})
CAMERA_VIEW = Record(
    "CameraView",
    position="vec3",
    projection="uint",
    right="vec3",
    clip_start="float",
    up="vec3",
    clip_end="float",
    forward="vec3",
    pixel_area="float",
    window="vec4",
    width="uint",
    height="uint",
    aperture_blades="uint",
    aperture_radius="float",
    focus_distance="float",
    aperture_rotation="float",
    aperture_ratio="float",
    field_of_view="float",
    panorama_range="vec4",
    sensor="vec2",
    lens="float",
    polynomial_constant="float",
    polynomial="vec4",
)
"""The band of the frame being rendered: ``window`` is left, right, bottom, top of the band with the
iteration's jitter; ``pixel_area`` is a pixel's area on the window: at distance 1 of perspective
cameras, m^2 of orthographic ones, fraction of the frame of panoramas. ``aperture_radius`` 0 is a pinhole.
``panorama_range`` is left, right, bottom, top in radians or of a cylinder of radius 1; ``sensor`` and
``lens`` are in millimeters."""
StorageBlock("Camera", "CameraView camera;")


def is_rasterized(camera: Camera) -> bool:
    """Whether a projection onto a plane from one point, or of parallel rays, shows what the camera sees, in rows that
    every device draws."""
    is_plane = all(part is None for part in (camera.panorama, camera.aperture, camera.stereo, camera.texels))
    return is_plane and not camera.is_sheared and camera.resolution[0] <= MAX_RASTER_PIXELS


def camera_view(camera: Camera, first_row: int, rows: int, offset: tuple[float, float]) -> np.ndarray:
    """CAMERA_VIEW record of a band of the camera's region, shifted by a subpixel offset.

    Raises SceneError when the camera's matrix, window, lens or clip range cannot be used.
    """
    left, right, bottom, top = camera.window
    pixel_width, pixel_height = (right - left) / camera.width, (top - bottom) / camera.height
    if not (
        np.isfinite(camera.matrix).all()
        and math.isfinite(pixel_width * pixel_height)
        and pixel_width * pixel_height > 0
    ):
        raise SceneError("the camera's matrix or lens is not finite or has no extent; reset its transform and lens")
    x_min, y_min, x_max, _ = camera.region
    x0 = left + pixel_width * (x_min + offset[0])
    y0 = bottom + pixel_height * (y_min + first_row + offset[1])
    view = CAMERA_VIEW.zeros(1)
    axes = camera.matrix[:3, :3] / np.linalg.norm(camera.matrix[:3, :3], axis=0)
    view["position"], view["right"], view["up"], view["forward"] = (
        camera.matrix[:3, 3],
        axes[:, 0],
        axes[:, 1],
        -axes[:, 2],
    )
    view["projection"] = PROJECTIONS.index("ORTHOGRAPHIC" if camera.orthographic else "PERSPECTIVE")
    start = camera.clip_start if camera.orthographic else max(camera.clip_start, 1e-6)
    view["clip_start"], view["clip_end"] = start, max(camera.clip_end, start * (1 + 1e-3) + 1e-6)
    view["pixel_area"] = pixel_width * pixel_height
    view["window"] = x0, x0 + pixel_width * (x_max - x_min), y0, y0 + pixel_height * rows
    view["width"], view["height"] = x_max - x_min, rows
    if camera.panorama is not None:
        _set_panorama(view, camera.panorama)
    _set_aperture(view, camera)
    return view


def _set_panorama(view: np.ndarray, panorama: Panorama) -> None:
    view["projection"] = PROJECTIONS.index(panorama.kind.name)
    cylindrical = panorama.kind is PanoramaKind.CENTRAL_CYLINDRICAL
    view["panorama_range"] = *panorama.longitude, *(panorama.height if cylindrical else panorama.latitude)
    view["field_of_view"], view["lens"], view["sensor"] = panorama.field_of_view, panorama.lens, panorama.sensor
    view["polynomial_constant"], view["polynomial"] = panorama.polynomial[0], panorama.polynomial[1:]
    lengths = (panorama.field_of_view, panorama.lens, *panorama.sensor)
    if not (min(lengths) > 0.0 and all(np.isfinite(view[name]).all() for name in ("panorama_range", "polynomial"))):
        raise SceneError("the camera's panorama has no extent or is not finite; reset its lens and sensor")


def _set_aperture(view: np.ndarray, camera: Camera) -> None:
    view["aperture_ratio"] = 1.0
    aperture = camera.aperture
    if aperture is None:
        return
    values = (aperture.radius, aperture.focus_distance, aperture.rotation, aperture.ratio)
    if not (np.isfinite(values).all() and aperture.radius >= 0.0 and aperture.ratio > 0.0):
        raise SceneError("the camera's aperture or focus is not finite; reset its depth of field")
    view["aperture_radius"], view["aperture_blades"] = aperture.radius, max(aperture.blades, 0)
    view["aperture_rotation"], view["aperture_ratio"] = aperture.rotation, aperture.ratio
    # In focus at the lens itself, rays would have no direction.
    view["focus_distance"] = max(aperture.focus_distance, 1e-6)
