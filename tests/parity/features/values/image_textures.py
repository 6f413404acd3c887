# SPDX-License-Identifier: GPL-3.0-or-later
"""Image textures: projection, extension, interpolation, color space, alpha, depth, and their use."""

import atexit
import shutil
import struct
import tempfile
import zlib
from functools import cache, partial
from pathlib import Path

import bpy
import numpy as np
import OpenEXR
from PIL import Image

from ...net import socket
from ..rows import value
from .coordinates import second_uv

GROUP = "Image Texture"


@cache
def folder() -> Path:
    """Where the pictures are until the program ends."""
    made = Path(tempfile.mkdtemp(prefix="rppm_parity_"))
    atexit.register(shutil.rmtree, made, ignore_errors=True)
    return made


def _pixels(width: int, height: int, seed: int) -> np.ndarray:
    """(H, W, 4) random colors from 0 to 1, alpha from 0.2 to 1."""
    pixels = np.random.default_rng(seed).random((height, width, 4))
    pixels[..., 3] = 0.2 + 0.8 * pixels[..., 3]
    return pixels


def _write_deep(path: Path, pixels: np.ndarray) -> None:
    """A png of (H, W, 4) numbers from 0 to 1 with 16 bits, which PIL does not write."""
    height, width = pixels.shape[:2]
    rows = np.round(65535 * pixels).astype(">u2").reshape(height, -1)
    parts = {
        b"IHDR": struct.pack(">IIBBBBB", width, height, 16, 6, 0, 0, 0),
        b"IDAT": zlib.compress(b"".join(b"\0" + row.tobytes() for row in rows)), b"IEND": b"",
    }  # fmt: skip
    chunks = [struct.pack(">I", len(part)) + kind + part + struct.pack(">I", zlib.crc32(kind + part))
              for kind, part in parts.items()]  # fmt: skip
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(chunks))


@cache
def picture(kind: str = "png", width: int = 12, height: int = 8) -> str:
    """A small picture file: png, opaque (png without alpha), gray (png), deep (png with 16 bits), deep_alpha (png with
    16 bits and alpha), exr, exr_alpha, multilayer (exr)."""
    path = folder() / f"{kind}_{width}x{height}{'.exr' if kind in {'exr', 'exr_alpha', 'multilayer'} else '.png'}"
    pixels = _pixels(width, height, 5)
    if kind == "premultiplied":
        pixels[..., :3] *= pixels[..., 3:]
    if kind == "multilayer":
        layer = {f"View.Combined.{c}": np.float32(3.0 * pixels[..., k]) for k, c in enumerate("RGB")}
        header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
        header["BlenderMultiChannel"] = "Blender V2.55.1 and newer"
        depth = {"View.Depth.Z": np.float32(pixels[..., 3])}
        parts = [OpenEXR.Part(dict(header), layer, "View.Combined"), OpenEXR.Part(dict(header), depth, "View.Depth")]
        OpenEXR.File(parts).write(str(path))
    elif kind in {"exr", "exr_alpha"}:
        planes = {c: np.float32(3.0 * pixels[..., k]) for k, c in enumerate("RGB")}
        if kind == "exr_alpha":
            planes["A"] = np.float32(pixels[..., 3])
        header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
        OpenEXR.File(header, planes).write(str(path))
    elif kind == "deep_alpha":
        _write_deep(path, pixels)
    elif kind == "deep":
        gray = np.uint16(65535 * pixels[..., 0])
        Image.fromarray(gray).save(path)
    else:
        shown = np.uint8(np.round(255 * pixels))
        shown = {"png": shown, "premultiplied": shown, "opaque": shown[..., :3], "gray": shown[..., 0]}[kind]
        Image.fromarray(shown).save(path)
    return str(path)


def image(kind: str = "png", space: str | None = None, alpha: str | None = None) -> bpy.types.Image:
    """The file as an image of Blender."""
    loaded = bpy.data.images.load(picture(kind))
    if space is not None:
        loaded.colorspace_settings.name = space
    if alpha is not None:
        loaded.alpha_mode = alpha
    return loaded


def texture(output="Color", inputs=None, kind="png", space=None, alpha=None, mapping=None, **properties):
    """Gives an output of an image texture; ``mapping`` = coordinates, location and scale, by default UV."""
    chosen = dict(inputs or {})
    if mapping is not None:
        coordinates, location, scale = mapping
        placed = {"Location": (location,) * 3, "Scale": (scale,) * 3, "Rotation": (0.3, -0.2, 0.5)}
        chosen["Vector"] = socket("Mapping", inputs={"Vector": socket("TexCoord", coordinates)} | placed)
    return lambda net: net.out("TexImage", output, chosen, image=image(kind, space, alpha), **properties)


