# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures what a viewport shows in its first seconds, beside Cycles, and how many pictures an orbit has.

    python -m benchmarks.viewport --scenes cube sun_sky pool first_light --save out/viewport

Prints tables and, with --save, writes the pictures' sheet and the figures. Scenes are those below, samples of docs/ by
their names, and .blend files. A second is one of all cores (machine.Clock), so that other programs beside change
little; shaders are compiled before (first_picture.py measures without). Cycles renders stills of as many samples as it
has by then, its set-up of a scene included, without adaptive sampling and denoising. Needs the bpy module and the bench
extra.
"""

import argparse
import dataclasses
import json
import math
import os
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import bpy
import numpy as np
import OpenEXR
import PIL.Image

import rppm_addon
from rppm_addon.blender.export import export_scene
from rppm_addon.commands.saved_scene import camera_at_resolution
from rppm_addon.denoising.denoiser import Denoiser
from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs.programs import ProgramLibrary
from rppm_addon.integrator.progressive import ProgressivePhotonMapper
from rppm_addon.scene import Scene
from rppm_addon.session.placeholders.known_programs import KnownPrograms
from rppm_addon.session.transport.frames import FrameReader
from rppm_addon.session.viewport.presenter import film_picture
from rppm_addon.session.viewport.viewport_renderer import ViewportRenderer

from . import ROOT
from .machine import Clock, describe
from .peers.metrics import displayed, exposure_of, flip

VIEWS_A_SECOND = 30.0
ORBIT_SECONDS, DEGREES_A_SECOND = 3.0, 30.0
SEED, REFERENCE_SEED = 0, 1234
MAX_SAMPLES = 1 << 16


def make_cube() -> None:
    """Blender's own first scene."""
    bpy.ops.wm.read_factory_settings()


def make_sun_sky() -> None:
    """Its cube on a floor, below a sun and a sky."""
    make_cube()
    bpy.data.objects.remove(bpy.data.objects["Light"])
    bpy.ops.mesh.primitive_plane_add(size=30.0, location=(0.0, 0.0, -1.0))
    tree = bpy.context.scene.world.node_tree
    sky = tree.nodes.new("ShaderNodeTexSky")
    sky.sun_disc = False
    tree.links.new(sky.outputs[0], tree.nodes["Background"].inputs[0])
    tree.nodes["Background"].inputs[1].default_value = 0.1
    bpy.ops.object.light_add(type="SUN", rotation=(0.7, 0.2, 0.4))
    bpy.context.object.data.energy = 3.0


MADE = {"cube": make_cube, "sun_sky": make_sun_sky}
PLAIN = frozenset(MADE)
"""Scenes without caustics, whose reference is Cycles'; others have RPPM's."""


def load(name: str) -> None:
    """Have a scene in Blender."""
    if name in MADE:
        MADE[name]()
        return
    path = Path(name) if name.endswith(".blend") else ROOT / f"docs/samples/{name}.blend"
    bpy.ops.wm.open_mainfile(filepath=str(path), load_ui=False, use_scripts=False)


class Window:
    """A viewport's session, without a window; keeps what it is sent."""

    def __init__(self, context: Context, library: ProgramLibrary, clock: Clock) -> None:
        self._clock = clock
        self._programs = KnownPrograms()
        self._context, self._library = context, library
        self.pictures: list[tuple[float, int, np.ndarray]] = []
        """Time, generation and pixels of each frame."""
        self.rendered = 0
        """Number of frames that were rendered, and not reprojected."""
        self._reader: FrameReader | None = None
        self.renderer = self._open()

    def _open(self) -> ViewportRenderer:
        return ViewportRenderer(self._context, self._library, Denoiser([]), self._take, self._programs)

    def _take(self, kind: str, **content: object) -> None:
        if kind == "slots":
            self._reader = FrameReader(**content)
        elif kind == "frame":
            self.rendered += content.pop("progress") > 0.0
            self.pictures.append((self._clock.now(), content["generation"], self._reader.read(**content)))

    def reopen(self) -> None:
        """Begin as a viewport that has shown nothing."""
        self.renderer.release()
        self.renderer, self.pictures = self._open(), []

    def run(self, seconds: float, during: Callable[[float], None] = lambda _: None) -> None:
        """Go on for so long, or until all is rendered."""
        started = self._clock.now()
        while (passed := self._clock.now() - started) < seconds:
            during(passed)
            if not self.renderer.busy:
                break
            self.renderer.run_slice()
            self._context.finish()


