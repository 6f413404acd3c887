# SPDX-License-Identifier: GPL-3.0-or-later
"""The rppm program: render and export from the command line, and what the device can do."""

import argparse
import dataclasses
import importlib.metadata
import io
import logging
import os
import sys
import traceback
from collections.abc import Sequence

from .commands.blend_files.fluid_domains import end_before_blender_aborts
from .commands.compiling import compile_programs
from .commands.farm.command import farm
from .commands.options.arguments import parser
from .commands.options.options import (
    is_blend,
    load_blend_or_saved,
    refuse_shared_files,
    request_of,
    split_values,
    write_json,
)
from .commands.picture_set import described
from .commands.recorder import apply_settings
from .commands.rendering import render
from .commands.terminal.interruption import INTERRUPTED
from .commands.terminal.progress_bar import LINE_SECONDS, BarLogHandler, ProgressBar
from .commands.terminal.texts import LineFormatter, printable
from .denoising.denoiser import Denoiser
from .denoising.places import library_places
from .gl.context.devices import Device, list_devices
from .pictures import PictureError, make_folder
from .scene import RenderSettings
from .scene.common.quantities import count_text
from .scene.errors import DenoiserError, DeviceError, RppmError, SettingsError, unforeseen


def main(arguments: Sequence[str] | None = None, line_seconds: float = LINE_SECONDS) -> int:
    """Run the program; returns the exit status. Errors are one line on standard error.

    line_seconds: between lines of progress, where standard error is no terminal.
    """
    status = _run(arguments, line_seconds)
    end_before_blender_aborts(status)
    return status


def _run(arguments: Sequence[str] | None, line_seconds: float) -> int:
    if isinstance(sys.stdout, io.TextIOWrapper):  # names of files may have letters that a pipe's encoding has not
        sys.stdout.reconfigure(errors="backslashreplace")
    options = parser().parse_args(arguments)
    bar = ProgressBar(sys.stderr, line_seconds)
    handler = BarLogHandler(bar, sys.stderr)
    handler.setFormatter(LineFormatter("rppm: %(message)s"))
    logging.basicConfig(level=logging.DEBUG if options.debug else logging.WARNING, handlers=[handler], force=True)
    if options.device is not None:
        os.environ["RPPM_DEVICE"] = options.device  # the engine inside Blender reads it too
    try:
        status = _RUNS[options.command](options, bar)
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
        message = unforeseen(error, "run again with --debug and report it")
        status = 1
    bar.clear()
    if options.debug:
        traceback.print_exc()
    sys.stderr.write(f"rppm: {printable(' '.join(message.split()))}\n")
    return status


def _merge(options: argparse.Namespace, bar: ProgressBar) -> int:
    from .commands.merging import merge_stills, write_stills

    refuse_shared_files(options.json, [*options.parts, *options.output])
    for path in options.output:
        make_folder(path)
    stills = merge_stills(options.parts, options.incomplete)
    files = [str(path) for path in write_stills(stills, options.output)]
    if options.json is not None:
        pictures = [{**dataclasses.asdict(still.name), **still.report()} for still in stills]
        report = stills[0].report() if len(stills) == 1 else {"pictures": pictures}
        write_json(options.json, {"files": files, **report})
    for still in stills:
        words = f"{still.iterations} samples, {count_text(still.photons)} photons of {len(still.parts)} "
        words += "part" if len(still.parts) == 1 else "parts"
        print(f"{words}: {', '.join(files)}" if len(stills) == 1 else f"{described(still.name)}: {words}")
    if len(stills) > 1:
        print(", ".join(files))
    return 0


