# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender images to pixels, each exported once."""

import re
from collections.abc import Callable, Hashable
from dataclasses import dataclass, replace
from pathlib import Path

import bpy
import numpy as np

from ....scene.common.whole_files import is_no_file
from ....scene.common.working_space import REC709, WorkingSpace
from ....scene.images import Image, encode_srgb
from ..common.slices import Slices
from .color_spaces import WHITE_IN_CYCLES, scene_linear, working_space
from .kept_images import keep, kept
from .multilayer import PassSelection, file_of, read_pass
from .texture_limit import limited

Warn = Callable[[str], None]
"""Tells the user what is done about the node that shows an image."""

_PART = 1 << 16
"""Numbers that are looked at while they lie in a cache."""
_LARGE = 1 << 20
"""Pixels from which on an image is read in steps."""
_FIRST_PASS = PassSelection()
_DATA = {"Non-Color", "Raw", "scene_linear"}


class ImageTable:
    """The images of a scene under export, at a frame of the scene."""

    def __init__(self) -> None:
        self.images: list[Image] = []
        self.frame = 1
        """Frame of the scene at which sequences and movies are shown."""
        self.longest_side = 0
        """Pixels that no side of an image exceeds, 0 for any."""
        self.reads_by_frame = 0
        """How often an image was asked for that depends on the frame."""
        self.slices = Slices()
        """Slices of the export that reads images."""
        self._indices: dict[tuple, int] = {}
        self._unfinished: dict[Hashable, dict] = {}
        """Records of the steps done so far for images that take more than one slice, by image key."""

    def of_node(self, node: bpy.types.Node, warn: Warn) -> int:
        """Index of a texture node's image, exported now if it is new; -1, with a warning, when it has no pixels."""
        image = node.image
        if image is None:
            warn("has no image and counts as magenta; choose one")
            return MISSING
        selection = PassSelection.of_user(node.image_user)
        if image.source not in {"SEQUENCE", "MOVIE"}:
            return self._index((image.as_pointer(), selection), lambda: image, image, warn, selection)
        self.reads_by_frame += 1
        number = frame_of(node.image_user, self.frame)
        load = _of_movie if image.source == "MOVIE" else _of_sequence
        key = (image.as_pointer(), number, selection)
        return self._index(key, lambda: load(image, number), image, warn, selection)

    def computed(self, key: Hashable, compute: Callable[[], Image]) -> int:
        """Index of an image that belongs to no datablock."""
        image = self.slices.computed(self._unfinished.setdefault(key, {}), "image", compute)
        del self._unfinished[key]
        self.images.append(image)
        return len(self.images) - 1

    def tiles(self, node: bpy.types.Node, warn: Warn) -> np.ndarray | None:
        """(n,) float32 index of the image of each UDIM tile from 1001 on, -1 where none is; None without tiles."""
        image = node.image
        if image is None or image.source != "TILED":
            return None
        numbers = [tile.number for tile in image.tiles]
        table = np.full(max(numbers) - 1000, -1.0, np.float32)
        for number in numbers:
            path = bpy.path.abspath(image.filepath.replace("<UDIM>", str(number)), library=image.library)
            key = (image.as_pointer(), number)

            def tile(number: int = number, path: str = path) -> bpy.types.Image | None:
                # The pixels that Blender hands out are those of the first tile, saved or not.
                return image if number == numbers[0] else _load(path, image)

            table[number - 1001] = self._index(key, tile, image, warn)
        return table

    def _index(
        self,
        key: tuple,
        load: Callable[[], bpy.types.Image | None],
        image: bpy.types.Image,
        warn: Warn,
        selection: PassSelection = _FIRST_PASS,
    ) -> int:
        if key not in self._indices:
            record = self._unfinished.setdefault(key, {})
            exported = self._pixels(image, load, record, selection)
            del self._unfinished[key]
            if exported is None:
                self._indices[key] = MISSING
            else:
                self._indices[key] = len(self.images)
                self.images.append(exported)
        if self._indices[key] == MISSING:
            warn(f'needs image "{image.name}", {_reason(image)}; magenta stands in')
        return self._indices[key]

    def _pixels(
        self,
        image: bpy.types.Image,
        load: Callable[[], bpy.types.Image | None],
        record: dict,
        selection: PassSelection,
    ) -> Image | None:
        if "whole" not in record:
            is_none = _is_no_file(image.filepath, image)
            record["whole"] = None if is_none else _export(image, load, self.slices, record, selection)
        whole = record["whole"]
        if whole is None or self.longest_side == 0:
            return whole
        return self.slices.computed(record, "limited", lambda: limited(whole, self.longest_side))


