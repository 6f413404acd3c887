# SPDX-License-Identifier: GPL-3.0-or-later
"""Which arguments the rppm program takes."""

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import Any, NoReturn, TypeAlias

from ...scene.errors import SettingsError
from ...scene.settings import CUBEMAP_COSTS
from ...session.checkpoints.checkpoint_writer import MINUTES
from .frame_numbers import frame_numbers
from .setting_options import add_setting, add_settings

_Commands: TypeAlias = "argparse._SubParsersAction[Any]"


def parser() -> argparse.ArgumentParser:
    """Return the parser of the whole program. Parsed options have the name of the command as ``command``."""
    common = argparse.ArgumentParser(add_help=False)
    common.add_argument("--debug", action="store_true", help="show tracebacks and everything that is logged")
    common.add_argument("--device", metavar="DEVICE", help="one that info lists; RPPM_DEVICE does the same")
    scene = argparse.ArgumentParser(add_help=False)
    scene.add_argument("--resolution", type=_resolution, metavar="WxH", help="size of the whole frame in pixels")
    scene.add_argument("--frame", type=int, metavar="N", help="frame number of a .blend file")
    scene.add_argument(
        "--scene-name",
        default="",
        metavar="NAME",
        help="scene of a .blend file; default: the one that it was saved with open",
    )
    scene.add_argument(
        "--view-layer",
        dest="view_layers",
        action="append",
        default=[],
        metavar="NAME",
        help="view layer of a .blend file; may be repeated where several are rendered; default: those in use",
    )
    scene.add_argument(
        "--set",
        dest="values",
        action="append",
        default=[],
        metavar="PATH=VALUE",
        help="rppm.NAME for a render setting (rppm.alpha=0.6); in a .blend file any data path below the scene or "
        "bpy.data (render.film_transparent=true, 'objects[\"Light\"].data.energy=50'); may be repeated",
    )

    program = _Parser(prog="rppm", description="Progressive photon mapping by rasterization.")
    commands = program.add_subparsers(required=True, metavar="COMMAND", dest="command")
    _add_render(commands, scene, common)
    _add_merge(commands, common)
    _add_farm(commands, scene, common)
    _add_export(commands, scene, common)
    _add_inspect(commands, scene, common)
    _add_compile(commands, scene, common)
    _add_info(commands, scene, common)
    _add_doctor(commands, common)
    return program


