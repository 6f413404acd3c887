# SPDX-License-Identifier: GPL-3.0-or-later
"""Files by others, error at equal wall time: RPPM beside Cycles, both with and without denoising.

    make bench-peers BENCH='--files ../scenes/bmw27.blend ../scenes/wild/loft.blend --seconds 5,20 --publish'

Both renderers have the settings of make pairs. The reference is Cycles, whose two long runs with other seeds are kept
in out/peers/files/; so a file with caustics that Cycles does not resolve is none for this comparison. Pixels that show
coincident faces do not count, since Cycles leaves these black or speckled. Prints a table
and writes out/peers/files.json; --publish writes docs/benchmarks/plain_files.md. Let nothing else run on the machine.
"""

import argparse
import dataclasses
import json
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .environments import OUT, ROOT, describe_busy_host, run_job
from .files import PeersError, make_file
from .jobs import Answer, Job
from .methods import METHODS
from .metrics import exposure_of, flip, mean_ratio, relative_mse

PAGE = ROOT / "docs" / "benchmarks" / "plain_files.md"
COMPARED = ("rppm", "cycles", "rppm_denoised", "cycles_denoised")
_FOLDER = OUT / "files"
_REFERENCE_SEEDS = (1001, 1002)
_LIMIT = 900.0
"""Most seconds that staging or exporting a file may take."""


@dataclass
class Row:
    """One file by one method after one time."""

    file: str
    method: str
    mark: float
    """Seconds asked for."""
    relative_mse: float
    flip: float
    """LDR-FLIP against the reference."""
    mean_ratio: float
    """Mean radiance over the reference's."""
    samples: float
    """Samples per pixel, or iterations; 0 where the renderer does not tell."""
    first_picture_seconds: float
    """From the start of the process to a first picture, loading and compiling included."""
    reference_noise: float
    """Relative mean square error that the reference has by its noise."""
    left_out: float
    """Fraction of the pixels that do not count, as they show coincident faces."""


class FileComparison:
    """Renders .blend files by both renderers and measures errors."""

    def __init__(self, resolution: str, seconds: list[float], reference_samples: int) -> None:
        """resolution: such as 320x180; reference_samples: per pixel, in each of the reference's two runs."""
        self._resolution = resolution
        self._seconds = seconds
        self._reference_samples = reference_samples

    def rows(self, source: Path) -> list[Row]:
        """Results of a file. Raises PeersError."""
        folder = _FOLDER / f"{source.stem}_{self._resolution}"
        folder.mkdir(parents=True, exist_ok=True)
        staged, exported = folder / "staged.blend", folder / "staged.npz"
        staging = [sys.executable, "-m", "benchmarks.peers.adapters.staged", str(source.resolve()), str(staged)]
        make_file([*staging, self._resolution], staged, _LIMIT)
        make_file([sys.executable, "-m", "rppm_addon", "export", str(staged), "-o", str(exported)], exported, _LIMIT)
        files = {"cycles": staged, "rppm": exported}
        counted = self._counted_pixels(exported, folder / "counted.npy")
        reference, noise = self._reference(folder, staged, counted)
        exposure = exposure_of(reference)
        rows = []
        for name in COMPARED:
            method = METHODS[name]
            answer = self._render(folder / name, method.adapter, files[method.adapter], method.options, self._seconds)
            for picture in answer.pictures:
                pixels = picture.load()
                kept, true = pixels[counted], reference[counted]
                errors = relative_mse(kept, true), flip(pixels, reference, exposure, counted)
                told = mean_ratio(kept, true), picture.samples, answer.first_picture_seconds, noise
                rows.append(Row(source.stem, name, picture.mark, *errors, *told, 1.0 - counted.mean()))
        return rows

    def _counted_pixels(self, exported: Path, path: Path) -> np.ndarray:
        """(H, W) bool: False where a pixel, or one beside it, shows coincident faces."""
        make_file([sys.executable, "-m", "benchmarks.peers.adapters.counted", str(exported), str(path)], path, _LIMIT)
        return np.load(path)

    def _reference(self, folder: Path, source: Path, counted: np.ndarray) -> tuple[np.ndarray, float]:
        """The mean of two long runs, and the relative mean square error that it has by their noise."""
        halves = []
        for seed in _REFERENCE_SEEDS:
            place = folder / f"reference_{self._reference_samples}_{seed}"
            if (place / "answer.json").exists():
                halves.append(Answer.read(place / "answer.json").pictures[-1].load())
                continue
            answer = self._render(place, "cycles", source, {}, samples=[self._reference_samples], seed=seed)
            halves.append(answer.pictures[-1].load())
        return 0.5 * (halves[0] + halves[1]), 0.25 * relative_mse(halves[0][counted], halves[1][counted])

    def _render(
        self,
        folder: Path,
        adapter: str,
        source: Path,
        options: dict[str, object],
        seconds: Sequence[float] = (),
        samples: Sequence[int] = (),
        seed: int = 1,
    ) -> Answer:
        job = Job("", str(folder), str(source), options, list(seconds), list(samples), resolution=0, seed=seed)
        answer = run_job(adapter, job)
        if answer.error or not answer.pictures:
            raise PeersError(f"no picture of {source} by {adapter}: {answer.error}")
        return answer