def _export(
    image: bpy.types.Image,
    load: Callable[[], bpy.types.Image | None],
    slices: Slices,
    record: dict,
    selection: PassSelection,
) -> Image | None:
    """Return the pixels of an image as ``load`` gives it; None when it has none.

    record: the steps that earlier slices have done. selection: what is shown of a multilayer file.
    """
    # Asks for the image's size: Blender decodes the file.
    known = slices.step_alone(record, "known", lambda: kept(image, selection))
    if known is not None:
        return known
    loaded = load()
    if loaded != image:
        exported = None if loaded is None else _read_loaded(image, loaded, selection)
        if loaded is not None:
            bpy.data.images.remove(loaded)
        return exported
    if _is_multilayer(image):
        exported = slices.step_alone(record, "pass", lambda: _multilayer_pass(image, image, selection))
    else:
        exported = _read_in_steps(image, slices, record)
    if exported is not None:
        keep(image, selection, exported)
    return exported


def _read_loaded(image: bpy.types.Image, loaded: bpy.types.Image, selection: PassSelection) -> Image | None:
    """Return what one file of an image shows, which was loaded as an image of its own."""
    pixels = read_pixels(loaded)
    if pixels is None and _is_multilayer(loaded):
        return _multilayer_pass(image, loaded, selection)
    return None if pixels is None else _encoded(_Look.of(image), pixels)


def _is_multilayer(image: bpy.types.Image) -> bool:
    """Return whether an image's file, which Blender has decoded, has several layers or passes."""
    return image.type == "MULTILAYER"


def _multilayer_pass(image: bpy.types.Image, loaded: bpy.types.Image, selection: PassSelection) -> Image | None:
    """Return the selected pass of a multilayer file. As in Blender, passes of one or two channels are data."""
    with file_of(loaded) as path:
        pixels = read_pass(path, selection)
    if pixels is None:
        return None
    look = replace(_Look.of(image), is_float=True)
    is_data = pixels.shape[-1] < 3
    pixels = _four_channels(pixels, is_float=True)
    if is_data:
        return Image(look.name, pixels, "LINEAR")
    if not look.is_linear:
        pixels[..., :3] = scene_linear(pixels[..., :3], look.space)
    return _encoded(look, pixels)


def _read_in_steps(image: bpy.types.Image, slices: Slices, record: dict) -> Image | None:
    """Blender's part is to write its numbers to memory that a thread has made ready: writing to it for the first time
    may take several times as long. A thread encodes them."""
    shape, look = _shape(image), _Look.of(image)
    if shape is None:
        return None
    if shape[0] * shape[1] < _LARGE or look.needs_blender:
        return slices.step(record, "encoded", lambda: _read_at_once(image, look))
    make = np.ones if slices.are_limited else np.empty
    stored = slices.computed(record, "memory", lambda: make(shape, np.float32))
    if not slices.step_alone(record, "is read", lambda: _read(image, stored)):
        return None
    return slices.computed(record, "encoded", lambda: _encoded(look, _four_channels(stored, look.is_float)))


def _is_no_file(path: str, image: bpy.types.Image) -> bool:
    """Whether something else has the name of an image's file: who opens a pipe waits until somebody writes, and Blender
    opens it as soon as it is asked for the image's size."""
    if not path or image.packed_file is not None:
        return False
    try:
        return is_no_file(_place(path, image))
    except (OSError, ValueError):
        return False


MISSING = -1
"""Stands for an image without pixels; it is magenta."""


