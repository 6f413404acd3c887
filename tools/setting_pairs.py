# SPDX-License-Identifier: GPL-3.0-or-later
"""Render the pictures of docs/panels: what a setting does, side by side, to docs/images/settings/.

``python tools/setting_pairs.py [NAME ...]`` renders those of these settings, or all. Each is a sample scene in
Blender, as F12 renders it, 240 x 180 pixels, with one setting at two or three values.
"""

import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SAMPLES = ROOT / "docs" / "samples"
PICTURES = ROOT / "docs" / "images" / "settings"
SIZE = (240, 180)
GAP = 4
"""White pixels between two pictures."""
QUALITY = 90
"""JPEG quality."""
COMMON: Mapping[str, object] = {
    "scene.rppm.samples": 8,
    "scene.rppm.photons": 8192,
    "scene.rppm.radius_scale": 10.0,
    "scene.rppm.radius_maximum": 0.0,
    "scene.rppm.use_adaptive_radius": True,
    "scene.rppm.max_bounces": 32,
    "scene.rppm.direct_light": "RAYS",
    "scene.rppm.use_final_gather": True,
    "scene.rppm.filter_width": 1.5,
    "scene.rppm.pixel_filter_type": "BLACKMAN_HARRIS",
    "scene.rppm.film_exposure": 1.0,
    "scene.rppm.use_denoising": False,
    "scene.rppm.use_adaptive_sampling": False,
    "scene.rppm.time_limit": 0.0,
}
"""Settings of all pictures unless a pair sets others: few samples, as noise is to be seen, and the defaults."""


@dataclass(frozen=True)
class Pair:
    """Pictures of a scene that differ in one setting."""

    path: str
    """Path of the setting: scene.rppm.samples. A setting of materials is set in all of them."""
    values: tuple
    labels: tuple[str, ...]
    caption: str
    """Description of what is to be seen; a sentence or two."""
    sample: str = "first_light"
    """The scene, of docs/samples."""
    others: Mapping[str, object] = field(default_factory=dict)
    """Other settings, by path."""
    frame: int = 1
    zoom: tuple[float, float, float, float] = (0.0, 0.0, 1.0, 1.0)
    """The part of the picture that is shown: left, bottom, right and top as fractions."""

    @property
    def setting(self) -> str:
        """Its name without the path, which the picture's file has."""
        return self.path.rpartition(".")[2]


_CAUSTICS = (0.1, 0.02, 0.6, 0.52)
"""The part of first_light with the caustics of the ball and the gold band on the floor."""
_PAIRS = (
    Pair(
        "scene.rppm.samples", (1, 8, 32), ("1", "8", "32"),
        "Each sample makes the noise finer and, as the radius shrinks, the caustics sharper.",
    ),
    Pair(
        "scene.rppm.photons", (1024, 65536), ("1024", "65536"),
        "8 samples. Few photons leave blotches in caustics; what rays find, such as direct light, stays as it is.",
    ),
    Pair(
        "scene.rppm.radius_scale", (3.0, 10.0, 40.0), ("3", "10", "40"),
        "8 samples. A small radius is sharp and noisy, a large one smooth and blurred; both go to the same picture.",
        others={"scene.rppm.use_adaptive_radius": False}, zoom=_CAUSTICS,
    ),
    Pair(
        "scene.rppm.alpha", (0.3, 0.99), ("0.3", "0.99"),
        "32 samples that began with a radius of 20 pixels. Low values have made it small by now, and noisy.",
        others={
            "scene.rppm.samples": 32, "scene.rppm.use_adaptive_radius": False, "scene.rppm.radius_scale": 20.0,
        },
        zoom=_CAUSTICS,
    ),
    Pair(
        "scene.rppm.use_adaptive_radius", (False, True), ("off", "on"),
        "8 samples of 2048 photons: where photons are few, caustics begin smoother.",
        others={"scene.rppm.photons": 2048}, zoom=_CAUSTICS,
    ),
    Pair(
        "scene.rppm.radius_maximum", (0.005, 0.0), ("5 mm", "automatic"),
        "8 samples. No photon reaches farther than the maximum, however large the pixels are there.", zoom=_CAUSTICS,
    ),
    Pair(
        "scene.rppm.max_bounces", (0, 2, 32), ("0", "2", "32"),
        "Without bounces there is direct light only, and glass and mirrors show nothing but what shines. Two bring "
        "caustics through one body of glass, and light from wall to wall twice.",
    ),
    Pair(
        "scene.rppm.specular_roughness", (0.05, 0.5), ("0.05", "0.5"),
        "Gold of roughness 0.2. Below it the gold gathers photons, and reflections in it are made of blotches; above "
        "it is followed as a mirror.",
        others={"node.Gold.Roughness": 0.2}, zoom=(0.05, 0.0, 0.45, 0.4),
    ),
    Pair(
        "scene.rppm.direct_light", ("RAYS", "PHOTONS"), ("Rays", "Photons"),
        "8 samples. By photons, shadows are as soft as the radius, and light is blotched.",
    ),
    Pair(
        "scene.rppm.use_final_gather", (False, True), ("off", "on"),
        "8 samples. Without it light between the walls is as blotched as the photons are few; with "
        "it the noise is fine.",
    ),
    Pair(
        "scene.rppm.pixel_filter_type", ("BOX", "BLACKMAN_HARRIS"), ("Box", "Blackman-Harris"),
        "The tank from near: a box leaves steps along edges, the window of the default makes them even.",
        zoom=(0.55, 0.5, 0.8, 0.75),
    ),
    Pair(
        "scene.rppm.filter_width", (0.0, 1.5, 4.0), ("0", "1.5", "4"),
        "The tank from near: 0 looks through the middle of pixels only, wide filters blur.",
        zoom=(0.55, 0.5, 0.8, 0.75),
    ),
    Pair(
        "scene.rppm.film_exposure", (0.5, 1.0, 2.0), ("0.5", "1", "2"),
        "Light of the picture times this, before the view transform.",
    ),
    Pair(
        "scene.rppm.use_denoising", (False, True), ("off", "on"),
        "8 samples. Fine noise goes; blotches of photons, which are wider, stay.",
    ),
    Pair(
        "scene.rppm.samples_per_frame", (1, 4, 16), ("1", "4", "16"),
        "A frame of an animation that plays in the viewport, and how long each takes: with 16 samples about 16 times "
        "as long as with 1.",
        sample="pool", frame=12,
    ),
    Pair(
        "scene.render.use_motion_blur", (False, True), ("off", "on"),
        "A shutter of 12 frames, in which the lamp goes round the hare. Each of the 16 samples is at one moment.",
        sample="spotlight", frame=12,
        others={"scene.rppm.samples": 16, "scene.render.motion_blur_shutter": 12.0},
    ),
    Pair(
        "material.rppm.use_dispersion", (False, True), ("off", "on"),
        "16 samples. Glass bends blue light more than red: with Abbe number 20 cut glass and its caustics have colors.",
        others={"material.rppm.abbe_number": 20.0, "scene.rppm.samples": 16, "scene.rppm.photons": 32768},
        zoom=(0.45, 0.0, 0.75, 0.3),
    ),
)  # fmt: skip
PAIRS = {pair.path.removeprefix("scene.rppm."): pair for pair in _PAIRS}
"""By setting, without ``scene.rppm.``."""