def in_frame(picture: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """A picture that may be coarser, as windows enlarge it: (height, width, 3)."""
    if picture.shape[1::-1] == size:
        return picture[..., :3]
    planes = [PIL.Image.fromarray(np.ascontiguousarray(picture[..., k])) for k in range(3)]
    return np.stack([np.asarray(plane.resize(size, PIL.Image.Resampling.BILINEAR)) for plane in planes], axis=-1)


def rppm_pictures(window: Window, clock: Clock, scene: Scene, marks: list[float]) -> Iterator[dict[str, object]]:
    """Yield the picture that is shown after so many seconds, and the film's own picture at that moment."""
    renderer, size, started = window.renderer, scene.camera.resolution, clock.now()
    renderer.show(scene, 1, False)
    for mark in marks:
        window.run(mark - (clock.now() - started))
        mapper = renderer.mapper
        samples = mapper.iteration if mapper.film.width == size[0] else 0
        yield {
            "shown": in_frame(window.pictures[-1][2], size),
            "noisy": in_frame(film_picture(mapper.film, scene), size),
            "samples": samples,
        }


def orbit(window: Window, scene: Scene) -> dict[str, float]:
    """Pictures a second while the view turns about the world's axis."""
    before, rendered, state = len(window.pictures), window.rendered, {"view": 1}
    renderer = window.renderer

    def turn(passed: float) -> None:
        view = 2 + int(passed * VIEWS_A_SECOND)
        if view == state["view"]:
            return
        state["view"] = view
        angle = math.radians(DEGREES_A_SECOND * passed)
        matrix = np.eye(4)
        matrix[:2, :2] = [[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]
        camera = dataclasses.replace(scene.camera, matrix=matrix @ scene.camera.matrix)
        renderer.show(dataclasses.replace(scene, camera=camera), view, True)

    window.run(ORBIT_SECONDS, turn)
    shown = window.pictures[before:]
    return {"shown": len(shown) / ORBIT_SECONDS, "rendered": (window.rendered - rendered) / ORBIT_SECONDS}


def cycles_picture(samples: int, size: tuple[int, int], seed: int) -> np.ndarray:
    """(height, width, 3) of so many samples, row 0 at the bottom."""
    scene = bpy.context.scene
    render, cycles = scene.render, scene.cycles
    render.engine, cycles.device, cycles.samples, cycles.seed = "CYCLES", "CPU", samples, seed
    render.resolution_x, render.resolution_y, render.resolution_percentage = *size, 100
    render.use_compositing = render.use_sequencer = render.use_border = False
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_auto_tile = False
    cycles.time_limit = 0.0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    if hasattr(render.image_settings, "media_type"):
        render.image_settings.media_type = "IMAGE"
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    with tempfile.TemporaryDirectory() as folder:
        render.filepath = str(Path(folder) / "picture.exr")
        bpy.ops.render.render(write_still=True)
        with OpenEXR.File(render.filepath) as file:
            channels = file.channels()
            return channels["RGBA" if "RGBA" in channels else "RGB"].pixels[::-1, :, :3].copy()


def cycles_samples(clock: Clock, size: tuple[int, int], marks: list[float]) -> list[int]:
    """How many samples Cycles has after so many seconds each, at least one."""
    cycles_picture(1, size, SEED)
    few, many = 1, 33
    seconds = [clock.once(lambda count=count: cycles_picture(count, size, SEED)) for count in (few, many)]
    each = max((seconds[1] - seconds[0]) / (many - few), 1e-4)
    return [min(max(1, round((mark - seconds[0]) / each)), MAX_SAMPLES) for mark in marks]


def rppm_reference(context: Context, library: ProgramLibrary, clock: Clock, scene: Scene, seconds: float) -> np.ndarray:
    """(height, width, 3) of a long render with another seed."""
    settings = dataclasses.replace(scene.settings, seed=REFERENCE_SEED, iterations=MAX_SAMPLES)
    mapper = ProgressivePhotonMapper(context, library)
    mapper.update(dataclasses.replace(scene, settings=settings))
    mapper.iterate()  # compiles
    started = clock.now()
    while clock.now() - started < seconds:
        mapper.iterate()
        context.finish()
    radiance = mapper.film.read_radiance()[..., :3] * scene.exposure
    mapper.release()
    return radiance


def measure(options: argparse.Namespace, name: str, context: Context, library: ProgramLibrary) -> dict[str, object]:
    """Figures and pictures of a scene."""
    size, clock, marks = options.size, Clock(context), options.seconds
    load(name)
    scene = export_scene(bpy.context.evaluated_depsgraph_get()).expanded()
    scene.camera = camera_at_resolution(scene.camera, *size)
    scene.settings = dataclasses.replace(
        scene.settings, passes=(), iterations=1024, time_limit=0.0, seed=SEED, photons=0
    )
    counts = cycles_samples(clock, size, [*marks, options.reference])
    if name in PLAIN:
        reference = cycles_picture(counts[-1], size, REFERENCE_SEED)
    else:
        reference = rppm_reference(context, library, clock, scene, options.reference)
    window = Window(context, library, clock)
    window.renderer.show(scene, 1, False)
    window.run(0.5)  # compile
    window.renderer.show(dataclasses.replace(scene, camera=dataclasses.replace(scene.camera)), 2, True)
    window.run(0.5)
    window.reopen()
    started, exposure = clock.now(), exposure_of(reference)
    row: dict[str, object] = {"scene": Path(name).stem, "marks": [], "reference": reference, "exposure": exposure}
    for mark, count, found in zip(marks, counts, rppm_pictures(window, clock, scene, marks), strict=False):
        found["cycles"] = None
        found |= {"seconds": mark, "cycles_samples": count}
        row["marks"].append(found)
    row["first_picture"] = window.pictures[0][0] - started
    row["orbit"] = orbit(window, scene)
    window.renderer.release()
    for found in row["marks"]:
        found["cycles"] = cycles_picture(found["cycles_samples"], size, SEED)
        for way in ("noisy", "shown", "cycles"):
            found[f"flip_{way}"] = flip(np.clip(found[way], 0.0, None), reference, exposure)
    return row


def tables(rows: list[dict[str, object]]) -> str:
    """Markdown."""
    lines = [
        "| scene | seconds | RPPM noisy | RPPM shown | Cycles | samples: RPPM, Cycles |",
        "|---|---:|---:|---:|---:|---|",
    ]
    for row in rows:
        for found in row["marks"]:
            figures = " | ".join(f"{found[f'flip_{way}']:.4f}" for way in ("noisy", "shown", "cycles"))
            counts = f"{found['samples'] or 'coarse'}, {found['cycles_samples']}"
            lines.append(f"| {row['scene']} | {found['seconds']:g} | {figures} | {counts} |")
    lines += [
        "",
        "| scene | first picture, s | orbit: pictures a second | of them newly rendered |",
        "|---|---:|---:|---:|",
    ]
    for row in rows:
        pictures = row["orbit"]
        figures = f"{row['first_picture']:.2f} | {pictures['shown']:.1f} | {pictures['rendered']:.1f}"
        lines.append(f"| {row['scene']} | {figures} |")
    return "\n".join(lines)


def sheet(rows: list[dict[str, object]]) -> PIL.Image.Image:
    """Each scene's first and last mark: the film's picture, what is shown, Cycles' and the reference."""
    strips = []
    for row in rows:
        for found in (row["marks"][0], row["marks"][-1]):
            pictures = [found["noisy"], found["shown"], found["cycles"], row["reference"]]
            strips.append(np.concatenate([displayed(picture[::-1], row["exposure"]) for picture in pictures], axis=1))
    return PIL.Image.fromarray(np.uint8(255.0 * np.concatenate(strips) + 0.5))


def save(rows: list[dict[str, object]], machine: dict[str, object], folder: Path) -> None:
    """Write the sheet and the figures so far."""
    folder.mkdir(parents=True, exist_ok=True)
    sheet(rows).save(folder / "sheet.png")
    scenes = []
    for row in rows:
        marks = [
            {key: value for key, value in found.items() if not isinstance(value, np.ndarray)} for found in row["marks"]
        ]
        scenes.append({"marks": marks} | {key: row[key] for key in ("scene", "first_picture", "orbit")})
    (folder / "figures.json").write_text(json.dumps({"machine": machine, "scenes": scenes}, indent=2))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", nargs="+", default=[*MADE, "pool", "first_light"], metavar="NAME")
    parser.add_argument("--size", type=lambda text: tuple(map(int, text.split("x"))), default=(192, 108))
    parser.add_argument("--seconds", type=lambda text: [float(part) for part in text.split(",")], default=[2, 5, 10])
    parser.add_argument("--reference", type=float, default=60.0, metavar="SECONDS", help="of the reference")
    parser.add_argument("--save", type=Path, metavar="FOLDER")
    options = parser.parse_args()
    rppm_addon.register()
    context = Context.create()
    library = ProgramLibrary(context)
    rows: list[dict[str, object]] = []
    for name in options.scenes:
        rows.append(measure(options, name, context, library))
        print(tables(rows[-1:]), flush=True)
        if options.save is not None:
            save(rows, describe(context, Clock(context)), options.save)
    print(tables(rows), flush=True)


if __name__ == "__main__":
    main()
    sys.stdout.flush()
    os._exit(0)  # Blender's own exit may hang
