# SPDX-License-Identifier: GPL-3.0-or-later
"""Pixels of image files, kept while a file is open: reading them anew is most of what an export takes."""

import threading
from pathlib import Path

import bpy
from bpy.app.handlers import persistent

from ....scene import Image
from ...app_handlers import add_handlers, remove_handlers
from .color_spaces import working_space
from .multilayer import PassSelection

MOST_BYTES = 1 << 30
"""Most bytes of pixels that are kept; the images that were used longest ago are dropped first."""
_kept: dict[tuple[int, PassSelection], tuple[tuple, Image]] = {}
"""By session_uid and the selection of a pass, what an image was like when it was read, and its pixels."""
_is_keeping = False
_lock = threading.Lock()
"""Viewports and renders export in threads of their own."""


def kept(image: bpy.types.Image, selection: PassSelection) -> Image | None:
    """The pixels that an image had when they were kept; None where there are none or it may have others now."""
    now, place = _key(image), (image.session_uid, selection)
    with _lock:
        key, pixels = _kept.pop(place, (None, None))
        if pixels is None or key != now:
            return None
        _kept[place] = key, pixels
    return pixels


def keep(image: bpy.types.Image, selection: PassSelection, pixels: Image) -> None:
    """Keep what was read, where a later export can see whether it still holds."""
    key = _key(image)
    if not _is_keeping or key is None:
        return
    with _lock:
        _kept[image.session_uid, selection] = key, pixels
        while sum(kept.pixels.nbytes for _, kept in _kept.values()) > MOST_BYTES:
            del _kept[next(iter(_kept))]


def _key(image: bpy.types.Image) -> tuple | None:
    """Return a key that tells whether an image is the same; None for images that Blender changes without a report."""
    if image.source != "FILE" or image.is_dirty:
        return None
    packed = image.packed_file
    place: object = packed.size if packed is not None else None
    if packed is None:
        try:
            status = Path(bpy.path.abspath(image.filepath, library=image.library)).stat()
        except (OSError, ValueError):
            return None
        place = status.st_mtime_ns, status.st_size
    space = image.colorspace_settings.name, working_space().name
    return image.name, image.filepath, place, tuple(image.size), space, image.alpha_mode, image.is_float


@persistent
def _on_update(_: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if _kept and depsgraph.id_type_updated("IMAGE"):
        _forget()


@persistent
def _forget(*_: object) -> None:
    with _lock:
        _kept.clear()


_HANDLERS = (
    (bpy.app.handlers.depsgraph_update_post, _on_update),
    (bpy.app.handlers.undo_post, _forget),
    (bpy.app.handlers.redo_post, _forget),
    (bpy.app.handlers.load_pre, _forget),
)


def register() -> None:
    """Keep pixels from now on where there is a window, whose viewports and renders read the same images."""
    global _is_keeping
    _is_keeping = not bpy.app.background
    add_handlers(_HANDLERS)


def unregister() -> None:
    """Give all back."""
    global _is_keeping
    _is_keeping = False
    _forget()
    remove_handlers(_HANDLERS)
