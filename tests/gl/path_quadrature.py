# SPDX-License-Identifier: GPL-3.0-or-later
"""Radiance of single light path classes L(S|G|D)*E by deterministic quadrature in float64.

Nothing here is shared with the shaders. Points, directions and normals are (..., 3) arrays; directions have unit
length and point away from the surface; planes have the normal on the side where the light is. Surfaces are white:
the caller multiplies by their colors, which is exact for lobes whose reflectance is constant.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from rppm_addon.scene import Camera, Light

Scatter = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]
"""BSDF in 1/sr of (normal, one direction, the other direction)."""

_AT_ONCE = 50_000
"""Pairs of points: their arrays stay in the processor's cache."""


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("...i,...i->...", a, b)


def unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def frame(axis: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Two unit vectors across an axis, (..., 3)."""
    helper = np.where(np.abs(axis[..., :1]) < 0.6, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    first = unit(np.cross(helper, axis))
    return first, np.cross(axis, first)


def gauss_legendre(low: float, high: float, count: int) -> tuple[np.ndarray, np.ndarray]:
    x, weight = np.polynomial.legendre.leggauss(count)
    return low + (high - low) * (0.5 + 0.5 * x), 0.5 * (high - low) * weight


def circle(count: int) -> np.ndarray:
    """(count,) angles around a full turn: the trapezoidal rule is exact to high order there."""
    return 2 * np.pi * (np.arange(count) + 0.5) / count


# --- scattering ----------------------------------------------------------------------------------


def diffuse(normal: np.ndarray, wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
    """White Lambertian reflection on the upper side."""
    return np.where((dot(normal, wi) > 0) & (dot(normal, wo) > 0), 1 / np.pi, 0.0)


def glossy(roughness: float) -> Scatter:
    """Single scattering by GGX microfacets that reflect everything (Walter et al. 2007, eq. 20 and 33), with the
    height-correlated masking of Heitz (2014, eq. 99); alpha is the squared roughness."""
    alpha2 = roughness**4

    def scatter(normal: np.ndarray, wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
        ci, co = dot(normal, wi), dot(normal, wo)
        lit = (ci > 0) & (co > 0)
        ci2, co2 = ci**2, co**2
        ch2 = (ci + co) ** 2 / np.maximum(2 + 2 * dot(wi, wo), 1e-18)  # of the unit vector between both
        distribution = alpha2 / (np.pi * (1 - ch2 + alpha2 * ch2) ** 2)
        # 2 ci co (1 + smith(ci) + smith(co)) without a division by a cosine
        masked = co * np.sqrt(ci2 + alpha2 * (1 - ci2)) + ci * np.sqrt(co2 + alpha2 * (1 - co2))
        return np.where(lit, distribution / np.where(lit, 2 * masked, 1.0), 0.0)

    return scatter


# --- surfaces and light --------------------------------------------------------------------------


@dataclass(frozen=True)
class Plane:
    point: np.ndarray
    normal: np.ndarray

    def hit(self, origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
        """Where rays (origins and directions) meet the plane."""
        distance = dot(self.point - origins, self.normal) / dot(directions, self.normal)
        return origins + distance[..., None] * directions

    def mirrored(self, points: np.ndarray) -> np.ndarray:
        return points - 2 * dot(points - self.point, self.normal)[..., None] * self.normal

    def mirrored_direction(self, directions: np.ndarray) -> np.ndarray:
        return directions - 2 * dot(directions, self.normal)[..., None] * self.normal


@dataclass(frozen=True)
class Spot:
    """A spot whose intensity rises smoothly from the cone's edge to its axis (blend 1), of a sphere's extent."""

    position: np.ndarray
    axis: np.ndarray
    intensity: float
    """W/sr on the axis."""
    cosine: float
    """Cosine of half the cone's angle."""
    radius: float

    @classmethod
    def of(cls, light: Light) -> "Spot":
        assert light.spot_blend == 1.0
        position, axis = light.matrix[:3, 3], -unit(light.matrix[:3, 2])
        return cls(position, axis, float(light.strength[0]), np.cos(light.spot_angle / 2), light.radius)

    def along(self, directions: np.ndarray) -> np.ndarray:
        """W/sr toward directions (Blender's smooth step in the cosine)."""
        x = np.clip((directions @ self.axis - self.cosine) / (1 - self.cosine), 0, 1)
        return self.intensity * x**2 * (3 - 2 * x)

    def mirrored(self, plane: Plane) -> "Spot":
        return replace(self, position=plane.mirrored(self.position), axis=plane.mirrored_direction(self.axis))

    def moved(self, offset: np.ndarray) -> "Spot":
        return replace(self, position=self.position + offset)

    def beams(self, detail: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Origins (n, 3), directions (n, 3) and flux (n,) W of rays that stand for all light.

        A sphere of uniform radiance shows the same disk to every direction: its intensity is spread evenly over it.
        """
        cosine, weight = gauss_legendre(self.cosine, 1.0, 4 * detail)
        angle = circle(6 * detail)
        u, v = frame(self.axis)
        sine = np.sqrt(1 - cosine**2)[:, None, None]
        around = np.cos(angle)[:, None] * u + np.sin(angle)[:, None] * v
        directions = (sine * around + cosine[:, None, None] * self.axis).reshape(-1, 3)
        flux = np.repeat(weight, len(angle)) * (2 * np.pi / len(angle)) * self.along(directions)
        if self.radius == 0:
            return np.broadcast_to(self.position, directions.shape), directions, flux
        square, share = gauss_legendre(0.0, 1.0, detail)
        place = (np.sqrt(square)[:, None] * np.exp(1j * circle(4 * detail))).ravel() * self.radius
        u, v = frame(directions)
        origins = self.position + place.real[:, None, None] * u + place.imag[:, None, None] * v
        shares = np.repeat(share, 4 * detail) / (4 * detail)
        everywhere = np.broadcast_to(directions, origins.shape)
        return origins.reshape(-1, 3), everywhere.reshape(-1, 3), (shares[:, None] * flux).ravel()

    def toward(self, points: np.ndarray, detail: int) -> tuple[np.ndarray, np.ndarray]:
        """Directions to the light (..., n, 3) and irradiance across them (..., n) of all light at points (..., 3)."""
        to_center = self.position - points
        distance = np.linalg.norm(to_center, axis=-1)
        axis = to_center / distance[..., None]
        if self.radius == 0:
            return axis[..., None, :], (self.along(-axis) / distance**2)[..., None]
        drop = 1 - np.sqrt(1 - (self.radius / distance) ** 2)  # of the cosine, over the cap that is seen
        share, weight = gauss_legendre(0.0, 1.0, 3 * detail)
        cosine = 1 - share * drop[..., None]
        around = circle(6 * detail)
        u, v = frame(axis)
        across = np.cos(around)[:, None] * u[..., None, :] + np.sin(around)[:, None] * v[..., None, :]
        directions = (
            np.sqrt(1 - cosine**2)[..., :, None, None] * across[..., None, :, :]
            + cosine[..., :, None, None] * axis[..., None, None, :]
        )
        solid_angle = weight * drop[..., None] * (2 * np.pi / len(around))
        radiance = self.along(-directions) / (np.pi * self.radius**2)
        return (
            directions.reshape(*points.shape[:-1], -1, 3),
            (radiance * solid_angle[..., None]).reshape(*points.shape[:-1], -1),
        )


# --- camera --------------------------------------------------------------------------------------


def camera_rays(camera: Camera) -> tuple[np.ndarray, np.ndarray]:
    """Origin (3,) and directions (H, W, 3) through pixel centers, row 0 at the bottom."""
    left, right, bottom, top = camera.window
    x = left + (right - left) * (np.arange(camera.width) + 0.5) / camera.width
    y = bottom + (top - bottom) * (np.arange(camera.height) + 0.5) / camera.height
    local = np.stack(np.broadcast_arrays(x[None, :], y[:, None], -1.0), -1)
    return camera.matrix[:3, 3], unit(local @ camera.matrix[:3, :3].T)


# --- reflected light -----------------------------------------------------------------------------


def lit(
    spot: Spot, scatter: Scatter, normal: np.ndarray, points: np.ndarray, viewers: np.ndarray, detail: int = 6
) -> np.ndarray:
    """Radiance toward viewers of points (..., 3) that the spot lights: L x E."""
    to_light, irradiance = spot.toward(points, detail)
    cosine = np.maximum(dot(to_light, normal), 0.0)
    return (scatter(normal, to_light, viewers[..., None, :]) * cosine * irradiance).sum(-1)


def relit(
    spot: Spot,
    first: Plane,
    first_scatter: Scatter,
    scatter: Scatter,
    normal: np.ndarray,
    points: np.ndarray,
    viewers: np.ndarray,
    detail: int = 3,
) -> np.ndarray:
    """Radiance toward viewers of points (..., 3) lit by a first surface that holds all of the spot's cone: L x x E."""
    origins, directions, flux = spot.beams(detail)
    sources = first.hit(origins, directions)
    shape, points, viewers = points.shape[:-1], points.reshape(-1, 3), viewers.reshape(-1, 3)
    result = np.empty(len(points))
    for some in np.array_split(np.arange(len(points)), max(1, len(points) * len(flux) // _AT_ONCE)):
        to_source = sources - points[some, None]
        distance2 = dot(to_source, to_source)
        to_source /= np.sqrt(distance2)[..., None]
        cosines = np.maximum(-dot(to_source, first.normal), 0.0) * np.maximum(dot(to_source, normal), 0.0)
        leaving = flux * first_scatter(first.normal, -directions, -to_source)
        value = leaving * cosines / distance2 * scatter(normal, to_source, viewers[some, None])
        result[some] = value.sum(-1)
    return result.reshape(shape)


def gathered(
    patches: np.ndarray,
    patch_normal: np.ndarray,
    flux: np.ndarray,
    scatter: Scatter,
    normal: np.ndarray,
    points: np.ndarray,
    viewers: np.ndarray,
) -> np.ndarray:
    """Radiance toward viewers of points (n, 3) lit by diffuse patches (m, 3) that reflect so much flux (m,) W."""
    to_patch = patches - points[:, None]
    distance2 = dot(to_patch, to_patch)
    to_patch /= np.sqrt(distance2)[..., None]
    cosines = np.maximum(-dot(to_patch, patch_normal), 0.0) * np.maximum(dot(to_patch, normal), 0.0)
    return (flux / np.pi * cosines / distance2 * scatter(normal, to_patch, viewers[:, None])).sum(-1)
