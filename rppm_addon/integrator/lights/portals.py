# SPDX-License-Identifier: GPL-3.0-or-later
"""Portals: area lights without light, which say where the world's comes in (shaders/lights/portals.glsl).

Shadow rays go to the world through a portal by its solid angle, or by the world's map; photons of the world leave by
what passes the portals, or from all around the scene. Each is divided by the pdf of both ways (balance heuristic, Veach
1997, section 9.2), so that a portal in a wrong place makes noise and changes no mean.
"""

from dataclasses import replace

import numpy as np

from ...scene.lights import Light, LightKind
from .environment import Environment
from .light_entry import light_entry
from .light_records import LIGHT

PORTAL_PARAMETERS = {
    "portal_count": "uint",
    "portal_light": "uint",
    "portal_fraction": "float",
    "portal_table_fraction": "float",
    "portal_table": "uint",
    "portal_width": "uint",
    "portal_height": "uint",
}
"""Members of LIGHT_PARAMETERS for portals, which are lights behind the last of the table. ``portal_light`` is the
number of the light whose photons leave through portals. ``portal_table`` is where the directions of the portals' light
begin in the EnvironmentDistribution, with ``portal_width`` columns and ``portal_height`` rows. Where portals face a
point, ``portal_fraction`` of the environment shadow rays are sampled by the portals' solid angle, and
``portal_table_fraction`` by the directions of the table; the others go by the world's map.
"""

FIRST_PHOTON_FRACTION = 0.5
"""Fraction of the world's photons that leave through portals as long as nothing has been learned."""
_MIN_PHOTONS, _MAX_PHOTONS = 0.1, 0.9
_SHADOW_RAYS = 0.9
"""Fraction of environment shadow rays that are sampled through portals; the others find other openings."""
_BRIGHT = 8.0
"""Times the mean: what is brighter in a world is found by the directions of its light."""
_BRIGHT_FRACTION = 0.1
"""Fraction of a world's light: where bright spots give more, half of the environment shadow rays look for them."""
_EVEN_ROWS = 32
_SUBCELLS = 2
"""Places along each side of a cell at which portals are asked what they let pass."""


class Portals:
    """Portals among a scene's lights, and the light of its world that passes through them; empty where none passes."""

    def __init__(
        self, lights: list[Light], environment: Environment, scene_radius: float, before: "Portals | None" = None
    ) -> None:
        """Puts the directions of what passes them behind the environment's. before: those of the last call; where they
        are the same, in the same environment, their directions stay."""
        self.records = portal_entries(lights, scene_radius)
        """LIGHT records."""
        if before is not None and environment.has_others and np.array_equal(self.records, before.records):
            found: tuple[float, dict[str, object]] = (before.power, before.parameters)
        else:
            found = self._light_up(environment)
        self.power: float = found[0]
        """W of the world's light, the channels' mean."""
        self.parameters: dict[str, object] = found[1]
        """Values of PORTAL_PARAMETERS but for the light's number."""

    def _light_up(self, environment: Environment) -> tuple[float, dict[str, object]]:
        """Power and parameters; forgets the records where no light passes."""
        passed, power = None, 0.0
        if len(self.records):
            passed = light_through(self.records, environment.brightness)
            power = power_through(passed, float(np.mean(np.abs(environment.radiance))))
        if not power > 0.0:
            self.records, passed = self.records[:0], None
        first = environment.add_directions(passed)
        fractions = shadow_ray_fractions(environment.brightness) if len(self.records) else (0.0, 0.0)
        return power, {
            "portal_count": len(self.records),
            "portal_fraction": fractions[0],
            "portal_table_fraction": fractions[1],
            "portal_table": first,
            "portal_width": 0 if passed is None else passed.shape[1],
            "portal_height": 0 if passed is None else passed.shape[0],
        }


