# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures that a viewport shows of a film: filtered while samples are few, enlarged while pixels are few, and combined
with the last view's picture while that has less noise."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...gl.buffer_sets import sum_by_name
from ...gl.buffers.records import stride
from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...materials.traits.ashikhmin_shirley import has_ashikhmin
from ...materials.traits.hair import has_hair
from ...materials.traits.node_rays import casts_rays, traces_rays
from ...materials.traits.ray_portals import has_ray_portals
from ...materials.traits.subsurface import has_subsurface
from ...materials.traits.thin_films import has_thin_film
from ...scene.materials import Material
from ...scene.scene import Scene
from ..common.require import require
from ..common.stage_sizes import StageSizes
from ..common.viewport_demands import ViewportDemands
from ..film.film import Film, exposed
from .first_look import FirstLook
from .noise_filter import NoiseFilter, strength
from .reprojection import HISTORY_ENDS, MAX_HISTORY, NewPicture, Reprojection, SeenPicture, can_move

MAX_SHADOW_RAYS = 4
"""Maximum number of shadow rays of a vertex in coarse pictures. Up to this, a vertex has about one for each pixel of
the full resolution that its pixel stands for."""


_SEEN_PICTURES = (SeenPicture,) * 3
"""Classes of the pictures that a Reprojection holds: the last, the next and the moved one."""


def demands_of(scene: Scene, level: float, materials: Sequence[Material] = ()) -> ViewportDemands:
    """Return what a picture of a scene demands of iterations, at a fraction ``level`` of the full side length.

    materials: one for each of the scene's, those that others stand in for as yet. Programs are to be ready for them:
    else they would be compiled when these come, while nothing new is shown.
    """
    coming = [material.graph for material, shown in zip(materials, scene.materials) if material is not shown]
    demands = ViewportDemands(
        has_subsurface=any(map(has_subsurface, coming)),
        has_hair=any(map(has_hair, coming)),
        has_ashikhmin=any(map(has_ashikhmin, coming)),
        has_ray_portals=any(map(has_ray_portals, coming)),
        has_thin_film=any(map(has_thin_film, coming)),
        traces_rays=any(map(traces_rays, coming)),
        casts_rays=any(map(casts_rays, coming)),
    )
    if len(scene.settings.passes) == 1:  # a pass is shown as it is
        return demands
    return replace(demands, shadow_rays=min(MAX_SHADOW_RAYS, round(1.0 / level**2)), is_filtered=True)


def expected_bytes(sizes: StageSizes) -> dict[str, int]:
    """Return the bytes that the pictures of a viewport take on the device, by buffer."""
    return sum_by_name(kind.expected_bytes(sizes) for kind in (NoiseFilter, *_SEEN_PICTURES))


class ViewportPictures:
    """The pictures of one viewport."""

    def __init__(self, context: Context, library: ProgramLibrary, first_look: FirstLook) -> None:
        self._context = context
        self._library = library
        self._reprojection = Reprojection(context, library, first_look)
        self._filter: NoiseFilter | None = None
        self._composed: np.ndarray | None = None
        self._to_keep: tuple[Scene, np.ndarray] | None = None
        """A picture that was not composed here, and is to be moved when the view moves."""

    def show(self, scene: Scene, film: Film, samples: int, last: bool = False) -> np.ndarray | None:
        """(height, width, 4) float32 scene-linear, exposed, premultiplied alpha, of a film of so many samples, which is
        of the scene's view and may be coarser; None where the film's own picture is the one to show, as after the
        ``last`` sample, or where the device holds none of this size in one buffer.

        Raises SceneError for a camera that sees nothing, and DeviceError.
        """
        settings, width, height = scene.settings, film.width, film.height
        self._reprojection.forget_others(scene)
        if len(settings.passes) == 1 or not self._holds(scene):
            return None
        self._keep_before(scene)
        coarse = (width, height) != scene.camera.resolution
        of = samples if last else settings.iterations
        filtered = strength(samples, of)
        fade = 1.0 if coarse else max(0.0, 1.0 - samples / min(of, HISTORY_ENDS))
        moves = can_move(scene) and (coarse or (fade > 0.0 and self._reprojection.has_history(scene)))
        picture = require(film.radiance.whole)
        if filtered > 0.0:
            noise_filter = self._filter_of(width, height)
            noise_filter.filter(film, samples, filtered)
            picture = noise_filter.picture.buffer
            if not moves:
                return exposed(noise_filter.read(), scene.exposure)
        if not moves:
            return None
        fraction = width / scene.camera.resolution[0]
        new = NewPicture(picture, width, height, fraction * samples)
        self._composed = self._reprojection.compose(scene, new, fade)
        return self._composed

    def move(self, scene: Scene) -> np.ndarray | None:
        """The last picture as it is seen in a scene's view, like show; None where there is none. Raises as show."""
        self._keep_before(scene)
        return self._reprojection.move(scene) if self._holds(scene) else None

    def given_out(self, scene: Scene, combined: np.ndarray) -> None:
        """This is what is to be seen of a scene now."""
        self._to_keep = None if combined is self._composed else (scene, combined)

    def _keep_before(self, scene: Scene) -> None:
        """Bring what was shown of another view to the device."""
        if self._to_keep is None or self._to_keep[0].camera is scene.camera:
            return
        shown, combined = self._to_keep
        self._to_keep = None
        movable = can_move(shown) and self._holds(shown)
        if movable and combined.shape[1::-1] == shown.camera.resolution and len(shown.settings.passes) != 1:
            self._reprojection.keep(shown, combined, MAX_HISTORY)

    def _holds(self, scene: Scene) -> bool:
        """Whether the device holds a picture of the view in one buffer, as all of what is done here asks for."""
        width, height = scene.camera.resolution
        return stride("vec4") * width * height <= self._context.storage_block_limit

    def _filter_of(self, width: int, height: int) -> NoiseFilter:
        if self._filter is None or self._filter.size != (width, height):
            if self._filter is not None:
                self._filter.release()
            self._filter = None
            self._filter = NoiseFilter(self._context, self._library, StageSizes(width, height))
        return self._filter

    @property
    def memory_bytes(self) -> dict[str, int]:
        """Bytes on the device by buffer."""
        owners = (self._reprojection, self._filter)
        return sum_by_name(owner.memory_bytes for owner in owners if owner is not None)

    def release(self) -> None:
        """Give all of it back."""
        self._reprojection.release()
        if self._filter is not None:
            self._filter.release()
            self._filter = None
