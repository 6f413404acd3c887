# SPDX-License-Identifier: GPL-3.0-or-later
"""Fingerprints that show whether two renders, perhaps on two machines, have the same scene and settings."""

import dataclasses
import hashlib
import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..scene import Scene
from ..settings import RenderSettings
from .documents import encode

UNSEEN = frozenset(
    {
        "iterations",
        "time_limit",
        "use_adaptive_sampling",
        "adaptive_threshold",
        "adaptive_min_samples",
        "iterations_per_frame",
        "density_estimation",
        "first_photon_hits",
        "acceleration_structure",
        "denoising_start_sample",
    }
)
"""Settings that say when a render ends or is shown or by which way it comes to its picture, and nothing of what an
iteration finds."""
AFTER_FILM = frozenset({"denoising_prefilter", "denoising_quality", "denoising_use_gpu"})
"""Settings that say what becomes of a picture once all iterations are in it."""
_NOT_RENDERED = frozenset({"settings", "stamps", "warnings", "instance_arrays"})


def scene_digests(scene: Scene) -> dict[str, str]:
    """A digest, hexadecimal, of each member of a scene: equal where the members are, arrays bit for bit.

    Instances count one by one, whether they are in arrays or not.
    """
    scene = scene.expanded()
    known: dict[int, str] = {}

    def keep(array: np.ndarray) -> str:
        # Arrays outlive the call as parts of the scene, so an address stands for one array.
        if id(array) not in known:
            data = np.ascontiguousarray(array)
            digest = hashlib.sha256(f"{data.dtype.str} {data.shape}".encode())
            digest.update(data.reshape(-1).view(np.uint8).data)
            known[id(array)] = digest.hexdigest()
        return known[id(array)]

    digests = {}
    for field in dataclasses.fields(scene):
        if field.name not in _NOT_RENDERED:
            document = json.dumps(encode(getattr(scene, field.name), keep), sort_keys=True)
            digests[field.name] = hashlib.sha256(document.encode()).hexdigest()
    return digests


def plain_settings(settings: RenderSettings) -> dict[str, Any]:
    """The settings that a picture depends on by name, as JSON has them."""
    values: Any = encode(settings, lambda array: array.tolist())
    return {name: value for name, value in values.items() if name not in UNSEEN}


def settings_of_plain(values: Mapping[str, Any]) -> RenderSettings:
    """The settings that plain_settings has made plain; those that it leaves out have their defaults. Raises
    SettingsError for what it has not made."""
    return RenderSettings().with_values(**values)
