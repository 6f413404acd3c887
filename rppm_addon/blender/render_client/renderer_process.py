# SPDX-License-Identifier: GPL-3.0-or-later
"""The one renderer process of this Blender: its viewports, previews and renders share it."""

import atexit
import sys
import threading
from pathlib import Path

import bpy
from bpy.app.handlers import persistent

from ...scene import Scene
from ...session.client import remote_rendering
from ...session.client.client import ProcessState, RendererProcess
from ...session.render.render_job import RenderJob
from ...session.render.results import RenderResult
from ...session.transport.sessions import SessionKind
from ..user_folder import user_folder
from .chosen_device import VARIABLE, chosen_device
from .denoising_libraries import denoising_libraries

_process: RendererProcess | None = None
_final: remote_rendering.RemoteRenderer | None = None
"""Renderer that all final renders share; None before the first one."""
_lock = threading.Lock()


def renderer_process() -> RendererProcess:
    """The process, which is not started before a session is opened in it."""
    global _process
    with _lock:
        if _process is None:
            folders = [folder for folder in sys.path if folder and Path(folder).is_dir()]
            python = [python_program(), *bpy.app.python_args]
            _process = RendererProcess(python, folders, log_path(), denoisers=denoising_libraries())
            _process.launcher.environment = environment()
        return _process


def failure() -> str:
    """Why the process does not run although it was needed, one line; empty while all is well."""
    process = _process
    return process.error if process is not None and process.state is ProcessState.FAILED else ""


def is_used() -> bool:
    """Whether renders go to the process: where there is a window, which must not freeze."""
    return not bpy.app.background


def render(scene: Scene, job: RenderJob, kind: SessionKind) -> RenderResult:
    """Render in the process as RemoteRenderer.render does; what final renders leave there is for the next."""
    global _final
    process = renderer_process()
    if kind is not SessionKind.FINAL:
        return remote_rendering.render(process, scene, job, kind)
    if _final is None or _final.process is not process:
        _final = remote_rendering.RemoteRenderer(process, kind)
    return _final.render(scene, job)


def forget() -> None:
    """Have the process give back what final renders have left there."""
    if _final is not None:
        _final.forget()


def libraries_changed() -> None:
    """Another library may be there to denoise with: a process that runs is started anew with it."""
    if _process is not None:
        _process.launcher.denoisers = denoising_libraries()
        if _process.state is ProcessState.RUNNING:
            _process.restart()


def device_changed() -> None:
    """Another device was chosen: a process that runs is started anew on it."""
    if _process is not None:
        _process.launcher.environment = environment()
        if _process.state is not ProcessState.STOPPED:
            _process.restart()


def environment() -> dict[str, str]:
    """Return the variables that the process's environment has besides Blender's."""
    device = chosen_device()
    return {VARIABLE: device} if device else {}


def close() -> None:
    """End the process and its sessions; waits a few seconds at the most."""
    if _process is not None:
        _process.close()


def python_program() -> str:
    """The Python that Blender brings or uses; sys.executable is Blender itself in some builds."""
    if "python" in Path(sys.executable or "").name.lower():
        return sys.executable
    version = f"{sys.version_info.major}.{sys.version_info.minor}"
    names = (f"bin/python{version}", "bin/python3", "bin/python.exe", "python.exe")
    programs = [program for name in names if (program := Path(sys.prefix, name)).is_file()]
    return str(programs[0]) if programs else "python"


def log_path() -> Path:
    """The file that the process logs to."""
    return user_folder() / "renderer.log"


@persistent
def _on_load(*_: object) -> None:
    """Nothing of the file before is of use any more."""
    close()


def register() -> None:
    """Have the process end when another file is loaded."""
    bpy.app.handlers.load_post.append(_on_load)


def unregister() -> None:
    """End the process."""
    bpy.app.handlers.load_post.remove(_on_load)
    close()


atexit.register(close)
