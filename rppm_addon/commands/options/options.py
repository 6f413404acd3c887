# SPDX-License-Identifier: GPL-3.0-or-later
"""Handling of options that the commands of the rppm program share."""

import argparse
import json
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from ...pictures import PictureError, make_folder, renamed_when_whole
from ...scene import Scene
from ...scene.common.whole_files import is_no_file
from ...scene.errors import SettingsError
from ..blend_files.data_paths import split_assignment
from ..recorder import apply_settings
from .frame_numbers import has_place, path_of_frame
from .setting_options import given_settings

if TYPE_CHECKING:
    from ..blend_files.blend_file import BlendRequest


def is_blend(path: Path) -> bool:
    """Whether to hand the file to Blender; raises SettingsError when it is neither kind."""
    suffix = path.suffix.lower()
    if suffix not in (".blend", ".npz"):
        raise SettingsError(f"{path} is neither a .blend file nor a saved scene (.npz)")
    return suffix == ".blend"


_OF_BLEND_FILES = frozenset({"film_exposure", "cubemap_center_object"})
"""Properties of scene.rppm that are members of a scene and no render settings."""


def split_values(values: list[str]) -> tuple[dict[str, object], list[tuple[str, str]]]:
    """Split --set into render settings by name, and data paths of a .blend file."""
    settings: dict[str, object] = {}
    data_values = []
    for text in values:
        path, value = split_assignment(text)
        if path == "render.engine" and value.strip('"') != "RPPM":
            raise SettingsError(f"--set {text}: rppm renders with RPPM only; for others use blender -b -E ENGINE")
        name = path.removeprefix("rppm.")
        if name != path and name not in _OF_BLEND_FILES:
            settings[name] = value
        else:
            data_values.append((path, value))
    return settings, data_values


def values_and_limits(options: argparse.Namespace) -> tuple[dict[str, object], list[tuple[str, str]]]:
    """Split --set as split_values does; options that are settings override the settings in --set."""
    settings, data_values = split_values(options.values)
    return settings | given_settings(options), data_values


def seconds_of(options: argparse.Namespace) -> float | None:
    """How long to render: --seconds, or without a limit as long as --snapshots take."""
    if options.seconds is None and options.samples is None and options.snapshots:
        return options.snapshots[-1]
    return options.seconds


def values_of_frames(settings: dict[str, object]) -> list[tuple[str, str]]:
    """Take what makes the seed of a frame out of the settings, to be set in the .blend file."""
    return [(f"rppm.{name}", str(settings.pop(name))) for name in ("seed", "use_animated_seed") if name in settings]


def refuse_blend_options(options: argparse.Namespace, data_values: list[tuple[str, str]]) -> None:
    """Raise SettingsError where options ask of a saved scene what only a .blend file can give."""
    if options.frame is not None:
        raise SettingsError("--frame needs a .blend file; a saved scene holds one frame")
    if options.scene_name:
        raise SettingsError("--scene-name needs a .blend file; a saved scene is one alone")
    if options.view_layers:
        raise SettingsError("--view-layer needs a .blend file; a saved scene holds one view layer")
    if data_values:
        raise SettingsError(f"--set {data_values[0][0]} needs a .blend file; a saved scene takes rppm.NAME only")


def outputs_of_still(options: argparse.Namespace) -> list[Path]:
    """The files of a still, with its frame's number where they have a place for one."""
    if options.frame is not None:
        return [path_of_frame(path, options.frame) for path in options.output]
    for path in options.output:
        if has_place(path):
            raise SettingsError(f"{path} has a place for a frame number; say which frame, or name it without #")
    return options.output


def refuse_shared_files(json_file: Path | None, others: Iterable[Path | None]) -> None:
    """Raise SettingsError where --json names a file that is read or written as something else."""
    for other in others:
        if json_file is not None and other is not None and _same_file(json_file, other):
            raise SettingsError(f"--json and another option both name {json_file}; give the report a name of its own")


def _same_file(first: Path, second: Path) -> bool:
    return first.resolve() == second.resolve() or (first.exists() and second.exists() and first.samefile(second))


def request_of(file: Path, options: argparse.Namespace, data_values: list[tuple[str, str]]) -> "BlendRequest":
    """Which picture of a .blend file the options name."""
    from ..blend_files.blend_file import BlendRequest

    return BlendRequest(file, options.frame, options.resolution, data_values, options.view_layers, options.scene_name)


def load_blend_or_saved(
    file: Path, options: argparse.Namespace, settings: dict[str, object], data_values: list[tuple[str, str]]
) -> Scene:
    """A .blend's or a saved scene at --frame and --resolution, with settings and data values of --set."""
    if is_blend(file):
        from ..blend_files import blend_file

        request = request_of(file, options, data_values)
        scene = blend_file.export_blend_file(request, show_output=options.debug)
    else:
        from ...scene import load_scene
        from ..saved_scene import camera_at_resolution

        refuse_blend_options(options, data_values)
        scene = load_scene(file)
        if options.resolution is not None:
            scene.camera = camera_at_resolution(scene.camera, *options.resolution)
    scene.settings = apply_settings(scene.settings, settings)
    return scene


def write_json(path: Path, report: dict[str, object]) -> None:
    """Write a whole file, or raise PictureError."""
    make_folder(path)
    text = json.dumps(report, indent=2) + "\n"
    try:
        if is_no_file(path):  # such as /dev/stdout
            path.write_text(text, encoding="utf-8")
            return
        with renamed_when_whole(path) as temporary:
            Path(temporary).write_text(text, encoding="utf-8")
    except OSError as error:
        raise PictureError(f"{path} cannot be written ({error}); choose another place with --json") from error
    except PictureError as error:
        raise PictureError(str(error).replace("with -o", "with --json")) from error
