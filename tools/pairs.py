# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders .blend files with RPPM and with Cycles, side by side.

Writes out/pairs/NAME.png (RPPM left, Cycles right), out/pairs/NAME.exr and NAME_cycles.exr, a table
of mean radiance ratios and of the median of those of 8 x 8 pixels, with RPPM's warnings below each, and a contact sheet
of RPPM's pictures alone. What a file lacks to be rendered, tools/staging.py adds, in a copy in out/pairs/staged/.
A scene that fails is reported and the others go on.
"""

import argparse
import json
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import PIL.Image
import PIL.ImageDraw

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from rppm_addon.pictures import read_exr, standard_view  # noqa: E402 (the checkout, installed or not)

SCENES = (
    "cornell_box_tm",
    "glass_caustics",
    "causticcube",
    "pool",
    "diamond_ring",
    "water_caustic_cornell",
    "fireplace_room",
)

_CYCLES = """
import sys
import bpy
source, target, width, height, seconds = sys.argv[1:]
bpy.ops.wm.open_mainfile(filepath=source, load_ui=False, use_scripts=False)
scene = bpy.context.scene
render, cycles = scene.render, scene.cycles
render.engine, cycles.device = "CYCLES", "CPU"
render.resolution_x, render.resolution_y, render.resolution_percentage = int(width), int(height), 100
render.use_compositing = render.use_sequencer = render.use_border = False
cycles.samples, cycles.time_limit = 65536, float(seconds)
cycles.use_adaptive_sampling = cycles.use_denoising = False
cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
cycles.caustics_reflective = cycles.caustics_refractive = True
cycles.light_sampling_threshold = 0.0
for kind in ("max", "diffuse", "glossy", "transmission", "transparent_max"):  # RPPM's defaults are 7 of any kind
    setattr(cycles, f"{kind}_bounces", max(getattr(cycles, f"{kind}_bounces"), 8))
cycles.use_auto_tile = False
if hasattr(render.image_settings, "media_type"):
    render.image_settings.media_type = "IMAGE"
render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
render.image_settings.color_mode, render.use_file_extension = "RGBA", False
used = [layer for layer in scene.view_layers if layer.use] or list(scene.view_layers)
for layer in scene.view_layers:
    layer.use = layer == used[0]
render.filepath = target
bpy.ops.render.render(write_still=True)
"""


def run(command: list[str], seconds: float) -> str:
    """Run a command with a limit; returns what went wrong, empty when nothing."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=seconds, cwd=ROOT)
    except subprocess.TimeoutExpired:
        return f"no end after {seconds:.0f} s"
    if done.returncode:
        return (done.stderr.strip().splitlines() or [f"exit status {done.returncode}"])[-1]
    return ""


def exposure_of(pixels: np.ndarray) -> float:
    """A factor that brings a picture's middle brightness into view, the same for both of a pair."""
    luminance = pixels[..., :3] @ (0.2126, 0.7152, 0.0722)
    lit = luminance[np.isfinite(luminance) & (luminance > 0.0)]
    return 0.3 / float(np.percentile(lit, 60)) if lit.size else 1.0


def as_image(pixels: np.ndarray, exposure: float) -> PIL.Image.Image:
    """A picture through the Standard view, over black."""
    shown = np.concatenate([pixels[..., :3] * exposure, np.ones_like(pixels[..., :1])], axis=-1)
    return PIL.Image.fromarray(standard_view(shown)[::-1, :, :3])