def _open(pair: Pair) -> None:
    import bpy

    bpy.ops.wm.open_mainfile(filepath=str(SAMPLES / f"{pair.sample}.blend"))
    scene = bpy.context.scene
    scene.frame_set(pair.frame)
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.resolution_percentage = 100
    left, bottom, right, top = pair.zoom
    if pair.zoom != (0.0, 0.0, 1.0, 1.0):
        # The part fills the picture.
        scene.render.resolution_percentage = round(100.0 / max(right - left, top - bottom))
        scene.render.use_border = scene.render.use_crop_to_border = True
        scene.render.border_min_x, scene.render.border_min_y = left, bottom
        scene.render.border_max_x, scene.render.border_max_y = right, top
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.dither_intensity = 0.0


def _assign(path: str, value: object) -> None:
    import bpy

    if path == "scene.rppm.samples_per_frame":
        path = "scene.rppm.samples"  # what a frame gets before it is shown
    if path.startswith("node."):
        _, material, socket = path.split(".")
        shader = next(node for node in bpy.data.materials[material].node_tree.nodes if socket in node.inputs)
        shader.inputs[socket].default_value = value
        return
    kind, *inner, name = path.split(".")
    for owner in bpy.data.materials if kind == "material" else [bpy.context.scene]:
        for part in inner:
            owner = getattr(owner, part)
        setattr(owner, name, value)


_rendered: dict[tuple, object] = {}
"""Pictures by what they show: many pairs have one with the defaults."""


def _picture(pair: Pair, settings: Mapping[str, object]) -> object:
    import bpy
    from PIL import Image

    _open(pair)
    for path, value in settings.items():
        _assign(path, value)
    with tempfile.TemporaryDirectory() as folder:
        bpy.context.scene.render.filepath = str(Path(folder) / "picture.png")
        bpy.ops.render.render(write_still=True)
        return Image.open(Path(folder) / "picture.png").convert("RGB").resize(SIZE, Image.Resampling.LANCZOS)


def render(pair: Pair) -> None:
    """Render a pair's pictures and write them side by side."""
    from PIL import Image

    shown = []
    for value in pair.values:
        settings = {**COMMON, **pair.others, pair.path: value}
        key = pair.sample, pair.frame, pair.zoom, frozenset(settings.items())
        if key not in _rendered:
            _rendered[key] = _picture(pair, settings)
        shown.append(_rendered[key])
    sheet = Image.new("RGB", (len(shown) * (SIZE[0] + GAP) - GAP, SIZE[1]), "white")
    for number, picture in enumerate(shown):
        sheet.paste(picture, (number * (SIZE[0] + GAP), 0))
    PICTURES.mkdir(exist_ok=True)
    sheet.save(PICTURES / f"{pair.setting}.jpg", quality=QUALITY)


def main() -> None:
    """Render what the command line names, or all."""
    import rppm_addon

    rppm_addon.register()
    for name in sys.argv[1:] or PAIRS:
        render(PAIRS[name])
        print(PICTURES / f"{PAIRS[name].setting}.jpg", flush=True)
    rppm_addon.unregister()


if __name__ == "__main__":
    sys.path[:0] = [str(ROOT)]
    main()
