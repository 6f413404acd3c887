# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes in .npz files, so that a machine without Blender can render them."""

import dataclasses
import enum
import json
import typing
import zipfile
from pathlib import Path

import numpy as np

from .errors import SceneError
from .node_graphs import Link
from .scene import Scene

FORMAT = 2


def save_scene(scene: Scene, path: str | Path) -> None:
    """Write a scene as a compressed .npz: the arrays, and the rest as JSON beside them."""
    arrays: dict[str, np.ndarray] = {}

    def encode(value: object, key: str) -> object:
        if isinstance(value, np.ndarray):
            arrays[key] = value
            return {"array": key}
        if isinstance(value, enum.Flag):
            return value.value  # combinations have no name
        if isinstance(value, enum.Enum):
            return value.name
        if dataclasses.is_dataclass(value):
            return {f.name: encode(getattr(value, f.name), f"{key}.{f.name}") for f in dataclasses.fields(value)}
        if isinstance(value, list | tuple):
            return [encode(item, f"{key}.{index}") for index, item in enumerate(value)]
        if isinstance(value, dict):
            return {name: encode(item, f"{key}.{name}") for name, item in value.items()}
        if isinstance(value, np.generic):
            return value.item()
        return value

    document = {"format": FORMAT, "scene": encode(scene, "scene")}
    with open(path, "wb") as file:
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

    def decode(value: object, kind: object) -> object:
        if isinstance(value, dict) and set(value) == {"array"}:
            return arrays[value["array"]]
        if kind is object:  # an input or option of a shader node
            if isinstance(value, dict):
                return decode(value, Link)
            return tuple(value) if isinstance(value, list) else value
        origin = typing.get_origin(kind)
        if origin is dict:
            return {name: decode(item, typing.get_args(kind)[1]) for name, item in value.items()}
        if origin is list:
            return [decode(item, typing.get_args(kind)[0]) for item in value]
        if origin is tuple:
            return tuple(value)
        if origin is not None:  # optional: the first alternative
            return None if value is None else decode(value, typing.get_args(kind)[0])
        if isinstance(kind, type) and issubclass(kind, enum.Enum):
            return kind(value) if issubclass(kind, enum.Flag) else kind[value]
        if dataclasses.is_dataclass(kind):
            hints = typing.get_type_hints(kind)
            return kind(**{name: decode(item, hints[name]) for name, item in value.items()})
        return value

    return decode(document["scene"], Scene)
