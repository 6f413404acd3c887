# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of a comparison: tables, plots and contact sheet."""

from pathlib import Path

from .methods import METHODS, OWN
from .results import Curve, Results, SceneResult

_SHEET_SECONDS = 10.0


def write_page(results: Results, page: Path, images: Path) -> None:
    """Write the page, and its pictures into a folder beside or below it."""
    from .drawing import draw_curves, draw_sheet  # late: the bench extra

    images.mkdir(parents=True, exist_ok=True)
    for scene in results.scenes:
        draw_curves(scene, images / f"{scene.name}.png")
    mark = sheet_mark(results)
    draw_sheet(results, mark, images / "sheet.png")
    place = images.relative_to(page.parent).as_posix()
    page.write_text(page_text(results, place, mark), encoding="utf-8")


def sheet_mark(results: Results) -> float:
    """The time whose pictures are shown: 10 s, or the last before."""
    return max([mark for mark in results.seconds if mark <= _SHEET_SECONDS], default=min(results.seconds))


def page_text(results: Results, images: str, mark: float) -> str:
    """The page as Markdown; images: the folder of its pictures, relative to the page."""
    machine = results.machine
    parts = [
        # REUSE-IgnoreStart
        "<!-- SPDX-License-Identifier: GPL-3.0-or-later -->",
        # REUSE-IgnoreEnd
        "# RPPM beside its peers",
        "Written by `make bench-peers BENCH=--publish`; how it is measured stands at the end.",
        f"{machine['processor']}, {machine['cores']} cores, {machine['system']}; commit {machine['commit']}, "
        f"{machine['date']}; load of other programs before the run {machine['load']:.2f}. "
        f"{results.resolution} x {results.resolution} pixels.",
        "## RPPM's error over that of the best peer",
        "Below 1 RPPM is ahead, above 1 it is behind; in brackets the peer.",
        summary_table(results),
        f"![Each scene after {mark:g} s by each method]({images}/sheet.png)",
    ]
    for scene in results.scenes:
        parts += [f"## {scene.title}", scene_words(scene), scene_table(scene, results.seconds)]
        parts.append(f"![Error against seconds]({images}/{scene.name}.png)")
    parts += ["## How it is measured", _method_words(results)]
    return "\n\n".join(parts) + "\n"


def summary_table(results: Results) -> str:
    """A row a scene: RPPM's error over the best peer's after each time."""
    lines = _head(["scene", *(f"{mark:g} s" for mark in results.seconds)])
    for scene in results.scenes:
        own = next((curve for curve in scene.curves if curve.method == OWN), None)
        cells = [_against_best(scene, own, mark) for mark in results.seconds]
        lines.append(_row([scene.title, *cells]))
    return "\n".join(lines)


def _against_best(scene: SceneResult, own: Curve | None, mark: float) -> str:
    ours = own.at(mark) if own else None
    peers = [(curve.at(mark), curve.label) for curve in scene.curves if curve.method != OWN]
    peers = [(error, label) for error, label in peers if error is not None]
    if ours is None:
        return "no picture yet"
    if not peers:
        return "no peer"
    error, label = min(peers)
    return f"{_ratio(ours / max(error, 1e-12))} ({label})"


def _ratio(value: float) -> str:
    return f"{value:.2f}" if value < 10.0 else f"{value:.0f}"


def scene_words(scene: SceneResult) -> str:
    """Describe the scene and how good its reference is."""
    agreement = scene.agreement
    first, second = (METHODS[name].label for name in agreement.methods)
    words = (
        f"{scene.triangles} triangles, lights: {scene.lights}. Reference: {first} ({agreement.weights[0]:.0%}) and "
        f"{second} ({agreement.weights[1]:.0%}), {agreement.seconds:g} s each, whose means differ by "
        f"{abs(agreement.mean_ratio - 1.0):.2%} and whose pixels by {_error(agreement.difference)} where their noise "
        f"explains {_error(sum(agreement.noise))}. Errors near {_error(agreement.floor)} are the reference's own."
    )
    if abs(agreement.mean_ratio - 1.0) > 0.02:
        words += " **The two do not agree: take this scene's figures with care.**"
    return words


def scene_table(scene: SceneResult, marks: list[float]) -> str:
    """A row a method."""
    has_caustic = any(point.caustic_ratio is not None for curve in scene.curves for point in curve.points)
    energy = "caustic's energy" if has_caustic else "energy"
    head = ["method", *(f"relMSE, {mark:g} s" for mark in marks), "FLIP", energy, "first picture", "memory"]
    lines = _head(head)
    best = [min((e for c in scene.curves if (e := c.at(mark)) is not None), default=None) for mark in marks]
    for curve in scene.curves:
        if not curve.points:
            lines.append(_row([curve.label, f"failed: {curve.error}", *[""] * (len(head) - 2)]))
            continue
        cells = []
        for mark, least in zip(marks, best):
            error = curve.at(mark)
            text = "none yet" if error is None else _error(error)
            cells.append(f"**{text}**" if error is not None and error == least else text)
        last = curve.points[-1]
        ratio = last.mean_ratio if last.caustic_ratio is None else last.caustic_ratio
        start, memory = f"{curve.first_picture_seconds:.1f} s", f"{curve.peak_bytes / 2**20:.0f} MB"
        lines.append(_row([curve.label, *cells, f"{last.flip:.3f}", f"{ratio:.3f}", start, memory]))
    return "\n".join(lines)


def _method_words(results: Results) -> str:
    used = dict.fromkeys((curve.method, curve.version) for scene in results.scenes for curve in scene.curves)
    lines = [
        "- Methods take turns on one machine, each in a process of its own, with all cores. The clock runs from the "
        "scene in the renderer's own form to the picture in hand: building hierarchies, caches and denoising count; "
        "starting, compiling and a first rough render do not, but are the first picture's time, with what earlier "
        "runs left in caches on disk.",
        "- relMSE: mean of (picture - reference)^2 / (reference^2 + 0.01), the worst 0.1 % of the pixels left out. A "
        "picture that came late counts for its error on the way, interpolated in logarithms; a first one may be 15 % "
        "late. FLIP (LDR, 67 pixels per degree, all pictures of a scene at one exposure) and energy are those of the "
        "last time.",
        "- Energy: mean radiance over the reference's. Caustic's energy: what the picture has within the caustic's "
        "mask beyond a render without caustics, over what the reference has.",
        "- Memory: the most that the process held, Python and Blender included where the renderer lives in them.",
        "- References: two methods, each in two runs with seeds of their own whose difference tells "
        "the noise; weighted by its inverse.",
        "- All filter pixels by Blackman-Harris of 1.5 pixels or the Gauss curve nearest to it, and take paths of up "
        "to 16 segments (RPPM 8 + 8).",
    ]
    for name, version in used:
        method = METHODS[name]
        lines.append(f"- {method.label}: {version or 'not run'}; {method.why}.")
    return "\n".join(lines)


def _head(cells: list[str]) -> list[str]:
    return [_row(cells), "|---" * len(cells) + "|"]


def _row(cells: list[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _error(value: float) -> str:
    return f"{value:.2g}" if value >= 1e-4 else f"{value:.1e}"
