# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender images to pixels, each exported once."""

import re
from collections.abc import Callable, Hashable
from dataclasses import dataclass, replace
from pathlib import Path

import bpy
import numpy as np

from ....materials.images import MISSING as MISSING_IMAGE
from ....scene.common.whole_files import is_no_file
from ....scene.images import Image
from ..common.slices import Slices
from .color_spaces import scene_linear
from .image_look import ImageLook, encoded
from .kept_images import keep, kept
from .late_image import LateImage
from .multilayer import PassSelection, file_of, read_pass
from .texture_limit import limited

Warn = Callable[[str], None]
"""Tells the user what is done about the node that shows an image."""

_LARGE = 1 << 20
"""Pixels from which on an image is read in steps."""
_FIRST_PASS = PassSelection()


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
        self._late: dict[int, tuple[_Place, LateImage]] = {}
        """By index, large images that are read while the export goes on, one after the other: their numbers take four
        times the memory."""
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

    def advance(self) -> None:
        """Go on with the large images as far as no thread is to be waited for. May raise Unfinished."""
        self._read_late(waits=False)

    def finish(self) -> None:
        """Have all images whole. Raises Unfinished when the slice is over."""
        self._read_late(waits=True)

    def _read_late(self, waits: bool) -> None:
        while self._late:
            index, (place, late) = next(iter(self._late.items()))
            if not late.advance(self.slices, waits):
                return
            del self._late[index]
            if late.image is not None:
                self.images[index] = late.image
            if late.whole is not None and (image := place.find()) is not None:
                keep(image, place.selection, late.whole)

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
            if isinstance(exported, LateImage):
                self._late[len(self.images)] = _Place(image.session_uid, selection), exported
                exported = MISSING_IMAGE  # until it is read; it stays where Blender has lost its pixels meanwhile
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
    ) -> Image | LateImage | None:
        if "whole" not in record:
            is_none = _is_no_file(image.filepath, image)
            record["whole"] = None if is_none else self._export(image, load, record, selection)
        whole = record["whole"]
        if whole is None or self.longest_side == 0 or isinstance(whole, LateImage):
            return whole
        return self.slices.computed(record, "limited", lambda: limited(whole, self.longest_side))

    def _export(
        self,
        image: bpy.types.Image,
        load: Callable[[], bpy.types.Image | None],
        record: dict,
        selection: PassSelection,
    ) -> Image | LateImage | None:
        """Return the pixels of an image as ``load`` gives it; None when it has none.

        record: the steps that earlier slices have done. selection: what is shown of a multilayer file.
        """
        slices = self.slices
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
            shape, look = _shape(image), ImageLook.of(image)
            if shape is None:
                return None
            if slices.are_limited and shape[0] * shape[1] >= _LARGE and not look.needs_blender:
                return self._late_image(shape, look, _Place(image.session_uid, selection))
            exported = slices.step(record, "encoded", lambda: _read_at_once(image, look))
        if exported is not None:
            keep(image, selection, exported)
        return exported

    def _late_image(self, shape: tuple[int, int, int], look: ImageLook, place: "_Place") -> LateImage:
        longest_side = self.longest_side

        def read(stored: np.ndarray) -> bool:
            image = place.find()
            return image is not None and _shape(image) == shape and _read(image, stored)

        return LateImage(
            shape,
            read,
            lambda stored: encoded(look, _four_channels(stored, look.is_float)),
            lambda whole: limited(whole, longest_side) if longest_side else whole,
        )


@dataclass(frozen=True)
class _Place:
    """An image's session_uid and the selection of a pass, by which Blender's image is found again in another slice."""

    session_uid: int
    selection: PassSelection

    def find(self) -> bpy.types.Image | None:
        """Return Blender's image; None if it is gone."""
        return next((image for image in bpy.data.images if image.session_uid == self.session_uid), None)


def _read_loaded(image: bpy.types.Image, loaded: bpy.types.Image, selection: PassSelection) -> Image | None:
    """Return what one file of an image shows, which was loaded as an image of its own."""
    pixels = read_pixels(loaded)
    if pixels is None and _is_multilayer(loaded):
        return _multilayer_pass(image, loaded, selection)
    return None if pixels is None else encoded(ImageLook.of(image), pixels)


def _is_multilayer(image: bpy.types.Image) -> bool:
    """Return whether an image's file, which Blender has decoded, has several layers or passes."""
    return image.type == "MULTILAYER"


def _multilayer_pass(image: bpy.types.Image, loaded: bpy.types.Image, selection: PassSelection) -> Image | None:
    """Return the selected pass of a multilayer file. As in Blender, passes of one or two channels are data."""
    with file_of(loaded) as path:
        pixels = read_pass(path, selection)
    if pixels is None:
        return None
    look = replace(ImageLook.of(image), is_float=True, file_format="")
    is_data = pixels.shape[-1] < 3
    pixels = _four_channels(pixels, is_float=True)
    if is_data:
        return Image(look.name, pixels, "LINEAR")
    if not look.is_linear:
        pixels[..., :3] = scene_linear(pixels[..., :3], look.space)
    return encoded(look, pixels)


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


def _read_at_once(image: bpy.types.Image, look: ImageLook) -> Image | None:
    pixels = read_pixels(image)
    return None if pixels is None else encoded(look, pixels)


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
