# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the pictures of docs/gallery.md: each scene by RPPM and by Cycles for the same seconds of the processor.

    python tools/gallery/render.py --seconds 120             # all that is not there already
    python tools/gallery/render.py --only prism --again
    python tools/gallery/render.py --films                   # the short films of the scenes that move

Seconds are those of all cores together, so that other programs do not matter. Files between are in out/gallery/;
pictures go to docs/images/gallery/, what they took into gallery.json beside them and into the table of docs/gallery.md.
"""

import argparse
import hashlib
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import PIL.Image

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS, SAMPLES = ROOT / "docs" / "gallery", ROOT / "docs" / "samples"
PICTURES, BETWEEN = ROOT / "docs" / "images" / "gallery", ROOT / "out" / "gallery"
RECORD, PAGE = PICTURES / "gallery.json", ROOT / "docs" / "gallery.md"
BEGIN, END = "<!-- begin: tools/gallery/render.py -->", "<!-- end -->"
SCENES = (
    "wine_glasses",
    "prism",
    "ring_and_gems",
    "perfume",
    "coffee_cup",
    "burning_lens",
    "pool_below",
    "aquarium",
    "disco_ball",
    "stage_mirrors",
    "chandelier",
    "headlamp",
    "kaleidoscope",
    "lighthouse",
    "pool_shafts",
    "window_smoke",
    "milk",
)
FRAMES = {"aquarium": 1, "disco_ball": 12, "lighthouse": 1, "window_smoke": 1}
"""Frame that is shown, of each scene that moves."""
FILM_FRAMES, FILM_SIZE, FILM_SPEED = "1..48..4", (320, 180), 6
"""Which are rendered, how large, and how many are shown a second."""
SHARED = (SCRIPTS / "stage.py", SAMPLES / "sample_scene.py", SAMPLES / "pool.py")
_IMPORT = re.compile(r"^from (\w+) import", re.MULTILINE)
"""Pattern of the modules that a script imports from; those beside it are a part of what makes its scene."""


def call(*command: object, label: str) -> str:
    """Run a program and return its output. Raises SystemExit with the end of what it complains of."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, *map(str, command)], capture_output=True, text=True, cwd=ROOT, env=environment, check=False
    )
    if done.returncode:
        raise SystemExit(f"{label} failed:\n{done.stderr.strip()[-2000:]}")
    return done.stdout


def last_json(text: str) -> dict:
    """The last line; Blender prints before it."""
    return json.loads(next(line for line in reversed(text.splitlines()) if line.startswith("{")))


def script_digest(name: str) -> str:
    """Return the digest of all files that make a scene."""
    script = SCRIPTS / f"{name}.py"
    imported = [SCRIPTS / f"{module}.py" for module in _IMPORT.findall(script.read_text(encoding="utf-8"))]
    files = (script, *SHARED, *(file for file in imported if file.exists() and file not in SHARED))
    return hashlib.sha256(b"\0".join(file.read_bytes() for file in files)).hexdigest()[:16]


def build(name: str) -> Path:
    """The .blend file, of the script as it is now."""
    blend = BETWEEN / f"{name}-{script_digest(name)}.blend"
    if not blend.exists():
        BETWEEN.mkdir(parents=True, exist_ok=True)
        for old in BETWEEN.glob(f"{name}-*.blend"):
            old.unlink()
        call(SCRIPTS / f"{name}.py", blend, label=f"building {name}")
    return blend


def render_ours(blend: Path, picture: Path, seconds: float, percent: float, frame: int) -> dict:
    """RPPM's picture as EXR, and what it took."""
    saved = picture.with_suffix(".npz")
    shape = ["--set", f"render.resolution_percentage={percent:.0f}", "--frame", frame]
    call("-m", "rppm_addon", "export", blend, "-o", saved, *shape, label=f"exporting {blend.name}")
    text = call(ROOT / "tools/gallery/rppm_picture.py", saved, picture, seconds, label=f"RPPM on {blend.name}")
    saved.unlink()
    return last_json(text)


def render_theirs(blend: Path, picture: Path, seconds: float, percent: float, frame: int) -> dict:
    """Cycles' picture as EXR, and what it took."""
    script = ROOT / "tools/gallery/cycles_picture.py"
    return last_json(call(script, blend, picture, seconds, f"{percent:.0f}", frame, label=f"Cycles on {blend.name}"))


