# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints the parity table, draws contact sheets to out/parity and writes docs/compatibility.md.

Run as `python -m tests.parity.features.report [pattern] [--continue]`; with a pattern only the rows that it matches are
rendered, and the page is left as it is. What is measured is kept in out/parity/rows: with --continue a row is taken
from there that the same sources gave, so that all can be measured in parts.
"""

import argparse
import dataclasses
import hashlib
import re
import sys
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

import rppm_addon
from rppm_addon.blender.export import omissions
from rppm_addon.session.render.renderer import Renderer

from ..comparison import OUTPUT
from .measure import Measurement, encoded, measure, shortcomings, white_of
from .rows import Kind, Row
from .suite import ROWS

CHECKOUT = Path(__file__).parents[3]
DOCS = CHECKOUT / "docs"
SIDE, LABEL, COLUMNS, PER_SHEET = 64, 13, 4, 48
INTRODUCTION = """<!-- SPDX-License-Identifier: GPL-3.0-or-later -->
# Compatibility with Cycles

Each row is a small scene that RPPM and Cycles render, made by `tests/parity/features`. `make parity` renders them
anew and writes this page; the tests hold every row to its limits.

*Values* are colors that glow, seen through the middles of pixels: there is no noise, so the difference is that of each
pixel. *Light* is light transport: the difference is that of the picture's mean in the channel where it is largest, with
its standard error. *Block* is the difference in the 8 x 8 pixels where it is largest beyond noise; of light it is left
out where it does not exceed four standard errors. FLIP (Andersson et al. 2020) says how different the pictures look
from 0 to 1, noise included; in brackets what two pictures of Cycles with other random numbers differ by.

The target is a mean within 1 % and blocks within 3 %. Rows beyond it say why.

![Rows of light: RPPM on the left, Cycles on the right](images/compatibility.jpg)
"""

NOT_RENDERED = """
## Not rendered

What a file may use beside its nodes and RPPM renders in another way, or not at all. Log, panel and statistics name it,
with the objects that use it. Nodes are named likewise; the remarks further down say what stands in for these.

| used by a file | in RPPM's picture |
|---|---|
"""
UNNAMED_INTRODUCTION = """
## Without a warning

What no warning names: differences that nobody can tell from the file, and settings that change no picture. Tests hold
that each property of a scene is rendered, named above, or listed with its reason (`tests/blender/audit`).

