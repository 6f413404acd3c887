# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders scenes: owns the device and runs the photon mapper on it."""

import contextlib
from collections.abc import Callable, Sequence

import numpy as np

from ...denoising.denoiser import Denoiser
from ...denoising.places import library_places
from ...gl.context.context import Context, DeviceInformation
from ...gl.programs.programs import ProgramLibrary
from ...integrator.memory import Memory
from ...integrator.progressive import ProgressivePhotonMapper
from ...scene.errors import DeviceLostError
from ...scene.scene import Scene
from ...scene.storage.validation import check_scene
from ..checkpoints.continuation import Continuation, DeviceLossRecovery
from .denoised_pictures import FinishedPictures, finished_result
from .render_loop import RenderLoop
from .results import Frame, Progress, RenderResult


class Renderer:
    """Owns the GL context and the compiled programs; renders one scene after another."""

    def __init__(self, device: str | None = None, denoiser: Denoiser | None = None, times_stages: bool = False) -> None:
        """Open the device. Raises DeviceError.

        Args:
            device: the wished device, as Context.create takes it.
            denoiser: denoiser of pictures; None is one with the libraries that are found here.
            times_stages: whether statistics have the seconds of stages, for which the CPU waits for the device.
        """
        self._device = device
        self._context = Context.create(device)
        self._denoiser = denoiser or Denoiser(library_places())
        self._library = ProgramLibrary(self._context)
        self._times_stages = times_stages
        self._mapper: ProgressivePhotonMapper | None = None

    @property
    def device(self) -> DeviceInformation:
        """Device that the renderer uses."""
        return self._context.information

    def __enter__(self) -> "Renderer":
        return self

    def __exit__(self, *_: object) -> None:
        self.release()

    def render(
        self,
        scene: Scene,
        on_progress: Callable[[Progress, Callable[[], Frame]], None] | None = None,
        should_stop: Callable[[], bool] | None = None,
        snapshots: Sequence[float] = (),
        on_snapshot: Callable[[float, Frame], None] | None = None,
        continuation: Continuation | None = None,
    ) -> RenderResult:
        """Render a scene to its settings' iterations or time limit, whichever comes first.

        Members of the scene before stay on the device, so members of scenes must not be changed.
        Where the device is lost, the render continues in another context after the last state that it handed over.
        Raises the errors of scene/errors.py.

        Args:
            scene: the scene.
            on_progress: called when the scene is built (iteration 0) and after each iteration, with a function that
                reads the picture so far.
            should_stop: called as often. One iteration is done in any case, so that there is a picture.
            snapshots: ascending seconds since the call.
            on_snapshot: receives each of ``snapshots`` and the picture at that time.
            continuation: where the render begins, and who receives its state.
        """
        scene = scene.expanded()
        recovery = DeviceLossRecovery(continuation)
        pictures = FinishedPictures(scene.settings, self._denoiser, on_progress, on_snapshot)
        while True:
            try:
                with self._context.moderngl:  # another context may be current in this thread
                    loop = RenderLoop(
                        self._context,
                        self._open_mapper(),
                        scene,
                        pictures.report,
                        snapshots,
                        pictures.take_snapshot,
                        recovery.continuation,
                    )
                    return finished_result(loop.run(should_stop), scene.settings, self._denoiser)
            except DeviceLostError as error:
                recovery.recover(scene, error)
                self._replace_context()

    def _open_mapper(self) -> ProgressivePhotonMapper:
        """Return the mapper, with what it has on the device of the last scene."""
        if self._mapper is None:
            self._mapper = ProgressivePhotonMapper(self._context, self._library)
            if self._times_stages:
                self._mapper.timers.begin()
        return self._mapper

    def _replace_context(self) -> None:
        """Open another context in place of a lost one."""
        self._mapper = None  # whose buffers are gone
        with contextlib.suppress(Exception):  # drivers may fail in any way to free a lost context
            self._library.release()
            self._context.release()
        self._context = Context.create(self._device)
        self._library = ProgramLibrary(self._context)

    def compile(self, scene: Scene, on_program: Callable[[float, str], None]) -> int:
        """Have the driver compile the programs that pictures of a scene need, and keep them on the disk.

        The scene is rendered, as drivers compile for the state in which programs run: make it small. ``on_program``
        is called before each program that runs for the first time, with the fraction of the work that is done, 0 to 1,
        and its name. Returns the number of programs. Raises the errors of scene/errors.py.
        """
        library, done = self._library, 0.0

        def tell(name: str) -> None:
            nonlocal done
            work = library.compilation_work()
            done = max(done, work.compiled / work.known)
            on_program(done, name)

        library.on_start = tell
        try:
            self.render(scene)
        finally:
            library.on_start = None
        return library.started

    def inspect(self, scene: Scene) -> tuple[np.ndarray, dict[str, int], dict[str, int]]:
        """Measure what the camera's rays cost in the scene's deep cubemap, without rendering.

        Returns (height, width, 4) float32 of CUBEMAP_COSTS, the counts of the structure, and
        its bytes by buffer. Raises the errors of scene/errors.py.
        """
        check_scene(scene)
        scene = scene.expanded()
        with self._context.moderngl:
            mapper = self._open_mapper()
            mapper.build_deep_cubemap(scene)
            cubemap = mapper.deep_cubemap
            counts = cubemap.counts | {"resolution": cubemap.resolution}
            return mapper.inspect_deep_cubemap(), counts, cubemap.memory_bytes

    def memory(self, scene: Scene) -> Memory:
        """Bytes on the device that rendering the scene takes. Raises the errors of scene/errors.py."""
        check_scene(scene)
        scene = scene.expanded()
        with self._context.moderngl:
            mapper = self._open_mapper()
            mapper.build(scene)
            mapper.lengthen_lists()
            return mapper.memory

    def forget(self) -> None:
        """Free the last scene on the device and in memory; programs stay."""
        if self._mapper is not None:
            with self._context.moderngl:
                self._mapper.release()
            self._mapper = None

    def release(self) -> None:
        """Free the device; the renderer cannot be used afterwards."""
        self.forget()
        self._library.release()
        self._context.release()