BEYOND = ("UV", -0.7, 3.0)
value(GROUP, "as it comes", texture())
for _interpolation in ("Linear", "Closest", "Cubic", "Smart"):
    value(GROUP, f"interpolation {_interpolation}", texture(interpolation=_interpolation, kind="opaque"))
for _extension in ("REPEAT", "EXTEND", "CLIP", "MIRROR"):
    for _interpolation in ("Linear", "Closest"):
        _give = texture(extension=_extension, interpolation=_interpolation, mapping=BEYOND)
        value(GROUP, f"extension {_extension}, {_interpolation}", _give)
value(GROUP, "extension CLIP, alpha", texture("Alpha", extension="CLIP", mapping=BEYOND))
value(GROUP, "extension MIRROR, Cubic", texture(extension="MIRROR", interpolation="Cubic", mapping=BEYOND))
for _projection in ("BOX", "SPHERE", "TUBE"):
    for _coordinates in ("Generated", "Object"):
        _give = texture(projection=_projection, mapping=(_coordinates, 0.1, 0.8))
        value(GROUP, f"projection {_projection}, {_coordinates}", _give)
for _blend in (0.2, 1.0):
    _give = texture(projection="BOX", projection_blend=_blend, mapping=("Object", 0.1, 0.8))
    value(GROUP, f"projection BOX, blend {_blend}", _give)
SPACES = {
    (1.0, 0.0): ("sRGB", "Non-Color", "Linear Rec.709"),
    (0.5, 0.8): ("ACEScg", "Linear Rec.2020", "Linear CIE-XYZ E", "Display P3", "Rec.1886"),
    (0.05, 0.5): (
        "Filmic sRGB", "Filmic Log", "AgX Base sRGB", "Khronos PBR Neutral sRGB", "ACES 2.0 sRGB", "Rec.2100-HLG",
    ),
}  # fmt: skip
"""Color spaces by the scale and offset with which their colors are shown."""
for _shown, _spaces in SPACES.items():
    for _space in _spaces:
        value(GROUP, f"color space {_space}", texture(space=_space, kind="opaque"), *_shown)
_rounds = "Cycles rounds to half floats before it multiplies by alpha"
value(GROUP, "color space Filmic sRGB, alpha", texture(space="Filmic sRGB"), 0.1, 0.5, reason=_rounds)
for _space in ("Linear Rec.709", "Non-Color", "sRGB", "ACEScg"):
    value(GROUP, f"float, {_space}", texture(space=_space, kind="exr"), 0.3, 0.5)
value(GROUP, "multilayer", texture(kind="multilayer"), 0.3, 0.5)
value(GROUP, "multilayer, ACEScg", texture(kind="multilayer", space="ACEScg"), 0.3, 0.5)
value(GROUP, "16 bits, gray", texture(kind="deep"))
value(GROUP, "8 bits, gray", texture(kind="gray"))
for _alpha in ("STRAIGHT", "PREMUL", "CHANNEL_PACKED", "NONE"):
    _kind = "premultiplied" if _alpha == "PREMUL" else "png"
    value(GROUP, f"alpha {_alpha}, color", texture(alpha=_alpha, kind=_kind))
    value(GROUP, f"alpha {_alpha}, alpha", texture("Alpha", alpha=_alpha))


def _color_over_alpha(give_image):
    def give(net):
        node = net.node("TexImage", image=give_image())
        return net.out("MixRGB", inputs={0: node.outputs["Alpha"], 1: (0.9, 0.1, 0.1), 2: node.outputs["Color"]})

    return give


for _alpha in ("STRAIGHT", "PREMUL", "CHANNEL_PACKED"):
    _given = partial(image, "premultiplied" if _alpha == "PREMUL" else "png", None, _alpha)
    value(GROUP, f"alpha {_alpha}, both outputs", _color_over_alpha(_given))


def _packed(kind, **settings):
    made = image(kind, **settings)
    made.pack()
    return made


for _alpha in ("STRAIGHT", "PREMUL"):
    value(GROUP, f"16 bits, alpha {_alpha}", texture(kind="deep_alpha", alpha=_alpha))
    for _space in ("sRGB", "Linear Rec.709"):
        _give = texture(kind="exr_alpha", space=_space, alpha=_alpha)
        value(GROUP, f"float, alpha {_alpha}, {_space}", _give, 0.1, 0.5)
