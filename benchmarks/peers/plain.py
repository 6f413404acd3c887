# SPDX-License-Identifier: GPL-3.0-or-later
"""Plain scenes, error per sample: RPPM's iterations against Cycles' samples, in a gray world and in a black one.

    make bench-peers BENCH='--plain --samples 8,32 --scenes plane boxes --reference-samples 1024'

The reference is a long run of Cycles with another seed, kept in out/peers/plain/. Prints a table and writes
out/peers/plain.json. The number of samples does not depend on what else the machine does.
"""

import argparse
import json
import sys

from .description import Scene
from .environments import OUT, run_job
from .files import SceneFiles
from .jobs import Answer, Job
from .metrics import convergence_rate, mean_ratio, relative_mse
from .scenes import plain_scenes

_REFERENCE_SEED = 1234


class PlainComparison:
    """Renders the plain scenes and measures errors."""

    def __init__(self, resolution: int, samples: list[int], reference_samples: int) -> None:
        self._resolution = resolution
        self._samples = samples
        self._reference_samples = reference_samples
        self._files = SceneFiles(resolution, OUT / "plain" / str(resolution))

    def row(self, scene: Scene) -> dict[str, object]:
        """Errors of both renderers, and how RPPM's mean compares."""
        reference = self._reference(scene)
        row: dict[str, object] = {"scene": scene.name, "title": scene.title, "world": scene.world}
        for adapter in ("rppm", "cycles"):
            answer = self._render(scene, adapter, adapter, self._samples, seed=1)
            if answer.error:
                row[adapter] = {"error": answer.error}
                continue
            errors = [relative_mse(picture.load(), reference) for picture in answer.pictures]
            row[adapter] = {
                "samples": [picture.mark for picture in answer.pictures],
                "relative_mse": errors,
                "mean_ratio": mean_ratio(answer.pictures[-1].load(), reference),
                "rate": convergence_rate(self._samples, errors),
            }
        return row

    def _reference(self, scene: Scene):
        name = f"reference_{scene.fingerprint}_{self._reference_samples}"
        path = OUT / "plain" / str(self._resolution) / name / "answer.json"
        if not path.exists():
            answer = self._render(scene, "cycles", name, [self._reference_samples], _REFERENCE_SEED)
            if answer.error:
                raise SystemExit(f"no reference of {scene.name}: {answer.error}")
        return Answer.read(path).pictures[-1].load()

    def _render(self, scene: Scene, adapter: str, place: str, samples: list[int], seed: int) -> Answer:
        folder = OUT / "plain" / str(self._resolution)
        folder = folder / place if place.startswith("reference") else folder / scene.name / place
        source = self._files.of(adapter, scene.name)
        job = Job(scene.name, str(folder), source, samples=samples, resolution=self._resolution, seed=seed)
        return run_job(adapter, job)


def table(rows: list[dict[str, object]]) -> str:
    """Markdown: error of both after each number of samples, and their ratio."""
    lines = ["| scene | world | samples | RPPM | Cycles | RPPM / Cycles | mean RPPM | mean Cycles |"]
    lines.append("|---|---|---|---|---|---|---|---|")
    for row in rows:
        ours, theirs = row["rppm"], row["cycles"]
        problem = ours.get("error") or theirs.get("error")
        if problem:
            lines.append(f"| {row['title']} | {row['world']:g} | | {problem} | | | | |")
            continue
        for samples, error, peer in zip(ours["samples"], ours["relative_mse"], theirs["relative_mse"]):
            lines.append(
                f"| {row['title']} | {row['world']:g} | {samples:g} | {error:.5f} | {peer:.5f} | {error / peer:.2f} | "
                f"{ours['mean_ratio']:.4f} | {theirs['mean_ratio']:.4f} |"
            )
    return "\n".join(lines)


def main(arguments: list[str] | None = None) -> int:
    """The program; without arguments those of the command line. Returns the exit status."""
    parser = argparse.ArgumentParser("bench-peers --plain", description=__doc__.splitlines()[0])
    parser.add_argument("--samples", type=lambda text: [int(part) for part in text.split(",")], default=[8])
    parser.add_argument("--scenes", nargs="*", help="plane, checkers, boxes, suns, spot; all without")
    parser.add_argument("--world", choices=("gray", "black"), help="only scenes in this world")
    parser.add_argument("--reference-samples", type=int, default=1024)
    parser.add_argument("--resolution", type=int, default=256)
    options = parser.parse_args(arguments)
    comparison = PlainComparison(options.resolution, options.samples, options.reference_samples)
    rows = []
    for name, scene in plain_scenes().items():
        _, kind, world = name.split("_")
        if (not options.scenes or kind in options.scenes) and options.world in (None, world):
            rows.append(comparison.row(scene))
            print(table(rows[-1:]).splitlines()[-1], file=sys.stderr, flush=True)
    (OUT / "plain.json").write_text(json.dumps(rows, indent=2), encoding="utf-8")
    print(table(rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
