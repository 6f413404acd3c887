# SPDX-License-Identifier: GPL-3.0-or-later
"""A render of a session, from its first slice to its finished result."""

from ...denoising.denoiser import Denoiser
from ...pictures import PictureError
from ...scene.scene import Scene
from ..checkpoints.checkpoint_writer import CheckpointWriter
from ..render.background_denoising import BackgroundFinish
from ..render.denoised_pictures import wanted_frame
from ..render.render_loop import RenderLoop
from ..render.results import Frame, RenderResult


class ActiveRender:
    """Runs the loop of a render, writes its last checkpoint and denoises its picture."""

    def __init__(self, loop: RenderLoop, scene: Scene, denoiser: Denoiser, writer: CheckpointWriter | None) -> None:
        """writer: writer of the render's checkpoint; None if it is not kept."""
        self.loop = loop
        self._scene = scene
        self._denoiser = denoiser
        self._writer = writer
        self._slices = loop.slices()
        self._finish: BackgroundFinish | None = None
        """Result that is being denoised; None while iterations are run."""

    def run_slice(self, is_stopping: bool) -> RenderResult | None:
        """Render for a bounded time. Returns the finished result once there is one.

        is_stopping: whether to end the render with what there is. One that has a checkpoint first completes its
        iteration.
        """
        if self._finish is None:
            may_end = self._writer is None or self.loop.can_be_kept
            if not (is_stopping and may_end) and next(self._slices, self) is not self:
                return None
            self._write_checkpoint()
            self._finish = BackgroundFinish(self.loop.result(is_stopping), self._scene.settings, self._denoiser)
        return self._finish.take(is_stopping)

    def _write_checkpoint(self) -> None:
        """Write the checkpoint of a render that ends; a failure becomes a warning."""
        if self._writer is None:
            return
        self.loop.keep()
        try:
            self._writer.finish()
        except PictureError as error:
            self._scene.warn(str(error))

    @property
    def has_picture(self) -> bool:
        """Whether iterations are still run and the film is that of a complete one."""
        return self._finish is None and self.loop.between_iterations and self.loop.iterations > 0

    def picture(self) -> Frame:
        """Return the noisy picture so far, with the passes that the settings name."""
        return wanted_frame(self.loop.frame(), self._scene.settings)
