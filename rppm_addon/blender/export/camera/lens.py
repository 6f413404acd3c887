# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's panoramas and depth of field, with Cycles' meaning."""

import bpy
import numpy as np

from ....scene import Aperture, Panorama, PanoramaKind
from ....scene.errors import SceneError

_LEAST_F_STOP = 1e-5


def export_panorama(camera: bpy.types.Camera, name: str, across: float, upward: float) -> Panorama:
    """The panorama of a camera whose frame is ``across`` by ``upward`` pixel widths.

    Raises SceneError, with the object's ``name``, for a panorama that RPPM does not know.
    """
    # Blender 5 has the properties on the camera, earlier versions on what Cycles adds to it.
    source = camera if hasattr(camera, "panorama_type") else getattr(camera, "cycles", None)
    if source is None:
        raise SceneError(
            f'the panorama of camera "{name}" is Cycles\' in this version of Blender; '
            "enable the add-on Cycles Render Engine in the preferences, or choose another type of camera"
        )
    if source.panorama_type not in PanoramaKind.__members__:
        raise SceneError(
            f'camera "{name}" has a panorama of type {source.panorama_type}, which RPPM cannot render; '
            "choose another panorama type, such as Equirectangular"
        )
    kind = PanoramaKind[source.panorama_type]
    panorama = Panorama(kind)
    if kind is PanoramaKind.EQUIRECTANGULAR:
        panorama.longitude = source.longitude_min, source.longitude_max
        panorama.latitude = source.latitude_min, source.latitude_max
    elif kind is PanoramaKind.CENTRAL_CYLINDRICAL:
        radius = source.central_cylindrical_radius
        panorama.longitude = source.central_cylindrical_range_u_min, source.central_cylindrical_range_u_max
        low, high = source.central_cylindrical_range_v_min, source.central_cylindrical_range_v_max
        panorama.height = low / radius, high / radius
    panorama.field_of_view = source.fisheye_fov
    panorama.lens = source.fisheye_lens
    panorama.polynomial = tuple(getattr(source, f"fisheye_polynomial_k{power}") for power in range(5))
    panorama.sensor = _sensor(camera, across, upward)
    return panorama


def _sensor(camera: bpy.types.Camera, across: float, upward: float) -> tuple[float, float]:
    """Width and height of the frame on the sensor, millimeters."""
    horizontal = camera.sensor_fit == "HORIZONTAL" or (camera.sensor_fit == "AUTO" and across > upward)
    size = camera.sensor_height if camera.sensor_fit == "VERTICAL" else camera.sensor_width
    return (size, size * upward / across) if horizontal else (size * across / upward, size)


def export_aperture(camera: bpy.types.Camera, matrix: np.ndarray, depsgraph: bpy.types.Depsgraph) -> Aperture | None:
    """The lens of a camera that stands at ``matrix`` (4, 4); None without depth of field."""
    lens = camera.dof
    if not lens.use_dof:
        return None
    # Millimeters of focal length, or in an orthographic view one meter.
    size = 1.0 if camera.type == "ORTHO" else 1e-3 * camera.lens
    return Aperture(
        radius=0.5 * size / max(lens.aperture_fstop, _LEAST_F_STOP),
        focus_distance=_focus_distance(lens, matrix, depsgraph),
        blades=lens.aperture_blades,
        rotation=lens.aperture_rotation,
        ratio=lens.aperture_ratio,
    )


def _focus_distance(lens: bpy.types.CameraDOFSettings, matrix: np.ndarray, depsgraph: bpy.types.Depsgraph) -> float:
    """Meters, of an object along the view axis."""
    if lens.focus_object is None:
        return lens.focus_distance
    focus = lens.focus_object.evaluated_get(depsgraph)
    target = focus.matrix_world
    if focus.pose is not None and lens.focus_subtarget in focus.pose.bones:
        target = target @ focus.pose.bones[lens.focus_subtarget].matrix
    return abs(float((np.array(target.translation) - matrix[:3, 3]) @ matrix[:3, 2]))
