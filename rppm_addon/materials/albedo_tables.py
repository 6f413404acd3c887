# SPDX-License-Identifier: GPL-3.0-or-later
"""Directional albedo of GGX lobes, tabulated for energy compensation and layering.

Rough microfacet lobes with single scattering lose energy; dividing by the albedo of the white
lobe restores it (Turquin 2019; Fdez-Aguera 2019), which is what Cycles' Multiscatter GGX does.
The layer below a dielectric coat receives what the coat's albedo leaves.

Tables are indexed [..., roughness, cosine], both linear from 0 to 1; the index of refraction by
its parameter z = sqrt(abs((ior - 1) / (ior + 1))), linear from 0 to 1. They are stored beside this
file; ``python -m rppm_addon.materials.albedo_tables`` computes them anew.

Those of the sheen (a and b of its linearly transformed cosine, and its albedo, (32, 32) each) are what Cycles
shows: tests/parity/nodes/measure_sheen.py measures them.
"""

from pathlib import Path

import numpy as np

from ..gl.buffers.constants import Constants

SIZE = 16
WHITE_SIZE = 32
SAMPLES = 4096
_VOLUME, _PLANE = (SIZE, SIZE, SIZE), (SIZE, SIZE)
_WHITE_PLANE = (WHITE_SIZE, WHITE_SIZE)
SHAPES = {
    "white": _WHITE_PLANE,
    "white_average": (WHITE_SIZE,),
    "dielectric": _VOLUME,
    "glass_entering": _VOLUME,
    "glass_leaving": _VOLUME,
    "sheen_a": _WHITE_PLANE,
    "sheen_b": _WHITE_PLANE,
    "sheen": _WHITE_PLANE,
    "glass_entering_average": _PLANE,
    "glass_leaving_average": _PLANE,
}
"""Shapes of all tables by name, in the order in which the device has them."""


def _starts() -> dict[str, int]:
    """Where each table begins in their list."""
    ends = np.cumsum([int(np.prod(shape)) for shape in SHAPES.values()]).tolist()
    return dict(zip(SHAPES, [0, *ends[:-1]], strict=True))


def length() -> int:
    """Return the length of the list of all tables."""
    return sum(int(np.prod(shape)) for shape in SHAPES.values())


Constants(
    "AlbedoTables",
    signed=True,
    TABLE_SIZE=SIZE,
    WHITE_SIZE=WHITE_SIZE,
    **{f"{name.upper()}_TABLE": start for name, start in _starts().items()},
)
_FILE = Path(__file__).with_name("albedo_tables.npz")
_SHEEN_FILE = Path(__file__).with_name("sheen_tables.npz")


def fresnel(cosine: np.ndarray, eta: np.ndarray | float) -> np.ndarray:
    """Unpolarised reflectance of a dielectric, index ``eta`` beyond over before."""
    g2 = eta * eta - 1 + cosine * cosine
    g = np.sqrt(np.maximum(g2, 1e-12))
    a = (g - cosine) / (g + cosine)
    b = (cosine * (g + cosine) - 1) / (cosine * (g - cosine) + 1)
    return np.where(g2 <= 0, 1.0, 0.5 * a * a * (1 + b * b))


def _samples(count: int) -> np.ndarray:
    """(count, 2) points of the R2 sequence (Roberts 2018)."""
    g = 1.32471795724474602596
    return (0.5 + np.arange(count)[:, None] * np.array([1 / g, 1 / g**2])) % 1.0


