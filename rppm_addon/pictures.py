# SPDX-License-Identifier: GPL-3.0-or-later
"""Picture files: multilayer EXR written and read.

Arrays have row 0 at the bottom, as frames do; files have the top row first.
"""

import contextlib
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .scene.common import whole_files
from .scene.common.declared import declared
from .scene.common.working_space import REC709, WorkingSpace
from .scene.errors import RppmError, SceneError
from .scene.images import encode_srgb
from .scene.passes import COMBINED, NOISY_IMAGE, PASSES, RenderPass


class PictureError(RppmError):
    """A picture file cannot be written or read."""


@dataclass(frozen=True)
class PictureName:
    """Which of the pictures of a render."""

    layer: str = ""
    """View layer; "" is the only one of a saved scene."""
    view: str = ""
    """View of stereo and multiview, such as "left"; "" is the only one."""

    @property
    def joined(self) -> str:
        """As metadata of files have it."""
        return ".".join(filter(None, (self.layer, self.view)))

    @property
    def prefix(self) -> str:
        """Before the names of its passes in files."""
        return f"{self.layer}." if self.layer else ""


@dataclass(frozen=True)
class Placement:
    """Where the pixels of a picture lie in the whole frame."""

    width: int = field(metadata=declared(minimum=1))
    """Pixels of the whole frame."""
    height: int = field(metadata=declared(minimum=1))
    x: int = field(default=0, metadata=declared(minimum=0))
    """Column of the picture's left edge in the frame."""
    y: int = field(default=0, metadata=declared(minimum=0))
    """Row of the picture's bottom edge in the frame, row 0 at the bottom."""

    def windows(self, width: int, height: int) -> dict[str, tuple[tuple[int, int], tuple[int, int]]]:
        """Where a picture of so many pixels lies, as attributes of an EXR."""
        top = self.height - self.y - height
        return {
            "dataWindow": ((self.x, top), (self.x + width - 1, top + height - 1)),
            "displayWindow": ((0, 0), (self.width - 1, self.height - 1)),
        }


def write_exr(
    path: str | Path,
    combined: np.ndarray,
    layers: Mapping[str, np.ndarray] | None = None,
    metadata: Mapping[str, object] | None = None,
    placement: Placement | None = None,
    attributes: Mapping[str, str] | None = None,
    passes: Sequence[RenderPass] = PASSES,
) -> None:
    """Write a float32 EXR: ``combined`` as R, G, B, A, and each layer by its pass's channels.

    Args:
        path: the file; its folder is made. The file is written beside and renamed, so that a
            reader never sees half of it.
        combined: (H, W, 4), scene-linear, premultiplied alpha.
        layers: (H, W) or (H, W, channels) arrays by the name of a pass (scene/passes.py), or another one.
        metadata: stored as text attributes ``rppm.NAME``.
        placement: where a cropped picture lies in its frame; None is the whole frame.
        attributes: text attributes by their own names; colorInteropID says of which space the colors are.
        passes: those that layers are named after.

    Raises:
        PictureError: the file cannot be written.
    """
    import OpenEXR  # late: the file format is not needed to import the engine

    channels = dict(zip("RGBA", _planes(combined)))
    layers = layers or {}
    for name, array in layers.items():
        planes = _planes(array)
        channels.update(zip(_channels_of(name, len(planes), passes), planes, strict=True))
    header = _header(combined.shape, metadata, placement, attributes)
    with renamed_when_whole(path) as temporary:
        OpenEXR.File(header, channels).write(temporary)


@dataclass(frozen=True)
class FilePicture:
    """One of several pictures of a file; arrays and passes as write_exr takes them."""

    name: PictureName
    combined: np.ndarray
    layers: Mapping[str, np.ndarray]
    passes: Sequence[RenderPass]


def write_multilayer_exr(
    path: str | Path,
    pictures: Sequence[FilePicture],
    metadata: Mapping[str, object] | None = None,
    placement: Placement | None = None,
    attributes: Mapping[str, str] | None = None,
) -> None:
    """Write several pictures of one frame into a float32 EXR as Blender does: a part for each pass of each view layer
    and view, with channels such as ``ViewLayer.Depth.Z``. Else as write_exr."""
    import OpenEXR

    parts = []
    for picture in pictures:
        header = _header(picture.combined.shape, metadata, placement, attributes) | _OF_BLENDER
        name = picture.name
        if name.view:
            header["view"] = name.view
        for layer, array in {COMBINED: picture.combined, **picture.layers}.items():
            planes = _planes(array)
            names = [f"{layer}.{letter}" for letter in "RGBA"]
            if layer != COMBINED:
                names = _channels_of(layer, len(planes), picture.passes)
            channels = {f"{name.prefix}{channel}": plane for channel, plane in zip(names, planes, strict=True)}
            part = f"{name.prefix}{layer}" + (f"-{name.view}" if name.view else "")
            parts.append(OpenEXR.Part(dict(header), channels, part))
    with renamed_when_whole(path) as temporary:
        OpenEXR.File(parts).write(temporary)


_OF_BLENDER = {"BlenderMultiChannel": "Blender V2.55.1 and newer"}
"""By which Blender knows files with layers of its own."""