def frame_of(user: bpy.types.ImageUser, scene_frame: int) -> int:
    """The number of the file of a sequence, or of the picture of a movie, that is shown at a frame of the scene. As in
    Cycles, whether the user refreshes by itself makes no difference."""
    number = scene_frame - user.frame_start + 1
    if user.use_cyclic:
        number = (number - 1) % max(user.frame_duration, 1) + 1
    return min(max(number, 0), user.frame_duration) + user.frame_offset


def _of_sequence(image: bpy.types.Image, number: int) -> bpy.types.Image | None:
    """A file of a sequence: the last number in its name counts."""
    path = Path(bpy.path.abspath(image.filepath, library=image.library))
    digits = re.search(r"\d+(?=\D*$)", path.stem)
    if digits is None or number < 0:
        return _load(str(path), image) if digits is None else None
    name = path.stem[: digits.start()] + f"{number:0{len(digits[0])}d}" + path.stem[digits.end() :]
    return _load(str(path.with_name(name + path.suffix)), image)


def _of_movie(image: bpy.types.Image, number: int) -> bpy.types.Image | None:
    """A picture of a movie, the first or last one beyond its ends, as a copy whose pixels are of that picture.

    Blender's Python gives the pixels of the picture that was asked for last: scaling a copy to its own size changes
    nothing else, and is what can name a picture without a window.
    """
    width, height = image.size
    if width < 1 or height < 1:
        return None
    copied = image.copy()
    copied.scale(width, height, frame=max(number, 1))
    return copied


def _load(path: str, like: bpy.types.Image) -> bpy.types.Image | None:
    """A file as a new image that is read as another one is; None when it cannot be read."""
    if _is_no_file(path, like):
        return None
    try:
        image = bpy.data.images.load(path)
    except RuntimeError:
        return None
    image.colorspace_settings.name = like.colorspace_settings.name
    image.alpha_mode = like.alpha_mode
    return image


def _read_at_once(image: bpy.types.Image, look: "_Look") -> Image | None:
    pixels = read_pixels(image)
    return None if pixels is None else _encoded(look, pixels)


@dataclass(frozen=True)
class _Look:
    """Properties of a Blender image other than its pixels, so that threads need not ask Blender."""

    name: str
    space: str
    alpha_mode: str
    is_float: bool
    is_associated: bool
    is_in_file: bool
    working: WorkingSpace
    """Space of the scene's colors."""

    @classmethod
    def of(cls, image: bpy.types.Image) -> "_Look":
        """Return the properties of an image."""
        space, in_file = image.colorspace_settings.name, image.source != "GENERATED" and image.packed_file is None
        return cls(image.name, space, image.alpha_mode, image.is_float, is_associated(image), in_file, working_space())

    @property
    def times_alpha(self) -> int:
        """Number of times, 0 to 2, that the colors of its bytes are multiplied by alpha.

        Cycles takes those in files for straight, whatever the user says.
        """
        if not self.is_associated:
            return 0
        return 2 if self.alpha_mode == "PREMUL" and self.is_in_file else 1

    @property
    def is_linear(self) -> bool:
        """True where the file has linear colors of the working space, or data."""
        return self.space in {*_DATA, self.working.name} or (self.working is REC709 and self.space == "Linear")

    @property
    def is_srgb(self) -> bool:
        """True where the renderer decodes the colors, which are those of Rec.709 by the curve of sRGB."""
        return self.space == "sRGB" and self.working is REC709

    @property
    def needs_blender(self) -> bool:
        """Whether Blender is asked to convert its colors."""
        return not (self.is_float or self.is_linear or self.is_srgb)


