# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of all machines' figures, written between two marks of a README.md."""

import json
from pathlib import Path

from . import estimator_tables
from .formats import geometric_mean, mebibytes, milliseconds, number, table

BEGIN, END = "<!-- tables: begin (written by benchmarks/device/run.py) -->", "<!-- tables: end -->"
_TITLES = {
    "construction": "Construction",
    "resolution": "Resolution",
    "bins": "Depth bins",
    "rays": "Rays",
    "placement": "Placement",
    "iterations": "Iterations",
    "path_lengths": "Path lengths",
    "photon_batches": "Photons of an iteration",
    "resolutions": "Frame sizes",
    "splat_radius": "Splat radius",
    "roulette": "Splat roulette",
    "final_gather": "Final gather",
}


def write_tables(folder: Path) -> None:
    """Renew the tables in ``folder``/README.md from the JSON files below; makes the file if need be."""
    path = folder / "README.md"
    text = path.read_text(encoding="utf-8") if path.exists() else f"# Benchmarks\n\n{BEGIN}\n{END}\n"
    before, begin, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise ValueError(f"{path} lacks the lines {BEGIN} and {END}, between which the tables go")
    documents = [(file, json.loads(file.read_text(encoding="utf-8"))) for file in sorted(folder.glob("*/*.json"))]
    path.write_text(f"{before}{BEGIN}\n\n{_tables(documents)}\n{END}{after}", encoding="utf-8")


def _tables(documents: list[tuple[Path, dict]]) -> str:
    parts = [_machines(documents)] if documents else ["Nothing has been measured yet."]
    for figure, title in _TITLES.items():
        for file, document in documents:
            if document["figure"] != figure:
                continue
            image = file.with_suffix(".png")
            parts.append(f"### {title}: {document['machine']['device']}")
            if image.exists():
                parts.append(f"![{title}]({image.parent.name}/{image.name})")
            parts.append(_WRITERS[figure](document))
    return "\n\n".join(parts) + "\n"


def _machines(documents: list[tuple[Path, dict]]) -> str:
    lines = []
    for file, document in documents:
        machine = document["machine"]
        quick = ", quick" if document["quick"] else ""
        line = [
            file.parent.name, machine["device"], machine["driver"], f"{machine['processor']}, {machine['cores']} cores",
            machine["clock"], f"{document['figure']}{quick}: {machine['commit']}, {machine['date']}",
        ]  # fmt: skip
        if lines and lines[-1][:5] == line[:5]:
            lines[-1][5] += f"<br>{line[5]}"
        else:
            lines.append(line)
    return table(["folder", "device", "driver", "processor", "clock", "measured"], lines)


def _construction(document: dict) -> str:
    lines = []
    for scene in document["scenes"]:
        raster, compute = scene["routes"]["rasterization"], scene["routes"]["compute"]
        boxes = scene["hierarchies"]
        line = [scene["scene"], f"{scene['triangles']:,}", str(raster.get("finest", "-"))]
        for route in (raster, compute):
            line += [milliseconds(route.get("first_seconds")), milliseconds(route.get("rebuild_seconds"))]
        for name in ("SAH", "Embree"):
            line.append(milliseconds(boxes[name]["seconds"]) if name in boxes else "-")
            factor = scene["times_the_rebuild"].get(name)
            line.append("-" if factor is None else f"{number(factor)} x")
        line += [
            *(
                number(raster[key]) if key in raster else "-"
                for key in ("fragments_per_triangle", "entries_per_triangle")
            ),
            number(mebibytes(raster["memory_bytes"])) if "memory_bytes" in raster else "-",
        ]
        lines.append(line)
    threads = {name: values["threads"] for scene in document["scenes"] for name, values in scene["hierarchies"].items()}
    note = ", ".join(f"{name} on {count} thread{'s' * (count > 1)}" for name, count in threads.items())
    return (
        "Finest cells: along a face's side. Fragments: triangles in cells; entries: triangles in depth bins of cells. "
        f"Milliseconds; hierarchies of boxes are built by {note}; x: how many times the rebuild by rasterization.\n\n"
        + table(
            [
                "scene",
                "triangles",
                "finest cells",
                "rasterization, first",
                "rebuild",
                "compute, first",
                "rebuild",
                "SAH boxes",
                "",
                "Embree boxes",
                "",
                "fragments per triangle",
                "entries per triangle",
                "memory, MiB",
            ],
            lines,
        )  # fmt: skip
    )