def render_scene(name: str, options: argparse.Namespace) -> None:
    """Both pictures of a scene, unless there are such already."""
    record = read_record()
    wanted = {"script": script_digest(name), "asked": options.seconds, "percent": options.percent}
    entry = record.get(name, {})
    if not options.again and all(entry.get(key) == value for key, value in wanted.items()):
        print(f"{name}: is there", flush=True)
        return
    blend, frame = build(name), FRAMES.get(name, 1)
    ours, theirs = BETWEEN / f"{name}.exr", BETWEEN / f"{name}_cycles.exr"
    arguments = (options.seconds, options.percent, frame)
    entry = {**wanted, "rppm": render_ours(blend, ours, *arguments), "cycles": render_theirs(blend, theirs, *arguments)}
    PICTURES.mkdir(parents=True, exist_ok=True)
    pairs = (ours, PICTURES / f"{name}.jpg", theirs, PICTURES / f"{name}_cycles.jpg")
    call(ROOT / "tools/gallery/develop.py", blend, *pairs, label=f"showing {name}")
    write_record(name, entry)
    print(f"{name}: RPPM {entry['rppm']}, Cycles {entry['cycles']}", flush=True)


def render_film(name: str, options: argparse.Namespace) -> None:
    """A short film of a scene that moves, by RPPM."""
    film = PICTURES / f"{name}.webp"
    wanted = {"script": script_digest(name), "samples": options.film_samples}
    if not options.again and read_record().get(film.name) == wanted:
        print(f"{film.name}: is there", flush=True)
        return
    PICTURES.mkdir(parents=True, exist_ok=True)
    blend, pattern = build(name), BETWEEN / f"{name}_####.png"
    shape = f"{FILM_SIZE[0]}x{FILM_SIZE[1]}"
    limits = ["--frames", FILM_FRAMES, "--samples", options.film_samples, "--resolution", shape]
    call("-m", "rppm_addon", "render", blend, "-o", pattern, *limits, label=f"RPPM on {blend.name}")
    names = sorted(BETWEEN.glob(f"{name}_[0-9][0-9][0-9][0-9].png"))
    images = [PIL.Image.open(path) for path in names]
    images[0].save(
        film, save_all=True, append_images=images[1:], duration=round(1000 / FILM_SPEED), loop=0, quality=80, method=6
    )
    write_record(film.name, wanted)
    print(f"{film.name}: {film.stat().st_size // 1024} KiB", flush=True)


def read_record() -> dict:
    """Read what the pictures took, by scene or film."""
    return json.loads(RECORD.read_text(encoding="utf-8")) if RECORD.exists() else {}


def write_record(name: str, entry: dict) -> None:
    """Keep what one took."""
    RECORD.write_text(json.dumps({**read_record(), name: entry}, indent=1) + "\n", encoding="utf-8")


def write_table() -> None:
    """Write a table of what the pictures took into the page."""
    lines = [
        "| scene | pixels | triangles | RPPM: samples, photons, seconds | Cycles: samples, seconds |",
        "|---|--:|--:|--:|--:|",
    ]
    record = read_record()
    for name in (name for name in SCENES if name in record):
        ours, theirs = record[name]["rppm"], record[name]["cycles"]
        photons = f"{ours['photons'] / 1e6:.1f} million"
        lines.append(
            f"| {name.replace('_', ' ')} | {ours['resolution'][0]} x {ours['resolution'][1]} "
            f"| {ours['triangles']} | {ours['samples']}, {photons}, {ours['seconds']:.0f} s "
            f"| {theirs['samples']}, {theirs['seconds']:.0f} s |"
        )
    text = PAGE.read_text(encoding="utf-8")
    before, after = text.split(BEGIN)[0], text.split(END)[1]
    PAGE.write_text(before + "\n".join([BEGIN, *lines, END]) + after, encoding="utf-8")


def main() -> None:
    """Render what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=120.0, help="of the processor, for each picture (120)")
    parser.add_argument("--percent", type=float, default=100.0, help="of the pictures' width and height (100)")
    parser.add_argument("--only", nargs="+", choices=SCENES, default=SCENES, metavar="NAME", help="these scenes")
    parser.add_argument("--again", action="store_true", help="also what is there already")
    parser.add_argument("--films", action="store_true", help="the short films instead")
    parser.add_argument("--film-samples", type=int, default=16, metavar="N", help="of each of their frames (16)")
    parser.add_argument("--draft", action="store_true", help="RPPM alone, to out/gallery/NAME.png")
    options = parser.parse_args()
    for name in options.only:
        if options.draft:
            blend, picture = build(name), BETWEEN / f"{name}_draft.exr"
            made = render_ours(blend, picture, options.seconds, options.percent, FRAMES.get(name, 1))
            shown = BETWEEN / f"{name}.png"
            call(ROOT / "tools/gallery/develop.py", blend, picture, shown, label=f"showing {name}")
            print(f"{shown}: {made}", flush=True)
        elif options.films:
            if name in FRAMES:
                render_film(name, options)
        else:
            render_scene(name, options)
    if not options.draft:
        write_table()


if __name__ == "__main__":
    main()
