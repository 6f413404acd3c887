# SPDX-License-Identifier: GPL-3.0-or-later
"""The rppm program: render and export from the command line, and what the device can do."""

import argparse
import dataclasses
import importlib.metadata
import json
import logging
import os
import sys
import traceback
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

from .commands.checkpoints import MINUTES, CheckpointRequest, StillKeeper
from .commands.data_paths import split_assignment
from .commands.frame_numbers import check_places, frame_numbers, has_place, path_of_frame
from .commands.interruption import Interruption
from .commands.progress_bar import BarLogHandler, ProgressBar
from .commands.recorder import RenderRecorder, RenderRequest, apply_settings
from .pictures import PictureError, make_folder, renamed_when_whole
from .scene import RenderSettings, Scene
from .scene.errors import RppmError, SettingsError
from .scene.quantities import count_text
from .scene.settings import CUBEMAP_COSTS

if TYPE_CHECKING:
    from .commands.blend_file import BlendRequest

INTERRUPTED = 130
"""Exit status after Ctrl-C, as shells have it, where nothing else is known."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the program; returns the exit status. Errors are one line on standard error."""
    options = _parser().parse_args(arguments)
    bar = ProgressBar(sys.stderr)
    handler = BarLogHandler(bar, sys.stderr)
    handler.setFormatter(logging.Formatter("rppm: %(message)s"))
    logging.basicConfig(level=logging.DEBUG if options.debug else logging.WARNING, handlers=[handler], force=True)
    if options.device is not None:
        os.environ["RPPM_DEVICE"] = options.device  # the engine inside Blender reads it too
    try:
        status = options.run(options, bar)
        sys.stdout.flush()
        return status
    except BrokenPipeError:  # the reader, such as head, has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except RppmError as error:
        message = str(error)
        status = 1
    except KeyboardInterrupt:
        message, status = "interrupted", INTERRUPTED
    except Exception as error:  # the last floor: a user gets a line, a developer --debug
        message = f"unexpected {type(error).__name__}: {error}; run again with --debug and report it"
        status = 1
    bar.clear()
    if options.debug:
        traceback.print_exc()
    sys.stderr.write(f"rppm: {' '.join(message.split())}\n")
    return status