def table(rows: list[Row]) -> str:
    """Markdown: errors of both renderers for each file and time, and RPPM's over Cycles'."""
    lines = [
        "| file | seconds | RPPM, relMSE | Cycles | ratio | denoised: RPPM, FLIP | Cycles | ratio "
        "| RPPM, relMSE | Cycles | mean | first picture, s | reference | left out |",
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|",
    ]
    found = {(row.file, row.mark, row.method): row for row in rows}
    for file, mark in dict.fromkeys((row.file, row.mark) for row in rows):
        ours, theirs, our_denoised, their_denoised = (found[file, mark, name] for name in COMPARED)
        lines.append(
            f"| {file} | {mark:g} | {ours.relative_mse:.2g} | {theirs.relative_mse:.2g} "
            f"| {ours.relative_mse / theirs.relative_mse:.2f} | {our_denoised.flip:.3f} | {their_denoised.flip:.3f} "
            f"| {our_denoised.flip / their_denoised.flip:.2f} | {our_denoised.relative_mse:.2g} "
            f"| {their_denoised.relative_mse:.2g} | {ours.mean_ratio:.4f} | {ours.first_picture_seconds:.1f}, "
            f"{theirs.first_picture_seconds:.1f} | {ours.reference_noise:.1g} | {ours.left_out:.1%} |"
        )
    return "\n".join(lines)


_ABOUT = """\
Files as people have them, most of them without a caustic, by RPPM on llvmpipe and by Cycles after the same wall time.
Written by `make bench-peers BENCH='--files ... --publish'`. The files are those of [files by
others](../real_files.md) and not part of RPPM."""
_HOW = """\
- Errors are measured as on [the page of the peers](peers.md#how-it-is-measured): the clock begins when the scene is
  there in the renderer's own form, building and denoising count, and compiling counts for the first picture.
- Both renderers have the settings of [make pairs](../real_files.md): twelve bounces, no clamp, no adaptive sampling.
  Denoised pictures are by Open Image Denoise with albedo and normal, which Cycles prefilters accurately.
- *ratio* is RPPM's value over Cycles'; below 1, RPPM is ahead. *mean* is RPPM's mean radiance over the reference's.
  *first picture* is measured from the start of the process, of RPPM and of Cycles.
- *reference* is the relMSE that the reference has by its noise: two long runs of Cycles.
- *left out* are pixels that show coincident faces, and those beside them. Cycles' rays that leave one of two such faces
  meet the other, so that its pictures are too dark there."""


def page_text(rows: list[Row], machine: dict[str, object], resolution: str) -> str:
    """The page as Markdown."""
    parts = [
        # REUSE-IgnoreStart
        "<!-- SPDX-License-Identifier: GPL-3.0-or-later -->",
        # REUSE-IgnoreEnd
        "# Files by others at equal time",
        _ABOUT,
        f"{machine['processor']}, {machine['cores']} cores; commit {machine['commit']}, {machine['date']}; load of "
        f"other programs before the run {machine['load']:.2f}. {resolution} pixels.",
        table(rows),
        _HOW,
    ]
    return "\n\n".join(parts) + "\n"


def main(arguments: list[str] | None = None) -> int:
    """The program; without arguments those of the command line. Returns the exit status."""
    parser = argparse.ArgumentParser("bench-peers --files", description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="+", type=Path, help=".blend files")
    parser.add_argument("--seconds", type=lambda text: sorted(float(part) for part in text.split(",")), default=[5, 20])
    parser.add_argument("--reference-samples", type=int, default=1024, help="of each of a reference's two runs")
    parser.add_argument("--resolution", default="320x180")
    parser.add_argument("--publish", action="store_true", help=f"write {PAGE.relative_to(ROOT)}")
    options = parser.parse_args(arguments)
    comparison = FileComparison(options.resolution, options.seconds, options.reference_samples)
    machine, rows = describe_busy_host(), []
    for file in options.files:
        try:
            rows += comparison.rows(file)
        except PeersError as error:
            print(f"{file.stem} is left out: {error}", file=sys.stderr, flush=True)
            continue
        (OUT / "files.json").write_text(json.dumps([dataclasses.asdict(row) for row in rows], indent=1))
    print(table(rows))
    if options.publish and rows:
        PAGE.write_text(page_text(rows, machine, options.resolution), encoding="utf-8")
    return 0 if rows else 1


if __name__ == "__main__":
    sys.exit(main())
