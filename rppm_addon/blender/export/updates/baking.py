# SPDX-License-Identifier: GPL-3.0-or-later
"""Export for Blender's bake operator, which renders places on a mesh in place of what a camera sees."""

import dataclasses
from dataclasses import dataclass

import bpy
import numpy as np

from ....scene import Camera, RayVisibility, RenderSettings, Scene, Texels
from ....scene.errors import SceneError
from ....session.render.bake_passes import ENVIRONMENT, BakePass
from ..camera.camera import export_camera
from ..instances.placements import Placed

_PRIMITIVE, _DIFFERENTIAL = "BakePrimitive", "BakeDifferential"
"""Passes by which Blender hands over what to bake, as it does to Cycles."""
_DENOISED_MARGIN = 8
"""Texels around those on the object that are rendered like their neighbors, so that no denoiser draws in the black
between islands."""


@dataclass(frozen=True)
class BakePixels:
    """The texels that are on an object; arrays are of all the texture, row 0 at the bottom."""

    triangles: np.ndarray
    """(height, width) int32, number in Mesh.loop_triangles; -1 is none."""
    barycentrics: np.ndarray
    """(height, width, 2) float32, weights of the triangle's first and second corner."""
    differentials: np.ndarray
    """(height, width, 4) float32, what the first changes by over half a texel to the right and upward, then the
    second."""

    @classmethod
    def of_result(cls, result: bpy.types.RenderResult, width: int, height: int) -> "BakePixels":
        """Read the texels from the result that RenderEngine.begin_result gives while a texture is baked."""
        planes = {}
        for render_pass in result.layers[0].passes:
            if render_pass.name in (_PRIMITIVE, _DIFFERENTIAL):
                values = np.empty(width * height * render_pass.channels, np.float32)
                render_pass.rect.foreach_get(values)
                planes[render_pass.name] = values.reshape(height, width, render_pass.channels)
        if len(planes) < 2 or planes[_PRIMITIVE].shape[2] != 3:
            raise SceneError("this Blender does not say what to bake in a way that RPPM knows; bake with Cycles")
        primitive = planes[_PRIMITIVE]
        # The number's bits are in place of a float's.
        triangles = np.ascontiguousarray(primitive[..., 2]).view(np.int32)
        return cls(triangles, primitive[..., :2], planes[_DIFFERENTIAL])

    @property
    def bounds(self) -> tuple[int, int, int, int] | None:
        """x_min, y_min, x_max, y_max of the texels that are on the object; None where none is."""
        rows, columns = (np.flatnonzero((self.triangles >= 0).any(axis=axis)) for axis in (1, 0))
        if not len(rows):
            return None
        return int(columns[0]), int(rows[0]), int(columns[-1]) + 1, int(rows[-1]) + 1

    @property
    def is_picture(self) -> bool:
        """Whether texels are beside each other because the places are; those of vertices lie anyhow."""
        return bool(self.differentials[self.triangles >= 0].any())


def bake_settings(settings: RenderSettings, bake_pass: BakePass, pixels: BakePixels) -> RenderSettings:
    """Return the settings of a final render, changed for a picture to be baked."""
    return dataclasses.replace(
        settings,
        passes=bake_pass.passes,
        aovs=(),
        light_groups=(),
        use_denoising=settings.use_denoising and bake_pass.is_denoised and pixels.is_picture,
        film_transparent=settings.film_transparent and bake_pass.has_alpha,
    )


def camera_beside(baked: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Camera:
    """The scene's camera, for nodes that ask for it; without one it is in the middle of the object."""
    try:
        return export_camera(depsgraph.scene_eval, depsgraph)
    except SceneError:
        matrix = np.eye(4)
        corners = np.array(baked.bound_box) @ np.array(baked.matrix_world)[:3, :3].T
        matrix[:3, 3] = corners.mean(axis=0) + np.array(baked.matrix_world.translation)
        return Camera(matrix, (-1.0, 1.0, -1.0, 1.0), 1, 1)


def seen_from(scene: bpy.types.Scene, camera: Camera) -> tuple[float, float, float, float] | None:
    """Texels.viewer by Blender's settings; camera: the scene's, if it has one."""
    if scene.render.bake.view_from != "ACTIVE_CAMERA" or scene.camera is None:
        return None
    if camera.orthographic:
        x, y, z = camera.matrix[:3, 2].tolist()
        return x, y, z, 0.0
    x, y, z = camera.matrix[:3, 3].tolist()
    return x, y, z, 1.0


def nearest_texels(known: np.ndarray, reach: int) -> np.ndarray:
    """(height, width) int32, for each texel the number, row by row, of a known one that is as near as may be, up to so
    many steps to the side and upward; -1 where there is none. known: (height, width) bool."""
    found = np.where(known, np.arange(known.size, dtype=np.int32).reshape(known.shape), np.int32(-1))
    for _ in range(reach):
        for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
            found = np.where(found >= 0, found, np.roll(found, step, axis))
    return found


def look_at_texels(
    scene: Scene,
    baked: bpy.types.Object,
    placed: Placed,
    pixels: BakePixels,
    viewer: tuple[float, float, float, float] | None,
    bake_pass: BakePass,
) -> None:
    """Give a scene a camera of texels in place of its own, and show it the object whatever other cameras see of it.

    placed: with identities; viewer: as Texels has it. Raises SceneError where the object is not in the scene.
    """
    identity = (baked.original.session_uid,)
    found = (n for n, instance in enumerate(scene.instances) if placed.identities[id(instance)] == identity)
    index = next(found, None)
    bounds = pixels.bounds
    if index is None or bounds is None:
        raise SceneError(
            f'object "{baked.name}" is not rendered, so it cannot be baked; show it in renders and give it faces and '
            "a scale that is not 0"
        )
    scene.instances[index] = dataclasses.replace(
        scene.instances[index],
        visibility=scene.instances[index].visibility | RayVisibility.CAMERA,
        holdout=False,
        shadow_catcher=False,
    )
    height, width = pixels.triangles.shape
    x_min, y_min, x_max, y_max = bounds
    region = np.s_[y_min:y_max, x_min:x_max]
    nearest = nearest_texels(pixels.triangles[region] >= 0, _DENOISED_MARGIN if scene.settings.use_denoising else 0)

    def taken(values: np.ndarray, nothing: float) -> np.ndarray:
        flat = values[region].reshape(nearest.size, -1)
        return np.where(nearest.reshape(-1, 1) >= 0, flat[nearest.reshape(-1)], values.dtype.type(nothing))

    first, second = taken(pixels.barycentrics, 0.0).reshape(*nearest.shape, 2).transpose(2, 0, 1)
    changes = taken(pixels.differentials, 0.0).reshape(*nearest.shape, 4)
    texels = Texels(
        index,
        taken(pixels.triangles, -1).reshape(nearest.shape),
        np.stack([second, 1.0 - first - second], axis=-1),
        np.concatenate([changes[..., 2:], -changes[..., :2] - changes[..., 2:]], axis=-1),
        viewer,
        bake_pass.kind == ENVIRONMENT,
    )
    scene.camera = Camera(
        scene.camera.matrix,
        (0.0, float(width), 0.0, float(height)),
        width,
        height,
        orthographic=True,
        crop=bounds,
        texels=texels,
    )