class _Parser(argparse.ArgumentParser):
    """Says what is wrong with the arguments in one line."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {message}; see {self.prog} --help\n")


def _parser() -> argparse.ArgumentParser:
    common = argparse.ArgumentParser(add_help=False)
    common.add_argument("--debug", action="store_true", help="show tracebacks and everything that is logged")
    common.add_argument("--device", metavar="N", help="EGL device number; RPPM_DEVICE does the same")
    scene = argparse.ArgumentParser(add_help=False)
    scene.add_argument("--resolution", type=_resolution, metavar="WxH", help="size of the whole frame in pixels")
    scene.add_argument("--frame", type=int, metavar="N", help="frame number of a .blend file")
    scene.add_argument(
        "--set",
        dest="values",
        action="append",
        default=[],
        metavar="PATH=VALUE",
        help="rppm.NAME for a render setting (rppm.alpha=0.6); in a .blend file any data path below the scene or "
        "bpy.data (render.film_transparent=true, 'objects[\"Lamp\"].data.energy=50'); may be repeated",
    )

    parser = _Parser(prog="rppm", description="Progressive photon mapping by rasterization.")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    render = commands.add_parser(
        "render",
        parents=[scene, common],
        help="render a .blend file or a saved scene",
        description="Render a .blend file inside Blender (the bpy module), or a scene saved by rppm export without "
        "Blender. --seconds and --snapshots count from the moment the renderer is given the scene.",
    )
    render.add_argument("file", type=Path, metavar="FILE", help="a .blend file or a .npz of rppm export")
    render.add_argument(
        "-o",
        "--output",
        type=_picture_path,
        action="append",
        required=True,
        metavar="PICTURE",
        help=".exr (Combined as R, G, B, A, scene-linear; Depth and Normal as layers) or .png (of a .blend file by the "
        "scene's view transform, of a saved scene by Standard); may be repeated",
    )
    limit = render.add_mutually_exclusive_group()
    limit.add_argument("--iterations", type=_positive_integer, metavar="N", help="number of iterations")
    limit.add_argument("--seconds", type=_positive_number, metavar="S", help="render so long instead")
    limit.add_argument(
        "--iterations-range",
        type=_iterations_range,
        metavar="A:B",
        help="render the iterations from A up to but not including B, the first being 0; PICTURE is then an .exr with "
        "this part of the still, for rppm merge",
    )
    render.add_argument(
        "--frames",
        type=_frames,
        metavar="A..B",
        help="frames of a .blend file: 1..100, 1..100..5 (every fifth), 1,5,9; PICTURE has #### where the number goes",
    )
    render.add_argument("--photons", type=_positive_integer, metavar="N", help="photons of an iteration")
    render.add_argument(
        "--snapshots",
        type=_snapshot_marks,
        default=(),
        metavar="S,S,...",
        help="write an EXR at each of these seconds, named PICTURE_Ss.exr; without --iterations and --seconds the "
        "render lasts until the last",
    )
    render.add_argument("--json", type=Path, metavar="FILE", help="write what happened as JSON")
    render.add_argument(
        "--checkpoint",
        type=_exr_path,
        metavar="FILE.exr",
        help="write now and then, and when the render ends or is interrupted, all that it takes to go on",
    )
    render.add_argument(
        "--checkpoint-minutes",
        type=_checkpoint_minutes,
        default=MINUTES,
        metavar="N",
        help=f"from one checkpoint to the next; default: {MINUTES:g}",
    )
    render.add_argument(
        "--resume",
        action="store_true",
        help="go on from the checkpoint, bit for bit, and begin anew where it is missing; of --frames leave out those "
        "whose files are there",
    )
    render.set_defaults(run=_render)

    merge = commands.add_parser(
        "merge",
        parents=[common],
        help="make one picture of the parts of a still",
        description="Make one picture of the parts of a still that rppm render --iterations-range wrote, on as many "
        "machines as you like. Checkpoints will do as well.",
    )
    merge.add_argument("parts", type=Path, nargs="+", metavar="PART.exr", help="parts without common iterations")
    merge.add_argument(
        "-o",
        "--output",
        type=_picture_path,
        action="append",
        required=True,
        metavar="PICTURE",
        help=".exr or .png, as of rppm render; may be repeated",
    )
    merge.add_argument("--incomplete", action="store_true", help="merge what there is though iterations are missing")
    merge.add_argument("--json", type=Path, metavar="FILE", help="write what was merged as JSON")
    merge.set_defaults(run=_merge)

    _add_farm(commands, scene, common)

    export = commands.add_parser(
        "export", parents=[scene, common], help="save the scene of a .blend file for machines without Blender"
    )
    export.add_argument("file", type=Path, metavar="FILE.blend")
    export.add_argument("-o", "--output", type=Path, required=True, metavar="SCENE.npz")
    export.set_defaults(run=_export)

    inspect = commands.add_parser(
        "inspect",
        parents=[scene, common],
        help="picture what the camera's rays cost in the deep cubemap",
        description="Build the deep cubemap of a scene, trace a ray through each pixel's centre, and picture its cost.",
    )
    inspect.add_argument("file", type=Path, metavar="FILE", help="a .blend file or a .npz of rppm export")
    inspect.add_argument(
        "-o",
        "--output",
        type=_picture_path,
        action="append",
        required=True,
        metavar="PICTURE",
        help=".png of one quantity in false colours, or .exr of all as they are; may be repeated",
    )
    inspect.add_argument(
        "--quantity",
        choices=CUBEMAP_COSTS,
        default=CUBEMAP_COSTS[0],
        help="what the .png shows: steps (cells and blocks looked at), tests (of triangles), list (entries in the cell "
        "that is hit), entries (read along the ray); default: steps",
    )
    inspect.add_argument("--json", type=Path, metavar="FILE", help="write counts and bytes by buffer as JSON")
    inspect.set_defaults(run=_inspect)

    info = commands.add_parser(
        "info",
        parents=[scene, common],
        help="show the device, its driver and limits, what is missing; the memory that a scene takes",
        description="Show the device, its driver and limits, and what is missing. With --scene, build the scene on the "
        "device and show the bytes of each buffer, the buffers of progressive photon mapping against the paper's.",
    )
    info.add_argument("--scene", type=Path, metavar="FILE", help="a .blend file or a .npz of rppm export")
    info.add_argument("--json", type=Path, metavar="FILE", help="write it as JSON")
    info.set_defaults(run=_info)
    return parser


def _add_farm(commands, scene: argparse.ArgumentParser, common: argparse.ArgumentParser) -> None:
    farm = commands.add_parser(
        "farm",
        parents=[scene, common],
        help="render an animation or the parts of a still on several processes or machines",
        description="Render frames, or parts of a still that are merged, on workers of dask.distributed. Pictures that "
        "are there and whole are left alone, so the same command goes on where an interrupted one was.",
    )
    farm.add_argument("file", type=Path, metavar="FILE", help="a .blend file; for a still also a .npz of rppm export")
    farm.add_argument(
        "-o",
        "--output",
        type=_picture_path,
        action="append",
        required=True,
        metavar="PICTURE",
        help="as in rppm render, with #### for the frame's number; may be repeated",
    )
    what = farm.add_mutually_exclusive_group(required=True)
    what.add_argument("--frames", type=_frames, metavar="A..B", help="an animation: 1..100, 1..100..5 or 1,5,9")
    what.add_argument("--parts", type=_positive_integer, metavar="K", help="a still, its iterations in so many parts")
    limit = farm.add_mutually_exclusive_group()
    limit.add_argument(
        "--iterations", type=_positive_integer, metavar="N", help="iterations of a frame, or of the still"
    )
    limit.add_argument("--seconds", type=_positive_number, metavar="S", help="render each frame so long instead")
    farm.add_argument("--photons", type=_positive_integer, metavar="N", help="photons of an iteration")
    where = farm.add_mutually_exclusive_group()
    where.add_argument("--scheduler", metavar="ADDRESS", help="dask scheduler, such as tcp://host:8786")
    where.add_argument(
        "--workers", type=_positive_integer, default=1, metavar="N", help="so many renders at a time here; default: 1"
    )
    where.add_argument("--devices", metavar="N,N,...", help="a render at a time here on each of these EGL devices")
    farm.add_argument(
        "--chunk",
        type=_positive_integer,
        default=1,
        metavar="N",
        help="render so many frames with one start of Blender, which loads the file and programs once; default: 1",
    )
    farm.add_argument(
        "--retries", type=_count, default=2, metavar="N", help="how often a frame or part is tried again; default: 2"
    )
    farm.add_argument("--overwrite", action="store_true", help="make pictures anew that are there")
    farm.set_defaults(run=_farm)


def _render(options: argparse.Namespace, bar: ProgressBar) -> int:
    settings, data_values = _split_values(options.values)
    if options.iterations is not None:
        settings["iterations"] = options.iterations
    if options.photons is not None:
        settings["photons"] = options.photons
    is_blend = _is_blend(options.file)
    blend_request = None
    if is_blend:
        from .commands import blend_file

        data_values += _values_of_frames(settings)
        blend_request = blend_file.BlendRequest(options.file, options.frame, options.resolution, data_values)
    apply_settings(RenderSettings(), settings)  # a wrong value is better told now than after Blender's start
    if options.frames is not None:
        return _render_frames(options, bar, blend_request, settings)
    options.output = _outputs_of_still(options)
    keeper = _still_keeper(options, settings, {"blend": blend_request.as_plain()} if blend_request else {})
    for path in [*options.output, *([options.checkpoint] if options.checkpoint else [])]:
        make_folder(path)
    seconds = options.seconds
    if seconds is None and options.iterations is None and options.snapshots:
        seconds = options.snapshots[-1]
    outputs = [] if options.iterations_range else options.output
    request = RenderRequest(outputs, settings, seconds, options.snapshots)
    with Interruption() as interruption:
        recorder = RenderRecorder(request, bar, lambda: interruption.asked, not is_blend, keeper)
        report: dict[str, object] = {"scene": str(options.file)}
        if blend_request:
            blender_report = blend_file.render_blend_file(blend_request, recorder, show_output=options.debug)
            report["blender"] = dataclasses.asdict(blender_report)
        else:
            from .commands.saved_scene import render_saved_scene

            _refuse_blend_options(options, data_values)
            render_saved_scene(options.file, recorder, options.resolution)
    bar.clear()
    if options.json is not None:
        _write_json(options.json, report | recorder.report())
    missed = request.snapshots[len(recorder.snapshots_written) :]
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
    from .commands.animation import Animation, AnimationRequest

    if blend_request is None:
        raise SettingsError("--frames needs a .blend file; a saved scene holds one frame")
    if options.frame is not None:
        raise SettingsError("--frame and --frames do not go together; leave one out")
    if options.checkpoint is not None or options.iterations_range is not None:
        raise SettingsError("--checkpoint and --iterations-range are for stills; name one frame with --frame")
    check_places(options.output, options.frames)
    for path in options.output:
        make_folder(path)
    seconds = options.seconds
    if seconds is None and options.iterations is None and options.snapshots:
        seconds = options.snapshots[-1]
    render = RenderRequest(options.output, settings, seconds, options.snapshots)
    request = AnimationRequest(blend_request, render, options.frames, options.resume)

    def write_report(report: dict[str, object]) -> None:
        if options.json is not None:
            _write_json(options.json, report)

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


def _outputs_of_still(options: argparse.Namespace) -> list[Path]:
    """The files of a still, with its frame's number where they have a place for one."""
    if options.frame is not None:
        return [path_of_frame(path, options.frame) for path in options.output]
    for path in options.output:
        if has_place(path):
            raise SettingsError(f"{path} has a place for a frame number; say which frame, or name it without #")
    return options.output


