# SPDX-License-Identifier: GPL-3.0-or-later
"""The benchmark's quick mode on the smallest scene, as a program of its own."""

import importlib.util
import inspect
import json
import subprocess
import sys

import numpy as np
import pytest

from benchmarks import ROOT
from rppm_addon.integrator.deep_cubemap.deep_cubemap import DeepCubemap

pytestmark = pytest.mark.long

FIGURES = ["construction", "resolution", "rays", "placement"]
if "max_bins" in inspect.signature(DeepCubemap.__init__).parameters:
    FIGURES.append("bins")
ESTIMATOR = {"iterations", "path_lengths", "photon_batches", "resolutions", "splat_radius", "roulette", "final_gather"}
FIGURES += sorted(ESTIMATOR)
KINDS = {"camera", "diffuse bounce", "photon"}


def run(*arguments: object) -> subprocess.CompletedProcess:
    command = [sys.executable, "-m", "benchmarks.device.run", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300, cwd=ROOT)


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
    for figure in set(FIGURES) - {"construction"} - ESTIMATOR:
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


def test_stages_add_up_to_the_iterations(documents):
    stages = {"photon paths", "camera paths", "direct light", "direct splatting", "indirect splatting", "film", "other"}
    for figure in ESTIMATOR - {"roulette", "final_gather"}:
        (line,) = documents[figure]["scenes"]
        assert line["size"][0] * line["size"][1] == pytest.approx(2048, rel=0.05) and line["photons"] == 2048
        for point in line.get("blocks") or line["points"]:
            assert stages <= set(point["seconds"])
            total = sum(point["seconds"].values())
            assert 0 < total < 10 and all(seconds >= 0 for seconds in point["seconds"].values())


def test_iterations_cover_the_render_while_radii_shrink(documents):
    (line,) = documents["iterations"]["scenes"]
    blocks = line["blocks"]
    assert [block["first"] for block in blocks] == [1] + [block["last"] + 1 for block in blocks[:-1]]
    assert blocks[-1]["last"] == line["iterations"]
    radii = [block["radius"] for block in blocks]
    assert all(later < earlier for earlier, later in zip(radii, radii[1:]))


def test_path_lengths_reach_the_renderer(documents):
    (line,) = documents["path_lengths"]["scenes"]
    first, *others = line["points"]
    assert first["length"] == 1 and first["seconds"]["indirect splatting"] == 0  # there is no second segment
    assert all(point["length"] > 1 and point["seconds"]["photon paths"] > 0 for point in others)


@pytest.mark.parametrize(("figure", "key"), [("photon_batches", "photons"), ("resolutions", "pixels")])
def test_lines_go_through_the_points(documents, figure, key):
    (line,) = documents[figure]["scenes"]
    fit, x = line["line"], np.array([point[key] for point in line["points"]])
    seconds = np.array([sum(point["seconds"].values()) for point in line["points"]])
    error = np.abs(fit["base_seconds"] + fit["slope_seconds"] * x - seconds) / seconds
    assert error.max() == pytest.approx(fit["greatest_relative_error"], abs=1e-3)


def test_both_radii_follow_the_factor(documents):
    (line,) = documents["splat_radius"]["scenes"]
    for name in ("radius", "wide_radius"):
        scaled = [point[name] / point["factor"] for point in line["points"]]
        np.testing.assert_allclose(scaled, scaled[0], rtol=1e-3)


def test_roulette_has_times_and_variances(documents):
    (line,) = documents["roulette"]["scenes"]
    # No camera path goes on from the gray walls: where that is known, nothing is splatted there.
    assert line["seconds_without"]["direct splatting"] > 0 and line["seconds_with"]["direct splatting"] > 0
    assert line["relative_variance"] > 0 and line["iterations_at_equal_time"] >= 1
    ratio, error = line["variance_ratio"]["with"]
    assert ratio > 1 and error > 0  # roulette's own noise adds to it


def test_error_falls_with_and_without_final_gather(documents):
    (line,) = documents["final_gather"]["scenes"]
    plain, gather = (line["curves"][name] for name in ("plain", "gather"))
    assert plain[-1]["seconds"] >= gather[-1]["seconds"] and gather[-1]["iterations"] == 4
    for curve in (plain, gather):
        assert curve[0]["iterations"] == 1
        assert len(curve[0]["errors"]) == 3 and min(curve[-1]["errors"]) > 0
        assert curve[-1]["errors"][0] < curve[0]["errors"][0]  # that of pixels, of which there are many


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
