# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of materials from .blend files, RPPM beside Cycles: ``python -m tests.parity.material_previews FOLDER OUT``.

FOLDER holds .blend files with materials; OUT gets the sheets sheet_01.png, ... and table.txt. As many materials as
--count says are drawn at random, always the same ones for a --seed, and put on balls with texture coordinates over
a checkered floor, under an area light and a gray world, twenty in a picture; with --alone under the light and a sky, so
that nothing but the material differs, and less light has come a long way. Each sheet has RPPM's row of pictures
above Cycles'. The table says for each material RPPM's mean over Cycles' on the ball, the standard error of
both together as --seeds independent pictures tell it, the same by channel, the difference of 8x8 blocks of the whole
picture as a share of Cycles' mean, and the warnings. --names renders the materials of those names only (with commas
between them), --first leaves out what earlier pieces have rendered.
"""

import argparse
import random
from dataclasses import dataclass, field
from pathlib import Path

import bpy
import numpy as np
from PIL import Image, ImageDraw

from rppm_addon.blender.export import export_scene
from rppm_addon.session.render.renderer import Renderer

from .comparison import block_means
from .engines import render_cycles
from .net import Net, material
from .scenes import camera, light, new_scene, place

COLUMNS, ROWS = 5, 4
CELL = 32
SPACING = 3.2
RADIUS = 1.1
LABEL = 12
TILT = np.radians(35.0)
"""Angle of the camera above the floor, radians."""


@dataclass
class Preview:
    """A material in both engines' pictures: (seeds, CELL, CELL, 3), row 0 at the bottom."""

    file: str
    name: str
    rppm: np.ndarray = None
    cycles: np.ndarray = None
    warnings: list[str] = field(default_factory=list)

    @property
    def ratio(self) -> np.ndarray:
        """(3,) means on the ball, RPPM's over Cycles'."""
        return _on_ball(self.rppm).mean(axis=0) / _on_ball(self.cycles).mean(axis=0)

    @property
    def mean(self) -> float:
        """The ratio of the channels' sums."""
        return float(_on_ball(self.rppm).sum() / _on_ball(self.cycles).sum())

    @property
    def error(self) -> float:
        """Standard error of the ratio of the channels' sums."""
        return float(np.hypot(*(_relative_error(_on_ball(pictures)) for pictures in (self.rppm, self.cycles))))

    @property
    def difference(self) -> float:
        rppm, cycles = self.rppm.mean(axis=0), self.cycles.mean(axis=0)
        return float(np.abs(block_means(rppm) - block_means(cycles)).mean() / cycles.mean())


def _on_ball(pictures: np.ndarray) -> np.ndarray:
    """(seeds, 3) means of the pixels that the ball fills."""
    at = (np.arange(CELL) + 0.5) / CELL * SPACING - 0.5 * SPACING
    inside = np.hypot(*np.meshgrid(at, at)) < RADIUS - SPACING / CELL
    return pictures[:, inside].mean(axis=1)


def _relative_error(means: np.ndarray) -> float:
    sums = means.sum(axis=1)
    return sums.std(ddof=1) / np.sqrt(len(sums)) / sums.mean()


def chosen(folder: Path, count: int, seed: int, names: set[str]) -> list[Preview]:
    """The materials drawn from the files of a folder, or those of the given names."""
    found = []
    for path in sorted(folder.glob("matlib_*.blend")) or sorted(folder.glob("*.blend")):
        with bpy.data.libraries.load(str(path)) as (source, _):
            found += [Preview(str(path), name) for name in source.materials]
    if names:
        return [preview for preview in found if preview.name in names]
    return random.Random(seed).sample(found, min(count, len(found)))


def _append(previews: list[Preview]) -> list[bpy.types.Material]:
    found = []
    for preview in previews:
        with bpy.data.libraries.load(preview.file) as (_, target):
            target.materials = [preview.name]
        found.append(target.materials[0])
    return found


def _floor() -> None:
    surface, net = material("Floor")
    colors = {"Color1": (0.6, 0.6, 0.6), "Color2": (0.15, 0.15, 0.2), "Scale": 1.999}
    checker = net.out("TexChecker", 0, colors | {"Vector": net.out("TexCoord", "Object")})
    net.output(net.out("BsdfDiffuse", 0, {"Color": checker}))
    bpy.ops.mesh.primitive_plane_add(size=30.0, location=(0.0, 0.0, -RADIUS - 0.001))
    bpy.context.object.data.materials.append(surface)


def _sky(world: bpy.types.World) -> None:
    """Brown below, bright above: even enough to be quiet, uneven enough to show where light goes."""
    net = Net(world.node_tree)
    height = net.out("SeparateXYZ", "Z", {0: net.out("TexCoord", "Generated")})
    ramp = net.node("ValToRGB", {0: net.out("MapRange", 0, {"Value": height, "From Min": -1.0, "From Max": 1.0})})
    ramp.color_ramp.elements[0].color = (0.25, 0.15, 0.1, 1.0)
    ramp.color_ramp.elements[1].color = (0.4, 0.6, 0.9, 1.0)
    net.set(net.find("BACKGROUND").inputs["Color"], ramp.outputs["Color"])


