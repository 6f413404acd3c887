# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of make bench-peers that need no other renderer: scenes, metrics, references' weights, the page."""

import dataclasses
import math

import numpy as np
import pytest

from benchmarks.peers import metrics
from benchmarks.peers.description import AreaLight, Counts, Diffuse, Glass, SphereLight, SunLight, frame_of
from benchmarks.peers.jobs import Job
from benchmarks.peers.methods import METHODS, OWN, REFERENCES
from benchmarks.peers.references import Agreement, combine
from benchmarks.peers.report import page_text
from benchmarks.peers.results import Curve, Point, Results, SceneResult
from benchmarks.peers.scenes import QUICK, SCENES, make_scene, plain_scenes
from benchmarks.peers.shapes import box, checkered_floor, sphere, washer, waves

ALL = [*SCENES, *plain_scenes()]


def gray(value, size=40):
    return np.full((size, size, 3), value, np.float32)


def test_relative_mse_of_an_even_difference():
    assert metrics.relative_mse(gray(0.6), gray(0.5)) == pytest.approx(0.01 / (0.25 + 0.01), rel=1e-5)


def test_blur_takes_gradients_and_noise_only_adds_energy():
    mask = np.ones((40, 40), bool)
    stripes = gray(0.5) + 0.2 * np.sin(np.arange(40) * 0.8)[None, :, None].astype(np.float32)
    assert metrics.gradients_kept(stripes, stripes, mask) == pytest.approx((1.0, 1.0))
    assert metrics.gradients_kept(0.5 + 0.6 * (stripes - 0.5), stripes, mask) == pytest.approx((0.6, 0.36), rel=1e-5)
    noise = np.random.default_rng(2).normal(0.0, 0.1, stripes.shape[:2])
    kept, energy = metrics.gradients_kept(stripes + noise[..., None], stripes, mask)
    # Of 3200 differences, each of noise 0.07, against stripes whose gradient is 0.1.
    assert kept == pytest.approx(1.0, abs=0.05) and energy > 1.3
    mask[:, 20:] = False
    half = np.where(mask[..., None], stripes, 0.5)
    assert metrics.gradients_kept(half, stripes, mask & (np.arange(40) < 18))[0] == pytest.approx(1.0)


def test_relative_mse_leaves_out_a_thousandth_of_the_pixels():
    picture = gray(0.5)  # 1600 pixels: round(1.6) = 2 are left out
    picture[0, :2] = 1000.0
    assert metrics.relative_mse(picture, gray(0.5)) == 0.0
    picture[1, 0] = 0.7
    assert metrics.relative_mse(picture, gray(0.5)) == pytest.approx(0.04 / 0.26 / 1598, rel=1e-5)


def test_relative_mse_counts_what_is_not_finite_as_black():
    picture = gray(0.5)
    picture[0, :3] = np.nan
    assert metrics.relative_mse(picture, gray(0.5)) == pytest.approx(0.25 / 0.26 / 1598, rel=1e-5)


def test_energies():
    without = gray(0.2)
    reference = without.copy()
    reference[10:20, 10:20] = 1.2
    half = without.copy()
    half[10:20, 10:20] = 0.7
    assert metrics.caustic_ratio(reference, reference, without) == pytest.approx(1.0)
    assert metrics.caustic_ratio(half, reference, without) == pytest.approx(0.5, rel=1e-5)
    assert metrics.caustic_ratio(without, reference, without) == pytest.approx(0.0, abs=1e-6)
    assert metrics.mean_ratio(gray(0.3), gray(0.2)) == pytest.approx(1.5, rel=1e-6)


def test_convergence_rate():
    counts = [2, 8, 64]
    assert metrics.convergence_rate(counts, [0.3 * count**-1.7 for count in counts]) == pytest.approx(1.7)
    assert math.isnan(metrics.convergence_rate([8], [0.1]))