def _values_of_frames(settings: dict[str, object]) -> list[tuple[str, str]]:
    """Take what makes the seed of a frame out of the settings, to be set in the .blend file."""
    return [(f"rppm.{name}", str(settings.pop(name))) for name in ("seed", "animate_seed") if name in settings]


def _still_keeper(
    options: argparse.Namespace, settings: dict[str, object], source: dict[str, object]
) -> StillKeeper | None:
    """Who keeps the still, if it is to be kept or rendered in part; the range's length and no time limit enter the
    settings."""
    if options.iterations_range is None and options.checkpoint is None and not options.resume:
        return None
    first, part = 0, None
    if options.iterations_range is not None:
        first, end = options.iterations_range
        if len(options.output) > 1 or options.output[0].suffix != ".exr" or options.snapshots:
            raise SettingsError(
                "--iterations-range writes one part for rppm merge; give one -o PART.exr and no --snapshots"
            )
        part = options.output[0]
        settings |= {"iterations": end - first, "time_limit": 0.0}
    elif options.checkpoint in options.output:
        raise SettingsError(f"--checkpoint and -o both name {options.checkpoint}; give the checkpoint another name")
    request = CheckpointRequest(options.checkpoint, options.checkpoint_minutes, options.resume, part, first, source)
    keeper = StillKeeper(request)
    if keeper.starts_over:
        sys.stderr.write(f"rppm: {options.checkpoint} is not there yet: the render starts from the beginning\n")
    return keeper