for _alpha in ("STRAIGHT", "CHANNEL_PACKED"):
    _given = partial(image, "deep_alpha", alpha=_alpha)
    value(GROUP, f"16 bits, alpha {_alpha}, both outputs", _color_over_alpha(_given))
    _given = partial(_packed, "deep_alpha", alpha=_alpha)
    value(GROUP, f"16 bits, packed, alpha {_alpha}, both outputs", _color_over_alpha(_given))
_second = texture(inputs={"Vector": socket("UVMap", uv_map="Second")})
value(GROUP, "in a second UV map", _second, prepare=second_uv)


def _limited(kind, width, height):
    def give(net):
        scene = bpy.context.scene
        scene.render.use_simplify, scene.cycles.texture_limit_render = True, "128"
        loaded = bpy.data.images.load(picture(kind, width, height))
        return net.out("TexImage", image=loaded)

    return give


value(GROUP, "texture limit", _limited("png", 300, 140))
value(GROUP, "texture limit, float", _limited("exr", 520, 2), 0.3, 0.5)
value(GROUP, "without an image", socket("TexImage"), warns=True)


def _generated_image(net):
    made = bpy.data.images.new("Painted", 8, 8)
    made.pixels.foreach_set(_pixels(8, 8, 9).astype(np.float32).ravel())
    made.update()
    return net.out("TexImage", image=made)


def _painted_float(net):
    made = bpy.data.images.new("Painted", 8, 8, float_buffer=True)
    made.colorspace_settings.name = "sRGB"
    made.pixels.foreach_set(_pixels(8, 8, 9).astype(np.float32).ravel())
    made.update()
    return net.out("TexImage", image=made)


value(GROUP, "painted in Blender", _generated_image)
value(GROUP, "painted in Blender, float", _painted_float)
value(GROUP, "packed", lambda net: net.out("TexImage", image=_packed("opaque")))


def _tiles(net):
    tiles = folder()
    for number, seed in ((1001, 1), (1002, 2), (1011, 3)):
        Image.fromarray(np.uint8(255 * _pixels(8, 8, seed)[..., :3])).save(tiles / f"tiled.{number}.png")
    made = bpy.data.images.load(str(tiles / "tiled.1001.png"))
    made.source = "TILED"
    made.filepath = str(tiles / "tiled.<UDIM>.png")
    for number in (1002, 1011):
        if number not in {tile.number for tile in made.tiles}:
            made.tiles.new(number)
    made.reload()
    where = net.out("Mapping", inputs={"Vector": net.out("TexCoord", "UV"), "Scale": (2.0, 2.0, 1.0)})
    return net.out("TexImage", inputs={"Vector": where}, image=made)


value(GROUP, "UDIM tiles", _tiles)


def _animated(movie: bool, frame: int, **user):
    """A sequence of files, or a movie, at a frame of the scene; ``user`` of the node's image user."""

    def give(net):
        pictures = [Image.fromarray(np.uint8(255 * _pixels(8, 8, seed)[..., :3])) for seed in range(1, 7)]
        for number, shown in enumerate(pictures, 1):
            shown.save(folder() / f"shot_{number:03d}.png")
        pictures[0].save(folder() / "shot.gif", save_all=True, append_images=pictures[1:], duration=40)
        made = bpy.data.images.load(str(folder() / ("shot.gif" if movie else "shot_001.png")))
        made.source = "MOVIE" if movie else "SEQUENCE"
        node = net.node("TexImage", image=made)
        for name, setting in ({"frame_duration": 6} | user).items():
            setattr(node.image_user, name, setting)
        bpy.context.scene.frame_set(frame)
        return node.outputs["Color"]

    return give


for _movie, _what in ((False, "sequence"), (True, "movie")):
    value(GROUP, f"{_what}, frame 3", _animated(_movie, 3, use_auto_refresh=True))
    value(GROUP, f"{_what}, without auto refresh", _animated(_movie, 4))
    value(GROUP, f"{_what}, start and offset", _animated(_movie, 5, frame_start=3, frame_offset=2))
    value(GROUP, f"{_what}, cyclic", _animated(_movie, 12, frame_duration=4, use_cyclic=True, frame_offset=1))
    value(GROUP, f"{_what}, after its end", _animated(_movie, 50))


_cubic = socket("Bump", inputs={"Height": texture(kind="gray", interpolation="Cubic"), "Distance": 0.1})
_linear = socket("Bump", inputs={"Height": texture(kind="gray"), "Distance": 0.05})
_mapped = socket("NormalMap", inputs={"Color": texture(space="Non-Color", kind="opaque")})
value("Bump", "image", _cubic, 0.5, 0.5)
value("Bump", "image, linear", _linear, 0.5, 0.5)
value("Normal Map", "image", _mapped, 0.5, 0.5)