def _export(options: argparse.Namespace, bar: ProgressBar) -> int:
    from .commands.blend_files import blend_file
    from .scene import save_scene

    if not is_blend(options.file):
        raise SettingsError(f"{options.file} is no .blend file; only those can be exported")
    settings, data_values = split_values(options.values)
    apply_settings(RenderSettings(), settings)
    make_folder(options.output)
    request = request_of(options.file, options, data_values)
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
    from .session.render.renderer import Renderer

    settings, data_values = split_values(options.values)
    apply_settings(RenderSettings(), settings)
    refuse_shared_files(options.json, [options.file, *options.output])
    for path in options.output:
        make_folder(path)
    scene = load_blend_or_saved(options.file, options, settings, data_values)
    with Renderer() as renderer:
        costs, counts, memory = renderer.inspect(scene)
    for path in options.output:
        greatest = write_inspection(path, costs, options.quantity, scene)
        if path.suffix == ".png":
            print(f"{path}: {options.quantity} from 0 (dark blue) to {greatest:g} (yellow)")
    if options.json is not None:
        write_json(options.json, {"scene": str(options.file), "counts": counts, "memory_bytes": memory})
    print("\n".join(inspection_lines(costs, counts, memory)))
    return 0


def _doctor(options: argparse.Namespace, bar: ProgressBar) -> int:
    from .self_test.report import report_text, write_report

    make_folder(options.output)
    try:
        found = write_report(options.output, bar.show, options.device)
    except OSError as error:
        raise PictureError(f"{options.output} cannot be written ({error}); choose another place with -o") from error
    bar.clear()
    print(f"{report_text(found)}\nWritten to {options.output}")
    return 0 if found.passed else 1


def _print_devices(devices: Sequence[Device], used: int | None) -> None:
    for device in devices:
        mark = "*" if device.number == used else " "
        print(f"{mark} --device {device.number} or {device.identity}: {device.label}")


def _info(options: argparse.Namespace, bar: ProgressBar) -> int:
    from .gl.context.context import device_information, open_others

    settings, data_values = split_values(options.values)
    if options.scene is None and (settings or data_values or options.resolution or options.frame is not None):
        raise SettingsError("--resolution, --frame and --set need a scene; name it with --scene FILE")
    apply_settings(RenderSettings(), settings)
    refuse_shared_files(options.json, [options.scene])
    try:
        blender = importlib.metadata.version("bpy")
    except importlib.metadata.PackageNotFoundError:
        blender = "no bpy module: saved scenes only (make setup, or pip install bpy==5.0.1)"
    print(f"Blender  {blender}")
    try:
        device = device_information()
    except DeviceError:
        _print_devices(open_others(list_devices(), None), None)
        raise
    unpacked = f", unpacked in {device.driver_folder}" if device.driver_folder else ""
    print(f"Device   {device.name}\nDriver   {device.driver}{unpacked}\nOpenGL   {device.version}")
    for warning in device.warnings:
        print(f"Warning  {warning}")
    devices = open_others(device.devices, device.number)
    _print_devices(devices, device.number)
    for name, value in device.limits.items():
        print(f"  {name} {value}")
    print("Missing  " + ("nothing" if not device.missing else "\n         ".join(device.missing)))
    try:
        denoiser = Denoiser(library_places()).description
    except DenoiserError as error:
        denoiser = f"none: {error}"
    print(f"Denoise  {denoiser}")
    device.devices = devices
    report: dict[str, object] = {"blender": blender, "device": dataclasses.asdict(device), "denoiser": denoiser}
    if options.scene is not None:
        from .commands.memory import memory_lines
        from .session.render.renderer import Renderer

        scene = load_blend_or_saved(options.scene, options, settings, data_values)
        with Renderer() as renderer:
            memory = renderer.memory(scene)
        print("\n".join([f"\nScene    {options.scene}", *memory_lines(memory, scene.camera.resolution)]))
        report |= {"scene": str(options.scene), "memory": memory.as_dict()}
    if options.json is not None:
        write_json(options.json, report)
    return 0


_RUNS = {
    "render": render,
    "merge": _merge,
    "farm": farm,
    "export": _export,
    "inspect": _inspect,
    "compile": compile_programs,
    "info": _info,
    "doctor": _doctor,
}