def test_exposure_brings_the_median_to_a_quarter():
    exposure = metrics.exposure_of(gray(5.0))
    assert exposure == pytest.approx(0.05, rel=1e-5)
    assert metrics.displayed(gray(5.0), exposure).max() == pytest.approx(1.055 * 0.25 ** (1 / 2.4) - 0.055, rel=1e-5)


def test_references_are_weighted_by_the_inverse_of_their_noise():
    random = np.random.default_rng(5)
    true, deviations = gray(0.5, 64), (0.01, 0.03)

    def halves(deviation):
        return tuple(true + deviation * random.standard_normal(true.shape) for _ in range(2))

    pixels, agreement = combine({"a": halves(deviations[0]), "b": halves(deviations[1])}, 300.0)
    # Each mean of two has half the variance; 12288 values give it within a few percent.
    for noise, deviation in zip(agreement.noise, deviations):
        assert noise == pytest.approx(0.5 * deviation**2 / 0.26, rel=0.1)
    assert agreement.weights == pytest.approx([0.9, 0.1], abs=0.02)
    assert agreement.difference == pytest.approx(sum(agreement.noise), rel=0.1)
    assert agreement.mean_ratio == pytest.approx(1.0, abs=0.003)
    assert metrics.relative_mse(pixels, true) == pytest.approx(agreement.floor, rel=0.1)


def curve(method, label, errors, seconds):
    points = [Point(mark, at, 0.0, error, 0.1, 1.0, None, "") for mark, at, error in zip((2.0, 8.0), seconds, errors)]
    return Curve(method, label, "1.0", 0.5, 1 << 20, points)


def test_late_pictures_count_for_their_error_on_the_way():
    late = curve(OWN, "RPPM", (0.1, 0.025), (4.0, 16.0))
    assert late.at(2.0) is None
    assert late.at(3.9) == 0.1
    assert late.at(8.0) == pytest.approx(0.05)
    assert late.at(60.0) == 0.025


def results(own, peer):
    agreement = Agreement(["cycles", "mitsuba_path"], [1e-4, 1e-4], [0.5, 0.5], 2e-4, 1.001, 300.0)
    scene = SceneResult("interior", "Room", 12, 2, agreement, 1.0, "", [own, peer])
    machine = {"processor": "P", "cores": 2, "system": "S", "commit": "c", "date": "d", "load": 0.0}
    return Results(machine, [2.0, 8.0], 256, [scene])


def test_the_page_tells_losses_as_plainly_as_wins(tmp_path):
    found = results(curve(OWN, "RPPM", (0.4, 0.01), (2, 8)), curve("cycles", "Cycles", (0.1, 0.04), (2, 8)))
    text = page_text(found, "images", 8.0)
    assert "| Room | 4.00 (Cycles) | 0.25 (Cycles) |" in text
    assert "| RPPM | 0.4 | **0.01** |" in text
    assert "| Cycles | **0.1** | 0.04 |" in text
    assert "do not agree" not in text
    found.scenes[0].agreement.mean_ratio = 0.97
    assert "do not agree" in page_text(found, "images", 8.0)
    found.write(tmp_path / "results.json")
    assert Results.read(tmp_path / "results.json") == found


def test_the_page_tells_what_failed():
    failed = Curve("cycles", "Cycles", "", 0.0, 0, [], "it would not start")
    text = page_text(results(curve(OWN, "RPPM", (0.4, 0.01), (5, 8)), failed), "images", 8.0)
    assert "| Cycles | failed: it would not start |" in text
    assert "| Room | no picture yet | no peer |" in text


