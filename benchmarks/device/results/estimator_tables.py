# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of the estimator's figures."""

from .formats import milliseconds, number, table


def _iterations(document: dict) -> str:
    lines = []
    for scene in document["scenes"]:
        blocks = scene["blocks"]
        first, last = blocks[0], blocks[-1]
        counts = [block["last"] - block["first"] + 1 for block in blocks]
        lines.append(
            [
                *_what_ran(scene),
                f"{scene['iterations']}",
                *_totals([first["seconds"], last["seconds"]]),
                *(
                    milliseconds(
                        sum(block["seconds"][stage] * count for block, count in zip(blocks, counts)) / sum(counts)
                    )
                    for stage in first["seconds"]
                ),
            ]
        )
    return "Milliseconds of an iteration: mean of the first and last block, and means of all by stage.\n\n" + table(
        [*_WHAT_RAN, "iterations", "first", "last", *_stages(document)], lines
    )


def _path_lengths(document: dict) -> str:
    lines = [
        [
            *_what_ran(scene)[:2], str(scene["photons"]), f"{point['length']}+{point['length']}",
            *_totals([point["seconds"]]), *map(milliseconds, point["seconds"].values()),
        ]
        for scene in document["scenes"]
        for point in scene["points"]
    ]  # fmt: skip
    return f"{_mean_of(document)}, milliseconds, by photon + camera path lengths.\n\n" + table(
        ["scene", "frame", "photons", "lengths", "all", *_stages(document)], lines
    )


def _sweep(document: dict, key: str, unit: str) -> str:
    """Iteration times by photons or pixels, and the straight line through them."""
    lines = []
    for scene in document["scenes"]:
        line, points = scene["line"], scene["points"]
        lines.append(
            [
                *_what_ran(scene), f"{points[0][key]:,} to {points[-1][key]:,}",
                *_totals([points[0]["seconds"], points[-1]["seconds"]]), milliseconds(line["base_seconds"]),
                number(1e9 * line["slope_seconds"]), f"{line['greatest_relative_error']:.0%}",
            ]
        )  # fmt: skip
    return f"{_mean_of(document)}, milliseconds; base + slope x {key} is the line of least relative error.\n\n" + table(
        [*_WHAT_RAN, key, "least", "most", "base", f"slope, ns per {unit}", "farthest from the line"], lines
    )


def _photon_batches(document: dict) -> str:
    return _sweep(document, "photons", "photon")


def _resolutions(document: dict) -> str:
    return _sweep(document, "pixels", "pixel")


def _splat_radius(document: dict) -> str:
    lines = [
        [
            *_what_ran(scene), f"{point['factor']:g}", f"{number(1e3 * point['radius'])} / "
            f"{number(1e3 * point['wide_radius'])}", milliseconds(point["seconds"]["direct splatting"]),
            milliseconds(point["seconds"]["indirect splatting"]), *_totals([point["seconds"]]),
        ]
        for scene in document["scenes"]
        for point in scene["points"]
    ]  # fmt: skip
    return f"{_mean_of(document)}, milliseconds.\n\n" + table(
        [*_WHAT_RAN, "radius / r_max", "radius / wide, mm", "direct splatting", "indirect splatting", "all"], lines
    )


def _roulette(document: dict) -> str:
    lines = []
    for scene in document["scenes"]:
        without, rejecting = scene["seconds_without"], scene["seconds_with"]
        line = [*_what_ran(scene)]
        for stage in ("direct splatting", "indirect splatting"):
            change = f"{rejecting[stage] / without[stage] - 1:+.0%}" if without[stage] else "-"
            line += [milliseconds(without[stage]), milliseconds(rejecting[stage]), change]
        line += [f"{number(scene['relative_variance'])}", str(scene["iterations"])]
        line += [" ± ".join(map(number, scene["variance_ratio"]["with"])), str(scene["iterations_at_equal_time"])]
        lines.append([*line, " ± ".join(map(number, scene["variance_ratio"]["equal time"]))])
    return (
        "Milliseconds of an iteration without and with roulette; relative variance of the picture without it after "
        f"so many iterations (of {document['scenes'][0]['seeds']} independent renders), and how many times that it is "
        "with roulette, after as many iterations and after as much time (± standard error).\n\n"
        + table(
            [
                *_WHAT_RAN,
                "direct: without",
                "with",
                "change",
                "indirect: without",
                "with",
                "change",
                "relative variance",
                "iterations",
                "variance with / without",
                "iterations at equal time",
                "variance with / without",
            ],
            lines,
        )  # fmt: skip
    )


def _final_gather(document: dict) -> str:
    lines = []
    for scene in document["scenes"]:
        plain, gather = (scene["curves"][name][-1] for name in ("plain", "gather"))
        line = [*_what_ran(scene), f"{gather['seconds']:.1f}", f"{plain['iterations']} / {gather['iterations']}"]
        for without, with_gather in zip(plain["errors"], gather["errors"]):
            line += [f"{without:.1%} / {with_gather:.1%}", number(with_gather / without)]
        lines.append(line)
    sides = document["scenes"][0]["blocks"]
    columns = [cell for side in sides for cell in ("pixels" if side == 1 else f"{side} x {side} pixels", "ratio")]
    return (
        "Median relative error of pixels and of blocks of pixels after as many seconds, plain / with final gather, and "
        "how many times that of the plain estimate it is.\n\n"
        + table([*_WHAT_RAN, "seconds", "iterations", *columns], lines)
    )


_WHAT_RAN = ["scene", "frame", "photons", "lengths"]


def _what_ran(scene: dict) -> list[str]:
    """Cells under _WHAT_RAN; lengths are those of photon and camera paths."""
    lengths = f"{scene['photon_path_length']}+{scene['camera_path_length']}"
    return [scene["scene"], "{} x {}".format(*scene["size"]), str(scene["photons"]), lengths]


def _mean_of(document: dict) -> str:
    return f"Mean of {document['scenes'][0]['repetitions']} iterations after one that is not counted"


def _stages(document: dict) -> list[str]:
    scene = document["scenes"][0]
    return list((scene.get("blocks") or scene["points"])[0]["seconds"])


def _totals(iterations: list[dict[str, float]]) -> list[str]:
    return [milliseconds(sum(seconds.values())) for seconds in iterations]


WRITERS = {
    "iterations": _iterations,
    "path_lengths": _path_lengths,
    "photon_batches": _photon_batches,
    "resolutions": _resolutions,
    "splat_radius": _splat_radius,
    "roulette": _roulette,
    "final_gather": _final_gather,
}
