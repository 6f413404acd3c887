# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark's quick mode on the smallest scene, as a program of its own."""

import importlib.util
import inspect
import json
import subprocess
import sys
from pathlib import Path

import pytest

from rppm_addon.integrator.deep_cubemap import DeepCubemap

RUN = Path(__file__).with_name("run.py")
FIGURES = ["construction", "resolution", "rays", "placement"]
if "most_bins" in inspect.signature(DeepCubemap.__init__).parameters:
    FIGURES.append("bins")
KINDS = {"camera", "diffuse bounce", "photon"}


def run(*arguments: object) -> subprocess.CompletedProcess:
    command = [sys.executable, str(RUN), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The folder with the figures of one device."""
    output = tmp_path_factory.mktemp("benchmarks")
    done = run("--quick", "--scenes", "room_1k", "--rays", 2048, "--output", output, "--commit", "a test")
    assert done.returncode == 0, done.stderr
    (found,) = (path for path in output.iterdir() if path.is_dir())
    return found


@pytest.fixture(scope="module")
def documents(folder):
    return {path.stem: json.loads(path.read_text()) for path in folder.glob("*.json")}


def numbers_below(value, key):
    """All numbers in a JSON value below any ``key``."""
    if isinstance(value, dict):
        for name, item in value.items():
            yield from numbers_below(item, None if name == key else key)
    elif isinstance(value, list):
        for item in value:
            yield from numbers_below(item, key)
    elif key is None and isinstance(value, int | float):
        yield value


def test_every_figure_names_machine_and_scene(documents):
    assert sorted(documents) == sorted(FIGURES)
    for figure, document in documents.items():
        assert document["figure"] == figure and document["quick"] is True
        machine = document["machine"]
        for name in ("device", "driver", "opengl", "processor", "system", "python", "moderngl", "numpy", "clock"):
            assert isinstance(machine[name], str) and machine[name], name
        assert machine["cores"] >= 1 and machine["commit"] == "a test" and "UTC" in machine["date"]
        (line,) = document["scenes"]
        assert (line["scene"], line["source"]) == ("room_1k", "made")
        assert 700 < line["triangles"] < 1100


def test_no_hit_differs(documents):
    for figure in set(FIGURES) - {"construction"}:
        differences = list(numbers_below(documents[figure], "differences"))
        assert len(differences) >= 3, figure
        assert not any(differences), figure


def test_construction_has_both_routes_and_boxes(documents):
    (line,) = documents["construction"]["scenes"]
    assert set(line["routes"]) == {"rasterization", "compute"}
    for route in line["routes"].values():
        assert 0 < route["rebuild_seconds"] < 10 and 0 < route["first_seconds"] < 10
        assert sum(route["memory_bytes"].values()) > 48 and route["entries_per_triangle"] > 1
    assert {"SAH", "Embree"} <= set(line["hierarchies"])
    for name, factor in line["times_the_rebuild"].items():
        expected = line["hierarchies"][name]["seconds"] / line["routes"]["rasterization"]["rebuild_seconds"]
        assert factor == pytest.approx(expected, rel=1e-3)


def test_resolution_has_the_automatic_choice(documents):
    (line,) = documents["resolution"]["scenes"]
    tried = [point["resolution"] for point in line["points"]]
    assert tried[0] == 0 and len(tried) >= 4
    for point in line["points"]:
        assert 0 < point["finest"] <= (point["resolution"] or 1 << 30)
        assert set(point["trace_seconds"]) == KINDS and min(point["trace_seconds"].values()) > 0


def test_rays_are_of_three_kinds(documents):
    (line,) = documents["rays"]["scenes"]
    assert set(line["kinds"]) == KINDS
    for kind in line["kinds"].values():
        assert 500 < kind["rays"] <= 2048 and kind["hit_share"] > 0.9  # the room is closed
        assert kind["ratio"] == pytest.approx(kind["cubemap_rays_per_second"] / kind["boxes_rays_per_second"], rel=1e-3)


def test_placement_tries_all_kinds_of_places(documents):
    (line,) = documents["placement"]["scenes"]
    assert {place["place"] for place in line["places"]} == {
        "automatic", "camera", "middle", "emitter", "inside", "outside",
    }  # fmt: skip
    assert line["places"][0]["place"] == "automatic" and set(line["places"][0]["relative"].values()) == {1.0}


def test_tables_and_plots_follow_the_json(folder, documents):
    tables = (folder.parent / "README.md").read_text()
    assert tables.count("room_1k") >= len(FIGURES)
    assert "a test" in tables and f"| {documents['rays']['scenes'][0]['triangles']} |" in tables
    if importlib.util.find_spec("matplotlib"):
        for figure in FIGURES:
            assert (folder / f"{figure}.png").stat().st_size > 5000
    assert run("--plot", "--output", folder.parent).returncode == 0
    assert (folder.parent / "README.md").read_text() == tables


def test_missing_scenes_are_left_out(tmp_path):
    done = run("--scenes", "pool", "--scene-folder", tmp_path, "--saved-scenes", tmp_path, "--output", tmp_path)
    assert done.returncode == 1
    assert "pool is left out" in done.stderr
    assert not list(tmp_path.glob("*/*.json"))