@pytest.mark.parametrize("name", ALL)
def test_scenes_are_sound(name):
    scene = make_scene(name)
    names = [thing.name for thing in (*scene.meshes, *scene.lights)]
    assert len(set(names)) == len(names)  # Blender's objects are found by them
    for mesh in scene.meshes:
        assert np.isfinite(mesh.vertices).all()
        assert mesh.triangles.min() >= 0 and mesh.triangles.max() < len(mesh.vertices)
        corners = mesh.vertices[mesh.triangles]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        assert (np.linalg.norm(normals, axis=1) > 0.0).all()
        if mesh.normals is not None:
            assert np.linalg.norm(mesh.normals, axis=1) == pytest.approx(1.0)
            facing = (normals[:, None] * mesh.normals[mesh.triangles]).sum(axis=-1)
            assert (facing > 0.0).all()
    assert scene.fingerprint == make_scene(name).fingerprint
    assert scene.fingerprint != dataclasses.replace(scene, world=9.0).fingerprint


def test_the_comparison_knows_all_scenes_and_methods():
    assert set(REFERENCES) == set(SCENES)
    assert set(QUICK) < set(SCENES)
    assert {name for pair in REFERENCES.values() for name in pair} <= set(METHODS)
    assert all(first != second for first, second in REFERENCES.values())
    assert make_scene("hall").counts.lights == 200
    assert make_scene("glass_box").counts == Counts(6, 10 + 2 * 96 * 47, 1)


def test_plain_scenes_differ_by_their_world_only():
    found = plain_scenes()
    for name, scene in found.items():
        if name.endswith("_gray"):
            twin = found[name.removesuffix("_gray") + "_black"]
            assert (scene.world, twin.world) == (0.05, 0.0)
            assert dataclasses.replace(scene, name=twin.name, world=0.0).fingerprint == twin.fingerprint


def test_closed_shapes_enclose_their_volume():
    def volume(mesh):
        a, b, c = np.moveaxis(mesh.vertices[mesh.triangles], 1, 0)
        return float((a * np.cross(b, c)).sum() / 6.0)

    assert volume(box("box", (0, 0, 0), (1, 2, 3), Diffuse(), 0.4)) == pytest.approx(6.0)
    assert volume(sphere("ball", (3, 2, 1), 0.5, Glass())) == pytest.approx(math.pi / 6.0, rel=0.01)


def test_open_shapes_look_up():
    for mesh in (*checkered_floor(1.0, 4, Diffuse(), Diffuse()), washer("ring", 1, 2, 0, Diffuse())):
        a, b, c = np.moveaxis(mesh.vertices[mesh.triangles], 1, 0)
        assert (np.cross(b - a, c - a)[:, 2] > 0.0).all()
    assert (waves("water", 1.0, 8, Glass()).normals[:, 2] > 0.5).all()


def test_lights_radiate_their_power():
    area = AreaLight("area", (1.0, 2.0, 3.0), (0.0, 0.6, -0.8), 0.5, 7.0)
    assert math.pi * area.size**2 * area.radiance == pytest.approx(7.0)
    a, b, c, _ = area.corners
    normal = np.cross(b - a, c - b)
    assert normal / np.linalg.norm(normal) == pytest.approx(area.direction)
    assert np.linalg.norm(normal) == pytest.approx(0.25)
    ball = SphereLight("ball", (0.0, 0.0, 0.0), 0.2, 7.0)
    assert math.pi * 4.0 * math.pi * ball.radius**2 * ball.radiance == pytest.approx(7.0)
    sun = SunLight("sun", (0.0, 0.0, -1.0), 3.0, 0.01)
    assert math.pi * 0.005**2 * sun.radiance == pytest.approx(3.0, rel=1e-4)


def test_frames_are_right_handed():
    for direction in ((0, 0, -1), (1, 0, 0), (0.3, -0.4, 0.2)):
        x, y, z = frame_of(direction)
        assert np.cross(x, y) == pytest.approx(z)
        assert z * np.linalg.norm(direction) == pytest.approx(np.array(direction, float))


def test_jobs_are_read_as_written(tmp_path):
    job = Job("pool", "folder", "file", {"denoise": True}, [2.0, 5.0], [], 128, 3, 12.5)
    job.write(tmp_path / "job.json")
    assert Job.read(tmp_path / "job.json") == job