class _Parser(argparse.ArgumentParser):
    """Says what is wrong with the arguments in one line."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {message}; see {self.prog} --help\n")


def _add_render(commands: _Commands, scene: argparse.ArgumentParser, common: argparse.ArgumentParser) -> None:
    render = commands.add_parser(
        "render",
        parents=[scene, common],
        help="render a .blend file or a saved scene",
        description="Render a .blend file inside Blender (the bpy module), or a scene saved by rppm export without "
        "Blender. --seconds and --snapshots count from the moment the renderer is given the scene.",
    )
    render.add_argument("file", type=Path, metavar="FILE", help="a .blend file or a .npz of rppm export")
    _add_output(
        render,
        ".exr (Combined as R, G, B, A, scene-linear; Depth and Normal as layers) or .png (of a .blend file by the "
        "scene's view transform, of a saved scene by Standard); may be repeated",
    )
    limit = render.add_mutually_exclusive_group()
    add_setting(limit, "iterations")
    limit.add_argument("--seconds", type=_positive_number, metavar="S", help="render so long instead")
    limit.add_argument(
        "--samples-range",
        type=_samples_range,
        metavar="A:B",
        help="render the samples from A up to but not including B, the first being 0; PICTURE is then an .exr with "
        "this part of the still, for rppm merge",
    )
    render.add_argument(
        "--frames",
        type=_frames,
        metavar="A..B",
        help="frames of a .blend file: 1..100, 1..100..5 (every fifth), 1,5,9; PICTURE has #### where the number goes",
    )
    render.add_argument(
        "--snapshots",
        type=_snapshot_marks,
        default=(),
        metavar="S,S,...",
        help="write an EXR at each of these seconds, named PICTURE_Ss.exr; without --samples and --seconds the "
        "render lasts until the last",
    )
    _add_json(render, "write what happened as JSON")
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
    add_settings(render)


def _add_merge(commands: _Commands, common: argparse.ArgumentParser) -> None:
    merge = commands.add_parser(
        "merge",
        parents=[common],
        help="make one picture of the parts of a still",
        description="Make one picture of the parts of a still that rppm render --samples-range wrote, on as many "
        "machines as you like. Checkpoints will do as well.",
    )
    merge.add_argument("parts", type=Path, nargs="+", metavar="PART.exr", help="parts without common samples")
    _add_output(
        merge,
        ".exr or .png, as of rppm render; may be repeated",
    )
    merge.add_argument("--incomplete", action="store_true", help="merge what there is though samples are missing")
    _add_json(merge, "write what was merged as JSON")


def _add_farm(commands: _Commands, scene: argparse.ArgumentParser, common: argparse.ArgumentParser) -> None:
    farm = commands.add_parser(
        "farm",
        parents=[scene, common],
        help="render an animation or the parts of a still on several processes or machines",
        description="Render frames, or parts of a still that are merged, on workers of dask.distributed. Pictures that "
        "are there and whole are left alone, so the same command goes on where an interrupted one was.",
    )
    farm.add_argument("file", type=Path, metavar="FILE", help="a .blend file; for a still also a .npz of rppm export")
    _add_output(
        farm,
        "as in rppm render, with #### for the frame's number; may be repeated",
    )
    what = farm.add_mutually_exclusive_group(required=True)
    what.add_argument("--frames", type=_frames, metavar="A..B", help="an animation: 1..100, 1..100..5 or 1,5,9")
    what.add_argument("--parts", type=_positive_integer, metavar="K", help="a still, its samples in so many parts")
    limit = farm.add_mutually_exclusive_group()
    add_setting(limit, "iterations")
    limit.add_argument("--seconds", type=_positive_number, metavar="S", help="render each frame so long instead")
    where = farm.add_mutually_exclusive_group()
    where.add_argument("--scheduler", metavar="ADDRESS", help="dask scheduler, such as tcp://host:8786")
    where.add_argument(
        "--workers", type=_positive_integer, default=1, metavar="N", help="so many renders at a time here; default: 1"
    )
    where.add_argument("--devices", metavar="DEVICE,...", help="a render at a time here on each of these devices")
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
    add_settings(farm)


def _add_export(commands: _Commands, scene: argparse.ArgumentParser, common: argparse.ArgumentParser) -> None:
    export = commands.add_parser(
        "export", parents=[scene, common], help="save the scene of a .blend file for machines without Blender"
    )
    export.add_argument("file", type=Path, metavar="FILE.blend")
    export.add_argument("-o", "--output", type=Path, required=True, metavar="SCENE.npz")


def _add_inspect(commands: _Commands, scene: argparse.ArgumentParser, common: argparse.ArgumentParser) -> None:
    inspect = commands.add_parser(
        "inspect",
        parents=[scene, common],
        help="picture what the camera's rays cost in the deep cubemap",
        description="Build the deep cubemap of a scene, trace a ray through each pixel's center, and picture its cost.",
    )
    inspect.add_argument("file", type=Path, metavar="FILE", help="a .blend file or a .npz of rppm export")
    _add_output(
        inspect,
        ".png of one quantity in false colors, or .exr of all as they are; may be repeated",
    )
    inspect.add_argument(
        "--quantity",
        choices=CUBEMAP_COSTS,
        default=CUBEMAP_COSTS[0],
        help="what the .png shows: steps (cells and blocks looked at), tests (of triangles), list (entries in the cell "
        "that is hit), entries (read along the ray); default: steps",
    )
    _add_json(inspect, "write counts and bytes by buffer as JSON")


def _add_compile(commands: _Commands, scene: argparse.ArgumentParser, common: argparse.ArgumentParser) -> None:
    compile_ = commands.add_parser(
        "compile",
        parents=[scene, common],
        help="compile the programs that a scene needs, so that its first picture need not wait for them",
        description="Compile the programs that pictures of a scene need and keep them on the disk, where renders and "
        "Blender find them. Other scenes share all but those of the materials.",
    )
    compile_.add_argument("file", type=Path, metavar="FILE", help="a .blend file or a .npz of rppm export")


def _add_info(commands: _Commands, scene: argparse.ArgumentParser, common: argparse.ArgumentParser) -> None:
    info = commands.add_parser(
        "info",
        parents=[scene, common],
        help="show the device, its driver and limits, what is missing; the memory that a scene takes",
        description="Show the device, its driver and limits, and what is missing. With --scene, build the scene on the "
        "device and show the bytes of each buffer, the buffers of progressive photon mapping against the paper's.",
    )
    info.add_argument("--scene", type=Path, metavar="FILE", help="a .blend file or a .npz of rppm export")
    _add_json(info, "write it as JSON")


def _add_doctor(commands: _Commands, common: argparse.ArgumentParser) -> None:
    doctor = commands.add_parser(
        "doctor",
        parents=[common],
        help="try the device and write a report that can be attached to a bug report",
        description="Try the device: rays against brute force, light whose radiance is known, a small picture, speeds. "
        "The report names the system, its driver and packages, but no person, machine or file.",
    )
    doctor.add_argument(
        "-o", "--output", type=Path, default=Path("rppm_report.txt"), metavar="REPORT.txt", help="where it is written"
    )


def _add_output(command: argparse.ArgumentParser, text: str) -> None:
    command.add_argument(
        "-o", "--output", type=_picture_path, action="append", required=True, metavar="PICTURE", help=text
    )


def _add_json(command: argparse.ArgumentParser, text: str) -> None:
    command.add_argument("--json", type=Path, metavar="FILE", help=text)


def _checked(convert: Callable, accept: Callable, what: str) -> Callable:
    """An argparse type that converts, checks and says what was wanted."""

    def parse(text: str) -> object:
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
_samples_range = _checked(_range, lambda ends: 0 <= ends[0] < ends[1] < 1 << 30, "a range of samples such as 0:500")
_checkpoint_minutes = _checked(float, lambda value: 0.0 <= value < 1e9, "a number of minutes")
_exr_path = _checked(Path, lambda path: path.suffix == ".exr", "the name of an .exr file")
_picture_path = _checked(Path, lambda path: path.suffix in (".exr", ".png"), "the name of an .exr or .png file")