def _header(
    shape: tuple[int, ...],
    metadata: Mapping[str, object] | None,
    placement: Placement | None,
    attributes: Mapping[str, str] | None,
) -> dict[str, Any]:
    import OpenEXR

    height, width = shape[:2]
    return {
        "compression": OpenEXR.ZIP_COMPRESSION,
        "type": OpenEXR.scanlineimage,
        **(placement or Placement(width, height)).windows(width, height),
        "colorInteropID": REC709.interop_id,
        **(attributes or {}),
        **{f"rppm.{name}": str(value) for name, value in (metadata or {}).items()},
    }


def _channels_of(layer: str, count: int, passes: Sequence[RenderPass]) -> list[str]:
    """Names of a layer's channels: those of the pass of that name, or X, Y, Z, and Z where it is one."""
    letters = {entry.name: entry.channels for entry in (*passes, NOISY_IMAGE)}.get(layer, "Z" if count == 1 else "XYZ")
    return [f"{layer}.{letter}" for letter in letters]


_ORDER = "UVRGBArgbaXYZW"
"""Order of the letters of a layer's channels, whatever the layer."""


@dataclass
class ExrPicture:
    """Contents of an EXR file; arrays are float32, row 0 at the bottom."""

    channels: dict[str, np.ndarray]
    """(H, W) by channel name."""
    metadata: dict[str, str]
    """The ``rppm.`` attributes without that prefix."""
    attributes: dict[str, str]
    """Other text attributes."""
    placement: Placement

    @property
    def combined(self) -> np.ndarray:
        """(H, W, 4): R, G, B, A."""
        return np.stack([self.channels[name] for name in "RGBA"], axis=-1)

    def layer(self, name: str) -> np.ndarray:
        """(H, W) or (H, W, channels) of a pass. Raises KeyError where the file does not have it."""
        letters = [channel.rpartition(".")[2] for channel in self.channels if channel.rpartition(".")[0] == name]
        if not letters:
            raise KeyError(name)
        planes = [self.channels[f"{name}.{letter}"] for letter in sorted(letters, key=_ORDER.index)]
        return np.stack(planes, axis=-1) if len(planes) > 1 else planes[0]


def read_exr(path: str | Path) -> ExrPicture:
    """Read an EXR file of one part. Raises PictureError when it is none."""
    import OpenEXR

    try:
        with OpenEXR.File(str(path), separate_channels=True) as file:
            header = dict(file.header())
            channels = {name: channel.pixels[::-1].astype(np.float32) for name, channel in file.channels().items()}
    except (RuntimeError, OSError, ValueError, TypeError) as error:
        raise PictureError(f"{path} cannot be read as EXR ({error})") from error
    (left, _), (_, bottom) = header["dataWindow"]
    (frame_left, frame_top), (frame_right, frame_bottom) = header["displayWindow"]
    return ExrPicture(
        channels,
        {name[5:]: value for name, value in header.items() if name.startswith("rppm.")},
        {name: value for name, value in header.items() if isinstance(value, str) and not name.startswith("rppm.")},
        Placement(
            int(frame_right - frame_left + 1),
            int(frame_bottom - frame_top + 1),
            int(left - frame_left),
            int(frame_bottom - bottom),
        ),
    )


def standard_view(combined: np.ndarray, space: WorkingSpace = REC709) -> np.ndarray:
    """The picture as Blender's Standard view shows it on an sRGB display.

    Args:
        combined: (H, W, 3 or 4) scene-linear; alpha is premultiplied.
        space: of its colors.

    Returns:
        uint8 of the same shape: clipped at 1, sRGB transfer curve, alpha no longer premultiplied.
    """
    color = np.nan_to_num(np.asarray(combined, np.float32)[..., :3], nan=0.0, posinf=1.0, neginf=0.0)
    alpha = combined[..., 3:].clip(0.0, 1.0)
    if alpha.shape[-1]:
        color = np.divide(color, alpha, out=color.copy(), where=(alpha > 0.0) & (alpha < 1.0))
    color = space.to_rec709(color).clip(0.0, 1.0)
    return np.rint(np.concatenate([encode_srgb(color), alpha], axis=-1) * 255.0).astype(np.uint8)


def refuse_spoiled(path: str | Path, combined: np.ndarray) -> None:
    """Raise SceneError where a picture, which was written, has pixels that are no finite numbers."""
    spoiled = int(np.count_nonzero(~np.isfinite(combined).all(axis=-1)))
    if spoiled:
        pixels = "pixel is no finite number" if spoiled == 1 else "pixels are no finite numbers"
        raise SceneError(
            f"{path}: {spoiled} {pixels}; look for lights, values of nodes, textures or an exposure that are too large"
        )


def make_folder(path: Path) -> None:
    """Make the folder that ``path`` is to lie in, and see that it can be written to. Raises PictureError."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=path.parent):  # what systems say of permissions does not hold for each disk
            pass
    except OSError as error:
        raise PictureError(f"{path} cannot be written ({error}); choose another place") from error


def _planes(array: np.ndarray) -> list[np.ndarray]:
    """Contiguous float32 channels with the top row first."""
    flipped = np.atleast_3d(np.asarray(array, np.float32))[::-1]
    return [np.ascontiguousarray(flipped[..., index]) for index in range(flipped.shape[-1])]


@contextlib.contextmanager
def renamed_when_whole(path: str | Path) -> Iterator[str]:
    """Write a picture's file whole or not at all (scene/common/whole_files.py). Raises PictureError."""
    try:
        with whole_files.renamed_when_whole(path) as temporary:
            yield temporary
    except (OSError, RuntimeError) as error:
        raise PictureError(f"{path} cannot be written ({error}); choose another place") from error
