# SPDX-License-Identifier: GPL-3.0-or-later
"""rppm render: a still, or the frames of an animation."""

import argparse
import dataclasses
import sys
from typing import TYPE_CHECKING

from ..pictures import make_folder
from ..scene import RenderSettings
from ..scene.errors import SettingsError
from ..session.checkpoints.checkpoint_writer import CheckpointRequest, CheckpointWriter
from .options.frame_numbers import check_places
from .options.options import (
    is_blend,
    outputs_of_still,
    refuse_blend_options,
    refuse_shared_files,
    request_of,
    seconds_of,
    values_and_limits,
    values_of_frames,
    write_json,
)
from .picture_set import PictureSet, recorded_pictures
from .recorder import RenderRecorder, RenderRequest, apply_settings
from .terminal.interruption import Interruption
from .terminal.progress_bar import ProgressBar

if TYPE_CHECKING:
    from .blend_files.blend_file import BlendRequest


def render(options: argparse.Namespace, bar: ProgressBar) -> int:
    """Do it; returns the exit status."""
    settings, data_values = values_and_limits(options)
    from_blend = is_blend(options.file)
    blend_request = None
    if from_blend:
        from .blend_files import blend_file

        data_values += values_of_frames(settings)
        blend_request = request_of(options.file, options, data_values)
    apply_settings(RenderSettings(), settings)  # a wrong value is better reported now than after Blender's start
    if options.frames is not None:
        return _render_frames(options, bar, blend_request, settings)
    options.output = outputs_of_still(options)
    snapshots = [RenderRequest(options.output).snapshot_path(mark) for mark in options.snapshots]
    refuse_shared_files(options.json, [options.file, *options.output, options.checkpoint, *snapshots])
    keeper = _still_keeper(options, settings, {"blend": blend_request.as_plain()} if blend_request else {})
    for path in [*options.output, *([options.checkpoint] if options.checkpoint else [])]:
        make_folder(path)
    outputs = [] if options.samples_range else options.output
    request = RenderRequest(outputs, settings, seconds_of(options), options.snapshots)
    with Interruption() as interruption:
        recorder: RenderRecorder | PictureSet
        report: dict[str, object] = {"scene": str(options.file)}
        if blend_request:
            recorder = pictures = recorded_pictures(request, bar, lambda: interruption.asked, keeper)
            interruption.has_work = lambda: pictures.has_samples
            blender_report = blend_file.render_blend_file(blend_request, recorder, show_output=options.debug)
            report["blender"] = dataclasses.asdict(blender_report)
        else:
            from .saved_scene import render_saved_scene

            refuse_blend_options(options, data_values)
            recorder = still = RenderRecorder(request, bar, lambda: interruption.asked, True, keeper)
            interruption.has_work = lambda: still.has_samples
            render_saved_scene(options.file, recorder, options.resolution)
    bar.clear()
    if options.json is not None:
        write_json(options.json, report | recorder.report())
    missed = recorder.snapshots_missed
    if missed:
        marks = ", ".join(f"{mark:g}" for mark in missed)
        sys.stderr.write(f"rppm: the render ended before the snapshots at {marks} s\n")
    print(recorder.summary())
    if interruption.asked:
        resume = "; go on with --resume" if options.checkpoint else ""
        done = "the files hold what was done until then" if recorder.files else "nothing was done yet"
        sys.stderr.write(f"rppm: interrupted; {done}{resume}\n")
        return interruption.status
    return 0


def _render_frames(
    options: argparse.Namespace, bar: ProgressBar, blend_request: "BlendRequest | None", settings: dict[str, object]
) -> int:
    from .animation import Animation, AnimationRequest

    if blend_request is None:
        raise SettingsError("--frames needs a .blend file; a saved scene holds one frame")
    if options.frame is not None:
        raise SettingsError("--frame and --frames do not go together; leave one out")
    if options.checkpoint is not None or options.samples_range is not None:
        raise SettingsError("--checkpoint and --samples-range are for stills; name one frame with --frame")
    check_places(options.output, options.frames)
    render = RenderRequest(options.output, settings, seconds_of(options), options.snapshots)
    request = AnimationRequest(blend_request, render, options.frames, options.resume)
    pictures = (path for frame in options.frames for path in request.outputs(frame))
    refuse_shared_files(options.json, [options.file, *pictures])
    for path in options.output:
        make_folder(path)

    def write_report(report: dict[str, object]) -> None:
        if options.json is not None:
            write_json(options.json, report)

    with Interruption() as interruption:
        animation = Animation(request, bar, interruption, write_report)
        animation.run(show_output=options.debug)
    bar.clear()
    if interruption.asked:
        sys.stderr.write(
            f"rppm: interrupted; {len(animation.rendered)} frames were rendered, the files are whole; go on with "
            "--resume\n"
        )
        return interruption.status
    if animation.failed:
        frames = ", ".join(map(str, animation.failed))
        sys.stderr.write(f"rppm: frames that could not be rendered: {frames}\n")
        return 1
    return 0


def _still_keeper(
    options: argparse.Namespace, settings: dict[str, object], source: dict[str, object]
) -> CheckpointWriter | None:
    """Who keeps the still, if it is to be kept or rendered in part; the range's length enters the settings, and that
    nothing else ends the render."""
    if options.samples_range is None and options.checkpoint is None and not options.resume:
        return None
    first, part = 0, None
    if options.samples_range is not None:
        first, end = options.samples_range
        if len(options.output) > 1 or options.output[0].suffix != ".exr" or options.snapshots:
            raise SettingsError(
                "--samples-range writes one part for rppm merge; give one -o PART.exr and no --snapshots"
            )
        part = options.output[0]
        settings |= {"samples": end - first, "time_limit": 0.0, "use_adaptive_sampling": False}
    elif options.checkpoint in options.output:
        raise SettingsError(f"--checkpoint and -o both name {options.checkpoint}; give the checkpoint another name")
    request = CheckpointRequest(options.checkpoint, options.checkpoint_minutes, options.resume, part, first, source)
    keeper = CheckpointWriter(request)
    if keeper.starts_over:
        sys.stderr.write(f"rppm: {options.checkpoint} is not there yet: the render starts from the beginning\n")
    return keeper