| used by a file | in RPPM's picture |
|---|---|
"""
NAMED = (
    ("A volume of the world that varies", "rendered around the scene only, up to half of its size beyond it",
     "varies from place to place; it is rendered around the scene only"),
    ("Adaptive Subdivision into more than a million triangles of all objects of a mesh",
     "edges are longer than is asked for", "Adaptive Subdivision leaves edges"),
    ("Inputs of a phase function that vary within a volume", "one value stands for all of it",
     "has a phase function that varies from place to place"),
    ("Light Linking of what has a volume that scatters",
     "lights shine on the volume as on objects without Light Linking", "Light Linking of volumes"),
    ("Light Linking of more than 63 sets of objects", "those beyond count as not linked",
     "sets of objects are linked, and those beyond"),
    ("Volume Interpolation Cubic, of materials", "voxels are interpolated linearly", "the volume interpolation Cubic"),
    ("Light Path: glass that lets shadow rays pass", "it makes shadows and caustics all the same",
     "its glass lets shadow rays pass (Is Shadow Ray)"),
    ("Light Path: light that passes by Ray Length", "photons measure from where they come from",
     "it lets light pass by Ray Length"),
    ("Subsurface method Christensen-Burley", "a random walk stands in", "has the subsurface method Christensen-Burley"),
    ("Sky Texture in a material", "its sun is left out", "has a sun, which is rendered in worlds alone"),
    ("Nodes of lights that vary by place and by direction", "one of the two counts",
     "its nodes vary by place and by direction"),
    ("Shader to RGB, Script and nodes of newer versions of Blender",
     "a diffuse surface of the node's color, or the value of the socket that it feeds, stands in",
     "is not rendered yet"),
    ("A choice of a node that RPPM does not have", "the first choice stands in", "which is not rendered"),
    ("Images that are missing or cannot be read", "magenta, as in Cycles", "magenta stands in"),
    ("Linked libraries that are missing", "what is linked is left out", "put it back, or link to another file"),
    ("Meshes whose vertices or faces change while the shutter is open", "their shape is not blurred",
     "its shape is not blurred"),
    ("View layers whose denoising or Layer Samples differ between the engines", "RPPM's count",
     "is off for Cycles only"),
    ("The compositor and the sequencer, in the program rppm", "not run; pictures are those of the view layers",
     "the compositor of scene"),
)  # fmt: skip
"""Uses that exports name as they come upon them, what becomes of them, and a part of the warning."""
UNNAMED = (
    (
        "Objects that share a mesh with Adaptive Subdivision",
        "divided as the camera sees the largest of them; in Cycles, as it sees the first",
    ),
    (
        "Adaptive Subdivision after physics, and in viewports after modifiers of other kinds",
        "goes on from the levels of the modifier, which should not be 0",
    ),
    (
        "A volume of the world that emits and scatters light",
        "its light comes from within 12 mean free paths of the scene, at most from 8 times its diagonal, with more "
        "noise than Cycles'",
    ),
    (
        "Light groups of objects that share a material whose volume emits light",
        "what camera rays and final gathers find of it counts for the group of one of them",
    ),
    (
        "Metallic BSDF with Physical Conductor",
        "an F82 curve stands in: of metals up to 4 % off, 0.7 % over all directions; darker where it hardly absorbs",
    ),
    (
        "Area lights that a parent of uneven scale shears",
        "they shine as their shape does; Cycles places the light's samples as if its sides were at right angles",
    ),
    (
        "WebP and Iris images with alpha, Cineon images",
        "as Blender shows them; Cycles does not multiply the former by alpha, and shows logarithms of the latter",
    ),
    (
        "Images of 16 bits with alpha that are no PNG, or premultiplied and neither sRGB nor linear",
        "half-transparent colors are Blender's, which differ from Cycles'",
    ),
    (
        "Thin films on glass with a Specular Tint",
        "tinted at all angles, in Cycles less at grazing ones; what passes the film is not tinted the other way round",
    ),
    (
        "Volume Scatter, in the Ray Visibility of what neither emits light nor is the world",
        "volumes see it as other surfaces do",
    ),
    (
        "Sampling of Cycles: path guiding, light tree, light threshold, scrambling distance, minimum bounces, multiple "
        "importance sampling of lights, emission sampling, map resolution",
        "light is found in another way; pictures converge to the same",
    ),
    (
        "Shadow Caustics of objects, lights and the world",
        "photons find the caustics of all objects, as Reflective and Refractive say",
    ),
    (
        "Velocities of volumes, with Motion Blur",
        "they blur as in Cycles with Biased; without it Cycles cuts off what goes far from where it is in the middle "
        "of the shutter's time. An object whose Motion Blur is off is sharp, with velocities by frame as well",
    ),
    ("Steps of volumes: Step Rate, Max Steps", "all of a volume is rendered, without bias"),
    ("Device, BVH, tiles and threads of Cycles; Persistent Data of other engines", "pictures do not depend on them"),
    (
        "Settings of EEVEE and Workbench: Blend Method, Backface Culling, factors of lights, Custom Distance, shadows "
        "of lights, light probes",
        "without effect, as in Cycles",
    ),
    ("Physics, particles, modifiers, geometry nodes, simulations", "Blender evaluates them for all engines"),
    ("Color management, Dithering, File Format, Metadata burned into pictures", "Blender applies them to the result"),
)
"""Uses that no warning names, and why: differences that the file does not show, and what changes no picture."""


def not_rendered() -> str:
    """The sections of the page that come of NAMED, UNNAMED and the tables by which exports are searched."""
    listed = [(entry.title, entry.consequence) for entry in (*omissions.OF_OBJECTS, *omissions.OF_SCENES)]
    rows = [f"| {title} | {consequence} |\n" for title, consequence, *_ in (*listed, *NAMED)]
    passes = ", ".join(omissions.PASSES.values())
    named = f"{NOT_RENDERED}{''.join(rows)}| Passes: {passes} | not offered; links from them stay black |\n"
    return named + UNNAMED_INTRODUCTION + "".join(f"| {title} | {consequence} |\n" for title, consequence in UNNAMED)


SOURCES = (
    "rppm_addon/**/*",
    "shaders/**/*",
    *(f"tests/parity/{name}.py" for name in ("comparison", "engines", "net", "scenes")),
    "tests/parity/features/**/*.py",
)


def sources_digest() -> str:
    """Return the digest of the files that measurements follow from, in hexadecimal."""
    digest = hashlib.sha256()
    for pattern in SOURCES:
        for path in sorted(CHECKOUT.glob(pattern)):
            if path.is_file() and path.suffix != ".pyc":
                digest.update(path.relative_to(CHECKOUT).as_posix().encode() + path.read_bytes())
    return digest.hexdigest()[:32]


def keep(file: Path, found: Measurement) -> None:
    """Write a measurement for kept()."""
    file.parent.mkdir(parents=True, exist_ok=True)
    np.savez_compressed(file, **dataclasses.asdict(found))


def kept(file: Path) -> Measurement | None:
    """Return the measurement that keep() wrote, or None."""
    if not file.exists():
        return None
    with np.load(file) as stored:
        members = {name: array if array.ndim else array.item() for name, array in stored.items()}
    return Measurement(**members | {"warnings": tuple(map(str, members["warnings"]))})


def run(pattern: str, again: bool = True) -> list[tuple[Row, Measurement, list[str]]]:
    """Measure the rows whose name matches, printing each as it is done.

    again: also those that are kept.
    """
    results = []
    folder = OUTPUT / "rows" / sources_digest()
    rppm_addon.register()
    try:
        with Renderer() as renderer:
            for row in (row for row in ROWS if re.search(pattern, row.id)):
                file = folder / f"{hashlib.sha256(row.id.encode()).hexdigest()[:16]}.npz"
                found = None if again else kept(file)
                if found is None:
                    found = measure(row, renderer)
                    keep(file, found)
                wrong = shortcomings(row, found)
                results.append((row, found, wrong))
                print(f"{'FAIL' if wrong else 'ok  '} {line(row, found)} {'; '.join(wrong)}", flush=True)
    finally:
        rppm_addon.unregister()
    return results


def line(row: Row, found: Measurement) -> str:
    """A row of the printed table."""
    return (
        f"{row.id:55} mean {found.mean:7.2%} +- {found.mean_error:6.2%}  block {found.block:7.2%}  "
        f"FLIP {found.flip:.3f} ({found.flip_noise:.3f})  {row.reason}"
    )


def triple(found: Measurement) -> np.ndarray:
    """(H, 3 W, 3) RPPM | Cycles | difference, where gray is none and full range a fifth of white; row 0 on top."""
    white = white_of(found.cycles)
    difference = np.clip(0.5 + 2.5 * (found.rppm - found.cycles) / white, 0.0, 1.0)
    shown = [encoded(found.rppm, white), encoded(found.cycles, white), difference]
    return np.concatenate(shown, axis=1)[::-1]


def sheet(results: list, parts: int, columns: int) -> Image.Image:
    """Labeled cells with the first ``parts`` pictures of each row."""
    width, height = parts * SIDE + 4, SIDE + LABEL
    page = Image.new("RGB", (columns * width, -(-len(results) // columns) * height), "white")
    draw = ImageDraw.Draw(page)
    for number, (row, found, wrong) in enumerate(results):
        x, y = number % columns * width, number // columns * height
        picture = triple(found)
        picture = picture[:, : picture.shape[1] * parts // 3]
        cell = Image.fromarray(np.uint8(np.round(255 * picture)))
        page.paste(cell.crop((0, 0, min(cell.width, parts * SIDE), min(cell.height, SIDE))), (x, y + LABEL))
        draw.text((x + 1, y), row.id[: parts * 10], fill="red" if wrong else "black")
    return page


def write_page(results: list) -> None:
    """docs/compatibility.md and its picture."""
    text = [INTRODUCTION, not_rendered()]
    for group in dict.fromkeys(row.group for row, _, _ in results):
        text.append(f"\n## {group}\n\n| feature | | mean | block | FLIP | remark |\n|---|---|--:|--:|--:|---|\n")
        for row, found, wrong in (result for result in results if result[0].group == group):
            light = row.kind is Kind.LIGHT
            mean = f"{found.mean:.2%} ± {found.mean_error:.2%}" if light else f"{found.mean:.2%}"
            block = f"{found.block:.1%}" if not light or found.block_excess > 0.0 else "noise"
            flip = f"{found.flip:.3f} ({found.flip_noise:.3f})" if light else f"{found.flip:.3f}"
            remark = row.reason or ("**not as it should be**: " + "; ".join(wrong) if wrong else "")
            text.append(f"| {row.name} | {row.kind.value} | {mean} | {block} | {flip} | {remark} |\n")
    (DOCS / "compatibility.md").write_text("".join(text), encoding="utf-8")
    lit = [result for result in results if result[0].kind is Kind.LIGHT]
    sheet(lit, 2, 8).save(DOCS / "images" / "compatibility.jpg", quality=70, optimize=True)


def main() -> int:
    """The number of rows that are not as they should be."""
    parser = argparse.ArgumentParser(description="Measures how near RPPM is to Cycles, row by row.")
    parser.add_argument("pattern", nargs="?", default="", help="a regular expression that names of rows match")
    parser.add_argument("--continue", dest="again", action="store_false", help="leave what the same sources gave")
    arguments = parser.parse_args()
    pattern, results = arguments.pattern, run(arguments.pattern, arguments.again)
    OUTPUT.mkdir(parents=True, exist_ok=True)
    for first in range(0, len(results), PER_SHEET):
        sheet(results[first : first + PER_SHEET], 3, COLUMNS).save(OUTPUT / f"features_{first // PER_SHEET + 1}.png")
    if not pattern:
        write_page(results)
    failed = [row.id for row, _, wrong in results if wrong]
    print(f"{len(results)} rows, {len(failed)} not as they should be; contact sheets in {OUTPUT}")
    return min(len(failed), 100)


if __name__ == "__main__":
    sys.exit(main())