def beside(images: list[PIL.Image.Image], columns: int, labels: list[str]) -> PIL.Image.Image:
    """Images of one size in a grid, each with a label below."""
    width, height = images[0].width, images[0].height + 14
    rows = -(-len(images) // columns)
    sheet = PIL.Image.new("RGB", (columns * width, rows * height), (24, 24, 24))
    draw = PIL.ImageDraw.Draw(sheet)
    for index, (image, label) in enumerate(zip(images, labels)):
        left, top = index % columns * width, index // columns * height
        sheet.paste(image, (left, top))
        draw.text((left + 3, top + height - 13), label, fill=(220, 220, 220))
    return sheet


def median_ratio(ours: np.ndarray, theirs: np.ndarray) -> float:
    """The median over blocks of 8 x 8 pixels of the ratio of their means, which a few bright spots do not move."""

    def blocks(pixels: np.ndarray) -> np.ndarray:
        height, width = (length // 8 for length in pixels.shape[:2])
        return pixels[: 8 * height, : 8 * width, :3].reshape(height, 8, width, 8, 3).mean((1, 3, 4))

    with np.errstate(all="ignore"):
        ratios = blocks(ours) / blocks(theirs)
    known = ratios[np.isfinite(ratios)]
    return float(np.median(known)) if known.size else float("nan")


def staged(source: Path, folder: Path, values: list[str]) -> Path | str:
    """The file, or a copy that has what a render needs and the values PATH=VALUE; or what went wrong."""
    target = folder / "staged" / source.name
    target.parent.mkdir(exist_ok=True)
    target.unlink(missing_ok=True)
    problem = run([sys.executable, str(ROOT / "tools/staging.py"), str(source), str(target), *values], 120.0)
    return f"staging: {problem}" if problem else target if target.exists() else source


def render_pair(source: Path, folder: Path, options: argparse.Namespace) -> tuple[np.ndarray, np.ndarray] | str:
    """RPPM's and Cycles' picture of a file, or what went wrong."""
    blend = staged(source, folder, options.set)
    if isinstance(blend, str):
        return blend
    ours, theirs = folder / f"{blend.stem}.exr", folder / f"{blend.stem}_cycles.exr"
    width, height = options.resolution
    command = [sys.executable, "-m", "rppm_addon", "render", str(blend), "-o", str(ours)]
    command += ["--resolution", f"{width}x{height}", "--set", "render.use_border=false"]
    command += ["--seconds", str(options.seconds), "--json", str(ours.with_suffix(".json"))]
    problem = run(command, options.seconds * 4 + 120)
    if problem:
        return f"RPPM: {problem}"
    command = [sys.executable, "-c", _CYCLES, str(blend), str(theirs), str(width), str(height), str(options.seconds)]
    if options.keep_cycles and theirs.exists() and read_exr(theirs).combined.shape[:2] == (height, width):
        problem = ""
    else:
        problem = run(command, options.seconds * 4 + 120)
    if problem:
        return f"Cycles: {problem}"
    return read_exr(ours).combined, read_exr(theirs).combined


def main() -> int:
    """Render all scenes; returns the exit status."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", type=Path, help="a folder of .blend files")
    parser.add_argument(
        "--names", nargs="*", default=SCENES, help="files without .blend; none given: all in the folder"
    )
    parser.add_argument("--set", action="append", default=[], metavar="PATH=VALUE", help="for both, as of rppm render")
    parser.add_argument("--resolution", type=lambda text: tuple(map(int, text.split("x"))), default=(256, 192))
    parser.add_argument("--seconds", type=float, default=60.0, help="time for each renderer and scene")
    parser.add_argument("--keep-cycles", action="store_true", help="use Cycles' pictures of an earlier run")
    parser.add_argument("--sheet", type=Path, default=ROOT / "out/pairs/contact_sheet.jpg")
    options = parser.parse_args()
    folder = ROOT / "out" / "pairs"
    folder.mkdir(parents=True, exist_ok=True)
    sheet, labels, failures = [], [], []
    print(f"{'scene':24} {'RPPM / Cycles, mean of R, G, B':36} {'median':8} seconds")
    for name in options.names or sorted(path.stem for path in options.scenes.glob("*.blend")):
        blend = (options.scenes / f"{name}.blend").resolve()
        start = time.monotonic()
        pair = render_pair(blend, folder, options) if blend.exists() else f"{blend.name} is not in {options.scenes}"
        if isinstance(pair, str):
            failures.append(name)
            print(f"{name:24} {pair}", flush=True)
            continue
        ours, theirs = pair
        with np.errstate(all="ignore"):
            ratio = ours[..., :3].mean((0, 1)) / theirs[..., :3].mean((0, 1))
        exposure = exposure_of(ours)  # Cycles is short of the light that it cannot find
        images = [as_image(ours, exposure), as_image(theirs, exposure)]
        beside(images, 2, ["RPPM", "Cycles"]).save(folder / f"{name}.png")
        sheet.append(images[0])
        labels.append(name)
        means, seconds = "  ".join(f"{value:.3f}" for value in ratio), time.monotonic() - start
        print(f"{name:24} {means:36} {median_ratio(ours, theirs):<8.3f} {seconds:.0f}")
        report = json.loads((folder / f"{name}.json").read_text())
        said = dict.fromkeys(
            text for part in report.get("pictures", [report]) for text in part["statistics"]["warnings"]
        )
        print(*(f"    {text}" for text in said), sep="\n", end="\n" if said else "", flush=True)
    if sheet:
        options.sheet.parent.mkdir(parents=True, exist_ok=True)
        temporary = options.sheet.with_name(f".{options.sheet.name}")
        beside(sheet, 3, labels).save(temporary, format="JPEG", quality=88)
        temporary.replace(options.sheet)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