def build(previews: list[Preview], alone: bool = False) -> None:
    """The scene of up to COLUMNS x ROWS materials; an orthographic camera gives each its square."""
    scene = new_scene(world=0.7 if alone else 0.25)
    scene.render.resolution_x, scene.render.resolution_y = COLUMNS * CELL, ROWS * CELL
    if alone:
        _sky(scene.world)
    else:
        _floor()
    for number, surface in enumerate(_append(previews)):
        column, row = number % COLUMNS, number // COLUMNS
        x = (column - (COLUMNS - 1) / 2) * SPACING
        y = ((ROWS - 1) / 2 - row) * SPACING / np.sin(TILT)
        # Turned so that neither a pole nor the seam of its texture coordinates is looked at.
        bpy.ops.mesh.primitive_uv_sphere_add(
            segments=48, ring_count=24, radius=RADIUS, location=(x, y, 0.0), rotation=(-0.4, 0.0, 0.4)
        )
        made = bpy.context.object
        made.data.shade_smooth()
        made.data.materials.clear()
        made.data.materials.append(surface)
    light("AREA", 6000.0, place((-8.0, -9.0, 14.0), (35.0, -25.0, 0.0)), size=14.0)
    away = 30.0
    made = camera((0.0, -away * np.cos(TILT), away * np.sin(TILT)), (0.0, 0.0, 0.0))
    made.data.type, made.data.ortho_scale = "ORTHO", COLUMNS * SPACING


def render(renderer: Renderer, previews: list[Preview], seeds: int, samples: int, alone: bool, settings: dict) -> None:
    """Fill in both engines' pictures and the warnings of materials that share a scene."""
    build(previews, alone)
    scene = export_scene(bpy.context.evaluated_depsgraph_get())
    rppm, cycles = [], render_cycles(samples, seeds)
    for seed in range(seeds):
        scene.settings = scene.settings.with_values(seed=seed, **settings)
        result = renderer.render(scene)
        rppm.append(result.frame.combined[..., :3].astype(np.float64))
    for number, preview in enumerate(previews):
        x, y = number % COLUMNS * CELL, (ROWS - 1 - number // COLUMNS) * CELL
        preview.rppm, preview.cycles = (
            np.array(pictures)[:, y : y + CELL, x : x + CELL] for pictures in (rppm, cycles)
        )
        preview.warnings = [text for text in result.statistics.warnings if f'"{preview.name}"' in text]
    others = [text for text in result.statistics.warnings if not any(text in p.warnings for p in previews)]
    print(f"{result.statistics.iterations} iterations", *others, sep="\n  ")


def _encoded(picture: np.ndarray) -> Image.Image:
    picture = np.clip(picture[::-1], 0.0, 1.0)
    coded = np.where(picture <= 0.0031308, 12.92 * picture, 1.055 * picture ** (1 / 2.4) - 0.055)
    return Image.fromarray(np.rint(coded * 255.0).astype(np.uint8))


def sheet(previews: list[Preview], scale: int = 4) -> Image.Image:
    """Labeled pictures: rows of RPPM's and of Cycles' in turn."""
    side = CELL * scale
    rows = -(-len(previews) // COLUMNS)
    made = Image.new("RGB", (COLUMNS * (side + 2), rows * 2 * (side + LABEL)), "white")
    draw = ImageDraw.Draw(made)
    for number, preview in enumerate(previews):
        x, row = number % COLUMNS * (side + 2), number // COLUMNS
        for part, pictures in enumerate((preview.rppm, preview.cycles)):
            y = (2 * row + part) * (side + LABEL)
            text = preview.name[:30] if part == 0 else f"Cycles; ratio {preview.mean:.3f}"
            draw.text((x + 2, y), text, fill="black")
            made.paste(_encoded(pictures.mean(axis=0)).resize((side, side), Image.Resampling.NEAREST), (x, y + LABEL))
    return made


def main() -> None:
    """The program."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--count", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--names", default="")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--iterations", type=int, default=16, help="RPPM's for each seed")
    parser.add_argument("--photons", type=int, default=8192, help="RPPM's for each iteration")
    parser.add_argument("--alone", action="store_true", help="no floor: a sky and the light")
    parser.add_argument("--samples", type=int, default=32, help="Cycles' for each seed")
    parser.add_argument("--path-length", type=int, default=0, help="RPPM's of all paths; 0 is the default of each")
    parser.add_argument("--specular-roughness", type=float, help="RPPM's")
    arguments = parser.parse_args()
    import rppm_addon

    rppm_addon.register()
    arguments.out.mkdir(parents=True, exist_ok=True)
    names = {name for name in arguments.names.split(",") if name}
    previews = chosen(arguments.folder, arguments.count, arguments.seed, names)
    settings = {"iterations": arguments.iterations, "photons": arguments.photons}
    if arguments.path_length:
        settings |= {"camera_path_length": arguments.path_length, "photon_path_length": arguments.path_length}
    if arguments.specular_roughness is not None:
        settings["specular_roughness"] = arguments.specular_roughness
    lines = []
    with Renderer() as renderer:
        for first in range(arguments.first, len(previews), COLUMNS * ROWS):
            group = previews[first : first + COLUMNS * ROWS]
            render(renderer, group, arguments.seeds, arguments.samples, arguments.alone, settings)
            sheet(group).save(arguments.out / f"sheet_{first // (COLUMNS * ROWS) + 1:02d}.png")
            before = len(lines)
            for preview in group:
                ratio = " ".join(f"{value:6.3f}" for value in preview.ratio)
                mean = f"{preview.mean:6.3f} +- {preview.error:.3f}"
                lines.append(f"{preview.name[:44]:44s} {mean}  {ratio}  {preview.difference:.3f}")
                lines += [f"    {text}" for text in preview.warnings]
            (arguments.out / "table.txt").write_text("\n".join(lines) + "\n")
            print("\n".join(lines[before:]), flush=True)


if __name__ == "__main__":
    main()
