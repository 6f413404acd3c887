# SPDX-License-Identifier: GPL-3.0-or-later
"""The preferences' button that tries the device and opens the report."""

import os
import subprocess
import sys
from pathlib import Path

import bpy
from bpy.app.translations import pgettext_iface as iface_
from bpy.app.translations import pgettext_rpt as rpt_

from .. import self_test
from . import panels
from .render_client import renderer_process

_SCRIPT = Path(self_test.__file__).with_name("run.py")
_ASKED_EVERY = 0.5
"""Seconds."""
_FLAGS = subprocess.CREATE_NO_WINDOW if sys.platform == "win32" else 0
_running: subprocess.Popen | None = None


def report_path() -> Path:
    """Where the report is written, beside the renderer's log."""
    return renderer_process.log_path().with_name("rppm_report.txt")


class RPPM_OT_self_test(bpy.types.Operator):
    """Try the graphics device for a minute or two, and open a report that can be attached to a bug report. It names the
    system, its driver and packages, but no person, machine or file"""

    bl_idname = "rppm.self_test"
    bl_label = "Self-Test"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        """Called by Blender."""
        return not is_running()

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Called by Blender."""
        global _running
        path = report_path()
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.unlink(missing_ok=True)
            # A Blender without a console, as Windows starts it, has nowhere to print to.
            with path.with_suffix(".log").open("wb") as log:
                _running = subprocess.Popen(
                    [
                        renderer_process.python_program(),
                        *bpy.app.python_args,
                        str(_SCRIPT),
                        str(path),
                        *(folder for folder in sys.path if folder and Path(folder).is_dir()),
                    ],
                    stdin=subprocess.DEVNULL,
                    stdout=log,
                    stderr=log,
                    creationflags=_FLAGS,
                    env={**os.environ, **renderer_process.environment()},
                )
        except OSError as error:
            self.report({"ERROR"}, rpt_("The self-test cannot be started: {}").format(error))
            return {"CANCELLED"}
        bpy.app.timers.register(_show_end, first_interval=_ASKED_EVERY)
        return {"FINISHED"}


def is_running() -> bool:
    """Whether a self-test has been started and has not ended."""
    return _running is not None and _running.poll() is None


def _show_end() -> float | None:
    """Open the report once it is there."""
    panels.redraw()
    if is_running():
        return _ASKED_EVERY
    if report_path().is_file() and not bpy.app.background:
        bpy.ops.wm.path_open(filepath=str(report_path()))
    return None


def draw(layout: bpy.types.UILayout) -> None:
    """The button, and how the last test ended."""
    row = layout.row()
    if is_running():
        row.label(text="The self-test runs for a minute or two")
    elif _running is not None and not report_path().is_file():
        log = report_path().with_suffix(".log")
        text = iface_("The self-test ended with code {}, without a report: {}").format(_running.returncode, log)
        row.label(text=text, icon="ERROR", translate=False)
    elif _running is not None:
        icon = "NONE" if _running.returncode == 0 else "ERROR"
        row.label(text=iface_("Report: {}").format(report_path()), icon=icon, translate=False)
    else:
        row.label(text="Try the device, for a bug report")
    row.operator("rppm.self_test", icon="CHECKMARK")


def register() -> None:
    """Add the operator."""
    bpy.utils.register_class(RPPM_OT_self_test)


def unregister() -> None:
    """Take out the operator, and end a test that runs."""
    if bpy.app.timers.is_registered(_show_end):
        bpy.app.timers.unregister(_show_end)
    if is_running():
        _running.kill()
    bpy.utils.unregister_class(RPPM_OT_self_test)