def _nanoseconds(point: dict, rays: dict[str, int]) -> str:
    if "failure" in point:
        return "-"
    return " / ".join(number(1e9 * seconds / rays[kind]) for kind, seconds in point["trace_seconds"].items())


def _differences(points: list[dict]) -> int:
    return sum(sum(point["differences"].values()) for point in points if "differences" in point)


def _sweep(document: dict, key: str, head: str) -> str:
    """A line a point; the knob's value None or 0 is the cubemap's own choice."""
    lines = []
    for scene in document["scenes"]:
        for point in scene["points"]:
            good = "failure" not in point
            lines.append(
                [
                    scene["scene"],
                    f"{scene['triangles']:,}",
                    str(point[key] or "automatic"),
                    str(point["finest"]) if good else "-",
                    number(mebibytes(point["memory_bytes"])) if good else "does not fit",
                    milliseconds(point.get("rebuild_seconds")),
                    _nanoseconds(point, scene["rays"]),
                ]
            )
    wrong = _differences([point for scene in document["scenes"] for point in scene["points"]])
    return f"Hits that differ from the hierarchy of boxes: {wrong}.\n\n" + table(
        ["scene", "triangles", head, "finest cells", "memory, MiB", "rebuild, ms",
         "ns per ray: camera / diffuse / photon"],
        lines,
    )  # fmt: skip


def _resolution(document: dict) -> str:
    return _sweep(document, "resolution", "most cells a side")


def _bins(document: dict) -> str:
    return _sweep(document, "max_bins", "most bins")


def _rays(document: dict) -> str:
    lines, ratios, wrong = [], {}, 0
    for scene in document["scenes"]:
        line = [scene["scene"], f"{scene['triangles']:,}"]
        for kind, values in scene["kinds"].items():
            ratios.setdefault(kind, []).append((values["ratio"], scene["scene"]))
            wrong += values["differences"]
            line += [
                number(values["cubemap_rays_per_second"] / 1e6), number(values["boxes_rays_per_second"] / 1e6),
                number(values["ratio"]),
            ]  # fmt: skip
        lines.append(line)
    heads = ["scene", "triangles"]
    for kind in ratios:
        heads += [f"{kind}: cubemap", "boxes", "ratio"]
    every = [ratio for kind in ratios.values() for ratio in kind]
    summary = [
        [kind, number(geometric_mean([ratio for ratio, _ in values])), f"{number(min(values)[0])} ({min(values)[1]})"]
        for kind, values in [*ratios.items(), ("all", every)]
    ]
    return (
        f"Mray/s; ratio: cubemap over boxes, more is better. Hits that differ: {wrong}.\n\n"
        + table(["ratio", "geometric mean", "worst"], summary)
        + "\n\n"
        + table(heads, [line + ["-"] * (len(heads) - len(line)) for line in lines])
    )


def _placement(document: dict) -> str:
    lines = []
    for scene in document["scenes"]:
        by_place: dict[str, list[float]] = {}
        for point in scene["places"]:
            by_place.setdefault(point["place"], []).append(geometric_mean(list(point["relative"].values())))
        cells = [scene["scene"], f"{scene['triangles']:,}"]
        for place in ("camera", "middle", "emitter", "inside", "outside"):
            found = by_place.get(place)
            if not found:
                cells.append("-")
            elif len(found) == 1:
                cells.append(number(found[0]))
            else:
                cells.append(f"{number(min(found))} / {number(geometric_mean(found))} / {number(max(found))}")
        lines.append(cells)
    wrong = _differences([point for scene in document["scenes"] for point in scene["places"]])
    return (
        "Trace time relative to the automatic place (least / geometric mean / greatest over the places; geometric "
        f"mean over the kinds of rays); below 1 the automatic place is the slower. Hits that differ: {wrong}.\n\n"
        + table(["scene", "triangles", "camera", "middle", "on an emitter", "inside", "outside"], lines)
    )


_WRITERS = {
    "construction": _construction,
    "resolution": _resolution,
    "bins": _bins,
    "rays": _rays,
    "placement": _placement,
    **estimator_tables.WRITERS,
}
