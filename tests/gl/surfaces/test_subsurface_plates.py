# SPDX-License-Identifier: GPL-3.0-or-later
"""Flux of photons that leave plates with subsurface scattering, against random walks in NumPy."""

import numpy as np
import scenes
from rendering import iterated
from test_subsurface import sun, wax

from rppm_addon.integrator.common.records.photon_paths import PhotonFlag
from rppm_addon.scene import DirectLight, Scene

THICKNESS, COLOR, IOR, ROUGHNESS = 0.02, 0.9, 1.4, 0.5
# Of either material, meters.
RADII = {"RANDOM_WALK": 0.01, "RANDOM_WALK_SKIN": 0.06}
WALKS, PHOTONS = 100_000, 131_072


def half_space_albedo(color: float) -> float:
    """Return the single-scattering albedo in the medium of RANDOM_WALK.

    After d'Eon, A Hitchhiker's Guide to Multiple Scattering, 53.7.
    """
    s = 4.20863 * color - np.sqrt(9.59217 + color * (41.6808 + 17.7126 * color)) + 4.09712
    return 1.0 - s * s


def skin_albedo(color: float) -> float:
    """Return the single-scattering albedo in RANDOM_WALK_SKIN (Chiang et al. 2016, as in Cycles)."""
    blend = color**0.25
    low = 1.82605 * np.arctan((4.98511 + 0.127356) * color) ** 1.09686
    high = 0.49631 * np.arctan((4.2319 + 0.00310604) * color) ** 2.40603
    return (1.0 - blend) * low + blend * high


def skin_mean_free_path(color: float) -> float:
    """Over the radius: Cycles halves twelve times and takes what it tried last."""
    mean = (0.710 - 1.440 / IOR) / IOR + 0.668 + 0.0636 * IOR
    a = 4 / 3 * (1 + mean) / (1 - mean)
    low, high = 0.0, 1.0
    for _ in range(12):
        tried = (low + high) / 2
        s = np.sqrt(3 * (1 - tried))
        is_less = tried / 2 * (1 + np.exp(-a * s)) * np.exp(-s) < color
        low, high = (tried, high) if is_less else (low, tried)
    return np.sqrt(3 * (1 - tried))


def refracted(rng: np.random.Generator, viewers: np.ndarray, alpha: float) -> np.ndarray:
    """Cosines below the surface of paths from viewers of such cosines, 0 of those that do not get in."""
    seen = np.stack([np.sqrt(1 - viewers**2), 0 * viewers, viewers])
    scale = np.array([[alpha], [alpha], [1.0]])
    stretched = seen * scale / np.linalg.norm(seen * scale, axis=0)
    # Visible normals: the stretched view and a point of a spherical cap (Dupuy and Benyoub 2023).
    turn, z = 2 * np.pi * rng.random(len(viewers)), (1 - rng.random(len(viewers))) * (1 + stretched[2]) - stretched[2]
    sine = np.sqrt(np.clip(1 - z * z, 0, 1))
    normals = (np.stack([sine * np.cos(turn), sine * np.sin(turn), z]) + stretched) * scale
    normals /= np.linalg.norm(normals, axis=0)
    cosine = (seen * normals).sum(axis=0)
    below = (cosine / IOR - np.sqrt(1 - (1 - cosine**2) / IOR**2)) * normals[2] - viewers / IOR
    return np.maximum(-below, 0.0)


def walked(method: str) -> tuple[np.ndarray, np.ndarray]:
    """Return the share of viewers' paths that comes out behind a plate and before it, and the mean of it times the
    viewer's cosine, (2, 2), with standard errors. Viewers are distributed by their cosine, so that by reciprocity the
    share is that of the flux that leaves there."""
    rng = np.random.default_rng(1)
    viewers = np.sqrt(rng.random(WALKS))
    if method == "RANDOM_WALK":
        cosines, free, albedo = refracted(rng, viewers, ROUGHNESS), RADII[method], half_space_albedo(COLOR)
    else:
        evenly = np.sqrt(rng.random(WALKS))
        cosines = np.where(rng.random(WALKS) < 0.5, evenly, refracted(rng, viewers, 1.0))
        free, albedo = RADII[method] * skin_mean_free_path(COLOR), skin_albedo(COLOR)
    depths, weight, sums = np.zeros(WALKS), 1.0, np.zeros((2, WALKS))
    index = np.flatnonzero(cosines)
    for _ in range(256):
        depths[index] -= np.log(1 - rng.random(len(index))) * free * cosines[index]
        behind, before = index[depths[index] > THICKNESS], index[depths[index] < 0.0]
        sums[0, behind], sums[1, before] = weight, weight
        index = index[(depths[index] >= 0.0) & (depths[index] <= THICKNESS)]
        cosines[index] = 1 - 2 * rng.random(len(index))
        weight *= albedo
    moments = np.stack([sums, sums * viewers], axis=1)
    return moments.mean(axis=2), moments.std(axis=2) / np.sqrt(WALKS)


def plates() -> Scene:
    """One of each material, side by side below a sun."""
    plate = scenes.box("plate")
    plate.positions *= np.float32([1.0, 1.0, THICKNESS / 2])
    looks = {"roughness": ROUGHNESS, "ior": IOR}
    materials = [wax((COLOR, COLOR, COLOR), radius, method, **looks) for method, radius in RADII.items()]
    scene = scenes.scene_of(
        scenes.camera((0, -5, 0), (0, 0, 0), 0.1, 8), *((plate, each) for each in materials), lights=[sun(0, 0, 9)],
        photons=PHOTONS, photon_path_length=2, camera_path_length=1, direct_light=DirectLight.PHOTONS,
    )  # fmt: skip
    for instance, x in zip(scene.instances, (-1.1, 1.1), strict=True):
        instance.matrix = scenes.placed(x, 0.0, 0.0)
    return scene


def test_photons_leave_plates_as_viewers_see_them(mapper):
    """Viewers who look straight at a plate see more of what comes through than others do: their paths go in steeper."""
    iterated(mapper, plates())
    first, second = mapper.read_photons()
    lit = first["flags"] & (PhotonFlag.ACTIVE | PhotonFlag.STORED) == PhotonFlag.ACTIVE | PhotonFlag.STORED
    # Not those at the rims, which may come out there.
    lit &= np.abs(np.abs(first["position"][:, 0]) - 1.1) < 0.8
    lit &= np.abs(first["position"][:, 1]) < 0.8
    for side, method in zip((-1, 1), RADII, strict=True):
        chosen = lit & (first["position"][:, 0] * side > 0.0)
        flux = second["flux"][chosen, 0].astype(float) / first["flux"][chosen, 0].mean(dtype=float)
        upward = np.where(flux > 0.0, -second["direction"][chosen, 2].astype(float), 0.0)
        sums = np.stack([flux * (upward < 0.0), flux * (upward > 0.0)])
        moments = np.stack([sums, sums * abs(upward)], axis=1)
        found, error = moments.mean(axis=2), moments.std(axis=2) / np.sqrt(len(flux))
        expected, spread = walked(method)
        np.testing.assert_array_less(abs(found - expected), 4 * np.hypot(error, spread), err_msg=method)
        # The mean cosine is known better than how much leaves.
        ratio = found[:, 1] / found[:, 0]
        ratio_error = (sums * (abs(upward) - ratio[:, None])).std(axis=1) / np.sqrt(len(flux)) / found[:, 0]
        np.testing.assert_array_less(abs(ratio - expected[:, 1] / expected[:, 0]), 4 * ratio_error + 0.002)