def _merge(options: argparse.Namespace, bar: ProgressBar) -> int:
    from .commands.merging import merge_parts

    for path in options.output:
        make_folder(path)
    merged = merge_parts(options.parts, options.incomplete)
    merged.write(options.output)
    files = [str(path) for path in options.output]
    if options.json is not None:
        _write_json(options.json, {"files": files, **merged.report()})
    print(
        f"{merged.iterations} iterations, {count_text(merged.photons)} photons of {len(merged.parts)} "
        f"{'part' if len(merged.parts) == 1 else 'parts'}: {', '.join(files)}"
    )
    return 0


def _farm(options: argparse.Namespace, bar: ProgressBar) -> int:
    try:
        from .commands.farm.job import FarmRequest, run_farm
    except ImportError as error:
        raise SettingsError(
            f"rppm farm needs dask.distributed ({error}); install it with pip install -e '.[farm]'"
        ) from error

    settings, data_values = _split_values(options.values)
    settings |= {
        name: getattr(options, name) for name in ("iterations", "photons") if getattr(options, name) is not None
    }
    is_blend = _is_blend(options.file)
    if is_blend:
        _values_of_frames(settings)
    apply_settings(RenderSettings(), settings)
    if not is_blend:
        if options.frames:
            raise SettingsError("--frames needs a .blend file; a saved scene holds one frame")
        _refuse_blend_options(options, data_values)
    if options.frames and options.frame is not None:
        raise SettingsError("--frame is for a still; name the frames of an animation with --frames alone")
    if options.parts and options.iterations is None:
        raise SettingsError("a still in --parts needs --iterations, those of all parts together")
    if options.scheduler and options.device:
        raise SettingsError("--device is for workers here; set RPPM_DEVICE where the workers of a scheduler start")
    if options.parts:
        options.output = _outputs_of_still(options)
    else:
        check_places(options.output, options.frames)
    for path in options.output:
        make_folder(path)
    names = ["frame", "photons", *(["iterations", "seconds"] if options.frames else [])]
    request = FarmRequest(
        file=options.file.absolute(),
        outputs=[path.absolute() for path in options.output],
        options=_task_options(options, names),
        frames=options.frames or (),
        iterations=options.iterations or 0,
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
        names = ", ".join(report.failed)
        sys.stderr.write(f"rppm: {len(report.failed)} of {report.total} {report.kind} failed: {names}\n")
    if not report.finished and interruption.asked:
        sys.stderr.write("rppm: interrupted; what is finished lies there, run the same again to go on\n")
        return interruption.status
    if report.failed:
        return 1
    print(f"{report.total} of {report.total} {report.kind}: {', '.join(str(path) for path in options.output)}")
    return 0


def _task_options(options: argparse.Namespace, names: list[str]) -> list[str]:
    """The options of rppm render that ``names`` and the size and values asked for make, as words."""
    words = []
    for name in names:
        if getattr(options, name) is not None:
            words += [f"--{name}", f"{getattr(options, name):.15g}"]
    if options.resolution is not None:
        words += ["--resolution", "{}x{}".format(*options.resolution)]
    for value in options.values:
        words += ["--set", value]
    return words


def _export(options: argparse.Namespace, bar: ProgressBar) -> int:
    from .commands import blend_file
    from .scene import save_scene

    if not _is_blend(options.file):
        raise SettingsError(f"{options.file} is no .blend file; only those can be exported")
    settings, data_values = _split_values(options.values)
    apply_settings(RenderSettings(), settings)
    make_folder(options.output)
    request = blend_file.BlendRequest(options.file, options.frame, options.resolution, data_values)
    scene = blend_file.export_blend_file(request, show_output=options.debug)
    scene.settings = apply_settings(scene.settings, settings)
    try:
        save_scene(scene, options.output)
    except OSError as error:
        raise PictureError(f"{options.output} cannot be written ({error}); choose another place with -o") from error
    bar.clear()
    counts = f"{scene.triangle_count} triangles, {len(scene.lights)} lights, {len(scene.materials)} materials"
    print(f"{counts}: {options.output}")
    return 0


def _inspect(options: argparse.Namespace, bar: ProgressBar) -> int:
    from .commands.inspection import inspection_lines, write_inspection
    from .session.renderer import Renderer

    settings, data_values = _split_values(options.values)
    apply_settings(RenderSettings(), settings)
    for path in options.output:
        make_folder(path)
    scene = _load_scene(options.file, options, settings, data_values)
    with Renderer() as renderer:
        costs, counts, memory = renderer.inspect(scene)
    for path in options.output:
        greatest = write_inspection(path, costs, options.quantity, scene)
        if path.suffix == ".png":
            print(f"{path}: {options.quantity} from 0 (dark blue) to {greatest:g} (yellow)")
    if options.json is not None:
        _write_json(options.json, {"scene": str(options.file), "counts": counts, "memory_bytes": memory})
    print("\n".join(inspection_lines(costs, counts, memory)))
    return 0


def _info(options: argparse.Namespace, bar: ProgressBar) -> int:
    from .gl.context import device_information

    settings, data_values = _split_values(options.values)
    if options.scene is None and (settings or data_values or options.resolution or options.frame is not None):
        raise SettingsError("--resolution, --frame and --set need a scene; name it with --scene FILE")
    apply_settings(RenderSettings(), settings)
    try:
        blender = importlib.metadata.version("bpy")
    except importlib.metadata.PackageNotFoundError:
        blender = "no bpy module: saved scenes only (make setup, or pip install bpy==5.0.1)"
    print(f"Blender  {blender}")
    device = device_information(options.device)
    print(f"Device   {device.name}\nDriver   {device.driver}\nOpenGL   {device.version}")
    for name, value in device.limits.items():
        print(f"  {name} {value}")
    print("Missing  " + ("nothing" if not device.missing else "\n         ".join(device.missing)))
    report: dict[str, object] = {"blender": blender, "device": dataclasses.asdict(device)}
    if options.scene is not None:
        from .commands.memory import memory_lines
        from .session.renderer import Renderer

        scene = _load_scene(options.scene, options, settings, data_values)
        with Renderer() as renderer:
            memory = renderer.memory(scene)
        print("\n".join([f"\nScene    {options.scene}", *memory_lines(memory, scene.camera.resolution)]))
        report |= {"scene": str(options.scene), "memory": memory.as_dict()}
    if options.json is not None:
        _write_json(options.json, report)
    return 0


def _load_scene(
    file: Path, options: argparse.Namespace, settings: dict[str, object], data_values: list[tuple[str, str]]
) -> Scene:
    """A .blend's or a saved scene at --frame and --resolution, with settings and data values of --set."""
    if _is_blend(file):
        from .commands import blend_file

        request = blend_file.BlendRequest(file, options.frame, options.resolution, data_values)
        scene = blend_file.export_blend_file(request, show_output=options.debug)
    else:
        from .commands.saved_scene import camera_at_resolution
        from .scene import load_scene

        _refuse_blend_options(options, data_values)
        scene = load_scene(file)
        if options.resolution is not None:
            scene.camera = camera_at_resolution(scene.camera, *options.resolution)
    scene.settings = apply_settings(scene.settings, settings)
    return scene


def _is_blend(path: Path) -> bool:
    """Whether to hand the file to Blender; raises SettingsError when it is neither kind."""
    suffix = path.suffix.lower()
    if suffix not in (".blend", ".npz"):
        raise SettingsError(f"{path} is neither a .blend file nor a saved scene (.npz)")
    return suffix == ".blend"


def _split_values(values: list[str]) -> tuple[dict[str, object], list[tuple[str, str]]]:
    """Split --set into render settings by name, and data paths of a .blend file."""
    settings: dict[str, object] = {}
    data_values = []
    for text in values:
        path, value = split_assignment(text)
        if path.startswith("rppm."):
            settings[path.removeprefix("rppm.")] = value
        else:
            data_values.append((path, value))
    return settings, data_values


def _refuse_blend_options(options: argparse.Namespace, data_values: list[tuple[str, str]]) -> None:
    if options.frame is not None:
        raise SettingsError("--frame needs a .blend file; a saved scene holds one frame")
    if data_values:
        raise SettingsError(f"--set {data_values[0][0]} needs a .blend file; a saved scene takes rppm.NAME only")


def _write_json(path: Path, report: dict[str, object]) -> None:
    make_folder(path)
    text = json.dumps(report, indent=2) + "\n"
    try:
        if path.exists() and not path.is_file():  # such as /dev/stdout
            path.write_text(text, encoding="utf-8")
            return
        with renamed_when_whole(path) as temporary:
            Path(temporary).write_text(text, encoding="utf-8")
    except OSError as error:
        raise PictureError(f"{path} cannot be written ({error}); choose another place with --json") from error
    except PictureError as error:
        raise PictureError(str(error).replace("with -o", "with --json")) from error


def _checked(convert: Callable, accept: Callable, what: str) -> Callable:
    """An argparse type that converts, checks and says what was wanted."""

    def parse(text: str):
        try:
            value = convert(text)
        except ValueError:
            value = None
        if value is None or not accept(value):
            raise argparse.ArgumentTypeError(f"{text!r} is not {what}")
        return value

    return parse


def _frames(text: str) -> tuple[int, ...]:
    try:
        return frame_numbers(text)
    except SettingsError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def _two_integers(text: str) -> tuple[int, int]:
    width, height = text.lower().split("x")
    return int(width), int(height)


def _range(text: str) -> tuple[int, int]:
    first, end = text.split(":")
    return int(first), int(end)


def _numbers(text: str) -> tuple[float, ...]:
    return tuple(float(item) for item in text.split(","))


_positive_integer = _checked(int, lambda value: value > 0, "a whole number above 0")
_count = _checked(int, lambda value: value >= 0, "a whole number, or 0")
_positive_number = _checked(float, lambda value: 0.0 < value < 1e9, "a number of seconds above 0")
_resolution = _checked(
    _two_integers, lambda size: all(1 <= side <= 65536 for side in size), "a resolution such as 640x480"
)
_snapshot_marks = _checked(
    _numbers,
    lambda marks: all(0.0 < mark < 1e9 for mark in marks) and list(marks) == sorted(set(marks)),
    "an ascending list of seconds such as 2,5,10",
)
_iterations_range = _checked(
    _range, lambda ends: 0 <= ends[0] < ends[1] < 1 << 30, "a range of iterations such as 0:500"
)
_checkpoint_minutes = _checked(float, lambda value: 0.0 <= value < 1e9, "a number of minutes")
_exr_path = _checked(Path, lambda path: path.suffix == ".exr", "the name of an .exr file")
_picture_path = _checked(Path, lambda path: path.suffix in (".exr", ".png"), "the name of an .exr or .png file")
