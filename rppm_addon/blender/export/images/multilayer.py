# SPDX-License-Identifier: GPL-3.0-or-later
"""Multilayer EXR files as textures. Blender's Python gives no pixels of their passes; they are read from the file."""

import contextlib
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import bpy
import numpy as np

_PASS_ORDER = (
    "Combined", "Depth", "Shadow", "Ambient Occlusion", "Position", "Normal", "Vector", "Grease Pencil", "Object Index",
    "UV", "Mist", "Emission", "Environment", "Material Index", "Diffuse Direct", "Diffuse Indirect", "Diffuse Color",
    "Glossy Direct", "Glossy Indirect", "Glossy Color", "Transmission Direct", "Transmission Indirect",
    "Transmission Color", "Subsurface Direct", "Subsurface Indirect", "Subsurface Color",
)  # fmt: skip
"""Passes in the order in which Blender numbers them (scene_layer's bits); others follow by their names."""
_COMPONENTS = {"RED": "R", "GREEN": "G", "BLUE": "B", "ALPHA": "A", "DEPTH": "Z"}
"""Channels that some programs spell out."""
_CHANNEL_ORDERS = ("RGBA", "XYZW", "UVA")


@dataclass(frozen=True)
class PassSelection:
    """Numbers by which an image user selects one picture of a multilayer file."""

    layer: int = 0
    number: int = 0
    """Number of the pass in the layer."""
    view: int = 0

    @classmethod
    def of_user(cls, user: bpy.types.ImageUser) -> "PassSelection":
        """Return the selection of a texture node's image user."""
        return cls(user.multilayer_layer, user.multilayer_pass, user.multilayer_view)


@dataclass
class _FilePass:
    """A pass of a file, with its channels as (height, width) arrays by letter, the top row first."""

    name: str
    view: str
    channels: dict[str, np.ndarray] = field(default_factory=dict)

    @property
    def order(self) -> tuple[bool, int, str]:
        """Key by which Blender sorts the passes of a layer."""
        is_other = self.name not in _PASS_ORDER
        return is_other, 0 if is_other else _PASS_ORDER.index(self.name), self.name

    def pixels(self) -> np.ndarray:
        """(height, width, channels) float32, row 0 at the bottom, at most four channels."""
        letters = list(self.channels)
        for order in _CHANNEL_ORDERS:
            if set(letters) <= set(order):
                letters.sort(key=order.index)
                break
        planes = [self.channels[letter] for letter in letters[:4]]
        return np.stack(planes, axis=-1)[::-1].astype(np.float32)


def split_channel(channel: str) -> tuple[str, str, str]:
    """Layer, pass and letter that Blender takes from the name of a channel, such as ViewLayer.Depth.Z."""
    *before, last = channel.split(".")
    letter = _COMPONENTS.get(last.upper(), last[0].upper() if len(last) == 1 else "X")
    if len(last) == 2 and last[1].upper() in "XYZRGBUVA":
        letter = last[1].upper()  # as in NX, NY and NZ
    if before:
        return ".".join(before[:-1]), before[-1], letter
    if letter in "RGBA":
        return "", "Combined", letter
    return "", "Depth" if last in {"Z", "z"} else last, letter


def read_pass(path: str | Path, selection: PassSelection) -> np.ndarray | None:
    """(height, width, channels) float32 of a pass of a multilayer EXR file as it is stored, row 0 at the bottom.

    None where the file cannot be read or has no such pass.
    """
    import OpenEXR  # late: Blender loads this module when it starts

    try:
        with OpenEXR.File(str(path), separate_channels=True) as file:
            layers: dict[str, dict[tuple[str, str], _FilePass]] = {}
            views: list[str] = []
            for part in file.parts:
                view = str(part.header.get("view", ""))
                if view not in views:
                    views.append(view)
                for name, channel in part.channels.items():
                    layer, pass_name, letter = split_channel(name)
                    passes = layers.setdefault(layer, {})
                    found = passes.setdefault((pass_name, view), _FilePass(pass_name, view))
                    found.channels[letter] = channel.pixels
    except (RuntimeError, OSError, ValueError, TypeError):
        return None
    if not 0 <= selection.layer < len(layers):
        return None
    passes = list(layers.values())[selection.layer]
    ordered = sorted(passes.values(), key=lambda found: (found.order, views.index(found.view)))
    if not 0 <= selection.number < len(ordered):
        return None
    chosen = ordered[selection.number]
    view = views[selection.view] if 0 <= selection.view < len(views) else chosen.view
    return passes.get((chosen.name, view), chosen).pixels()


@contextlib.contextmanager
def file_of(image: bpy.types.Image) -> Iterator[str]:
    """Path of an image's file, for as long as the context lasts where the file is packed."""
    if image.packed_file is None:
        yield bpy.path.abspath(image.filepath, library=image.library)
        return
    with tempfile.TemporaryDirectory(prefix="rppm_") as folder:
        path = Path(folder) / "packed.exr"
        path.write_bytes(image.packed_file.data)
        yield str(path)
