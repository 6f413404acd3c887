# SPDX-License-Identifier: GPL-3.0-or-later
"""Estimators of light in volumes agree about how much there is."""

import numpy as np
import pytest

from benchmarks.volumes.estimators import Method, VolumeEstimator
from benchmarks.volumes.run import squared_bias
from benchmarks.volumes.scenes import SCENES, compared_pixels
from rppm_addon.gl.context.context import Context

KERNELS = [
    Method("light tracing", 16384),
    Method("ball", 4096, 0.1),
    Method("disk", 4096, 0.05),
    Method("disk", 4096, 0.05, shadow_rays=False),
    Method("short beam", 1024, 0.05),
    Method("short beam", 1024, 0.05, shadow_rays=False),
    Method("long beam", 1024, 0.05, shadow_rays=False),
]


@pytest.fixture(scope="module")
def context():
    opened = Context.create()
    yield opened
    opened.release()


def level(context, scene, method: Method, iterations: int) -> float:
    estimator = VolumeEstimator(context, scene, method)
    for _ in range(iterations):
        estimator.iterate()
    found = float(estimator.picture()[compared_pixels(scene)].mean())
    estimator.release()
    return found


@pytest.mark.parametrize("scene", [SCENES[0], SCENES[2]], ids=lambda scene: scene.name)
def test_estimators_agree(context, scene):
    paths = level(context, scene, Method("path"), 16)
    for method in KERNELS:
        if not (scene.is_cloud and method.kind == "long beam"):
            found = level(context, scene, method, 16)
            assert found == pytest.approx(paths, rel=0.05), method  # balls reach out of the box


def test_bias_is_told_from_noise():
    generator = np.random.default_rng(3)
    reference, factors = np.ones((240, 320)), np.ones((240, 320))
    noise = generator.normal(0.0, 0.5, (2, 240, 320))
    assert squared_bias(reference + noise, reference, factors) == pytest.approx(0.0, abs=5e-3)
    assert squared_bias(reference + 0.2 + noise, reference, factors) == pytest.approx(0.04, abs=5e-3)
