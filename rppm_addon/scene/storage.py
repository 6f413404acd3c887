# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes in .npz files, so that a machine without Blender can render them."""

import json
import zipfile
from pathlib import Path

import numpy as np

from .documents import decode, encode
from .errors import SceneError
from .scene import Scene

FORMAT = 4


def save_scene(scene: Scene, path: str | Path) -> None:
    """Write a scene as a compressed .npz: the arrays, and the rest as JSON beside them."""
    arrays: dict[str, np.ndarray] = {}

    def keep(array: np.ndarray) -> str:
        name = f"array{len(arrays)}"
        arrays[name] = array
        return name

    document = {"format": FORMAT, "scene": encode(scene, keep)}
    with Path(path).open("wb") as file:
        np.savez_compressed(file, document=np.frombuffer(json.dumps(document).encode(), np.uint8), **arrays)


def load_scene(path: str | Path) -> Scene:
    """Read a scene that save_scene wrote.

    Raises SceneError when the file is no saved scene or of another format.
    """
    try:
        with np.load(path, allow_pickle=False) as stored:
            document = json.loads(stored["document"].tobytes())
            arrays = {name: stored[name] for name in stored.files if name != "document"}
    except (OSError, ValueError, KeyError, zipfile.BadZipFile) as error:
        raise SceneError(f"{path} is not a saved scene ({error}); write one with rppm export") from error
    if document.get("format") != FORMAT:
        raise SceneError(f"{path} has scene format {document.get('format')}, not {FORMAT}; export it again")
    try:
        return decode(document["scene"], Scene, arrays)
    except (KeyError, TypeError, ValueError) as error:
        raise SceneError(f"{path} holds what this version of RPPM does not know ({error}); export it again") from error