def portal_entries(lights: list[Light], scene_radius: float) -> np.ndarray:
    """(n,) LIGHT records of the portals among the lights, but for those without an area."""
    white = (replace(light, strength=np.ones(3), spread=np.pi) for light in lights if is_portal(light))
    entries = [entry for entry, power in (light_entry(light, scene_radius) for light in white) if power.any()]
    return np.array(entries, LIGHT.dtype) if entries else LIGHT.zeros(0)


def is_portal(light: Light) -> bool:
    """Whether it stands in no table of lights that shine."""
    return light.is_portal and light.kind is LightKind.AREA


def shadow_ray_fractions(brightness: np.ndarray | None) -> tuple[float, float]:
    """Return two fractions of the environment shadow rays: those that go anywhere in portals, and those that follow
    the directions of the world's light through portals, which are taken where the world has bright spots. brightness:
    the world's map (rows, columns), or None for an even world."""
    if brightness is None:
        return _SHADOW_RAYS, 0.0
    light = brightness * _sines(len(brightness))[:, None]
    bright = light[brightness > _BRIGHT * brightness.mean()].sum() / max(light.sum(), 1e-300)
    by_light = 0.5 * min(float(bright) / _BRIGHT_FRACTION, 1.0)
    return _SHADOW_RAYS - by_light, by_light


def light_through(portals: np.ndarray, brightness: np.ndarray | None) -> np.ndarray:
    """(rows, columns) W/sr that pass the portals (LIGHT records) from the directions of each cell of a world's map, the
    largest in the cell; of an even world's, None, for a radiance of 1."""
    brightness = np.ones((_EVEN_ROWS, 2 * _EVEN_ROWS)) if brightness is None else _shown(brightness)
    rows, columns = brightness.shape
    parts = (np.arange(_SUBCELLS) + 0.5) / _SUBCELLS
    v = (np.arange(rows)[:, None] + parts).ravel() / rows
    u = (np.arange(columns)[:, None] + parts).ravel() / columns
    azimuth, polar = (0.5 - u) * 2.0 * np.pi, (1.0 - v) * np.pi
    passed = np.zeros((rows, columns))
    for portal in portals:
        normal = portal["normal"].astype(np.float64)
        across = normal[0] * np.cos(azimuth) + normal[1] * np.sin(azimuth)
        toward = np.sin(polar)[:, None] * across + normal[2] * np.cos(polar)[:, None]
        cosine = np.maximum(-toward, 0.0).reshape(rows, _SUBCELLS, columns, _SUBCELLS).max(axis=(1, 3))
        passed += float(portal["area"]) * cosine
    return brightness * passed


def _shown(brightness: np.ndarray) -> np.ndarray:
    """Means of a map over its cells as textures show it, linear between their middles: what is beside a sun has a part
    of its light, and would be too bright for how seldom it is chosen."""
    padded = np.pad(np.pad(brightness, ((0, 0), (1, 1)), "wrap"), ((1, 1), (0, 0)), "edge")
    across = (padded[:, :-2] + 6.0 * padded[:, 1:-1] + padded[:, 2:]) / 8.0
    return (across[:-2] + 6.0 * across[1:-1] + across[2:]) / 8.0


def photon_fraction(contributing_power: np.ndarray) -> float:
    """Return the fraction of the world's photons that leave through portals. contributing_power: (2,) W of the world's
    power that contributes, of all that comes to the scene and of what passes portals. What other openings let in keeps
    photons."""
    everywhere, through = contributing_power
    return float(np.clip(through / max(everywhere, 1e-300), _MIN_PHOTONS, _MAX_PHOTONS))


def power_through(passed: np.ndarray, radiance: float) -> float:
    """W of what light_through says, times a radiance."""
    rows, columns = passed.shape
    return float(radiance * (passed * _sines(rows)[:, None]).sum() * 2.0 * np.pi**2 / (rows * columns))


def _sines(rows: int) -> np.ndarray:
    return np.sin(np.pi * (np.arange(rows) + 0.5) / rows)
