# SPDX-License-Identifier: GPL-3.0-or-later
"""rppm farm, up to the point where Dask is needed."""

import argparse
import sys

from ...pictures import make_folder
from ...scene import RenderSettings
from ...scene.errors import SettingsError
from ..options.frame_numbers import check_places
from ..options.options import is_blend, outputs_of_still, refuse_blend_options, values_and_limits, values_of_frames
from ..options.setting_options import given_settings
from ..recorder import apply_settings
from ..terminal.interruption import Interruption
from ..terminal.progress_bar import ProgressBar


def farm(options: argparse.Namespace, bar: ProgressBar) -> int:
    """Do it; returns the exit status."""
    try:
        from .job import FarmRequest, run_farm
    except ImportError as error:
        raise SettingsError(
            f"rppm farm needs dask.distributed ({error}); install it with pip install -e '.[farm]'"
        ) from error

    settings, data_values = values_and_limits(options)
    from_blend = is_blend(options.file)
    if from_blend:
        values_of_frames(settings)
    apply_settings(RenderSettings(), settings)
    if not from_blend:
        if options.frames:
            raise SettingsError("--frames needs a .blend file; a saved scene holds one frame")
        refuse_blend_options(options, data_values)
    if options.frames and options.frame is not None:
        raise SettingsError("--frame is for a still; name the frames of an animation with --frames alone")
    if options.parts and options.samples is None:
        raise SettingsError("a still in --parts needs --samples, those of all parts together")
    if options.scheduler and options.device:
        raise SettingsError("--device is for workers here; set RPPM_DEVICE where the workers of a scheduler start")
    if options.parts:
        options.output = outputs_of_still(options)
    else:
        check_places(options.output, options.frames)
    for path in options.output:
        make_folder(path)
    names = ["frame", *(["seconds"] if options.frames else [])]
    request = FarmRequest(
        file=options.file.absolute(),
        outputs=[path.absolute() for path in options.output],
        options=_task_options(options, names),
        frames=options.frames or (),
        iterations=int(options.samples or 0),
        parts=options.parts or 0,
        chunk=options.chunk,
        scheduler=options.scheduler,
        devices=options.devices.split(",") if options.devices else [None] * options.workers,
        retries=options.retries,
        overwrite=options.overwrite,
    )
    with Interruption() as interruption:
        report = run_farm(request, bar, lambda: interruption.asked, options.debug)
    bar.clear()
    if report.failed:
        failed = ", ".join(report.failed)
        sys.stderr.write(f"rppm: {len(report.failed)} of {report.total} {report.kind} failed: {failed}\n")
    if not report.finished and interruption.asked:
        sys.stderr.write("rppm: interrupted; what is finished lies there, run the same again to go on\n")
        return interruption.status
    if report.failed:
        return 1
    print(f"{report.total} of {report.total} {report.kind}: {', '.join(str(path) for path in options.output)}")
    return 0


def _task_options(options: argparse.Namespace, names: list[str]) -> list[str]:
    """The options of rppm render that ``names``, the size, values and settings asked for make, as words."""
    words = []
    for name in names:
        if getattr(options, name) is not None:
            words += [f"--{name}", f"{getattr(options, name):.15g}"]
    if options.resolution is not None:
        words += ["--resolution", "{}x{}".format(*options.resolution)]
    if options.scene_name:
        words += ["--scene-name", options.scene_name]
    for name in options.view_layers:
        words += ["--view-layer", name]
    for value in options.values:
        words += ["--set", value]
    for name, value in given_settings(options).items():
        if options.frames or name != "samples":  # of a still those of all parts
            words += ["--set", f"rppm.{name}={value}"]
    return words
