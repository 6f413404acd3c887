# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures estimators of light in volumes: the error of their pictures after equal time.

Prints Markdown tables. References are long runs, kept in out/benchmarks/volumes/.
"""

import argparse
import dataclasses
import sys

import numpy as np

from rppm_addon.gl.context.context import Context

from .. import ROOT
from ..machine import Clock, describe
from .estimators import Method, VolumeEstimator
from .scenes import HEIGHT, SCENES, WIDTH, VolumeScene, compared_pixels

WORST = 0.001
"""Fraction of the pixels, the worst ones, that errors leave out."""
BRIGHT = 0.02
"""Fraction of the pixels, the brightest ones, whose error is also reported alone: the caustic, where there is one."""
REFERENCE_SEED = 77
SWEEP = {
    "path": [(0, 0.0)],
    "light tracing": [(65536, 0.0), (16384, 0.0)],
    "ball": [(16384, 0.1), (16384, 0.2), (65536, 0.12), (65536, 0.06)],
    "disk": [(4096, 0.05), (16384, 0.08), (16384, 0.03), (65536, 0.03)],
    "short beam": [(1024, 0.05), (1024, 0.1), (4096, 0.03), (4096, 0.08)],
    "long beam": [(1024, 0.05), (1024, 0.1), (4096, 0.03), (4096, 0.08)],
}
"""Photon paths of an iteration and first radii, by kind of estimator; the first two also run without shadow rays."""
CLOUD_FRACTION = 0.25
"""Fraction of these paths in the cloud, where a path leaves many photons."""


def methods(scene: VolumeScene, kinds: list[str], single: bool) -> list[Method]:
    """The sweep, with single scattering by shadow rays, and where there is ``single`` once more by photons."""
    found = []
    for kind, parameters in SWEEP.items():
        if kind not in kinds or (kind == "long beam" and scene.is_cloud):
            continue
        if scene.is_cloud:
            parameters = [(int(paths * CLOUD_FRACTION), radius) for paths, radius in parameters]
        found += [Method(kind, *values) for values in parameters[: None if single else 2]]
        if single and kind not in ("path", "ball"):
            found += [Method(kind, *values, shadow_rays=False) for values in parameters[:2]]
    return found


def weights(scene: VolumeScene, reference: np.ndarray) -> np.ndarray:
    """(HEIGHT, WIDTH) factors of squared errors: 0 where a pixel is not compared.

    They take the reference's mean over 5 x 5 pixels, so that its noise does not weight itself.
    """
    pixels = compared_pixels(scene)
    floor = 0.01 * np.square(reference[pixels].mean())
    padded = np.pad(reference, 2, mode="edge")
    mean = np.lib.stride_tricks.sliding_window_view(padded, (5, 5)).mean((2, 3))
    return pixels / (np.square(mean) + floor)


def bright(reference: np.ndarray, factors: np.ndarray) -> np.ndarray:
    """The factors of the brightest pixels alone."""
    compared = factors > 0.0
    return factors * (reference > np.quantile(reference[compared], 1.0 - BRIGHT))


def relative_error(picture: np.ndarray, reference: np.ndarray, factors: np.ndarray) -> float:
    """Mean of squared relative errors without the worst pixels."""
    errors = (np.square(picture - reference) * factors)[factors > 0.0]
    return float(np.sort(errors)[: int(errors.size * (1.0 - WORST))].mean())


def squared_bias(halves: np.ndarray, reference: np.ndarray, factors: np.ndarray) -> float:
    """Mean of squared relative bias: the noise of both halves is independent, so its product has the mean 0."""
    even, odd = halves - reference
    return float((even * odd * factors)[factors > 0.0].mean())


def reference_error(halves: np.ndarray, factors: np.ndarray) -> float:
    """Mean of squared relative errors of the mean of two independent halves."""
    return float((np.square(halves[0] - halves[1]) * factors)[factors > 0.0].mean()) / 4.0


def make_reference(context: Context, clock: Clock, scene: VolumeScene, single: bool, seconds: float) -> np.ndarray:
    """(2, HEIGHT, WIDTH): halves of a long run of light tracing with shadow rays; of paths in the cloud."""
    part = "" if single else "_photons"
    kept = ROOT / f"out/benchmarks/volumes/{scene.name}_{scene.depth:g}{part}_{WIDTH}x{HEIGHT}_{seconds:g}s.npy"
    if not kept.exists():
        method = Method("path") if scene.is_cloud else Method("light tracing", 65536)
        estimator = VolumeEstimator(context, scene, method, REFERENCE_SEED, single)
        spent = 0.0
        while spent < seconds:
            spent += clock.once(lambda: [estimator.iterate() for _ in range(8)])
        kept.parent.mkdir(parents=True, exist_ok=True)
        np.save(kept, estimator.pictures())
        estimator.release()
    return np.load(kept)


def measure(context, clock, scene, method, single, seconds, references) -> dict[str, object]:
    """Errors after each of ``seconds``, and iterations, squared bias and fragments after the last.

    ``references`` are two halves, whose noise is subtracted: it is independent of the picture's.
    """
    reference = references.mean(0)
    factors = weights(scene, reference)
    brightest = bright(reference, factors)
    noise, bright_noise = (reference_error(references, part) for part in (factors, brightest))
    estimator = VolumeEstimator(context, scene, method, 1, single)
    estimator.iterate()  # compiles
    estimator.restart()
    spent, errors = 0.0, []
    for limit in seconds:
        while spent < limit:
            spent += clock.once(estimator.iterate)
        picture = estimator.picture()
        # Noise falls with time, so that a last iteration that ended late has a larger error on time.
        errors.append((relative_error(picture, reference, factors) - noise) * spent / limit)
    halves = estimator.pictures()
    result = {
        "method": method,
        "errors": errors,
        "bright": (relative_error(picture, reference, brightest) - bright_noise) * spent / limit,
        "iterations": estimator.iteration,
        "bias": squared_bias(halves, reference, factors) - noise,
        "bright_bias": squared_bias(halves, reference, brightest) - bright_noise,
        "per_pixel": estimator.fragments / estimator.iteration / (WIDTH * HEIGHT),
        "rate": estimator.fragments / spent,
    }
    estimator.release()
    return result


def name(result: dict[str, object], single: bool) -> str:
    method = result["method"]
    return method.name + (" + rays" if single and method.shadow_rays and method.kind != "path" else "")


def table(results: list[dict[str, object]], seconds: list[float], single: bool, best_only: bool) -> str:
    """Rows of methods, or of each kind's best ones; in brackets the ratio to the least error of a column."""
    least = np.min([result["errors"] for result in results], axis=0)
    if best_only:
        kinds: dict[tuple, dict] = {}
        for result in results:
            key = result["method"].kind, result["method"].shadow_rays
            if key not in kinds or result["errors"][-1] < kinds[key]["errors"][-1]:
                kinds[key] = result
        results = list(kinds.values())
    head = " | ".join(f"{limit:g} s" for limit in seconds)
    splatting = "fragments a pixel | Mfragments/s"
    lines = [f"| estimator | {head} | squared bias | brightest | squared bias | iterations | {splatting} |"]
    lines.append("|---|" + "---:|" * (len(seconds) + 6))
    for result in results:
        cells = [f"{error:.2e} ({error / low:.1f})" for error, low in zip(result["errors"], least, strict=True)]
        figures = [f"{result[key]:.1e}" for key in ("bias", "bright", "bright_bias")]
        splats = [f"{result['per_pixel']:.1f}", f"{result['rate'] / 1e6:.1f}"] if result["per_pixel"] else ["", ""]
        lines.append(
            "| " + " | ".join([name(result, single), *cells, *figures, str(result["iterations"]), *splats]) + " |"
        )
    return "\n".join(lines)


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", nargs="+", default=[scene.name for scene in SCENES])
    parser.add_argument("--kinds", nargs="+", default=list(SWEEP), choices=list(SWEEP))
    parser.add_argument("--seconds", type=float, nargs="+", default=[0.25, 1.0, 3.0])
    parser.add_argument("--reference-seconds", type=float, default=40.0)
    parser.add_argument("--densities", type=float, nargs="+", default=[1.0], help="factors of the extinction")
    parser.add_argument("--photon-light", action="store_true", help="leave out what shadow rays can carry")
    parser.add_argument("--best", action="store_true", help="print the best of each kind alone")
    options = parser.parse_args(arguments)
    context = Context.create()
    clock = Clock(context)
    machine = describe(context, clock)
    print(", ".join(str(machine[key]) for key in ("device", "driver", "processor", "commit", "date", "clock")), "\n")
    single = not options.photon_light
    for scene in (scene for scene in SCENES if scene.name in options.scenes):
        for factor in options.densities:
            denser = dataclasses.replace(scene, majorant=scene.majorant * factor)
            halves = make_reference(context, clock, denser, single, options.reference_seconds)
            noise = reference_error(halves, weights(denser, halves.mean(0)))
            print(f"{scene.name}, optical depth {denser.depth:g}; the reference's own error {noise:.1e}\n", flush=True)
            results = []
            for method in methods(denser, options.kinds, single):
                results.append(measure(context, clock, denser, method, single, options.seconds, halves))
                print(method.name, *(f"{e:.2e}" for e in results[-1]["errors"]), file=sys.stderr, flush=True)
            print(table(results, options.seconds, single, options.best), "\n", flush=True)
    context.release()
    return 0


if __name__ == "__main__":
    sys.exit(main())