def visible_normals(alpha: float, cosine: float, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """View direction (3,) and microfacet normals (n, 3) by density of visible ones (Heitz 2018)."""
    wo = np.array([np.sqrt(max(0.0, 1 - cosine * cosine)), 0.0, cosine])
    v = wo * [alpha, alpha, 1.0]
    v /= np.linalg.norm(v)
    t1 = np.array([0.0, 1.0, 0.0]) if v[2] < 0.9999999 else np.array([1.0, 0.0, 0.0])
    t2 = np.cross(v, t1)
    r, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
    p1, p2 = r * np.cos(phi), r * np.sin(phi)
    s = 0.5 * (1 + v[2])
    p2 = (1 - s) * np.sqrt(np.maximum(0, 1 - p1**2)) + s * p2
    h = p1[:, None] * t1 + p2[:, None] * t2 + np.sqrt(np.maximum(0, 1 - p1**2 - p2**2))[:, None] * v
    h *= [alpha, alpha, 1.0]
    return wo, h / np.linalg.norm(h, axis=1, keepdims=True)


def _lambda(cosine: np.ndarray, alpha: float) -> np.ndarray:
    c2 = np.maximum(cosine * cosine, 1e-12)
    return 0.5 * (np.sqrt(1 + alpha * alpha * (1 - c2) / c2) - 1)


def _masking(alpha: float, wo_z: float, wi_z: np.ndarray) -> np.ndarray:
    """Shadowing given masking, G2 / G1."""
    lambda_o = _lambda(np.array(wo_z), alpha)
    return (1 + lambda_o) / (1 + lambda_o + _lambda(wi_z, alpha))


def lobe_albedos(alpha: float, cosine: float, etas: np.ndarray, samples: int) -> tuple[float, np.ndarray, np.ndarray]:
    """At one view cosine: albedo of the white mirror lobe; per eta, the interpolation between the
    reflectances at normal and at grazing incidence that layers count with; and per eta, the albedo
    of glass (what is reflected and refracted to the right side).

    As in Cycles, the interpolation is the mean over the microfacets that the viewer sees, of which
    those that reflect below the surface count as 0 and none is weighted by shadowing."""
    wo, h = visible_normals(alpha, cosine, _samples(samples))
    oh = h @ wo
    reflected_z = 2 * oh * h[:, 2] - wo[2]
    reflects = reflected_z > 0
    mirror = np.where(reflects, _masking(alpha, wo[2], reflected_z), 0.0)
    interpolations, glass = [], []
    for eta in etas:
        f = fresnel(oh, eta)
        f0 = ((eta - 1) / (eta + 1)) ** 2
        interpolations.append(np.mean(np.clip((f - f0) / max(1 - f0, 1e-6), 0, 1) * reflects))
        k = 1 - (1 - oh**2) / eta**2
        refracted_z = (oh / eta - np.sqrt(np.maximum(k, 0))) * h[:, 2] - wo[2] / eta
        passed = np.where((k > 0) & (refracted_z < 0), _masking(alpha, wo[2], refracted_z), 0.0)
        glass.append(np.mean(f * mirror + (1 - f) * passed))
    return float(mirror.mean()), np.array(interpolations), np.array(glass)


def index_of(z: np.ndarray | float) -> np.ndarray | float:
    """Index of refraction of the table parameter z."""
    z2 = np.minimum(z, 0.97) ** 2
    return (1 + z2) / (1 - z2)


def trapezoid(values: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Integral along the last axis; NumPy's own has another name before version 2."""
    return (0.5 * (values[..., 1:] + values[..., :-1]) * np.diff(at)).sum(axis=-1)


def compute(samples: int = SAMPLES) -> dict[str, np.ndarray]:
    """All tables: white (32, 32), white_average (32,), dielectric, glass_entering, glass_leaving (16, 16, 16)."""
    white = np.ones((WHITE_SIZE, WHITE_SIZE))
    for r in range(WHITE_SIZE):
        for c in range(WHITE_SIZE):
            alpha = max((r / (WHITE_SIZE - 1)) ** 2, 1e-4)
            white[r, c] = lobe_albedos(alpha, max(c / (WHITE_SIZE - 1), 1e-3), np.array([]), samples)[0]
    cosines = np.linspace(0, 1, WHITE_SIZE)
    average = trapezoid(white * 2 * cosines, cosines)
    etas = np.asarray(index_of(np.linspace(0, 1, SIZE)))
    tables = {name: np.ones((SIZE, SIZE, SIZE)) for name in ("dielectric", "glass_entering", "glass_leaving")}
    for r in range(SIZE):
        for c in range(SIZE):
            alpha, cosine = max((r / (SIZE - 1)) ** 2, 1e-4), max(c / (SIZE - 1), 1e-3)
            _, tables["dielectric"][:, r, c], tables["glass_entering"][:, r, c] = lobe_albedos(
                alpha, cosine, etas, samples
            )
            tables["glass_leaving"][:, r, c] = lobe_albedos(alpha, cosine, 1 / etas, samples)[2]
    tables |= {"white": white, "white_average": average}
    return {name: table.astype(np.float32) for name, table in tables.items()}


def load_lobes() -> dict[str, np.ndarray]:
    """Load the tables that compute() gave."""
    with np.load(_FILE, allow_pickle=False) as file:
        return {name: file[name].astype(np.float32) for name in SHAPES if name in file}


def load() -> np.ndarray:
    """All tables in one (n,) float32 list, in the order of SHAPES; those called average are cosine-weighted means."""
    tables = load_lobes()
    with np.load(_SHEEN_FILE, allow_pickle=False) as file:
        for name, key in (("sheen_a", "a"), ("sheen_b", "b"), ("sheen", "albedo")):
            tables[name] = file[key].astype(np.float32)
    cosines = np.linspace(0, 1, SIZE)
    for name in ("glass_entering", "glass_leaving"):
        tables[f"{name}_average"] = trapezoid(tables[name] * 2 * cosines, cosines).astype(np.float32)
    return np.concatenate([tables[name].reshape(shape).ravel() for name, shape in SHAPES.items()])


if __name__ == "__main__":
    np.savez_compressed(_FILE, **compute())
