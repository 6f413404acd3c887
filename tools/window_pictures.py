# SPDX-License-Identifier: GPL-3.0-or-later
"""Take the pictures of Blender's window to docs/images/window_*: ``python tools/window_pictures.py``.

First ``pytest -m long tests/gui/test_window_pictures.py`` makes them, in out/gui/.
"""

from pathlib import Path

from PIL import Image

ROOT = Path(__file__).resolve().parents[1]
SOURCE = ROOT / "out" / "gui" / "test_what_the_documents_show"
TARGET = ROOT / "docs" / "images"
PARTS: dict[str, tuple[str, tuple[int, int, int, int] | None]] = {
    "engine": (".png", (1053, 166, 1280, 520)),
    "viewport": (".jpg", None),
    "status": (".png", (0, 0, 194, 292)),
    "preferences": (".png", None),
}
"""By picture: how it is kept, and left, top, right and bottom of the part, all where it is None."""
QUALITY = 85
"""JPEG quality."""


def main() -> None:
    """Cut them out."""
    for name, (suffix, part) in PARTS.items():
        with Image.open(SOURCE / f"{name}.png") as picture:
            shown = picture.convert("RGB").crop(part or (0, 0, *picture.size))
        options = {"quality": QUALITY} if suffix == ".jpg" else {"optimize": True}
        shown.save(TARGET / f"window_{name}{suffix}", **options)


if __name__ == "__main__":
    main()
