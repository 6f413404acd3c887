# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes in .npz files, so that a machine without Blender can render them."""

import errno
import json
import math
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib import format as npy

from ..common.quantities import bytes_text
from ..common.whole_files import renamed_when_whole
from ..errors import SceneError, SettingsError
from ..scene import Scene
from .documents import decode, encode
from .validation import check_scene

FORMAT = 4


def save_scene(scene: Scene, path: str | Path) -> None:
    """Write a scene as a compressed .npz: the arrays, and the rest as JSON beside them.

    What the file was before stays until all is written. Raises OSError.
    """
    arrays: dict[str, np.ndarray] = {}

    def keep(array: np.ndarray) -> str:
        name = f"array{len(arrays)}"
        arrays[name] = array
        return name

    document = {"format": FORMAT, "scene": encode(scene, keep)}
    arrays["document"] = np.frombuffer(json.dumps(document).encode(), np.uint8)
    # As numpy.savez_compressed, which on a full disk leaves an archive open that complains on standard error.
    with renamed_when_whole(path) as temporary, zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, array in arrays.items():
            with archive.open(f"{name}.npy", "w", force_zip64=True) as entry:
                npy.write_array(entry, np.asanyarray(array), allow_pickle=False)


def load_scene(path: str | Path) -> Scene:
    """Read a scene that save_scene wrote.

    Raises SceneError, and nothing else, when the file is no saved scene, of another format, damaged, larger than it can
    honestly be, or when something in it is not what the scene's declaration says.
    """
    try:
        if not Path(path).is_file():  # nor a pipe, at which one would wait
            raise SceneError(f"{path} is no file; write a saved scene with rppm export")
        document, arrays = _read(path)
    except SceneError:
        raise
    except Exception as error:  # zipfile, zlib, numpy and json raise a dozen types for what is damaged
        if isinstance(error, OSError) and error.errno in _NO_HANDLES:
            raise SceneError(f"{path} cannot be opened ({error}); raise the limit: ulimit -n 1024") from error
        raise SceneError(f"{path} is not a saved scene ({_short_text(error)}); write one with rppm export") from error
    if not isinstance(document, dict):
        raise SceneError(f"{path} is not a saved scene (its document is none); write one with rppm export")
    if document.get("format") != FORMAT:
        raise SceneError(f"{path} has scene format {document.get('format')!r:.40}, not {FORMAT}; export it again")
    try:
        scene = decode(document["scene"], Scene, arrays)
    except Exception as error:  # whatever Python says to a document that is none
        raise SceneError(
            f"{path} holds what this version of RPPM does not know ({_short_text(error)}); export it again"
        ) from error
    try:
        check_scene(scene)
        scene.settings.validate()
    except (SceneError, SettingsError) as error:
        raise SceneError(f"{path}: {error}; export it again") from error
    return scene


_NO_HANDLES = (errno.EMFILE, errno.ENFILE)
MIN_LIMIT = 1 << 29
_MAX_STRETCH = 100
"""Bytes that are taken out of an archive in any case, and for each byte of the file: real scenes, whose numbers all
differ, stay far below."""
_KINDS = "biuf"


def _read(path: str | Path) -> tuple[Any, dict[str, np.ndarray]]:
    """The document and the arrays. Raises whatever there is for what is damaged."""
    size = Path(path).stat().st_size
    with zipfile.ZipFile(path) as archive:
        entries = {entry.filename.removesuffix(".npy"): entry for entry in archive.infolist()}
        limit, total = max(MIN_LIMIT, _MAX_STRETCH * size), sum(entry.file_size for entry in entries.values())
        if total > limit:
            raise SceneError(
                f"{path} would take {bytes_text(total)} of memory for {bytes_text(size)} on the disk, which is more "
                "than a scene needs; export it again"
            )
        arrays = {name: _read_array(archive, entry) for name, entry in entries.items()}
    return json.loads(arrays.pop("document").tobytes()), arrays


def _read_array(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> np.ndarray:
    """An array of numbers that has the bytes which its head announces. Raises as _read does."""
    with archive.open(entry) as file:
        version = npy.read_magic(file)
        read_head = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
        shape, _, dtype = read_head(file)
        if dtype.kind not in _KINDS or math.prod(shape) * dtype.itemsize != entry.file_size - file.tell():
            raise ValueError(f"{entry.filename} is no array of numbers")
        file.seek(0)
        return npy.read_array(file, allow_pickle=False)


def _short_text(error: Exception) -> str:
    """An error in one short line."""
    text = " ".join(str(error).split()) or type(error).__name__
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}..."


_LONGEST = 200