def _encoded(look: _Look, pixels: np.ndarray) -> Image:
    """Pixels as they are to be filtered: encoded where Cycles does it, and colors times alpha."""
    space = look.space
    if look.alpha_mode == "NONE":
        pixels[..., 3] = 1.0
    if look.is_float:
        # Blender has made them linear.
        pixels[..., :3] *= WHITE_IN_CYCLES.get(space, 1.0)
        if look.is_srgb:
            pixels[..., :3] = encode_srgb(pixels[..., :3])
        return Image(look.name, pixels, "SRGB" if look.is_srgb else "LINEAR")
    if look.needs_blender:
        encoded = pixels[..., :3]
        if look.times_alpha == 2:
            encoded = _times_alpha(_bytes(pixels)) / np.float32(255.0)
        linear = scene_linear(encoded, space) * WHITE_IN_CYCLES.get(space, 1.0)
        pixels[..., :3] = linear * pixels[..., 3:] if look.times_alpha else linear
        return Image(look.name, pixels, "LINEAR")
    encoding = "SRGB" if look.is_srgb else "LINEAR"
    pixels = _bytes(pixels)
    if look.is_associated and pixels[..., 3].min() < 255:
        colors = _times_alpha(pixels) if look.times_alpha == 2 else pixels[..., :3].astype(np.uint16)
        pixels[..., :3] = colors * pixels[..., 3:] // 255
    return Image(look.name, pixels, encoding)


def _times_alpha(pixels: np.ndarray) -> np.ndarray:
    """(height, width, 3) uint16 colors of bytes, multiplied by their alpha and rounded."""
    return (pixels[..., :3].astype(np.uint16) * pixels[..., 3:] + 127) // 255


def _bytes(pixels: np.ndarray) -> np.ndarray:
    """Bytes that Blender has given as numbers from 0 to 1."""
    flat, result = pixels.reshape(-1), np.empty(pixels.size, np.uint8)
    for start in range(0, len(flat), _PART):
        part = flat[start : start + _PART] * np.float32(255.0)
        result[start : start + _PART] = np.rint(part, out=part)
    return result.reshape(pixels.shape)


def is_associated(image: bpy.types.Image | None) -> bool:
    """Whether an image's colors come multiplied by its alpha, and are divided by it where alpha is used as well."""
    return (
        image is not None
        and image.alpha_mode in {"STRAIGHT", "PREMUL"}
        and image.colorspace_settings.name not in {"Non-Color", "Raw"}
    )


def _reason(image: bpy.types.Image) -> str:
    """Why an image has no pixels, and what to do."""
    place = image.filepath or "no file"
    try:
        is_there = image.source in {"FILE", "MOVIE"} and _place(image.filepath, image).is_file()
    except (OSError, ValueError):  # such as a name that is too long
        is_there = False
    if is_there and image.packed_file is None:
        return f"whose file Blender cannot read ({place}); it is damaged or no picture: save it anew or choose another"
    return f"which is missing ({place}); find it with File > External Data > Find Missing Files"


def _place(path: str, image: bpy.types.Image) -> Path:
    return Path(bpy.path.abspath(path, library=image.library))


def read_pixels(image: bpy.types.Image) -> np.ndarray | None:
    """Pixels as Blender stores them, (height, width, 4) float32, row 0 at the bottom.

    None when the image has none, as when its file is missing.
    """
    shape = _shape(image)
    if shape is None:
        return None
    stored = np.empty(shape, np.float32)
    return _four_channels(stored, image.is_float) if _read(image, stored) else None


def _shape(image: bpy.types.Image) -> tuple[int, int, int] | None:
    """Height, width and channels; None when it has no pixels."""
    width, height = image.size
    return None if width < 1 or height < 1 else (height, width, image.channels)


def _read(image: bpy.types.Image, stored: np.ndarray) -> bool:
    """Write Blender's numbers to an array of the image's shape; whether there were any."""
    try:
        image.pixels.foreach_get(stored.reshape(-1))
    except (RuntimeError, TypeError):
        return False
    return image.has_data


def _four_channels(stored: np.ndarray, is_float: bool) -> np.ndarray:
    height, width, channels = stored.shape
    # Bytes are finite.
    if is_float and not (np.isfinite(stored.min()) and np.isfinite(stored.max())):
        stored = np.nan_to_num(stored, copy=False, nan=0.0, posinf=65504.0, neginf=0.0)
    if channels == 4:
        return stored
    pixels = np.ones((height, width, 4), np.float32)
    if channels == 3:
        pixels[..., :3] = stored
    else:
        pixels[..., :3] = stored[..., :1]
        if channels == 2:
            pixels[..., 3] = stored[..., 1]
    return pixels
