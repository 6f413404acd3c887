# SPDX-License-Identifier: GPL-3.0-or-later
"""Light below surfaces: what it keeps, where it comes out, and that nothing else is in its way."""

import numpy as np
import pytest
import scenes
from rendering import iterated, radiance_of

from rppm_addon.integrator.common.records.photon_paths import PhotonFlag
from rppm_addon.scene import Instance, Light, LightKind, Material, NodeGraph, Scene, World
from rppm_addon.scene.settings import DensityEstimation, DirectLight


def wax(color: tuple[float, float, float], radius: float, method: str = "RANDOM_WALK", **inputs: object) -> Material:
    graph = NodeGraph()
    graph.surface = graph.add(
        "subsurface_scattering", "bssrdf", options={"falloff": method}, color=color, scale=radius,
        radius=(1.0, 1.0, 1.0), **inputs,
    )  # fmt: skip
    return Material("wax", graph)


def ball(material: Material, **settings: object) -> Scene:
    """Return a scene of a ball of radius 1, before a camera that sees nothing else."""
    defaults = {"photons": 64, "filter_width": 0.0, "camera_path_length": 2}
    camera = scenes.camera((0, -5, 0), (0, 0, 0), 0.1, 24)
    return scenes.scene_of(camera, (scenes.sphere("ball"), material), **defaults | settings)


def sun(*position: float) -> Light:
    """A sun that shines from a side of the ball."""
    return Light("sun", LightKind.SUN, scenes.looking(position, (0, 0.001, 0)), np.ones(3))


def crowded(material: Material) -> Material:
    """With more lobes than closures hold: one part stands for others."""
    graph = material.graph
    for _ in range(3):
        gloss = graph.add("bsdf_glossy", "bsdf", color=(0.02, 0.02, 0.02), roughness=0.5)
        graph.surface = graph.add("add_shader", "shader", shader=graph.surface, shader_001=gloss)
    return material


def estimate(mapper, scene: Scene, iterations: int) -> tuple[np.ndarray, np.ndarray]:
    """Mean radiance of all pixels, and its standard error."""
    pixels = radiance_of(mapper, scene, iterations)[..., :3].reshape(-1, 3).astype(float)
    return pixels.mean(axis=0), pixels.std(axis=0) / np.sqrt(len(pixels))


@pytest.mark.parametrize(
    ("method", "radius"), [("RANDOM_WALK", 0.2), pytest.param("RANDOM_WALK_LEGACY", 2.0, marks=pytest.mark.long)]
)
def test_white_wax_keeps_all_light(mapper, method, radius):
    """In a white world; what has not come out after the last step is lost."""
    scene = ball(wax((1.0, 1.0, 1.0), radius, method))
    scene.world = World(np.ones(3))
    mean, error = estimate(mapper, scene, 8)
    np.testing.assert_array_less(abs(mean - 1.0), 4 * error + 0.005)


def test_light_comes_through_from_behind(mapper):
    """A sun behind the ball lights none of what a diffuse one shows. Red goes farther than green, green than blue."""
    material = wax((0.9, 0.9, 0.9), 0.3)
    material.graph.nodes[-1].inputs["radius"] = (1.0, 0.5, 0.1)
    scene = ball(material, camera_path_length=1)
    scene.lights = [sun(0, 9, 0)]
    mean, error = estimate(mapper, scene, 8)
    assert mean[0] > mean[1] + 4 * error[0] and mean[1] > 4 * error[1] and mean[0] > 0.01
    assert mean[2] < 0.1 * mean[1]


def test_what_lies_within_another_object_is_not_in_the_way(mapper):
    """A black ball within a white one would take light: walks meet their own object only, as in Cycles."""
    scene = ball(wax((1.0, 1.0, 1.0), 0.5))
    scene.world = World(np.ones(3))
    scene.materials.append(scenes.diffuse(0.0, 0.0, 0.0))
    core = np.diag([0.5, 0.5, 0.5, 1.0])
    scene.instances.append(Instance(0, core, [1]))
    mean, error = estimate(mapper, scene, 8)
    np.testing.assert_array_less(abs(mean - 1.0), 4 * error + 0.005)


def test_passes_show_what_the_camera_sees_first(mapper):
    """The same as of a diffuse surface."""
    found = []
    for material in (wax((0.8, 0.5, 0.2), 0.3), scenes.diffuse(0.8, 0.5, 0.2)):
        iterated(mapper, ball(material, passes=("Position", "Normal", "Depth", "Diffuse Color")))
        found.append(mapper.film.read_passes())
    for name, seen in found[1].items():
        np.testing.assert_allclose(found[0][name], seen, rtol=1e-6, err_msg=name)


@pytest.mark.long
def test_splats_meet_importons_where_paths_come_out(mapper):
    """They do not lie where the camera sees the surface; the grid of photons has no use for that."""
    found = []
    for route in (DensityEstimation.GRID, DensityEstimation.RASTERIZED):
        scene = ball(
            wax((0.8, 0.5, 0.2), 0.3), photons=4096, direct_light=DirectLight.PHOTONS, density_estimation=route
        )
        scene.lights = [sun(0, -9, 0)]
        found.append(estimate(mapper, scene, 1)[0])
    assert found[0].min() > 0.0
    np.testing.assert_allclose(found[1], found[0], rtol=1e-4)


def test_photons_leave_where_they_come_out(mapper):
    """A sun's photons that have come to a ball go on with their flux times the albedo. Free paths are short against the
    ball, so that the albedo is that of a half space: the fit of it is within 2 %."""
    color = (0.8, 0.5, 0.2)
    scene = ball(
        wax(color, 0.02), photons=32768, photon_path_length=2, direct_light=DirectLight.PHOTONS, camera_path_length=1
    )
    scene.lights = [sun(0, 0, 9)]
    iterated(mapper, scene)
    first, second = mapper.read_photons()
    lit = first["flags"] & (PhotonFlag.ACTIVE | PhotonFlag.STORED) == PhotonFlag.ACTIVE | PhotonFlag.STORED
    assert lit.sum() > 1000
    arrived, left = first["flux"][lit].astype(float), second["flux"][lit].astype(float)
    error = (left - arrived.mean(axis=0) * np.array(color)).std(axis=0) / np.sqrt(lit.sum()) / arrived.mean(axis=0)
    albedo = left.mean(axis=0) / arrived.mean(axis=0)
    np.testing.assert_array_less(abs(albedo - color), 4 * error + 0.02 * np.array(color))
    # All that leave do so on the outside.
    gone = lit & (second["flux"].max(axis=1) > 0.0)
    assert (second["flags"][gone] & PhotonFlag.ESCAPED != 0).mean() > 0.99


def test_photons_go_below_crowded_surfaces(mapper):
    """A sun above a ball sends light up again; what has gone through the ball comes out below as well."""
    means, errors = [], []
    for material in (wax((0.9, 0.9, 0.9), 0.5), crowded(wax((0.9, 0.9, 0.9), 0.5))):
        scene = ball(
            material, photons=8192, photon_path_length=2, direct_light=DirectLight.PHOTONS, camera_path_length=1
        )
        scene.lights = [sun(0, 0, 9)]
        iterated(mapper, scene)
        first, second = mapper.read_photons()
        gone = second["flux"].max(axis=1) > 0.0
        flux, upward = second["flux"][gone, 0].astype(float), -second["direction"][gone, 2].astype(float)
        means.append((flux * upward).sum() / flux.sum())
        errors.append((flux * (upward - means[-1])).std() * np.sqrt(gone.sum()) / flux.sum())
    assert abs(means[0] - means[1]) < 4 * np.hypot(*errors)
