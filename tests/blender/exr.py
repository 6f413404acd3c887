# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures that Blender writes to EXR files."""

import contextlib

import bpy
import numpy as np
import OpenEXR

from rppm_addon.session.render.observers import observing


def write_exr(scene, path, is_multilayer=True):
    """Have the scene's renders written to an EXR file of 32-bit floats."""
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "MULTI_LAYER_IMAGE" if is_multilayer else "IMAGE"
    settings.file_format = "OPEN_EXR_MULTILAYER" if is_multilayer else "OPEN_EXR"
    settings.color_depth, scene.render.filepath = "32", str(path)


def read_channels(path):
    """Pixels by the channel's name, and the header of the file."""
    with OpenEXR.File(str(path), separate_channels=True) as file:
        channels = {name: channel.pixels for part in file.parts for name, channel in part.channels.items()}
        return channels, dict(file.header())


def read_layers(path):
    """Layers of a picture: name -> (height, width, channels), row 0 at the top, in the order of Blender's letters."""
    layers = {}
    for name, pixels in read_channels(path)[0].items():
        layer, _, letter = name.rpartition(".")
        layers.setdefault(layer, {})[letter.upper()] = pixels
    return {
        layer: np.stack([found[letter] for letter in sorted(found, key="RGBXYZUVAW".index)], axis=-1)
        for layer, found in layers.items()
    }


def render_exr(scene, folder, observer=None):
    """Layers of the picture: name -> (height, width, channels), row 0 at the bottom."""
    write_exr(scene, folder / "picture.exr")
    with observing(observer) if observer else contextlib.nullcontext():
        bpy.ops.render.render(write_still=True)
    return {name: layer[::-1] for name, layer in read_layers(scene.render.filepath).items()}
