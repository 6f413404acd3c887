# SPDX-License-Identifier: GPL-3.0-or-later
"""RPPM beside its peers at equal wall time: make bench-peers, or python -m benchmarks.peers.run.

Scenes, references, pictures, results.json, peers.md and its plots go to out/peers/; --publish writes the page to
docs/benchmarks/ as well. Let nothing else run on the machine, or times mean nothing.
"""

import argparse
import os
import sys
import time

import numpy as np

from . import blend_files, plain
from .description import Scene
from .environments import OUT, ROOT, describe_busy_host, install, run_job
from .files import PeersError, SceneFiles
from .jobs import Answer, Job
from .methods import METHODS, Method, chosen
from .metrics import caustic_ratio, exposure_of, flip, mean_ratio, relative_mse
from .references import Reference, ReferenceStore
from .report import write_page
from .results import Curve, Point, Results, SceneResult
from .scenes import QUICK, SCENES, make_scene

PAGE = ROOT / "docs" / "benchmarks" / "peers.md"


def measure(scene: Scene, methods: list[Method], files: SceneFiles, store: ReferenceStore, results: Results) -> None:
    """Render the scene by all methods and add what was found to the results. Raises PeersError."""
    reference = store.get(scene)
    folder = OUT / "pictures" / scene.name
    folder.mkdir(parents=True, exist_ok=True)
    reference_file = folder / "reference.npy"
    np.save(reference_file, reference.pixels)
    exposure, counts = exposure_of(reference.pixels), scene.counts
    result = SceneResult(
        scene.name,
        scene.title,
        counts.triangles,
        counts.lights,
        reference.agreement,
        exposure,
        os.path.relpath(reference_file, ROOT),
    )
    results.scenes.append(result)
    for method in methods:
        if scene.name in method.leaves_out:
            continue
        start = time.monotonic()
        source = files.of(method.adapter, scene.name)
        place = str(folder / method.name)
        job = Job(scene.name, place, source, method.options, results.seconds, [], results.resolution)
        curve = curve_of(method, run_job(method.adapter, job), reference, exposure)
        result.curves.append(curve)
        found = ", ".join(f"{point.seconds:.1f} s: {point.relative_mse:.2g}" for point in curve.points)
        elapsed = time.monotonic() - start
        print(f"{scene.name:12} {method.label:26} {found or curve.error} ({elapsed:.0f} s)", flush=True)


def curve_of(method: Method, answer: Answer, reference: Reference, exposure: float) -> Curve:
    """An adapter's pictures compared with the reference."""
    points = []
    for picture in answer.pictures:
        pixels, true = picture.load(), reference.pixels
        caustic = None
        if reference.without_caustics is not None:
            caustic = caustic_ratio(pixels, true, reference.without_caustics)
        points.append(
            Point(
                picture.mark,
                picture.seconds,
                picture.samples,
                relative_mse(pixels, true),
                flip(pixels, true, exposure),
                mean_ratio(pixels, true),
                caustic,
                os.path.relpath(picture.file, ROOT),
            )
        )
    return Curve(
        method.name,
        method.label,
        answer.version,
        answer.first_picture_seconds,
        answer.peak_bytes,
        points,
        answer.error,
    )


def parse() -> argparse.Namespace:
    """The command line; --quick changes what is not given."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="three scenes, 2 and 5 s, cheap references")
    parser.add_argument("--plain", action="store_true", help="plain scenes by sample; --plain --help tells its options")
    parser.add_argument("--files", action="store_true", help=".blend files; --files --help tells its options")
    parser.add_argument("--scenes", nargs="*", choices=tuple(SCENES), metavar="SCENE", help=", ".join(SCENES))
    parser.add_argument("--methods", nargs="*", choices=tuple(METHODS), metavar="METHOD", help=", ".join(METHODS))
    parser.add_argument("--seconds", type=lambda text: sorted(float(part) for part in text.split(",")))
    parser.add_argument("--reference-seconds", type=float, help="for each of the two methods of a reference, at least")
    parser.add_argument("--resolution", type=int, default=256)
    parser.add_argument("--publish", action="store_true", help=f"write {PAGE.relative_to(ROOT)} too")
    parser.add_argument("--page", action="store_true", help="only write the page of out/peers/results.json anew")
    options = parser.parse_args()
    options.scenes = options.scenes or (QUICK if options.quick else tuple(SCENES))
    options.seconds = options.seconds or ([2.0, 5.0] if options.quick else [2.0, 5.0, 10.0, 30.0, 60.0])
    if options.reference_seconds is None:
        options.reference_seconds = 40.0 if options.quick else 600.0
    return options


def write_pages(results: Results, publish: bool) -> None:
    """Write out/peers/peers.md, and the page of docs/."""
    write_page(results, OUT / "peers.md", OUT / "images")
    if publish:
        write_page(results, PAGE, PAGE.parent / "peers")
        results.write(PAGE.parent / "peers" / "results.json")


def main() -> int:
    if "--plain" in sys.argv[1:]:
        return plain.main([argument for argument in sys.argv[1:] if argument != "--plain"])
    if "--files" in sys.argv[1:]:
        return blend_files.main([argument for argument in sys.argv[1:] if argument != "--files"])
    options = parse()
    if options.page:
        write_pages(Results.read(OUT / "results.json"), options.publish)
        return 0
    methods = chosen(options.methods)
    for adapter in dict.fromkeys(method.adapter for method in methods):
        problem = install(adapter)
        if problem:
            print(f"{adapter} is left out: {problem}", flush=True)
            methods = [method for method in methods if method.adapter != adapter]
    files = SceneFiles(options.resolution)
    store = ReferenceStore(files, options.resolution, options.reference_seconds)
    results = Results(describe_busy_host(), options.seconds, options.resolution)
    for name in options.scenes:
        try:
            measure(make_scene(name), methods, files, store, results)
        except PeersError as error:
            print(f"{name} is left out: {error}", flush=True)
        results.write(OUT / "results.json")
    if results.scenes:
        write_pages(results, options.publish)
        print(f"{(OUT / 'peers.md').relative_to(ROOT)}")
    return 0 if results.scenes else 1


if __name__ == "__main__":
    sys.exit(main())
