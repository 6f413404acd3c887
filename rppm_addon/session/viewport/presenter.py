# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures that a viewport presents: first looks, reprojected and rendered ones."""

import time

import numpy as np

from ...gl.context.context import Context
from ...gl.programs.programs import ProgramLibrary
from ...integrator.common.require import require
from ...integrator.film.film import Film
from ...integrator.progressive import ProgressivePhotonMapper
from ...integrator.viewport.pictures import ViewportPictures
from ...scene.scene import Scene
from ..placeholders.first_looks import FirstLooks
from ..render.frame_passes import frame_passes
from ..render.frame_reading import read_combined
from ..transport.messages import Send
from .frame_sender import FrameSender
from .reprojection_pacing import ReprojectionPacing


def film_picture(film: Film, scene: Scene) -> np.ndarray:
    """Return the film's picture as a viewport shows it, (height, width, 4) float32.

    The picture is Combined, or the only pass that the scene's settings name: colors as they are, values as gray.
    """
    if len(scene.settings.passes) != 1:
        return read_combined(film, scene.exposure)
    values = frame_passes(film.read_passes(), film.rendered_passes, scene.exposure)[scene.settings.passes[0]]
    planes = np.atleast_3d(values)
    picture = np.zeros((*planes.shape[:2], 4), np.float32)
    picture[..., : planes.shape[2]] = planes
    if planes.shape[2] == 1:
        picture[..., :3] = planes
    picture[..., 3] = 1.0
    return picture


class ViewportPresenter:
    """Makes the pictures of a viewport and sends them as frames."""

    def __init__(self, context: Context, library: ProgramLibrary, send: Send) -> None:
        self._context = context
        self._library = library
        self._first_looks = FirstLooks(context, library)
        """First looks, presented until there is a rendered picture. Afterward they help to draw a moving view."""
        self._pictures: ViewportPictures | None = None
        """Filter and history of the rendered pictures; None before the first."""
        self._reprojection = ReprojectionPacing()
        self._frames = FrameSender(send)

    @property
    def newest_generation(self) -> int:
        """Generation of the last frame; 0 before the first."""
        return self._frames.newest_generation

    @property
    def memory_bytes(self) -> int:
        """Bytes on the device for the pictures."""
        return 0 if self._pictures is None else sum(self._pictures.memory_bytes.values())

    def present_first_look(self, scene: Scene, generation: int, mapper: ProgressivePhotonMapper) -> None:
        """Send a first look at a scene, unless it shows a single pass or cannot be drawn. Raises DeviceLostError."""
        if len(scene.settings.passes) == 1:
            return
        combined = self._first_looks.draw(scene, mapper)
        if combined is not None:
            self._frames.send(combined, generation, 0.0)

    def update_first_look(self, scene: Scene, generation: int, mapper: ProgressivePhotonMapper) -> None:
        """Send a first look at a newer scene if the device has its parts already. Raises DeviceLostError."""
        if generation > self.newest_generation and self._first_looks.shows_parts_of(scene):
            self.present_first_look(scene, generation, mapper)

    def can_reproject(self, generation: int) -> bool:
        """Whether the last picture is of an older scene, and reprojecting it now leaves time for rendering."""
        return self._pictures is not None and generation > self.newest_generation and self._reprojection.is_due

    def reproject(self, scene: Scene, generation: int) -> None:
        """Send the last picture reprojected into the view of a scene that differs in nothing else."""
        began = time.perf_counter()
        combined = require(self._pictures).move(self._reprojection.scaled(scene))
        self._reprojection.add(began, 0 if combined is None else combined.shape[0] * combined.shape[1])
        if combined is not None:
            self._frames.send(combined, generation, 0.0)

    def present(self, scene: Scene, generation: int, mapper: ProgressivePhotonMapper, is_last: bool) -> None:
        """Send the film's picture, filtered where it has few samples; ``is_last``: after the last iteration."""
        if self._pictures is None:
            self._pictures = ViewportPictures(self._context, self._library, self._first_looks.of(mapper))
        combined = self._pictures.show(scene, mapper.film, mapper.iteration, is_last)
        if combined is None:
            combined = film_picture(mapper.film, scene)
        self.present_denoised(
            combined, scene, generation, 1.0 if is_last else mapper.iteration / scene.settings.iterations
        )

    def present_denoised(self, combined: np.ndarray, scene: Scene, generation: int, progress: float) -> None:
        """Send a finished picture, which is changed, unless a frame of a newer scene was sent meanwhile."""
        require(self._pictures).given_out(scene, combined)
        if generation >= self.newest_generation:
            self._frames.send(combined, generation, progress)

    def release_pictures(self) -> None:
        """Free the pictures on the device. Frames that were sent stay."""
        if self._pictures is not None:
            self._pictures.release()
            self._pictures = None
        self._first_looks.release()

    def release(self) -> None:
        """Free all pictures and frames."""
        self.release_pictures()
        self._frames.release()
